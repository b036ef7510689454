// What a tyre on a road tells of a wheel that is too deep, thrown up or above the road, and what is refused at once.

#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/wheel.hpp>

#include <cmath>
#include <memory>
#include <string>

using namespace dem;
using namespace dem::vehicle;
using Catch::Matchers::ContainsSubstring;

namespace {

using Machine = mbd::Machine<integrator::VelocityVerlet>;

const TyreSpec small_tyre = {.radius = 0.35, .stiffness = 2e5, .damping = 1e3};

/// A wheel alone.
struct Lone {
  Machine m;
  Wheel w;
  explicit Lone(double height, double mass = 25.0) {
    w.body = m.add_body(mbd::given_body("front wheel", mass, Vec3(1, 2, 1)).at(Vec3(0, 0, height)));
  }
  void put(const TyreSpec& tyre, const Road& road = {}) { add_tyre(Assembly(m), "front", w, tyre, road); }
};

}  // namespace

TEST_CASE("a tyre that is too soft for its wheel ends the run once, at half of its radius") {
  TyreSpec soft = small_tyre;
  soft.stiffness = 200.0;  // kN/m typed for N/m
  Lone of(0.345);
  of.put(soft);
  const mbd::MachineReport deep = of.m.run(2.0, 1e-4);
  CHECK_FALSE(deep.ok);
  CHECK(tyre_of(of.m, of.w).deflection == Approx(0.175).margin(1e-3));
  CHECK_THAT(deep.text, ContainsSubstring("tyre of body 'front wheel' is 0.175 m deep in the road") &&
                            ContainsSubstring("its radius, 0.35 m") && ContainsSubstring("stiffness (200 N/m under"));
  const mbd::MachineReport on = of.m.run(0.1, 1e-4);
  INFO(on.text);
  CHECK(on.ok);
}

TEST_CASE("what was told of a tyre is not told again by a machine that takes its saved memory") {
  TyreSpec soft = small_tyre;
  soft.stiffness = 200.0;
  Lone first(0.345), second(0.345);
  first.put(soft);
  second.put(soft);
  REQUIRE_FALSE(first.m.run(2.0, 1e-4).ok);
  mbd::Terrain &saved = mbd::terrain_of(first.m, first.w.tyre), &loaded = mbd::terrain_of(second.m, second.w.tyre);
  loaded.set_memory(saved.memory());
  CHECK(loaded.memory() == saved.memory());
  second.m.body(second.w.body).motion = first.m.body(first.w.body).motion;
  CHECK(second.m.run(0.01, 1e-4).ok);
}

TEST_CASE("a step that is too large for a tyre's stiffness or damping ends the run once, with the step that fits") {
  const double dt = 5e-5, m = 25.0;
  for (const bool is_damped : {false, true}) {
    CAPTURE(is_damped);
    TyreSpec tyre = small_tyre;
    (is_damped ? tyre.damping : tyre.stiffness) = is_damped ? 1e7 : 2e11;
    Lone of(0.351);
    of.put(tyre);
    const mbd::MachineReport thrown = of.m.run(0.5, dt);
    CHECK_FALSE(thrown.ok);
    CHECK(thrown.time < 0.1);
    CHECK_THAT(thrown.text, ContainsSubstring("tyre of body 'front wheel' asks for steps below") &&
                                ContainsSubstring("but they are 5e-05 s") && ContainsSubstring("substeps"));
    CHECK(of.m.run(0.1, dt).ok);
    // The step that is named: k h^2 + 2 c h = m.
    const double k = tyre.stiffness, c = tyre.damping, h = m / (c + std::sqrt(c * c + m * k));
    Lone fine(0.351);
    fine.put(tyre);
    CHECK(fine.m.run(0.05, 0.99 * h).ok);
    CHECK(fine.m.body(fine.w.body).position().z() < 0.352);
  }
}

TEST_CASE("a stiff tyre that begins in the road ends the run when it throws its wheel out") {
  TyreSpec stiff = small_tyre;
  stiff.stiffness = 1e9;  // stable, but 12.5 kJ are in its first 5 mm
  Lone of(0.345);
  of.put(stiff);
  const mbd::MachineReport thrown = of.m.run(0.1, 5e-5);
  CHECK_FALSE(thrown.ok);
  CHECK_THAT(thrown.text, ContainsSubstring("tyre of body 'front wheel' began 0.005 m deep in the road") &&
                              ContainsSubstring("stiffness (1e+09 N/m)"));
  CHECK(of.m.run(0.1, 5e-5).ok);
  Lone usual(0.325);
  usual.put(small_tyre);
  CHECK(usual.m.run(0.5, 5e-5).ok);
}

TEST_CASE("a tyre that carries a load as it should tells nothing, also where its wheel falls on the road") {
  for (const double height : {0.33, 0.6}) {
    CAPTURE(height);
    Lone of(height, 325.0);
    of.put(small_tyre);
    const mbd::MachineReport report = of.m.run(4.0, 1e-4);
    INFO(report.text);
    CHECK(report.ok);
    CHECK(report.note.empty());
    CHECK(tyre_of(of.m, of.w).load == Approx(325.0 * 9.81).epsilon(0.05));
  }
}

TEST_CASE("a road more than a radius below a wheel is noted until the tyre touches it") {
  Lone of(0.345);
  of.put(small_tyre, Road{.point = Vec3(0, 0, -0.5)});
  const mbd::MachineReport falls = of.m.run(1e-3, 1e-4);
  CHECK(falls.ok);
  CHECK_THAT(falls.note,
             ContainsSubstring("tyre of body 'front wheel' has not touched the road yet, 0.495 m below it"));
  CHECK(of.m.run(0.5, 1e-4).note.empty());
}

TEST_CASE("a wheel that starts deep in the road is refused") {
  check_refused([] { Lone(0.0).put(small_tyre); }, "body 'front wheel' starts 0.35 m deep",
                "place it higher by 0.35 m");
  check_refused([] { Lone(-1.0).put(small_tyre); }, "body 'front wheel' starts 1.35 m deep");
  check_refused(
      [] {
        const auto step = RoadHeights::of(-2, -2, 4, 4, 0.1, [](double x, double) { return x > -1.0 ? 0.3 : 0.0; });
        Lone(0.35).put(small_tyre, Road{.heights = std::make_shared<RoadHeights>(step)});
      },
      "starts 0.3 m deep");
  CHECK_NOTHROW(Lone(0.2).put(small_tyre));
}

TEST_CASE("roads that cannot be are refused in words") {
  const auto refused = [](const Road& road, const char* words) {
    check_refused([&] { Lone(0.345).put(small_tyre, road); }, words);
  };
  const double none = std::nan("");
  refused({.friction = -1.0}, "friction of a road is -1");
  refused({.friction = none}, "friction of a road is nan");
  refused({.normal = Vec3::Zero()}, "normal of a road is (0, 0, 0)");
  refused({.normal = Vec3(0, none, 1)}, "normal of a road is (0, nan, 1)");
  refused({.normal = Vec3(0, 0, -1)}, "body 'front wheel' is (0, 0, -1), into the ground");
  refused({.point = Vec3(0, 0, none)}, "a road goes through (0, 0, nan) m");
  const auto level = std::make_shared<RoadHeights>(RoadHeights::of(-2, -2, 4, 4, 1, [](double, double) { return 0; }));
  refused({.normal = Vec3(-0.3, 0, 1), .heights = level}, "a road has heights, and a plane through (0, 0, 0) m");
  refused({.point = Vec3(0, 0, 1), .heights = level}, "a road has heights, and a plane through (0, 0, 1) m");
  refused({.friction = none, .heights = level}, "friction of a road is nan");
  CHECK_NOTHROW(Lone(0.345).put(small_tyre, {.normal = Vec3(0, 0, 1e-3), .friction = 0.0}));
}

TEST_CASE("a wheel takes one tyre") {
  Lone of(0.345);
  of.put(small_tyre);
  check_refused([&] { add_tyre(Assembly(of.m), "again", of.w, small_tyre, Road{}); },
                "body 'front wheel' has a tyre already");
  CHECK(of.m.run(0.01, 1e-4).ok);
}

TEST_CASE("a tyre can be changed between steps") {
  Lone of(0.35 - 25.0 * 9.81 / 2e5);
  check_refused([&] { set_tyre(of.m, of.w, small_tyre); }, "body 'front wheel' has no tyre on hard ground");
  of.put(small_tyre);
  of.m.body(of.w.body).motion.velocity.x = 3.0;
  const auto braking = [&] {
    of.m.body(of.w.body).motion.angular_velocity = {0, 0, 0};
    REQUIRE(of.m.run(1e-2, 1e-4));
    return -tyre_of(of.m, of.w).pull / tyre_of(of.m, of.w).load;
  };
  CHECK(braking() == Approx(small_tyre.friction));
  TyreSpec icy = small_tyre;
  icy.friction = 0.1;
  set_tyre(of.m, of.w, icy);
  CHECK(braking() == Approx(0.1));
  icy.friction = -0.1;
  check_refused([&] { set_tyre(of.m, of.w, icy); }, "friction of a tyre is -0.1");
}
