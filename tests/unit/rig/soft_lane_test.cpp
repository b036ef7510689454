#include "catch.hpp"

#include <dem/rig/soft_lane/driver.hpp>
#include <dem/rig/soft_lane/lane.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace soft_lane_test {

using Catch::Approx;
using namespace dem::rig;
using dem::Vec3;

namespace {

soft_lane::Settings quick_lane() {
  soft_lane::Settings s;
  s.output = "lane";
  return s;
}

std::string refusal_of(soft_lane::Settings s) {
  try {
    soft_lane::resolve(s);
  } catch (const dem::Error& e) {
    return e.what();
  }
  return "";
}

/// A car that drives at 1.5 m/s with slip, on wheels where they should be.
soft_lane::Sample driving(double time) {
  soft_lane::Sample x;
  x.car.controls.throttle = 0.5;
  x.car.time = time;
  x.car.speed = 1.5;
  x.way = 1.5 * time;
  x.car.position = Vec3(x.way, 0.01 * time, 0.5);
  x.car.engine_work = 6000.0 * time;
  for (auto& w : x.wheels) w = {.slip = 0.2, .load = 12e3, .pull = 100.0, .torque = 970.0, .sinkage = 0.05};
  return x;
}

std::array<dem::Vec3, 4> wheels_in_their_tracks() {
  const double y = 0.91;
  return {Vec3(3, y, 0.5), Vec3(3, -y, 0.5), Vec3(0, y, 0.5), Vec3(0, -y, 0.5)};
}

}  // namespace

TEST_CASE("a lane that is too short or too narrow for the car and its path is refused, with what to change") {
  using Catch::Matchers::ContainsSubstring;
  auto s = quick_lane();
  CHECK(refusal_of(s).empty());
  s.path = 50.0;
  CHECK_THAT(refusal_of(s), ContainsSubstring("a --path of 50 m is longer than the lane"));
  s = quick_lane();
  s.bed.length = 4.0;
  CHECK_THAT(refusal_of(s), ContainsSubstring("the lane is 4 m long, but the car's wheels stand 3.3 m apart"));
  s = quick_lane();
  s.bed.width = 0.3;
  CHECK_THAT(refusal_of(s), ContainsSubstring("a trough is 0.3 m wide, but must hold a tyre"));
  s.bed.width = 1.9;
  CHECK_THAT(refusal_of(s), ContainsSubstring("give --layout bed"));
  s.layout = "bed";
  CHECK_THAT(refusal_of(s), ContainsSubstring("the bed is 1.9 m wide, but the car needs"));
  s.layout = "ditch";
  CHECK_THAT(refusal_of(s), ContainsSubstring("--layout is 'ditch', but must be troughs, bed"));
}

TEST_CASE("a lane of tiles that go along is as long as it is told, and no shorter than the car needs") {
  using Catch::Matchers::ContainsSubstring;
  auto s = quick_lane();
  s.tiles = 6;
  s.path = 200.0;
  CHECK(refusal_of(s).empty());
  soft_lane::resolve(s);
  CHECK(s.length() == Approx(6 * s.bed.length));
  CHECK(s.ground_end() > 200.0);
  // The rear tyres stand behind the rim, whose grains are held.
  const double rear = s.start() + s.car.rear.points.wheel.x();
  CHECK(rear - s.car.tyre.radius > -0.5 * s.length() + s.rim());
  s = quick_lane();
  s.tiles = 3;
  CHECK_THAT(refusal_of(s), ContainsSubstring("3 tiles of 1.875 m are 5.62 m long, but must be at least") &&
                                ContainsSubstring("give --tiles 4"));
  s.tiles = 40;
  s.bed.length = 0.2;
  CHECK_THAT(refusal_of(s), ContainsSubstring("a tile is 0.2 m long, but must be at least"));
  s = quick_lane();
  s.tiles = 6, s.passes = 2;
  CHECK_THAT(refusal_of(s), ContainsSubstring("--passes 2 needs a lane that stays; give --tiles 0"));
  s.passes = 1, s.scene = "step";
  CHECK_THAT(refusal_of(s), ContainsSubstring("--scene step needs a lane that stays"));
}

TEST_CASE("the lane of the thesis has 331,890 grains, and grains overlap below two hundredths whatever their size") {
  soft_lane::Settings s;
  for (const double loosest : {0.6, dem::soil::cube8_limits.loosest}) {
    s = quick_lane();
    s.size = "full";
    s.grains.limits.loosest = loosest;
    soft_lane::resolve(s);
    const double volume = dem::soil::cube_volume(s.grains.half_edge);
    const auto rained = static_cast<double>(grains_in(s.bed, s.grains, volume));
    CHECK(2.0 * (rained - std::floor(s.bed.strike_off * rained)) == Approx(331890.0).margin(4.0));
  }
  const double weight = 48.36e3;  // N
  CHECK(s.overlap(weight) < 0.02);
  s.grains.half_edge *= 2.0;
  CHECK(s.overlap(weight) == Approx(0.0178).margin(5e-4));
}

TEST_CASE("slip is 1 for a wheel that spins on the spot and -1 for a locked one") {
  using dem::vehicle::slip_of;
  CHECK(slip_of(2.0, 0.0) == 1.0);
  CHECK(slip_of(0.0, 2.0) == -1.0);
  CHECK(slip_of(2.0, 1.5) == 0.25);
  CHECK(slip_of(1.5, 2.0) == -0.25);
  CHECK(slip_of(-2.0, -1.5) == -0.25);
  CHECK(slip_of(5e-4, 0.0) == 0.0);
}

TEST_CASE("a car that rolls over, digs in, slides back or leaves the lane ends its run with that word") {
  auto s = quick_lane();
  soft_lane::resolve(s);
  const auto wheels = wheels_in_their_tracks();
  const auto word = [&](auto&& change) {
    soft_lane::Judge judge(s);
    std::string found;
    for (double t = 0.01; found.empty() && t < 1.5; t += 0.01) {
      auto x = driving(t);
      change(x);
      found = judge(x, wheels);
    }
    return found;
  };
  CHECK(word([](auto&) {}) == "");
  CHECK(word([](auto& x) { x.car.roll = -1.1; }) == soft_lane::ending::rolled_over);
  CHECK(word([](auto& x) { x.car.pitch = 1.1; }) == soft_lane::ending::rolled_over);
  CHECK(word([](auto& x) { x.wheels[2].sinkage = 0.5; }) == soft_lane::ending::dug_in);
  CHECK(word([](auto& x) { x.way = -0.31; }) == soft_lane::ending::slid_back);
  CHECK(word([](auto& x) { x.way += 10.0; }) == soft_lane::ending::arrived);
  CHECK(word([](auto& x) { x.car.time += 60.0, x.way = 0.2; }) == soft_lane::ending::too_slow);
  const auto spin = [](auto& x) {
    x.car.speed = x.way = 0.02;
    for (auto& w : x.wheels) w.slip = 0.95;
  };
  CHECK(word(spin) == soft_lane::ending::dug_in);
  CHECK(word([&](auto& x) {
          if (x.car.time < 0.9) spin(x);  // not for a second
        }) == "");
  // Half of the wheels spin, and the car gains less than 0.1 m in 3 s; it may stand for 2.
  const auto stuck = [&](double from, double to) {
    soft_lane::Judge judge(s);
    std::string found;
    for (double t = 0.01; found.empty() && t < 5.0; t += 0.01) {
      auto x = driving(t);
      x.way = t < from ? 0.3 * t : t < to ? 0.3 * from : 0.3 * (from + t - to);
      x.wheels[0].slip = x.wheels[1].slip = 0.7;
      found = judge(x, wheels);
    }
    return found;
  };
  CHECK(stuck(1.0, 3.0) == "");
  CHECK(stuck(1.0, 5.0) == soft_lane::ending::dug_in);
  // A car that brakes and rocks on its tyres, with wheels that seem to slip, has stopped.
  s.scene = "brake";
  soft_lane::Judge judge(s);
  std::string found;
  for (double t = 0.01; found.empty() && t < 8.0; t += 0.01) {
    auto x = driving(t);
    x.way = 0.5 * s.path + std::min(0.1 * t, 0.2);
    x.car.speed = 0.1 * std::cos(8.0 * t);
    for (auto& w : x.wheels) w.slip = 0.9;
    found = judge(x, wheels);
  }
  CHECK(found == soft_lane::ending::stopped);
  // So has one that inputs let stand on its brakes: they go on.
  s.scene = "level";
  s.open_loop = dem::vehicle::OpenLoop({{0.0, 0.0, 1.0, 0.0}, {9.0, 0.0, 1.0, 0.0}});
  soft_lane::Judge by_inputs(s);
  found.clear();
  for (double t = 0.01; found.empty() && t < 20.0; t += 0.01) {
    auto x = driving(t);
    x.car.controls = {.brake = 1.0};
    x.way = x.car.speed = 0.05 * std::cos(8.0 * t);
    for (auto& w : x.wheels) w.slip = 0.9;
    found = by_inputs(x, wheels);
    if (!found.empty()) CHECK(t == Approx(9.0).margin(0.011));
  }
  CHECK(found == soft_lane::ending::inputs_ended);
  s.open_loop = {};
  auto beside = wheels;
  beside[1] -= Vec3(0, 0.5, 0);
  CHECK(soft_lane::Judge(s)(driving(0.1), beside) == soft_lane::ending::left_lane);
}

TEST_CASE(
    "resistance is thrust less pull, and energy per metre is what the engine gave on the second half of the way") {
  auto s = quick_lane();
  soft_lane::resolve(s);
  soft_lane::Campaign c;
  c.weight = 48e3;
  for (int k = 0; k <= 200; ++k) c.samples.push_back(driving(0.01 * k));
  soft_lane::evaluate(c, s);
  CHECK(c.means.from_way == Approx(1.5));
  CHECK(c.means.slip == Approx(0.2));
  CHECK(c.means.pull == Approx(400.0));
  CHECK(c.means.resistance == Approx(4.0 * (970.0 / 0.485 - 100.0)));
  // 6 kW at 1.5 m/s
  CHECK(c.means.energy_per_metre == Approx(4000.0));
  CHECK(c.means.cost_of_transport == Approx(4000.0 / 48e3));
  CHECK(c.drift == Approx(0.02));
  // A car that slid back: of its way back.
  for (std::size_t k = 0; k < c.samples.size(); ++k) {
    c.samples[k].way = -0.002 * static_cast<double>(k);
    c.samples[k].car.speed = k <= 100 ? -0.1 : -0.3;
  }
  soft_lane::evaluate(c, s);
  CHECK(c.means.speed == Approx(-0.3));
}

TEST_CASE("each option of a lane has a name of its own, and grains sleep unless they are asked not to") {
  soft_lane::Settings s;
  Options options;
  REQUIRE_NOTHROW(declare(options, s));
  CHECK(s.bed.sleep);
}

TEST_CASE("other ground lies where the rear wheels come to it, and a border beyond that is refused") {
  using Catch::Matchers::ContainsSubstring;
  for (const char* scene : {"step", "soils"}) {
    auto s = quick_lane();
    s.scene = scene;
    soft_lane::resolve(s);
    CAPTURE(scene, s.path, s.border);
    CHECK(s.path - s.car.wheelbase() > s.border);
    // The front wheels stand before it by that much.
    CHECK(s.border_at() == Approx(s.start() + s.car.front.points.wheel.x() + s.border));
    s.border = s.path;
    CHECK_THAT(refusal_of(s), ContainsSubstring("are to come to the other ground within the --path"));
  }
  auto s = quick_lane();
  s.scene = "soils";
  soft_lane::resolve(s);
  CHECK(s.border == Approx(0.5 * (s.path - s.car.wheelbase())));  // as far on one as on the other
  s.second_share = 1.5;
  CHECK_THAT(refusal_of(s), ContainsSubstring("--second-share is 1.5"));
}

TEST_CASE("hard ground takes the place of the grains that it would cut") {
  auto s = quick_lane();
  s.scene = "step";
  soft_lane::resolve(s);
  std::vector<dem::soil::Placement> bed;
  for (int k = -100; k <= 100; ++k) bed.push_back({Vec3(0.03 * k, 0, 0.1), dem::Mat3::Identity()});
  const auto grains = soft_lane::lane_grains(s, bed);
  double first = 1e9;
  for (const auto& g : grains) first = std::min(first, g.position.x());
  const double corner = std::sqrt(3.0) * s.grains.half_edge;
  CHECK(first > s.border_at() + corner);
  CHECK(first < s.border_at() + corner + 0.03);
  s.scene = "level";
  CHECK(soft_lane::lane_grains(s, bed).size() == 2 * bed.size());
}

TEST_CASE("a car on a load cell goes through slips of -0.05 to 0.95 within its path") {
  using Catch::Matchers::ContainsSubstring;
  auto s = quick_lane();
  s.scene = "drawbar";
  soft_lane::resolve(s);
  const double end = soft_lane::held_time(s), dt = 1e-3;
  CHECK(soft_lane::held_slip(s, 0.0) == -0.05);
  CHECK(soft_lane::held_slip(s, end) == Approx(0.95));
  double way = 0.0;
  for (double t = 0.5 * dt; t < end; t += dt) {
    way += dt * soft_lane::held_rims(s, t) * (1.0 - soft_lane::held_slip(s, t));
  }
  CHECK(way == Approx(0.98 * s.path).epsilon(0.01));  // the start is taken as 1, but slip is -0.05 there: 1/20 of 0.4 m
  s.speed = 0.6 * s.path;
  CHECK_THAT(refusal_of(s), ContainsSubstring("too short for a drawbar"));
}

TEST_CASE("what a load cell shows is told by tenths of slip, with slip and efficiency of the mean speeds") {
  auto s = quick_lane();
  s.scene = "drawbar";
  soft_lane::resolve(s);
  soft_lane::Campaign c;
  c.weight = 48e3;
  const double r = s.car.tyre.radius;
  for (double t = 0.0; t < soft_lane::held_time(s); t += 0.01) {
    const double slip = soft_lane::held_slip(s, t);
    auto x = driving(t);
    x.car.speed = s.speed * (1.0 - slip);
    x.hitch = 1e4 * slip;
    for (auto& w : x.wheels) w.slip = slip, w.spin = s.speed / r, w.torque = 0.25 * 2e4 * slip * r;
    // One wheel of an axle spins twice as fast, without torque; the other one stands.
    x.wheels[2].spin *= 2.0, x.wheels[2].torque = 0.0;
    x.wheels[3].spin = 0.0, x.wheels[3].torque *= 2.0;
    c.samples.push_back(x);
  }
  soft_lane::evaluate(c, s);
  REQUIRE(c.pulls.size() == 10);
  for (const auto& p : c.pulls) {
    CHECK(p.pull == Approx(1e4 * p.slip).margin(1.0));
    CHECK(p.torque == Approx(2e4 * r * p.slip).margin(1.0));
  }
  // The two wheels that turn under load spend half of what four alike would; a half of the way is left at this slip.
  CHECK(c.pulls[5].slip == Approx(0.5).margin(0.005));
  CHECK(c.pulls[5].efficiency == Approx(0.5).margin(0.01));
}

TEST_CASE("where the ground changes, each stretch has its own means") {
  auto s = quick_lane();
  s.scene = "step";
  soft_lane::resolve(s);
  soft_lane::Campaign c;
  c.weight = 48e3;
  const double rear = s.border + s.car.wheelbase();
  for (double t = 0.0; 1.5 * t < s.path; t += 0.01) {
    auto x = driving(t);
    const double slip = x.way < s.border ? 0.0 : x.way < rear ? 0.1 : 0.3;
    for (auto& w : x.wheels) w.slip = slip;
    c.samples.push_back(x);
  }
  soft_lane::evaluate(c, s);
  CHECK(c.stretches[0].slip == Approx(0.0));
  CHECK(c.stretches[1].slip == Approx(0.1));
  CHECK(c.stretches[2].slip == Approx(0.3));
  CHECK(c.stretches[1].energy_per_metre == Approx(4000.0));
}

}  // namespace soft_lane_test
