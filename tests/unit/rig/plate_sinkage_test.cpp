#include "catch.hpp"
#include "worlds.hpp"

#include <dem/rig/bed/small_bed.hpp>
#include <dem/rig/plate_sinkage.hpp>
#include <dem/rig/plate_sinkage/study.hpp>

#include <array>
#include <cmath>

namespace plate_sinkage_test {

using Catch::Approx;
using namespace dem::rig;

namespace {

/// A plate of 30 x 30 mm on some eighty coarse grains: fast to make.
plate_sinkage::Settings small() {
  plate_sinkage::Settings s;
  s.size = "smoke";
  s.grains.half_edge = 5e-3;
  s.grains.damping = 0.1;  // comes to rest soon
  s.grains.separation_factor = 1.0;
  s.bed.length = s.bed.width = 0.06;
  s.bed.depth = 0.025;
  s.bed.threads = 1;
  s.widths = {0.03};
  s.length = 0.03;
  s.sinkage = 2e-3;
  return s;
}

PlateSinkage<models::VerletCubes> small_test() {
  return {small(), [](double h) { return dem::shape::cube8(h); }};
}

}  // namespace

TEST_CASE("a plate's fit finds the k and n that its pressures were made of, counted from where they begin") {
  plate_sinkage::Settings s;
  s.sinkage = 0.02;
  s.threshold = 1e-3;  // as good as none: the curve begins 5e-9 m after its first point
  s.smoothing = 0.0;
  plate_sinkage::PlateResult r{.width = 0.03};
  for (int i = 0; i <= 450; ++i) {
    const double travel = 5e-5 * i, z = std::max(0.0, travel - 2e-3), p = 5e6 * std::pow(z, 1.2);
    r.samples.push_back({0.0, travel, 0.0, p, p, p});
  }
  plate_sinkage::evaluate(r, s);
  REQUIRE(r.fit);
  CHECK(r.fit->curve.modulus == Approx(5e6).epsilon(1e-4));
  CHECK(r.fit->curve.exponent == Approx(1.2).epsilon(1e-4));
  CHECK(r.samples.back().sinkage == Approx(450 * 5e-5 - 2e-3).epsilon(1e-5));
  CHECK(plate_sinkage::pressure_at(r.curve, 0.01) == Approx(5e6 * std::pow(0.01, 1.2)).epsilon(1e-4));
  CHECK(std::isnan(plate_sinkage::pressure_at(r.curve, 0.03)));
}

TEST_CASE("a plate that carries nothing has no curve and no fit") {
  plate_sinkage::Settings s;
  s.sinkage = 0.02;
  plate_sinkage::PlateResult r{.width = 0.03};
  for (int i = 0; i <= 450; ++i) r.samples.push_back({0.0, 5e-5 * i, 0.0, 10.0, 0.0, 0.0});
  plate_sinkage::evaluate(r, s);
  CHECK_FALSE(r.fit);
  CHECK(r.curve.sinkage.empty());
}

TEST_CASE("the slope of unloading is that of the samples between 90 and 10 percent") {
  std::vector<plate_sinkage::Unloading> samples;
  for (int i = 0; i <= 20; ++i) {  // 2e7 Pa/m, but for a knee at either end
    const double back = 1e-4 * i, p = 3e4 - 2e7 * back;
    samples.push_back({0.01 - back, i == 0 ? 3e4 : i >= 14 ? 1000.0 : p});
  }
  CHECK(plate_sinkage::unloading_slope(samples) == Approx(2e7));
  CHECK(std::isnan(plate_sinkage::unloading_slope(std::span(samples).first(2))));
  CHECK(std::isnan(plate_sinkage::unloading_slope({})));
}

TEST_CASE("settings of plates that make no sense are refused by the names of their options") {
  const auto refuses = [](auto&& change, const char* option) {
    auto s = small();
    change(s);
    CHECK_THROWS_WITH(plate_sinkage::resolve(s), Catch::Contains(option));
  };
  refuses([](auto& s) { s.sinkage = 0.02; }, "--sinkage");
  refuses([](auto& s) { s.widths = {0.07}; }, "--plates");
  refuses([](auto& s) { s.length = 0.04, s.widths = {0.03, 0.0301}; }, "--plates");
  refuses([](auto& s) { s.length = 0.04, s.widths = {0.0295, 0.0305}; }, "both would be called plate_30mm");
  refuses([](auto& s) { s.length = 0.07; }, "--plate-length");
  refuses([](auto& s) { s.length = 0.02; }, "the smaller side of a plate) is 0.03");
  refuses([](auto& s) { s.plate_density = 0.0; }, "--plate-density");
  refuses([](auto& s) { s.drive_stiffness = -1e7; }, "--drive-stiffness");
  refuses([](auto& s) { s.unload_speed = 2.0; }, "--unload-speed");
  refuses([](auto& s) { s.fit_from = 0.6; }, "--fit-from");
  refuses([](auto& s) { s.bed.relative_density = 1.5; }, "--relative-density");
  refuses([](auto& s) { s.bed.fall_speed = 0.01; }, "--fall-speed is 0.01 m/s");
  refuses([](auto& s) { s.grains.half_edge = -1.0; }, "--half-edge");
  refuses([](auto& s) { s.grains.stiffness = 1e300; }, "--stiffness");
  refuses([](auto& s) { s.grains.damping = 1e300; }, "--damping");
  refuses([](auto& s) { s.grains.constants_for = 1.86; }, "--constants-for");  // mm
}

TEST_CASE("a plate goes half as deep as its bed at most, also where that comes from a file of grains") {
  auto s = small();
  s.bed.file = "bed.txt";
  s.sinkage = 0.02;  // of a bed that may be deeper than the rig's own
  CHECK_NOTHROW(plate_sinkage::resolve(s));
  CHECK_NOTHROW(plate_sinkage::require_depth(s, 0.041));
  CHECK_THROWS_WITH(plate_sinkage::require_depth(s, 0.039),
                    Catch::Contains("--sinkage is 0.02 m, but must be at most half of the bed's depth"));
}

TEST_CASE("relative densities count between the limits of the grains' shape, and so does the number of grains") {
  GrainSettings grains{.half_edge = 5e-3};
  BedSettings bed;
  bed.length = bed.width = bed.depth = 0.1;
  CHECK(grains_in(bed, grains, 1e-7) == 7620);
  CHECK(grains.relative_density(0.762) == Approx(0.0).margin(1e-12));
  grains.limits = dem::soil::sharp_cube_limits;
  CHECK(grains_in(bed, grains, 1e-7) == 5300);
  CHECK(grains.relative_density(0.893) == Approx(1.0));
  CHECK(std::isnan(grains.relative_density(std::nan(""))));
}

TEST_CASE("the line of a fit is drawn where points were fitted") {
  plate_sinkage::VariantResult v;
  auto& s = v.variant.settings;
  s.sinkage = 0.02;
  s.threshold = 1e-3;
  s.smoothing = 0.0;
  s.fit_from = 0.25;
  auto& r = v.plates.emplace_back(plate_sinkage::PlateResult{.width = 0.03});
  for (int i = 0; i <= 450; ++i) r.samples.push_back({0.0, 5e-5 * i, 0.0, 1e6 * 5e-5 * i, 0.0, 0.0});
  plate_sinkage::evaluate(r, s);
  REQUIRE(r.fit);
  const auto plot = plate_sinkage::fit_plot(v);
  CHECK(plot.series.at(0).x.front() < 0.5);  // mm
  CHECK(plot.series.at(1).x.front() == Approx(5.0).margin(0.1));
  CHECK(plot.series.at(1).x.back() == Approx(20.0).margin(0.1));
}

TEST_CASE("a bed whose grains fall slowly takes longer to make, and says so") {
  const auto bed_at = [](double fall_speed) {
    auto s = small();
    s.bed.fall_speed = fall_speed;
    return PlateSinkage<models::VerletCubes>(s, [](double h) { return dem::shape::cube8(h); }).make_bed();
  };
  const auto freely = bed_at(0.0), slowly = bed_at(0.1);
  CHECK(slowly.world.grain_count() == freely.world.grain_count());
  // The topmost of five layers of the lattice comes down by some 40 mm: 0.4 s in place of 0.1.
  CHECK(slowly.world.time() > freely.world.time() + 0.15);
  CHECK_THAT(packing_of(freely).note, Catch::Contains("rained, seed"));
  CHECK_THAT(packing_of(slowly).note, Catch::Contains("rained at 0.1 m/s at most, seed"));
}

TEST_CASE("walls leave room for a heap above a bed that starts level, as one from a file does") {
  const GrainSettings grains{.half_edge = 5e-3};
  const dem::soil::Packing level{.half_edge = 5e-3, .grains = {{{0, 0, 0.02}, {}}, {{0.01, 0, 0.03}, {}}}};
  CHECK(walls_for(level, grains) >= 0.03 + 10 * 0.01);
}

TEST_CASE("a grain that is lost is told of with the option that helps") {
  CHECK(in_own_words("close the walls, lower time_step (now 5e-05 s), or enlarge domain", bed_words()) ==
        "lower --stable-share (the time step is now 5e-05 s)");
}

TEST_CASE("a bed that is narrower than five widths of its widest plate, or shallower than two, is told of in numbers") {
  using Catch::Contains;
  const auto both = small_bed_note(0.07, 0.16, 0.10);
  CHECK_THAT(both, Contains("plate of 70 mm"));
  CHECK_THAT(both, Contains("2.3 widths wide and 1.4 widths deep"));
  CHECK_THAT(both, Contains("walls and floor"));
  CHECK_THAT(both, Contains("Give --bed-width 0.35 and --bed-depth 0.14, or narrower --plates"));
  CHECK_THAT(small_bed_note(0.07, 0.16, 0.14), Contains("Give --bed-width 0.35, or"));
  CHECK_THAT(small_bed_note(0.07, 0.35, 0.10), Contains("floor may help") && Contains("Give --bed-depth 0.14, or"));
  CHECK(small_bed_note(0.07, 0.35, 0.14).empty());  // just large enough
  CHECK(small_bed_note(0.07, 0.35, std::nan("")).empty());
  CHECK_FALSE(small_bed_note(0.07, 0.34, std::nan("")).empty());
}

TEST_CASE("a study of plates changes what it says, and nothing else, in beds of three seeds") {
  const auto resolved = [](const char* study) {
    auto s = small();
    s.study = study;
    plate_sinkage::resolve(s);
    return s;
  };
  auto s = resolved("box");
  const auto box = plate_sinkage::variants(s);
  REQUIRE(box.size() == 12);
  CHECK(box[1].settings.bed.width == Approx(2.0 * s.bed.width));
  CHECK(box[1].settings.bed.depth == s.bed.depth);
  CHECK(box[2].settings.bed.depth == Approx(2.0 * s.bed.depth));
  CHECK(box[3].settings.bed.length == Approx(2.0 * s.bed.length));
  CHECK(box[5].settings.bed.width == Approx(2.0 * s.bed.width));
  CHECK(box[5].settings.bed.seed == s.bed.seed + 1);
  s = resolved("speed");
  CHECK(plate_sinkage::variants(s).at(1).settings.speed == Approx(0.5 * s.speed));
  CHECK(plate_sinkage::variants(resolved("none")).size() == 1);
  s = small();
  s.study = "speed";
  s.bed.file = "bed.txt";
  plate_sinkage::resolve(s);  // half the speed on the bed of a file: that is one seed
  CHECK(plate_sinkage::variants(s).size() == 2);
  s.study_seeds = 2;
  CHECK_THROWS_WITH(plate_sinkage::resolve(s), Catch::Contains("--study-seeds 2 needs other beds"));
  s = small();
  s.study = "seeds";
  s.study_seeds = 1;
  CHECK_THROWS_WITH(plate_sinkage::resolve(s), Catch::Contains("--study-seeds"));
}

TEST_CASE("the study of plates has the spread of the seeds, and changes paired by seed with a verdict") {
  auto s = small();
  s.widths = {0.03, 0.04}, s.length = 0.05;
  s.study = "box";
  plate_sinkage::resolve(s);
  plate_sinkage::Campaign c;
  // Pressures (kPa) under the two plates: as set, twice as wide, as deep and as long; beds of three seeds.
  const double kPa[12][2] = {{20, 30}, {18, 27}, {20.2, 30.3}, {19, 30},      {22, 30},       {20.24, 27},
                             {22, 30}, {21, 30}, {24, 33},     {21.12, 29.7}, {23.76, 32.67}, {23, 33}};
  const auto all = plate_sinkage::variants(s);
  for (std::size_t v = 0; v < all.size(); ++v) {
    auto& of = c.variants.emplace_back(plate_sinkage::VariantResult{.variant = all[v], .solid_fraction = 0.78});
    for (std::size_t k = 0; k < 2; ++k) {
      const double p = 1e3 * kPa[v][k], z = s.sinkage;
      of.plates.push_back(
          {.width = s.widths[k],
           .finished = true,
           .curve = {.width = s.widths[k], .sinkage = {0.1 * z, 0.6 * z, 0.9 * z}, .pressure = {0, p, p}}});
    }
  }
  auto rows = plate_sinkage::study_rows(c);
  REQUIRE(rows.size() == 12);  // two plates and their mean, of four boxes
  CHECK(rows[0].value.count == 3);
  CHECK(rows[0].value.mean == Approx(22e3));
  CHECK(rows[0].value.deviation == Approx(2e3));
  CHECK(rows[0].from_as_set.pairs() == 0);
  CHECK(rows[2].value.mean == Approx(26.5e3));
  CHECK(rows[2].place == 2);
  CHECK(rows[3].from_as_set.percent().value == Approx(-10.06).epsilon(1e-3));
  CHECK(rows[3].from_as_set.percent().error == Approx(1.206).epsilon(1e-3));
  CHECK(rows[4].from_as_set.percent().error == Approx(0.0).margin(1e-9));
  CHECK(rows[6].from_as_set.is_within(5.0) == std::string("yes"));
  CHECK(rows[9].from_as_set.value().value == Approx(-1e3));

  const StudiedValue of = plate_sinkage::studied_pressure(s);
  const auto table = study_table(of, rows, plate_sinkage::study_caption);
  dem::io::check_table(table);
  CHECK(table.rows[0][0] == "as set");
  CHECK(table.rows[0][5] == "2.00");
  CHECK(table.rows[0][6].empty());  // pairs
  CHECK(table.rows[0][9].empty());
  CHECK(table.rows[3][9] == "-10.1");
  CHECK(table.rows[3][12] == "5 %: not told");
  CHECK(table.rows[5][1] == "mean");
  CHECK(table.rows[8][11] == "no");
  const auto words = study_findings(of, rows, 2);
  REQUIRE(words.size() == 4);
  CHECK_THAT(words[0], Catch::Contains("Beds of 3 seeds in the box as set deviate by 1.80 kPa in the mean pressure of "
                                       "the plates, 26.50 ± 1.04 kPa"));
  CHECK_THAT(words[1],
             Catch::StartsWith(
                 "A bed twice as wide changes the mean pressure of the plates by -2.66 ± 0.22 kPa, -10.0 ± 0.5 %"));
  CHECK_THAT(words[1], Catch::EndsWith("told from none, and more than the 5 %."));
  CHECK_THAT(words[2], Catch::EndsWith("not told from none, and within the 5 %."));

  // A run that ended early has no pressure; its seed drops out of the pair.
  c.variants[5].plates.back().finished = false;
  rows = plate_sinkage::study_rows(c);
  CHECK(rows[3].from_as_set.pairs() == 3);
  CHECK(rows[4].from_as_set.pairs() == 2);
  CHECK(rows[5].from_as_set.pairs() == 2);
  CHECK(of.speed_limit == 3.0);
  c.variants.resize(1);
  CHECK(plate_sinkage::study_rows(c).empty());
}

TEST_CASE(
    "a plate in a levelled bed: the machine of table 4.1, the weight on the floor, and the same again from a copy") {
  const auto test = small_test();
  const auto bed = test.make_bed();
  const auto& m = bed.world.machine();
  CHECK(m.bodies().size() == 4);  // ground, bottom box, top box, lid
  CHECK(m.parts().joints.size() == 3);
  CHECK(m.parts().actuators.size() == 3);

  // Sinkage is measured from the mean surface, so an untouched bed has no rut, and not from the lid, which stood on the
  // highest grains.
  const auto places = dem::soil::placements(bed.world);
  const auto surface = surface_profile(places, 5e-3, -0.03, 0.03, -0.03, 0.03);
  CHECK(bed.level == Approx(mean_surface(std::span(&surface, 1))));
  const SurfaceProfile flat{surface.y, std::vector<double>(surface.y.size(), bed.level)};
  CHECK(rut_between(flat, surface, 0.0, 0.12).depth == Approx(0.0).margin(1e-9));
  CHECK(bed.lid_low() > bed.level + 1e-3);

  // At rest the box carries the grains: friction holds no part of them but against the box itself.
  double up = 0.0;
  for (std::size_t k = 0; k < 9; ++k) up -= bed.world.surface_force(dem::SurfaceId(k)).z();  // floor and 8 walls
  const double weight = 9.81 * 2650.0 * bed.grain_volume() * static_cast<double>(bed.world.grain_count());
  CHECK(up == Approx(weight).epsilon(0.02));  // rest is a speed below 3 mm/s, not a force

  auto settings = small();
  settings.unload = true;
  const PlateSinkage<models::VerletCubes> drawing_up(settings, [](double h) { return dem::shape::cube8(h); });
  const auto first = test.press(bed, 0.03), second = drawing_up.press(bed, 0.03);
  REQUIRE(first.finished);
  CHECK(first.unloading.empty());
  CHECK(std::isnan(first.unloading_stiffness));
  // It is drawn up until the grains push with a twentieth, by less than it was pressed.
  REQUIRE(second.unloading.size() > 2);
  CHECK(second.unloading.back().pressure <= 0.05 * second.samples.back().pressure);
  // Coarse grains let go of a plate that stops. Its drive (1e7 N/m, damped critically) stops 0.07 kg at 0.1 m/s within
  // v sqrt(m/k), 8 um.
  CHECK(second.unloading.back().travel < second.samples.back().travel + 8.4e-6);
  CHECK(second.unloading.back().travel > second.samples.back().travel - 0.25 * 2e-3 - 1e-4);
  REQUIRE(first.samples.size() == second.samples.size());
  bool same = true;
  for (std::size_t i = 0; i < first.samples.size(); ++i) same &= first.samples[i].force == second.samples[i].force;
  CHECK(same);
  CHECK(first.curve.sinkage.back() >= 2e-3 * (1.0 - 1e-9));
  // The drive carries what the grains push, less the plate's weight. Its momentum, 0.07 kg at 0.1 m/s, changes the mean
  // over the 0.05 s or more that the test takes by at most 0.14 N.
  double off = 0.0;
  for (const auto& x : first.samples) {
    off += (x.force - x.drive - 9.81 * 7800.0 * 9e-6) / static_cast<double>(first.samples.size());
  }
  CHECK(off == Approx(0.0).margin(0.15));
  CHECK(first.samples.back().time > 0.05);

  // A test that goes on after its last moment draws the plate up no farther.
  Stages quiet;
  plate_sinkage::PlateResult drawn{.width = 0.03, .unloading = {second.unloading.back()}};
  drawing_up.press(bed, drawn, quiet, [](const auto&, double) {});
  CHECK(drawn.unloading.size() == 1);

  // Where the smoothed pressure passes the threshold after a single push does, the plate goes on to the sinkage that
  // is counted from there.
  settings = small();
  settings.smoothing = 0.2;
  settings.threshold = 2e4;
  const PlateSinkage<models::VerletCubes> smooth(settings, [](double h) { return dem::shape::cube8(h); });
  const auto late = smooth.press(bed, 0.03);
  REQUIRE(late.finished);
  std::size_t push = 0;
  while (late.samples[push].pressure < 2e4) ++push;
  CHECK(late.samples[push].sinkage < -2e-5);
  CHECK(late.curve.sinkage.back() >= 2e-3 * (1.0 - 1e-9));

  // A plate of another mass, on another drive: the settings reach the machine.
  settings = small();
  settings.plate_density = 2700.0;
  settings.drive_stiffness = 2e6;
  settings.sinkage = 2e-4;
  settings.ramp_time = 1e-3;
  const PlateSinkage<models::VerletCubes> light(settings, [](double h) { return dem::shape::cube8(h); });
  plate_sinkage::PlateResult result{.width = 0.03};
  double mass = 0.0, stiffness = 0.0;
  std::array<std::size_t, 3> parts = {};
  light.press(bed, result, quiet, [&](const auto& world, double) {
    const auto& machine = world.machine();
    mass = machine.bodies().back().mass;
    stiffness = machine.parts().actuators.back().spec.position_gain;
    parts = {machine.bodies().size(), machine.parts().joints.size(), machine.parts().actuators.size()};
  });
  CHECK(parts == std::array<std::size_t, 3>{5, 4, 4});  // the plate comes with its test
  CHECK(mass == Approx(2700.0 * 9e-6));
  CHECK(stiffness == 2e6);
}

}  // namespace plate_sinkage_test
