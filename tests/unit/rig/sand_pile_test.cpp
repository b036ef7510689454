#include "catch.hpp"
#include "io/files.hpp"
#include "worlds.hpp"

#include <dem/io/file.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/sand_pile.hpp>
#include <dem/rig/sand_pile/pile_rig.hpp>
#include <dem/rig/settings_file.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace sand_pile_test {

using namespace dem;
using namespace dem::rig;
using namespace dem::rig::sand_pile;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("kinds of grains by name") {
  const auto kinds = kinds_in("cube8,cube8-viscous,sphere-rolling,sphere-braked");
  REQUIRE(kinds.size() == 4);
  CHECK((kinds[0].shape == "cube8" && !kinds[0].viscous && !kinds[0].rolling));
  CHECK((kinds[1].shape == "cube8" && kinds[1].viscous));
  CHECK((kinds[2].shape == "sphere" && kinds[2].rolling && kinds[2].name == "sphere-rolling" && !kinds[2].braked));
  CHECK((kinds[3].shape == "sphere" && kinds[3].rolling && kinds[3].braked));
  CHECK((kinds[1].world() == "cube8" && kinds[2].world() == "sphere" && kinds[3].world() == "sphere-braked"));
  for (const char* wrong :
       {"", "cube", "cube8-", "cube8-rolling", "cube8-braked", "sphere-soft", "sphere,", "sphere, cube8"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(kinds_in(wrong), ContainsSubstring("but must be cube8, polyhedron"));
  }
  CHECK_THROWS_WITH(kinds_in("sphere,cube8,sphere"), ContainsSubstring("'sphere' twice"));
}

TEST_CASE("what a sand pile's settings leave open follows from the size and the grains") {
  Settings s;
  sand_pile::resolve(s);
  CHECK(s.grains == 1200);
  CHECK(kinds_in(s.kinds).size() == 4);
  // The cylinder's fill, at a solid fraction of 0.6, is twice as high as its radius.
  CHECK(bulk_volume(s) == Approx(1200 * 8 * std::pow(1.6e-3, 3) / 0.6));
  CHECK(2.0 * std::acos(-1.0) * std::pow(s.cylinder_radius, 3) == Approx(bulk_volume(s)));
  CHECK(s.plate_friction == 0.4);
  CHECK(s.container_friction == 0.0);
  Settings box;
  box.method = "drain";
  box.plate_friction = 0.5;
  sand_pile::resolve(box);
  CHECK(box.container_friction == 0.5);
}

TEST_CASE("settings of a sand pile that make no sense are refused") {
  const auto refused = [](auto change) {
    Settings s;
    change(s);
    sand_pile::resolve(s);
  };
  CHECK_THROWS_WITH(refused([](Settings& s) { s.method = "throw"; }), ContainsSubstring("--method is 'throw'"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.size = "big"; }), ContainsSubstring("--size is 'big'"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.grains = 3; }), ContainsSubstring("--grains"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.method = "funnel", s.orifice_radius = 1e-3; }),
                    ContainsSubstring("--orifice-radius"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.plate_radius = 1e-3; }), ContainsSubstring("--plate-radius"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.friction = -1.0; }), ContainsSubstring("--friction"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.flank_low = 0.9; }), ContainsSubstring("--flank-low"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.sample_time = 0.1; }), ContainsSubstring("--sample-time"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.rolling_damping = -0.1; }), ContainsSubstring("--rolling-damping"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.stiffness = 1e300; }), Catch::StartsWith("--stiffness"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.constants_for = 0.9; }), Catch::StartsWith("--constants-for"));  // mm
  CHECK_THROWS_WITH(refused([](Settings& s) { s.rolling_length = 1.0; }), Catch::StartsWith("--rolling-length"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.plate_rolling_length = 1.0; }),
                    ContainsSubstring("--plate-rolling-length"));
  CHECK_THROWS_WITH(refused([](Settings& s) { s.lift_speed = std::nan(""); }), ContainsSubstring("--lift-speed"));
}

TEST_CASE("a cylinder that is too wide for its grains is to be narrower, and one that is too narrow wider") {
  Settings s;
  s.size = "smoke";
  s.cylinder_radius = 5.0;
  CHECK_THROWS_WITH(sand_pile::resolve(s), ContainsSubstring("--cylinder-radius is 5 m, but must be at most 0.237 m"));
  s.cylinder_radius = 0.236;
  sand_pile::resolve(s);
  for (const double radius : {sphere_radius(s.half_edge), std::sqrt(3.0) * s.half_edge}) {
    CHECK(sand_pile::lattice(s, radius, 1).size() == s.grains);
  }
  s.cylinder_radius = 5.0;
  CHECK_THROWS_WITH(sand_pile::lattice(s, 1.4 * s.half_edge, 1),
                    ContainsSubstring("--cylinder-radius is 5 m, so wide"));
  s.cylinder_radius = 4.0 * s.half_edge;
  CHECK_THROWS_WITH(sand_pile::lattice(s, 1.9 * s.half_edge, 1), ContainsSubstring("make it wider"));
}

TEST_CASE("what is no pile has no angle, and it is said why and what to change") {
  Settings s;
  s.size = "smoke";
  sand_pile::resolve(s);
  const double d = 2.0 * s.half_edge, radius = sphere_radius(s.half_edge);
  PileResult r;
  r.kind = kind_named("sphere");
  /// Columns of grains within `reach` (m) of the axis, as high as layers(distance from the axis).
  const auto pile_up = [&](double reach, auto&& layers) {
    r.pile.clear();
    const int n = static_cast<int>(reach / d);
    for (int i = -n; i <= n; ++i) {
      for (int j = -n; j <= n; ++j) {
        const double out = std::hypot(i * d, j * d);
        for (int k = 0; out <= reach && k < layers(out); ++k) {
          r.pile.push_back({.position = {i * d, j * d, (k + 0.5) * d}});
        }
      }
    }
    r.flank = flank_of(r.pile, s, radius);
    return no_angle_note(s, r);
  };
  CHECK(no_angle_note(s, r).empty());  // not measured
  CHECK(pile_up(10.0 * d, [&](double out) { return 10.0 - out / d; }).empty());
  CHECK(r.flank.angle * degrees == Approx(45.0).margin(5.0));
  CHECK_THAT(pile_up(10.0 * d, [](double) { return 1.0; }), ContainsSubstring("pile sphere of seed 0 has no angle") &&
                                                                ContainsSubstring("must be 18 mm, three grains") &&
                                                                ContainsSubstring("a smaller --cylinder-radius"));
  CHECK(std::isnan(r.flank.angle));
  CHECK_THAT(pile_up(1.5 * d, [](double) { return 8.0; }), ContainsSubstring("fewer than 5 places in every sector"));
}

namespace {

using Cubes = models::VerletCubes;

/// A small pile of cubes that come to rest soon.
Settings small_pile() {
  Settings s;
  s.size = "smoke";
  s.half_edge = 5e-3;
  s.grains = 90;
  s.cylinder_radius = 0.025;
  s.damping = 0.1;
  s.separation_factor = 1.0;
  s.lift_speed = 0.3;
  s.creep_time = 0.01;
  s.rest_limit = 0.05;
  s.threads = 1;
  sand_pile::resolve(s);
  return s;
}
SandPile<Cubes> pile_of(const Settings& s) {
  return {s, grains_of<Cubes>(s, kind_named("cube8"), shape::cube8(s.half_edge))};
}

}  // namespace

TEST_CASE("a flank has an angle once the cylinder holds no grain any more") {
  const Settings s = small_pile();
  const SandPile<Cubes> pile = pile_of(s);
  PileResult r;
  r.kind = kind_named("cube8");
  r.seed = 1;
  Stages quiet;
  double half_length = 0.0;
  int steep = 0, free = 0;
  bool none_while_held = true;
  pile.make(r, quiet, [&](const auto& world) {
    const double z = world.machine().bodies().back().position().z();
    if (half_length == 0.0) half_length = z - 1.2 * s.half_edge;
    const auto grains = soil::placements(world);
    const bool is_held = soil::height_percentile(grains, 1.0) > z - half_length;
    if (is_held) steep += std::isfinite(flank_of(grains, s, equal_radius(shape::cube8(s.half_edge))).angle) ? 1 : 0;
    none_while_held &= !is_held || std::isnan(r.samples.back().angle);
    free += std::isfinite(r.samples.back().angle) ? 1 : 0;
  });
  CHECK(none_while_held);
  CHECK(steep > 0);  // the grains in the cylinder would have one
  CHECK(free > 0);
  CHECK(r.finished);
}

TEST_CASE("a pile starts from the fill that an earlier one has left") {
  Settings s = small_pile();
  const PileResult first = pile_of(s).make(1);
  REQUIRE(first.fill.size() == s.grains);
  const TempFolder folder;
  s.fill_file = (folder / "cube8_1_filled.txt").string();
  save_fill(s, "cube8", first.fill, s.fill_file);

  const auto start = read_fill(s, "cube8");
  REQUIRE(start.size() == s.grains);
  for (std::size_t k = 0; k < start.size(); ++k) CHECK(start[k].position == first.fill[k].position);

  const PileResult second = pile_of(s).make(7);  // the seed is that of grains that are rained in
  CHECK(second.finished);
  // Without the springs of friction that the first had, the grains shift a little as they come to rest once more. A
  // lattice falls through many grains.
  double farthest = 0.0;
  for (std::size_t k = 0; k < start.size(); ++k) {
    farthest = std::max(farthest, (second.fill[k].position - start[k].position).norm());
  }
  CHECK(farthest < 0.5 * s.half_edge);
  CHECK(second.samples.back().time < first.samples.back().time);  // nothing has to fall
}

TEST_CASE("a fill of other grains or of another container is refused") {
  const TempFolder folder;
  Settings s;
  s.size = "smoke";
  s.fill_file = (folder / "filled.txt").string();
  for (const char* method : {"lift", "funnel", "drain"}) {
    INFO(method);
    Settings of = s;
    of.method = method;
    sand_pile::resolve(of);
    CHECK(of.seeds == 1);
    const auto grains = sand_pile::lattice(of, 1.8 * of.half_edge, 1);
    save_fill(of, "cube8", grains, s.fill_file);
    const auto read = read_fill(of, "cube8");
    REQUIRE(read.size() == grains.size());
    CHECK((read.back().position - grains.back().position).norm() < 1e-15);
    CHECK_THROWS_WITH(read_fill(of, "sphere"),
                      ContainsSubstring("has grains of shape cube8") && ContainsSubstring("give --kinds cube8"));
    Settings other = of;
    other.grains = 251;
    CHECK_THROWS_WITH(read_fill(other, ""), ContainsSubstring("give --grains 250 --half-edge 0.003"));
    other = of;
    other.plate = "flat";
    CHECK_THROWS_WITH(read_fill(other, ""),
                      ContainsSubstring("another container") &&
                          ContainsSubstring(std::string("give --method ") + method + " --plate ridged"));
    other = of;
    other.orifice_radius *= 1.1;
    CHECK((method == std::string("funnel")) == [&] {
      try {
        read_fill(other, "");
        return false;
      } catch (const Error&) {
        return true;
      }
    }());
  }
  soil::save_packing({3e-3, 0.1, 0.1, "a pile, lift", {{}}}, s.fill_file);
  CHECK_THROWS_WITH(read_fill(s, ""), ContainsSubstring("is no fill of a container"));
  s.seeds = 2;
  CHECK_THROWS_WITH(sand_pile::resolve(s), ContainsSubstring("--seeds is 2, but must be 1 with --fill-file"));
}

TEST_CASE("options of a sand pile that change nothing are named") {
  Settings s;
  Options options;
  sand_pile::declare(options, s);
  for (const char* method : {"lift", "funnel", "drain"}) {
    s.method = method;
    IdleOptions idle;
    sand_pile::find_idle(idle, s);
    for (const IdleOption& o : idle.all()) CHECK(options.find(o.name) != nullptr);
    CHECK(idle.contains("--lift-speed") == (s.method != "lift"));
    CHECK(idle.contains("--orifice-radius") == (s.method != "funnel"));
    CHECK(idle.contains("--slot-width") == (s.method != "drain"));
  }
  for (const bool vtk : {true, false}) {
    for (const bool replay : {true, false}) {
      s.vtk = vtk, s.replay = replay;
      IdleOptions idle;
      sand_pile::find_idle(idle, s);
      CHECK(idle.contains("--frame-time") == (!vtk && !replay));
    }
  }
  s.kinds = "sphere";
  IdleOptions idle;
  sand_pile::find_idle(idle, s);
  CHECK(idle.contains("--rolling-length"));
  CHECK(idle.contains("--rolling-damping"));
  s.kinds = "sphere-braked";
  idle = {};
  sand_pile::find_idle(idle, s);
  CHECK_FALSE(idle.contains("--rolling-length"));
  CHECK(idle.contains("--rolling-damping"));  // a constant torque has no springs
}

TEST_CASE("what a way of piling does not have is not asked for") {
  Settings s;
  s.method = "drain";
  s.grains = 20;
  CHECK_THROWS_WITH(sand_pile::resolve(s), ContainsSubstring("--box-length"));
  s.box_length = 0.02;
  CHECK_NOTHROW(sand_pile::resolve(s));
  s = {};
  s.method = "lift", s.grains = 40;
  CHECK_NOTHROW(sand_pile::resolve(s));  // too few for a box that is emptied
  s = {};
  s.method = "lift", s.grains = 20;
  CHECK_NOTHROW(sand_pile::resolve(s));
  CHECK(s.cylinder_radius == Approx(6.0 * s.half_edge));  // the least that the lattice has places in
  s.cylinder_radius = 3.0 * s.half_edge;
  CHECK_THROWS_WITH(sand_pile::resolve(s), ContainsSubstring("--cylinder-radius"));
}

TEST_CASE("a few grains of any shape have places in the cylinder that is as wide as they need") {
  for (const std::size_t grains : {20, 21, 31, 37, 60, 90, 105}) {
    Settings s;
    s.grains = grains;
    sand_pile::resolve(s);
    for (const double bounding_radius :
         {std::sqrt(3.0) * s.half_edge, 1.366 * s.half_edge, sphere_radius(s.half_edge)}) {
      CHECK(lattice(s, bounding_radius, 1).size() == grains);
    }
  }
}

TEST_CASE("it is said which piles stand, by the one that creeps most, and that they were watched too shortly") {
  Campaign c;
  const auto add = [&](const char* kind, double creep, double time) {
    PileResult& r = c.piles.emplace_back();
    r.kind = kind_named(kind), r.creep = creep, r.creep_time = time;
  };
  add("cube8", not_known, not_known);
  CHECK(creep_text(c).empty());
  add("cube8", 2e-4, 10.0);
  CHECK_THAT(creep_text(c), Catch::EndsWith("cube8 stands (0.0002)."));
  add("cube8", 3e-4, 10.0);
  add("sphere", 1e-5, 1.0);
  add("sphere", 0.02, 1.0);
  CHECK_THAT(creep_text(c), ContainsSubstring("cube8 stands (0.0003), sphere creeps (0.02).") &&
                                Catch::EndsWith("for 1 s alone: give --creep-time 10."));
}

TEST_CASE("piles of a kind are one row of the table") {
  Campaign c;
  for (const double angle : {0.4, 0.5}) {
    PileResult& r = c.piles.emplace_back();
    r.kind = kind_named("sphere");
    r.flank.angle = angle;
    r.poured = 100;
    r.lost = 5;
  }
  c.piles.emplace_back().kind = kind_named("cube8");
  const auto t = angle_table(c);
  REQUIRE(t.rows.size() == 2);
  CHECK(t.rows[0][0] == "sphere");
  CHECK(t.rows[0][1] == "2");
  CHECK(t.rows[0][2] == "25.8");  // 0.45 rad
  CHECK(t.rows[0][4] == "4.1");   // 0.1/sqrt(2) rad
  CHECK(t.rows[0][9] == "5.0");
  CHECK(t.rows[1][2] == "-");  // a run that ended early
}

namespace {

/// Piles with angles (deg) that were made up: two of spheres that roll hardly, one of cubes.
Campaign made_up() {
  Campaign c;
  for (const auto& [kind, angle] : {std::pair{"cube8", 30.0}, {"sphere-braked", 20.0}, {"sphere-braked", 24.0}}) {
    PileResult& r = c.piles.emplace_back();
    r.kind = kind_named(kind);
    r.seed = c.piles.size();
    r.poured = 10;
    r.finished = true;
    r.pile.push_back({});
    r.flank.angle = angle / degrees;
    r.flank.scatter = 3.0 / degrees;
  }
  return c;
}

}  // namespace

TEST_CASE("spheres with rolling resistance have the angle of Zhou et al., and no others do") {
  Settings s;
  s.half_edge = 4.02998e-3;  // a diameter of 10 mm
  s.friction = 0.4;
  s.plate_friction = 0.5;
  s.rolling_length = 0.05e-3;
  s.plate_rolling_length = 0.1e-3;
  CHECK(angle_by_zhou(s, kind_named("sphere-braked")) == Approx(18.4).margin(0.05));
  s.half_edge = 2.01499e-3;
  CHECK(angle_by_zhou(s, kind_named("sphere-rolling")) == Approx(21.1).margin(0.05));
  CHECK(std::isnan(angle_by_zhou(s, kind_named("sphere"))));
  CHECK(std::isnan(angle_by_zhou(s, kind_named("cube8"))));
  s.plate_friction = 0.0;
  CHECK(std::isnan(angle_by_zhou(s, kind_named("sphere-braked"))));
}

TEST_CASE(
    "the angles of all kinds are drawn with their scatter, those of several piles each, and the fit beside them") {
  Settings s;
  sand_pile::resolve(s);
  Campaign c = made_up();
  c.piles.emplace_back().kind = kind_named("sphere-viscous");  // nothing is known of it
  const io::Plot plot = repose_plot(s, c);
  REQUIRE(plot.x_ticks.size() == 2);
  CHECK((plot.x_ticks[0].text == "cube8" && plot.x_ticks[1].text == "sphere-braked" && plot.x_ticks[1].at == 2.0));
  REQUIRE(plot.series.size() == 5);
  CHECK(plot.series[0].y[0] == Approx(30.0));
  CHECK(plot.series[0].y[1] == Approx(22.0));
  const auto &seeds = plot.series[1], &directions = plot.series[2], &each = plot.series[3], &zhou = plot.series[4];
  REQUIRE(seeds.y.size() == 3);  // a bar, and a gap after it
  CHECK(seeds.y[0] == Approx(22.0 - std::sqrt(8.0)));
  CHECK(seeds.y[1] == Approx(22.0 + std::sqrt(8.0)));
  REQUIRE(directions.y.size() == 3);
  CHECK((directions.x[0] == 1.0 && directions.y[1] == Approx(33.0)));
  CHECK(each.y.size() == 2);
  CHECK((std::isnan(zhou.y[0]) && zhou.y[1] == Approx(angle_by_zhou(s, kind_named("sphere-braked")))));
  CHECK_THAT(zhou_text(s, c), ContainsSubstring("by the fit of Zhou et al. (2002)") &&
                                  ContainsSubstring("these piles are made otherwise"));
  s.method = "drain";
  CHECK_THAT(zhou_text(s, c), !ContainsSubstring("otherwise"));
  c.piles.erase(c.piles.begin() + 1, c.piles.end());
  CHECK(zhou_text(s, c).empty());
  CHECK(repose_plot(s, {}).x_ticks.empty());
}

TEST_CASE("the report of a sand pile has the plot of its angles") {
  const auto make = [](const Settings&, PileResult& r, report::Replay*, Session&, Stages& stages) {
    for (const char* stage : {": fill", ": let go", ": rest", ": creep"}) stages.begin(r.kind.name + stage, 1.0);
    const Campaign c = made_up();
    const auto seed = r.seed;
    r = c.piles[r.kind.name == "cube8" ? 0 : seed];
    r.seed = seed;
  };
  const PileWorld worlds[] = {{"cube8", make}, {"sphere-braked", make}};
  PileRig rig(worlds);
  const TempFolder folder;
  const std::string output = (folder / "piles").string();
  const char* const words[] = {"sand_pile", "--output", output.c_str(), "--kinds",    "cube8,sphere-braked",
                               "--seeds",   "2",        "--no-vtk",     "--no-replay"};
  REQUIRE(run_program({.name = "sand_pile", .title = "Piles"}, rig, static_cast<int>(std::size(words)), words) == 0);
  const std::string page = io::read_file(folder / "piles/report.html");
  CHECK_THAT(page, ContainsSubstring("Angle of repose of each kind of grain"));
  CHECK_THAT(page, ContainsSubstring("by the fit of Zhou et al. (2002)"));
  const std::string script = io::read_file(folder / "piles/repose.gp");
  CHECK_THAT(script, ContainsSubstring("set xtics ('cube8' 1, 'sphere-braked' 2)"));
  CHECK_THAT(script, ContainsSubstring("'Zhou et al. 2002, a drained box'"));
}

}  // namespace sand_pile_test
