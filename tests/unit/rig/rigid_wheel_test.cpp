#include "catch.hpp"
#include "io/files.hpp"
#include "worlds.hpp"

#include <dem/io/file.hpp>
#include <dem/rig/bed/kept_bed.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/rigid_wheel.hpp>
#include <dem/rig/rigid_wheel/study.hpp>
#include <dem/rig/rigid_wheel/wheel_rig.hpp>
#include <dem/terramechanics/soil_reader.hpp>

#include <cmath>
#include <filesystem>
#include <iterator>

namespace rigid_wheel_test {

using Catch::Approx;
using namespace dem::rig;

namespace {

/// A small wheel on some hundred and fifty coarse grains.
rigid_wheel::Settings small() {
  rigid_wheel::Settings s;
  s.size = "smoke";
  s.grains.half_edge = 4e-3;
  s.grains.damping = 0.1;  // comes to rest soon
  s.grains.separation_factor = 1.0;
  s.bed.length = 0.12;
  s.bed.width = 0.05;
  s.bed.depth = 0.018;
  s.bed.threads = 1;
  s.radius = 0.04;
  s.width = 0.03;
  s.load = 5.0;
  s.spin_deg = 180.0;
  s.path = 0.02;
  s.slips = {0.3};
  return s;
}

}  // namespace

TEST_CASE("means of a wheel are those after its transient, and efficiency is pull v over torque omega") {
  rigid_wheel::Settings s = small();
  rigid_wheel::SlipResult r{.slip = 0.25};
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i, noise = i % 10 < 5 ? 0.5 : -0.5, late = i < 60 ? 1.0 - i / 60.0 : 0.0;
    r.samples.push_back(
        {t, 0.25, 0.0, 20.0 * (1.0 - late) + noise, 2.0, 0.01 * (1.0 - late) + 1e-4 * noise, 5.0, 0.0, 0.0});
  }
  rigid_wheel::evaluate(r, 0.05, s);
  CHECK(r.is_steady);
  CHECK(r.window_from >= 0.4);
  CHECK(r.window_from <= 1.0);
  CHECK(r.pull.mean == Approx(20.0).margin(0.2));  // what is left of the ramp in its last part
  CHECK(r.pull.deviation == Approx(0.5).margin(0.3));
  CHECK(r.efficiency.mean == Approx(r.pull.mean * 0.75 * s.radius / 2.0));
  // The torque is steady, so that efficiency swings as the pull does.
  CHECK(r.efficiency.deviation == Approx(r.pull.deviation * 0.75 * s.radius / 2.0));

  rigid_wheel::Campaign c;
  c.slips = {r};
  const auto soils = rigid_wheel::references(s);
  const auto plot = rigid_wheel::efficiency_plot(s, c, soils);
  REQUIRE(plot.series.size() > 3);
  CHECK(plot.series[0].y.front() == Approx(r.efficiency.mean));
  const auto& p1 = plot.series[3];  // Bekker and Wong: only where the wheel drives and pulls
  REQUIRE_FALSE(p1.x.empty());
  for (std::size_t k = 0; k < p1.x.size(); ++k) {
    CHECK(p1.y[k] > 0.0);
    CHECK(p1.y[k] < 1.0);
  }
}

TEST_CASE("a groove in a flat surface is found with its depth and width") {
  rigid_wheel::Settings s = small();
  s.bed.width = 0.16;
  s.width = 0.06;
  std::vector<dem::soil::Placement> grains;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double y = (j + 0.5) * 8e-3 - 0.08;
      grains.push_back({dem::Vec3((i + 0.5) * 8e-3, y, std::abs(y) < 0.03 ? 0.020 : 0.026)});
    }
  }
  rigid_wheel::SlipResult r{.slip = 0.0};
  rigid_wheel::find_rut(grains, s, 0.0, 0.08, r);
  for (int i = 0; i < 400; ++i) r.samples.push_back({0.01 * i, 0, 0, 1.0, 1.0, 0.0, 0, 0, 0});
  rigid_wheel::evaluate(r, 0.030, s);
  CHECK(r.rut.depth == Approx(6e-3));
  CHECK(r.rut.width == Approx(8 * 8e-3));  // the eight strips whose middles lie within 30 mm
}

TEST_CASE("the print of a wheel under given stresses has them back, with the area that carries") {
  // 10 kPa and a shear stress of 3 kPa from -15 to 30 deg, on the middle half of the width; 40 moments.
  rigid_wheel::ContactPrint print;
  print.set_up(0.1, 0.08, 0.01);
  REQUIRE(print.across == 8);
  const double from = -15.0, to = 30.0, degree = 3.14159265358979 / 180.0, da = 0.5 * degree, dy = 0.002;
  for (int moment = 0; moment < 40; ++moment) {
    for (double a = (from + 0.25) * degree; a < to * degree; a += da) {
      for (double y = -0.02 + 0.5 * dy; y < 0.02; y += dy) {
        const double area = 0.1 * da * dy, c = std::cos(a), s = std::sin(a);
        print.add({0.1 * s, y, -0.1 * c}, area * (1e4 * dem::Vec3(-s, 0, c) + 3e3 * dem::Vec3(c, 0, s)));
      }
    }
    print.moments += 1.0;
  }
  CHECK(print.area() == Approx(0.95 * 0.1 * 45.0 * degree * 0.04).epsilon(0.03));  // whole cells: one of 36
  CHECK(print.mean_pressure() == Approx(1e4).epsilon(0.03));
  for (std::size_t a = 0; a < print.along; ++a) {
    const double angle = print.angle(a) / degree, share = angle > from && angle < to ? 0.5 : 0.0;
    CHECK(print.pressure(a) == Approx(share * 1e4).margin(1.0));
    CHECK(print.shear(a) == Approx(share * 3e3).margin(1.0));
    CHECK(print.pressure(a, 0) == 0.0);
    CHECK(print.shear(a, 0) == 0.0);
  }
  // The plot of it shows where the grains press, and all of the soils' curves: a soft soil holds the rim higher up.
  rigid_wheel::Settings s;
  rigid_wheel::resolve(s);
  rigid_wheel::SlipResult r;
  r.slip = 0.3, r.print = print;
  const auto hard = rigid_wheel::print_plot(s, {}, r);
  CHECK(hard.x_range.min == Approx(-22.5));  // the middle of the last cell, and 10 deg
  CHECK(hard.x_range.max == Approx(37.5));
  const std::vector<rigid_wheel::Reference> soft{{"dry sand", dem::terramechanics::known_soil("dry-sand").soil}};
  const auto forces = rigid_wheel::reference_at(soft[0].soil, 0.3, s);
  REQUIRE(forces);
  REQUIRE(forces->entry / degree > 27.5);
  CHECK(rigid_wheel::print_plot(s, soft, r).x_range.max == Approx(forces->entry / degree + 10.0));
}

TEST_CASE("settings of wheels that make no sense are refused by the names of their options") {
  const auto refuses = [](auto&& change, const char* option) {
    auto s = small();
    change(s);
    CHECK_THROWS_WITH(rigid_wheel::resolve(s), Catch::Contains(option));
  };
  refuses([](auto& s) { s.path = 0.2; }, "--bed-length");
  refuses([](auto& s) { s.slips = {0.1, 0.101}; }, "--slips");
  refuses([](auto& s) { s.slips = {1.5}; }, "--slips");
  refuses([](auto& s) { s.width = 0.06; }, "--width");
  refuses([](auto& s) { s.load = 0.0; }, "--load");
  refuses([](auto& s) { s.wheel_share = 1.0; }, "--wheel-share");
  refuses([](auto& s) { s.carriage_mass = 0.0; }, "--carriage-mass");
  refuses([](auto& s) { s.drive_stiffness = 0.0; }, "--drive-stiffness");
  refuses([](auto& s) { s.motor_stiffness = -1.0; }, "--motor-stiffness");
  refuses([](auto& s) { s.wheel = "grousers", s.grousers = 400; }, "give fewer --grousers");
  CHECK(rigid_wheel::slip_name(-0.3) == "slip_m30");
  CHECK(rigid_wheel::slip_name(0.3) == "slip_30");
}

TEST_CASE(
    "a wheel travels as far at any slip, while its rim turns at most four times as far; or its rim by a given path") {
  rigid_wheel::Settings s;
  s.slips = {-0.5, 0.7, 0.9, 1.0};
  rigid_wheel::resolve(s);
  CHECK(s.travel == 0.12);
  CHECK(s.path_at(-0.5) == Approx(0.08));
  CHECK(s.path_at(0.7) == Approx(0.4));
  for (const double slip : {0.9, 1.0}) CHECK(s.path_at(slip) == Approx(0.48));
  CHECK(s.travel_at(0.9) == Approx(0.048));
  CHECK(s.travel_at(1.0) == 0.0);
  CHECK(s.start() == Approx(-0.06));
  CHECK(s.sample_interval() == Approx(s.duration_at(-0.5) / 400.0));
  s.path = 0.15;
  for (const double slip : s.slips) CHECK(s.path_at(slip) == 0.15);
}

TEST_CASE("a soil that the grains stand beside is read before the run begins, and not again") {
  rigid_wheel::WheelRig rig([](const rigid_wheel::Settings& s, rigid_wheel::Campaign& campaign, Session& session) {
    session.begin_run(1);
    std::filesystem::remove(s.soil);
    rigid_wheel::SlipResult& r = campaign.slips.emplace_back();
    r.slip = 0.3;
    for (int i = 0; i < 2; ++i) r.samples.push_back({0.1 * i, 0.3, 0, 1.0, 1.0, 0.0, 0, 0, 0});
    r.print.set_up(s.radius, s.width, s.grains.edge());
    r.print.moments = 1.0;
  });
  const TempFolder folder;
  const std::string output = (folder / "wheel").string(), soil = (folder / "found.toml").string();
  const char* const words[] = {"rigid_wheel", "--size",     "smoke",    "--output",   output.c_str(),
                               "--soil",      soil.c_str(), "--no-vtk", "--no-replay"};
  const auto run = [&] {
    return run_program({.name = "rigid_wheel", .title = "Wheel"}, rig, static_cast<int>(std::size(words)), words);
  };
  CHECK(run() == 2);  // there is none
  CHECK_FALSE(std::filesystem::exists(output + "/settings.toml"));
  dem::terramechanics::save_soil(soil, {"found", "a test", dem::terramechanics::melanz_sand});
  CHECK(run() == 0);
  CHECK_THAT(dem::io::read_file(output + "/report.html"), Catch::Contains("found.toml, dynamic Bekker"));
}

TEST_CASE("a bed that is too small to tell its density says so, and one that was not made says nothing of it") {
  rigid_wheel::Campaign c;
  CHECK_THAT(rigid_wheel::bed_text(small(), c), Catch::Contains("solid fraction - (relative density -)"));
  c.level = 0.02;
  CHECK_THAT(rigid_wheel::bed_text(small(), c), Catch::Contains("too small to tell its density"));
  CHECK(level_text(0.0271, std::nan("")) == "27.1 mm deep, too small to tell its solid fraction");
  c.solid_fraction = 0.762;
  CHECK_THAT(rigid_wheel::bed_text(small(), c), Catch::Contains("solid fraction 0.762 (relative density 0.00)"));
  CHECK(level_text(0.0271, 0.762) == "27.1 mm deep, solid fraction 0.762");
}

TEST_CASE("one run alone is named in the title of a plot of all runs, and several in its legend") {
  rigid_wheel::Campaign c;
  for (const double slip : {0.1, 0.3}) c.slips.push_back({.slip = slip, .samples = {{}}});
  auto plot = rigid_wheel::time_plot(c, &rigid_wheel::Sample::pull, 1.0, "Pull over time", "pull [N]");
  CHECK(plot.title == "Pull over time, slip s = 1 - v/(ω r)");
  CHECK(plot.series.at(1).name == "s = 0.3");
  c.slips.pop_back();
  plot = rigid_wheel::time_plot(c, &rigid_wheel::Sample::pull, 1.0, "Pull over time", "pull [N]");
  CHECK(plot.title == "Pull over time, slip 1 - v/(ω r) = 0.1");
  CHECK(plot.series.at(0).name.empty());
}

TEST_CASE("a study of a wheel changes the box, the speed or the seed, and nothing else") {
  auto s = small();
  rigid_wheel::resolve(s);
  CHECK(rigid_wheel::variants(s).size() == 1);
  s.study = "box";
  CHECK(rigid_wheel::variants(s).size() == 12);  // of three seeds
  s.study_seeds = 2;
  const auto box = rigid_wheel::variants(s);
  REQUIRE(box.size() == 8);
  CHECK(box[1].settings.bed.width == Approx(2.0 * s.bed.width));
  CHECK(box[1].settings.bed.depth == s.bed.depth);
  CHECK(box[2].settings.bed.depth == Approx(2.0 * s.bed.depth));
  CHECK(box[2].prefix() == "deep_");
  CHECK(box[3].settings.bed.length == Approx(2.0 * s.bed.length));
  CHECK(box[3].settings.start() == s.start());
  CHECK(box[4].settings.bed.seed == s.bed.seed + 1);
  CHECK(box[4].settings.bed.width == s.bed.width);
  s.study = "speed";
  const auto speed = rigid_wheel::variants(s);
  REQUIRE(speed.size() == 4);
  CHECK(speed[1].settings.spin() == Approx(0.5 * s.spin()));
  CHECK(speed[1].settings.bed.seed == s.bed.seed);
  s.study = "box";
  s.bed.file = "bed.txt";
  CHECK_THROWS_WITH(rigid_wheel::resolve(s), Catch::Contains("--bed-file"));
  s.study = "speed";
  s.study_seeds = 0;
  rigid_wheel::resolve(s);  // in the bed of a file: that is one seed
  CHECK(rigid_wheel::variants(s).size() == 2);
}

TEST_CASE("the study of a wheel has the pull of each slip with its change, and all runs by themselves") {
  auto s = small();
  s.slips = {-0.5, 0.3};
  s.study = "speed";
  s.study_seeds = 2;
  rigid_wheel::resolve(s);
  // Seeds 1 and 2, at the speed as set and at half of it.
  const double pulls[4][2] = {{-20, 10}, {-21, 12}, {-24, 8}, {-25.2, 6}};
  rigid_wheel::Campaign c;
  const auto all = rigid_wheel::variants(s);
  for (std::size_t v = 0; v < all.size(); ++v) {
    rigid_wheel::VariantResult& of = v == 0 ? c : c.study.emplace_back();
    of.variant = all[v];
    of.solid_fraction = 0.78;
    for (std::size_t k = 0; k < 2; ++k) {
      of.slips.push_back({.slip = s.slips[k], .finished = true, .pull = {pulls[v][k], 3.0}, .pull_error = 0.5});
    }
  }
  auto rows = rigid_wheel::study_rows(c);
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].value.mean == Approx(-22.0));
  CHECK(rows[2].from_as_set.value().value == Approx(-1.1));  // it is braked more
  CHECK(rows[3].from_as_set.value().value == Approx(0.0).margin(1e-12));
  const auto words = study_findings(rigid_wheel::studied_pull(s), rows);
  REQUIRE(words.size() == 4);
  CHECK(words[0] == "Beds of 2 seeds in the box as set deviate by 2.83 N in the pull at slip -0.5, -22.00 ± 2.00 N.");
  // Of two pairs Student's t is 12.7: neither mean is told from zero by it, so there are no percentages.
  CHECK_THAT(words[2], Catch::StartsWith("Half the speed changes the pull at slip -0.5 by -1.10 ± 0.10 N (2 seeds)"));
  const auto runs = rigid_wheel::runs_table(c);
  dem::io::check_table(runs);
  CHECK(runs.rows.size() == 8);
  CHECK(runs.rows[2][0] == "half the speed");
  CHECK(runs.rows[2][5] == "-21.00");
  CHECK(runs.rows[2][9] == "yes");
  TempFolder folder;
  rigid_wheel::write_runs(folder / "runs.csv", c);
  CHECK_THAT(dem::io::read_file(folder / "runs.csv"),
             Catch::StartsWith("run,slip_1-v/(omega*r),grains,solid_fraction,drawbar_pull_N,") &&
                 Catch::Contains("\nhalf the speed,-0.5,0,0.78,-21,0.5,,,1\n"));
  // A slip that ended early has no pull.
  c.study[2].slips[0].finished = false;
  rows = rigid_wheel::study_rows(c);
  CHECK(rows[2].from_as_set.pairs() == 1);
  CHECK(std::isnan(rows[2].from_as_set.value().error));
  CHECK(rigid_wheel::runs_table(c).rows[6][9] == "no");
}

TEST_CASE("a wheel is set down gently, carries its load, and keeps its slip") {
  const RigidWheel<models::VerletCubes> test(small(), [](double h) { return dem::shape::cube8(h); });
  const auto stand = test.set_down(test.make_bed());
  const auto& m = stand.bed.world.machine();
  CHECK(m.bodies().size() == 6);  // ground and the five of table 5.2
  CHECK(m.body(stand.carriage).mass == Approx(5.0));
  CHECK(m.body(stand.wheel).mass == Approx(0.6 * 5.0 / 9.81));
  CHECK(m.body(stand.shaft).mass == Approx(0.4 * 5.0 / 9.81));
  CHECK(m.parts().joints.size() == 4);                                        // three slides and an axle
  CHECK(m.parts().actuators.size() == 4);                                     // those of the table, and the load servo
  CHECK(m.sensor(stand.grains).mean().force.z == Approx(5.0).epsilon(0.03));  // the servo ends within 2 %

  CHECK_THROWS_WITH(test.roll(stand, 1.5), Catch::Contains("the slip of a run"));
  CHECK_THROWS_WITH(test.roll(stand, -4.0), Catch::Contains("leaves a bed that ends at"));
  const auto run = test.roll(stand, 0.3), again = test.roll(stand, 0.3);
  REQUIRE(run.finished);
  bool same = run.samples.size() == again.samples.size();
  for (std::size_t i = 0; same && i < run.samples.size(); ++i) same = run.samples[i].pull == again.samples[i].pull;
  CHECK(same);
  const auto& last = run.samples.back();
  CHECK(last.slip == Approx(0.3).margin(0.01));  // the actuators give by 0.1 mm, their speeds swing
  CHECK(last.travel == Approx(0.7 * 0.02).epsilon(0.05));
  // A dead load: what the grains carry swings about it as grains give way. Over the run the wheel's vertical momentum
  // changes by less than its mass times 20 mm/s, 4 % of the load over 0.16 s.
  double carried = 0.0;
  for (const auto& x : run.samples) carried += x.carried / static_cast<double>(run.samples.size());
  CHECK(carried == Approx(5.0).epsilon(0.08));
  // What was seen under the wheel, at a hundred moments of the second half, is what the sensor felt all of that time.
  double up = 0.0, forward = 0.0, lift = 0.0, pull = 0.0;
  for (std::size_t a = 0; a < run.print.along; ++a) {
    const double area = run.print.cell_area() * static_cast<double>(run.print.across), angle = run.print.angle(a);
    up += area * (run.print.pressure(a) * std::cos(angle) + run.print.shear(a) * std::sin(angle));
    forward += area * (run.print.shear(a) * std::cos(angle) - run.print.pressure(a) * std::sin(angle));
  }
  for (std::size_t i = run.samples.size() / 2; i < run.samples.size(); ++i) {
    lift += 2.0 * run.samples[i].carried / static_cast<double>(run.samples.size());
    pull += 2.0 * run.samples[i].pull / static_cast<double>(run.samples.size());
  }
  CHECK(up == Approx(lift).epsilon(0.08));  // single moments instead of means; cells are 5 degrees long
  CHECK(forward == Approx(pull).margin(0.08 * lift));
}

TEST_CASE("a wheel that spins on the spot on one heavy grain is braked by mu N r, and pushed by mu N") {
  using namespace dem;
  const auto slider = [](bool is_mesh) {
    World<models::VerletCubes> world({.gravity = {0, 0, 0}, .overlap_limit = 10.0});
    const double r = 0.04, half = 0.05, load = 5.0, mu = 0.5;
    world.set_contact({.normal = {1e5, 1.0, 1.0}, .friction = {mu, 1e5, 1.0, 0.975}});
    world.add_surface(world.ground(), surface::Box(Vec3(1, 1, 0.1)), {.position = {0, 0, -half - 0.05}});
    // So heavy that it stays: 8e3 kg. One of its balls, of radius 25 mm, has its top at x = y = 25 mm, z = 50 mm.
    const SpeciesId heavy = world.add_species(shape::cube8(half), {.density = 8e6});
    world.add_grain({.species = heavy});
    auto& m = world.machine();
    const Vec3 at(0.025, 0.025, half + r);
    Mat3 about_y;
    about_y << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    const BodyId wheel = m.add_body(mbd::cylinder_body("wheel", r, 0.03, 7800).at(at, about_y));
    if (is_mesh) world.add_surface(wheel, surface::TriangleMesh(mesh::cylinder(r, 0.03, 360)));
    else world.add_surface(wheel, surface::Cylinder(r, 0.03));
    m.add_motion(mbd::prescribed_position("x", wheel, Vec3::UnitX(), 0.0));
    m.add_motion(mbd::prescribed_position("y", wheel, Vec3::UnitY(), 0.0));
    m.add_motion(mbd::prescribed_rotation("spin", wheel, Vec3::UnitY(), mbd::Signal::ramp(0.0, 2.0)));
    m.add_motion(
        mbd::prescribed_position("down", wheel, Vec3::UnitZ(), mbd::Signal::ramp(0.0, -load / 1e5 / 0.01, 0.0, 0.01)));
    REQUIRE(world.run_for(0.3));
    const SensorId grains = m.add_sensor(mbd::contact_sensor("grain", wheel, 0.1));
    REQUIRE(world.run_for(0.1));
    const auto w = m.sensor(grains).mean();
    REQUIRE(w.force.z > 1.0);  // less than asked for, as the floor under the grain gives too
    CHECK(w.force.x == Approx(mu * w.force.z).epsilon(0.02));  // broken asperities keep 0.975, the ramp gives the rest
    CHECK(-w.torque.y == Approx(mu * w.force.z * r).epsilon(0.02));  // the overlap shortens the arm by 0.1 %
  };
  slider(false);
  slider(true);
}

}  // namespace rigid_wheel_test
