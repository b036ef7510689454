#include "catch.hpp"

#include <dem/rig/bevameter/circle.hpp>
#include <dem/rig/bevameter/constants.hpp>
#include <dem/rig/bevameter/resolve.hpp>
#include <dem/rig/session.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace bevameter_test {

using Catch::Approx;
using namespace dem::rig;
namespace mechanics = dem::terramechanics;

namespace {

/// Plates and shear tests of a soil that obeys a pressure law and Janosi's.
struct MadeSoil {
  plate_sinkage::VariantResult plates;
  direct_shear::Campaign shear;
  direct_shear::Settings shear_settings;

  MadeSoil(const mechanics::PressureLaw& law, const mechanics::JanosiHanamoto& strength) {
    plates.variant.settings.sinkage = 0.02;
    plates.variant.settings.threshold = 1e-3;
    plates.variant.settings.smoothing = 0.0;
    plates.solid_fraction = 0.8;
    for (const double b : {0.03, 0.05, 0.08}) {
      plate_sinkage::PlateResult r{.width = b};
      for (int i = 0; i <= 400; ++i) {
        const double z = 5.1e-5 * i, p = under(law, b).pressure(z);
        r.samples.push_back({0.0, z, 0.0, p, p, p});
      }
      for (int i = 0; i < 20; ++i) r.unloading.push_back({0.02 - 1e-5 * i, 4e4 - 2e7 * 1e-5 * i * 10.0});
      r.finished = true;
      plate_sinkage::evaluate(r, plates.variant.settings);
      plates.plates.push_back(std::move(r));
    }
    direct_shear::resolve(shear_settings);
    for (const double sigma : {5e3, 1e4, 2e4, 4e4}) {
      direct_shear::LoadResult r;
      // A box of whose load the plane of shear bears twice as much: the soil's laws are those of the plane.
      r.normal_stress = r.normal_at_maximum = 0.5 * sigma;
      r.plane_stress = sigma;
      r.finished = true;
      for (int i = 1; i <= 400; ++i) {
        const double j = 2e-5 * i;
        direct_shear::Sample s{};
        s.displacement = j;
        s.stress = strength.stress(sigma, j);
        r.samples.push_back(s);
      }
      r.maximum = strength.strength(sigma);
      r.at_maximum = 8e-3;
      shear.loads.push_back(r);
    }
    shear_settings.smoothing = 0.0;
  }
  [[nodiscard]] bevameter::Constants constants() const {
    return bevameter::find_constants(plates, shear, shear_settings, 5, 0.95);
  }
};

constexpr mechanics::JanosiHanamoto dry{.cohesion = 0.0, .friction_angle = 0.6, .displacement = 8e-4};

}  // namespace

TEST_CASE("a bevameter gives back the constants of a soil that obeys the laws") {
  SECTION("Bekker, with cohesion") {
    const mechanics::Bekker law{.k_c = 2e4, .k_phi = 3e6, .n = 0.9};
    const auto c = MadeSoil(law, {.cohesion = 800.0, .friction_angle = 0.6, .displacement = 8e-4}).constants();
    // The curves are exact but for the sinkage's zero, at 1 mPa.
    CHECK(c.bekker[0].value == Approx(2e4).epsilon(1e-4));
    CHECK(c.bekker[1].value == Approx(3e6).epsilon(1e-4));
    CHECK(c.bekker[2].value == Approx(0.9).epsilon(1e-5));
    CHECK(c.bekker[2].freedom == 12);  // 3 plates in 5 pieces each, 3 constants
    CHECK(c.bekker[2].error < 1e-5);
    CHECK(c.has_cohesion);
    CHECK(c.cohesion.value == Approx(800.0).epsilon(1e-9));
    CHECK(c.friction_angle.value == Approx(0.6).epsilon(1e-9));
    CHECK(c.displacement.value == Approx(8e-4).epsilon(1e-6));
    CHECK(c.displacement.freedom == 3);
    CHECK(c.unit_weight == Approx(9.81 * 2650.0 * 0.8));
    CHECK(c.unloading.value == Approx(2e8).epsilon(1e-6));
    CHECK(mechanics::under(c.bekker_soil.pressure, 0.05).pressure(0.01) ==
          Approx(law.under(0.05).pressure(0.01)).epsilon(1e-4));
  }
  SECTION("Bekker's k_c alone, with cohesion: Reece's k_phi' would be negative, and is left out") {
    const auto c = MadeSoil(mechanics::Bekker{.k_c = 2e4, .k_phi = 0.0, .n = 0.5},
                            {.cohesion = 800.0, .friction_angle = 0.6, .displacement = 8e-4})
                       .constants();
    // p = k_c z^0.5/b falls with the width by more than (z/b)^0.5 does: k_phi' of p = (c k_c' + gamma b k_phi') (z/b)^n
    // is below 0.
    CHECK(c.reece[0].value > 0.0);
    CHECK(c.reece[1].value == 0.0);
    CHECK(c.reece[2].value > 0.0);
    CHECK_THAT(bevameter::reece_text(c), Catch::Contains("k_phi' came out negative"));
  }
  SECTION("a shear curve that is largest at once has a strength, but no K; a single one tells no cohesion") {
    MadeSoil soil(mechanics::Bekker{.k_c = 2e4, .k_phi = 3e6, .n = 0.9}, dry);
    auto& first = soil.shear.loads.front();
    first.samples.front().stress = first.maximum;
    first.at_maximum = first.samples.front().displacement;
    auto c = soil.constants();
    REQUIRE(c.shear_curves.size() == 4);
    CHECK(std::isnan(c.shear_curves.front().displacement));
    CHECK(c.displacement.freedom == 2);
    CHECK(c.displacement.value == Approx(8e-4).epsilon(1e-6));
    CHECK_THAT(bevameter::no_bend_text(c), Catch::Contains("Loaded with 2.5 kPa"));
    soil.shear.loads.resize(2);
    soil.shear.loads[0].maximum = std::nan("");
    c = soil.constants();
    CHECK_THAT(bevameter::cohesion_text(c, 0.95), Catch::Contains("one strength alone"));
  }
  SECTION("Reece, without cohesion: Bekker's k_c would be negative, and is left out") {
    const mechanics::Reece law{.k_phi = 90.0, .n = 0.7, .unit_weight = 9.81 * 2650.0 * 0.8};
    const auto c = MadeSoil(law, dry).constants();
    CHECK(c.reece[0].value == 0.0);
    CHECK(c.reece[1].value == Approx(90.0).epsilon(1e-4));
    CHECK(c.reece[2].value == Approx(0.7).epsilon(1e-5));
    CHECK(c.bekker[0].value == 0.0);
    CHECK(c.bekker[1].value > 0.0);
    CHECK(c.bekker_r_squared < c.reece_r_squared);
    // The plates' own report says so too, with the constants that are left.
    const MadeSoil made(law, dry);
    CHECK_THAT(plate_sinkage::constants_text(made.plates),
               Catch::Contains("kc came out negative") &&
                   Catch::Contains(dem::text("kphi is {:.4g} kPa/m^n", 1e-3 * c.bekker[1].value)));
    CHECK(plate_sinkage::constants_text({}).empty());
    CHECK_FALSE(c.has_cohesion);
    CHECK(c.cohesion.value == 0.0);
    // Nobody takes its 0 for measured.
    const auto path = std::filesystem::temp_directory_path() / ("dem_constants_" + std::to_string(::getpid()) + ".csv");
    bevameter::write_constants(path, c, 0.95);
    const std::string file = dem::io::read_file(path);
    CHECK(file.find("Bekker k_c,0,,,0,kPa/m^(n-1),left out\n") != std::string::npos);
    CHECK(file.find("cohesion c,0,,,0,kPa,left out\n") != std::string::npos);
    CHECK(file.find("deg,measured\n") != std::string::npos);
    auto without = c;
    without.unloading = {.value = std::nan("")};
    bevameter::write_constants(path, without, 0.95);
    CHECK(dem::io::read_file(path).find("MPa/m,not known\n") != std::string::npos);
    CHECK_THAT(bevameter::interval_comments(without, 0.95, "Reece"),
               Catch::Contains("# unloading stiffness was not measured\n"));
    CHECK(file.find("cohesion of the free line,") != std::string::npos);
    std::filesystem::remove(path);
    const std::string comments = bevameter::left_out_comments(c);
    CHECK(comments.find("// Bekker_Kc is 0 because it was left out") == 0);
    CHECK(comments.find("Mohr_cohesion") != std::string::npos);
    CHECK(comments.find("Kphi") == std::string::npos);
    const std::string intervals = bevameter::interval_comments(c, 0.95, "Reece");
    CHECK_THAT(intervals, Catch::Contains("# Bekker k_c is 0 because it was left out\n") &&
                              Catch::Contains("kPa/m^n (95 %, this bed alone)\n") && !Catch::Contains("Reece") &&
                              !Catch::Contains("free line"));
    const auto soil = mechanics::to_text(mechanics::NamedSoil{"found", "a test", c.bekker_soil});
    CHECK(mechanics::read_soil(intervals + soil, "found").soil.shear.friction_angle ==
          mechanics::read_soil(soil, "found").soil.shear.friction_angle);
  }
}

TEST_CASE("a bed that is too small to measure has the density that was asked for, or the loosest, which is said") {
  MadeSoil soil(mechanics::Bekker{.k_c = 2e4, .k_phi = 3e6, .n = 0.9}, dry);
  CHECK(bevameter::density_text(soil.constants()).empty());
  soil.plates.solid_fraction = std::nan("");
  const auto c = soil.constants();
  CHECK(c.unit_weight == Approx(9.81 * 2650.0 * dem::soil::cube8_limits.loosest));
  CHECK(c.relative_density == 0.0);
  CHECK(bevameter::constants_text(c, 0.95).find(
            "relative density 0.00, taken as the loosest: the bed of the plates is too small") != std::string::npos);
  CHECK(bevameter::bed_density(soil.plates).relative_density == 0.0);
  soil.plates.variant.settings.bed.relative_density = 0.4;
  CHECK(bevameter::constants_text(soil.constants(), 0.95).find("relative density 0.40, as asked for: the bed") !=
        std::string::npos);
}

TEST_CASE("the line of the picture is the soil's, and strengths at the end of the travel are told") {
  MadeSoil soil(mechanics::Bekker{.k_c = 2e4, .k_phi = 3e6, .n = 0.9}, dry);
  soil.shear_settings.travel = 8.1e-3;
  for (auto& r : soil.shear.loads) r.maximum += r.plane_stress > 3e4 ? -2e3 : 0.0;  // the free line has a cohesion
  const auto c = soil.constants();
  REQUIRE_FALSE(c.has_cohesion);
  CHECK(c.free_cohesion.value > 100.0);
  const auto line = bevameter::strength_plot(soil.shear, c).series.front();
  CHECK(line.name ==
        dem::text("the soil: {:.1f}°, c = 0.00 kPa, through the origin", mechanics::degrees(c.friction_angle.value)));
  CHECK(line.y.at(0) == 0.0);
  CHECK(line.y.at(1) == Approx(line.x.at(1) * std::tan(c.friction_angle.value)));
  CHECK(bevameter::strength_plot(soil.shear, c).series.at(1).x.at(0) == Approx(5.0));  // kPa, on the plane
  CHECK(c.rising.size() == 4);
  CHECK(bevameter::constants_text(c, 0.95).find(
            "Loaded with 2.5, 5, 10, 20 kPa the shear stress is largest in the last 5 %") != std::string::npos);
  soil.shear_settings.travel = 9e-3;
  CHECK(bevameter::rising_text(soil.constants()).empty());
}

TEST_CASE("two strengths tell the cohesion of their line without an error, and none is taken; three tell it with one") {
  const mechanics::Bekker law{.k_c = 2e4, .k_phi = 3e6, .n = 0.9};
  MadeSoil soil(law, {.cohesion = 800.0, .friction_angle = 0.6, .displacement = 8e-4});
  const auto three = [&] {
    soil.shear.loads.resize(3);
    return soil.constants();
  }();
  CHECK(three.has_cohesion);
  CHECK(bevameter::cohesion_text(three, 0.95) ==
        "The line of the strengths over the stress on the plane of shear has the cohesion 0.80 ± 0.00 kPa (95 %).");
  soil.shear.loads.resize(2);  // at 5 and 10 kPa
  const auto two = soil.constants();
  CHECK(two.free_cohesion.value == Approx(800.0).epsilon(1e-9));
  CHECK(std::isnan(two.free_cohesion.half_width()));
  CHECK_FALSE(two.has_cohesion);
  CHECK(two.cohesion.value == 0.0);
  // Least squares through the origin: tan(phi) = tan(0.6) + c sum(sigma)/sum(sigma^2).
  CHECK(std::tan(two.friction_angle.value) == Approx(std::tan(0.6) + 800.0 * 15e3 / 125e6).epsilon(1e-9));
  CHECK(two.friction_angle.freedom == 1);
  const std::string words = bevameter::constants_text(two, 0.95);
  CHECK(words.find("0.80 kPa, was not tested") != std::string::npos);
  CHECK(words.find("--normal-stresses") != std::string::npos);
  CHECK(words.find("no more than none") == std::string::npos);
}

TEST_CASE("a soil with one plate has no constants, in words; one whose shear curves rise to their end has a K within") {
  MadeSoil one(mechanics::Bekker{.k_c = 0.0, .k_phi = 3e6, .n = 0.9}, dry);
  one.plates.plates.resize(1);
  CHECK_THROWS_WITH(one.constants(), Catch::Contains("--sinkage"));
  MadeSoil straight(mechanics::Bekker{.k_c = 0.0, .k_phi = 3e6, .n = 0.9}, dry);
  for (auto& r : straight.shear.loads) {
    for (auto& s : r.samples) s.stress = r.maximum * s.displacement / 8e-3;
  }
  // The least squares of j/L - 1 + exp(-j/K) over 0 to L have K = 0.6143 L (by a search of its own).
  CHECK(straight.constants().displacement.value == Approx(0.6143 * 8e-3).epsilon(0.005));
}

TEST_CASE(
    "the apparatus of a bevameter have the same grains, and its settings are refused by the names of their options") {
  bevameter::Settings s;
  s.grains.friction = 0.31;
  s.grains.half_edge = 5e-3;
  s.stable_share = 0.6;
  s.stage_limit = 2.5;
  s.sleep = true;
  s.plate_friction = 0.3;
  s.wheel_friction = 0.7;
  bevameter::resolve(s);
  const auto plates = bevameter::plates_of(s);
  const auto shear = bevameter::shear_of(s, 0.2);
  const auto wheel = bevameter::wheel_of(s, "");
  CHECK(plates.grains.friction == 0.31);
  CHECK(shear.friction == 0.31);
  CHECK(wheel.grains.friction == 0.31);
  // K of the contacts as they act.
  CHECK(plates.grains.scale() * plates.grains.stiffness ==
        Approx(direct_shear::contact_scale(shear) * shear.stiffness));
  CHECK(plates.grains.scale() == wheel.grains.scale());
  CHECK(shear.normal_stress(shear.loads.front()) == Approx(5e3));
  CHECK(shear.relative_density == 0.2);
  CHECK(plates.bed.stable_share == 0.6);
  CHECK(shear.stable_share == 0.6);
  CHECK(wheel.bed.stable_share == 0.6);
  CHECK(plates.bed.stage_limit == 2.5);
  CHECK(wheel.bed.stage_limit == 2.5);
  CHECK((plates.bed.sleep && wheel.bed.sleep));
  CHECK(plates.plate_friction == 0.3);
  CHECK(wheel.wheel_friction == 0.7);
  CHECK(wheel.travel == 0.12);  // as far at every slip, also where the wheel hardly gets on
  CHECK(wheel.path == 0.0);
  CHECK(plates.unload);
  CHECK(plates.output == "bevameter_output/plates");
  s.output.clear();  // here, and not at the root of the disk
  CHECK(bevameter::plates_of(s).output == "plates");
  CHECK(bevameter::shear_of(s, 0.2).output == "shear");
  CHECK(bevameter::wheel_of(s, "").output == "wheel");
  const auto refuses = [](auto&& change, const char* option) {
    bevameter::Settings wrong;
    change(wrong);
    CHECK_THROWS_WITH(bevameter::resolve(wrong), Catch::Contains(option));
  };
  refuses([](auto& x) { x.widths = {0.05}; }, "--plates");
  refuses([](auto& x) { x.normal_stresses = {1e4}; }, "a cohesion three");
  refuses([](auto& x) { x.normal_stresses = {1e4, -1.0}; }, "--normal-stresses");
  refuses([](auto& x) { x.confidence = 1.0; }, "--confidence");
  refuses([](auto& x) { x.pieces = 1.0; }, "--pieces");
  refuses([](auto& x) { x.shear_smoothing = 0.7; }, "--shear-smoothing");
  refuses([](auto& x) { x.grains.half_edge = -1.0; }, "--half-edge");
  refuses([](auto& x) { x.sinkage = 2e-4; }, "--sinkage is 0.0002 m, which takes");
  refuses(
      [](auto& x) {
        x.plate_speed = 2.0;
        x.sinkage = 0.05;
      },
      "--plate-speed (m/s) is 2");
  refuses([](auto& x) { x.shear_travel = 1.0; }, "--shear-travel (m, at most");
  refuses([](auto& x) { x.normal_stresses = {1e4, 2e4, 1e4}; }, "10000 and 10000 Pa of --normal-stresses");
  refuses([](auto& x) { x.path = 2.0; }, "give --wheel-bed-length");
  refuses([](auto& x) { x.path = 2.0; }, "or a shorter --wheel-travel or --path");
  refuses([](auto& x) { x.wheel_travel = 1e-3; }, "--wheel-travel is 0.001 m, which takes");
  CHECK(in_own_words("change --relative-density, --densify-time or --seed if", bevameter::shear_words) ==
        "change --relative-density or --seed if");
}

TEST_CASE("the wheel stands beside Bekker, Reece and dynamic Bekker in the table, the file and the plot") {
  bevameter::Constants c;
  c.bekker_soil = mechanics::melanz_sand;
  c.reece_soil = mechanics::mojave_martian_simulant;
  rigid_wheel::Settings s;
  s.size = "smoke";
  s.slips = {0.3, 0.99};
  rigid_wheel::resolve(s);
  rigid_wheel::Campaign w;
  for (const double slip : s.slips) {
    w.slips.push_back({.slip = slip, .samples = {{}}, .pull = {.mean = 10.0, .deviation = 1.0}});
  }
  const auto predictions = bevameter::predict(c, w, s);
  const mechanics::ColumnWheel alone{.wheel = rigid_wheel::reference_wheel(s),
                                     .soil = c.bekker_soil,
                                     .load = s.load,
                                     .wheel_mass = 0.1 * s.load / 9.81,
                                     .spin = 1.0,
                                     .travel = 1.5 * s.radius,
                                     .spacing = s.radius / 13.0};
  const double pull = roll_on_columns(alone, 0.3).pull;
  REQUIRE(predictions[2].at_runs.size() == 2);
  REQUIRE(predictions[2].at_runs[0]);
  CHECK(predictions[2].at_runs[0]->pull == pull);
  CHECK_FALSE(predictions[2].at_runs[1]);  // it hardly gets on there

  w.solid_fraction = 0.7881, w.level = 0.0521;
  plate_sinkage::VariantResult plates;
  plates.level = 0.116, plates.solid_fraction = 0.785;
  CHECK_THAT(bevameter::beds_text(plates, w),
             Catch::Contains("solid fraction 0.788, 52.1 mm deep; that of the plates has 0.785, 116.0 mm"));
  const auto table = bevameter::circle_table(predictions, w);
  dem::io::check_table(table);
  CHECK(table.rows.size() == 6);
  CHECK(table.rows[0][1] == "no");  // steady
  CHECK(table.header[9] == "dynamic Bekker");
  CHECK(table.rows[0][9] == dem::text("{:.1f}", pull));
  CHECK(table.rows[0][10] == dem::text("{:.1f}", pull - 10.0));
  CHECK(table.rows[3][9] == "-");

  const auto folder = std::filesystem::temp_directory_path() / ("dem_circle_" + std::to_string(::getpid()));
  bevameter::write_predicted(folder / "predicted.csv", predictions, w);
  const std::string file = dem::io::read_file(folder / "predicted.csv");
  CHECK(file.find("steady,bekker,reece,dynamic_bekker\n0.3,pull [N],10,1,0,") != std::string::npos);
  CHECK(file.find(dem::text(",{}\n0.3,torque", pull)) != std::string::npos);
  CHECK(file.find(",\n0.99,torque") != std::string::npos);  // not known
  std::filesystem::remove_all(folder);

  const auto plot = bevameter::circle_plot(c, predictions, w, s, bevameter::compared[0]);
  CHECK(plot.series.back().name == "dynamic Bekker");
  CHECK(plot.series.back().y.at(0) == pull);
  CHECK(plot.series.back().color == plot.series[3].color);  // of the same soil by Bekker and Wong
}

TEST_CASE("a run within another one tells it how far it is, and leaves its progress alone") {
  struct Heard : Stages {
    void update(double done, std::string_view status = {}) override {
      share = done;
      words = status;
    }
    void message(std::string_view text) override { said = text; }
    double share = -1.0;
    std::string words, said;
  } heard;
  const auto folder = std::filesystem::temp_directory_path() / ("dem_within_" + std::to_string(::getpid()));
  {
    Session session({"inner", folder.string(), "a=1\n", {.files = {"old.csv"}}, {}, {}, &heard});
    CHECK_FALSE(session.has_begun());
    dem::io::write_file(folder / "old.csv", "1\n");
    session.begin_run(4);
    CHECK(session.has_begun());
    CHECK(heard.said.find("old.csv") != std::string::npos);  // it is said what is replaced
    CHECK_FALSE(std::filesystem::exists(folder / "old.csv"));
    session.begin("rain", 10.0);
    session.update(5.0, "0.1 s");
    CHECK(heard.share == Approx(0.125));
    CHECK(heard.words == "rain: 0.1 s");
    session.begin("level");  // of unknown length
    CHECK(heard.share == Approx(0.25));
    session.update(3.0);
    CHECK(heard.share == Approx(0.25));
    session.begin("press", 2.0);
    session.update(7.0);  // no more than all of it
    CHECK(heard.share == Approx(0.75));
    session.end();
    CHECK(session.outcome.problem.empty());
  }
  std::filesystem::remove_all(folder);
}

}  // namespace bevameter_test
