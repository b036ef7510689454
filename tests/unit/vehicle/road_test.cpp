// Roads of heights, and what telemetry tells of a car that stands on one.

#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/telemetry.hpp>
#include <dem/vehicle/wheel.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

using namespace dem;
using namespace dem::vehicle;
using Catch::Matchers::Contains;

TEST_CASE("heights of a road are straight between their points, and level beyond them") {
  const auto road = RoadHeights::of(-1.0, -2.0, 4.0, 3.0, 0.5, [](double x, double y) { return 2.0 * x - y; });
  CHECK(road(0.3, -0.7) == Approx(0.6 + 0.7));
  CHECK(road(-1.0, -2.0) == Approx(0.0).margin(1e-12));
  CHECK(road(3.0, 1.0) == Approx(5.0));
  CHECK(road(9.0, 1.0) == Approx(5.0));
  CHECK(road(-9.0, -9.0) == Approx(0.0).margin(1e-12));
  const auto fitted = RoadHeights::of(0.0, 0.0, 1.1, 0.6, 0.5, [](double x, double y) { return x + 10.0 * y; });
  CHECK(fitted(1.1, 0.0) == Approx(1.1));  // three cells of 0.37 m along x, two of them along y
  CHECK(fitted(0.0, 0.7) == Approx(7.0));
  CHECK_THAT(message_of([] { RoadHeights::of(0, 0, 1.0, 1.0, 4.0, [](double, double) { return 0.0; }); }),
             Contains("0.0625 cells of 4 m"));
  CHECK_THAT(message_of([] { RoadHeights(0, 0, 0.5, 3, {1, 2, 3, 4}); }), Contains("4 heights in rows of 3"));
  CHECK_THAT(message_of([] { RoadHeights(0, 0, 0.0, 2, {1, 2, 3, 4}); }), Contains("spacing of the heights of a road"));
  CHECK_THAT(message_of([] { RoadHeights(0, 0, 1.0, 2, {1, 2, 3, std::nan("")}); }), Contains("height 3 of a road"));
}

TEST_CASE("words of a road tell heights from their negative") {
  std::vector<double> heights{0, 0, 0.05, 0.1, 0.1, 0.05, 0, 0};
  const RoadHeights hump(0, 0, 0.5, 2, heights), same(0, 0, 0.5, 2, heights);
  for (double& h : heights) h = -h;
  const RoadHeights ditch(0, 0, 0.5, 2, heights);
  CHECK(hump.in_words() == same.in_words());
  CHECK(hump.in_words() != ditch.in_words());
}

TEST_CASE("a tyre rolls on a tilted plane of heights as on the plane itself") {
  // 20 % up and 10 % across. Heights hold a plane exactly, so forces differ by rounding.
  const double up = 0.2, across = -0.1;
  const Road plane{.normal = Vec3(-up, -across, 1.0).normalized()};
  const Road heights{.heights = std::make_shared<RoadHeights>(RoadHeights::of(
                         -3.0, -3.0, 6.0, 6.0, 0.3, [&](double x, double y) { return up * x + across * y; }))};
  const TyreSpec tyre;
  Body wheel;
  const Vec3 start = (tyre.radius - 0.02) * plane.normal;
  wheel.motion.velocity = {2.0, 0.1, 0.4};
  wheel.motion.angular_velocity = {0, 5.0, 0};
  TyreState on_plane, on_heights;
  for (int k = 0; k <= 2000; ++k) {
    const double time = 1e-4 * k;
    wheel.motion.position = from_eigen(Vec3(start + time * wheel.velocity()));
    const Wrench a = tyre_wrench(tyre, plane, wheel, Vec3::UnitY(), time, on_plane);
    const Wrench b = tyre_wrench(tyre, heights, wheel, Vec3::UnitY(), time, on_heights);
    REQUIRE(to_eigen(b.force).isApprox(to_eigen(a.force), 1e-9));
    REQUIRE(to_eigen(b.torque).isApprox(to_eigen(a.torque), 1e-9));
  }
  CHECK(on_heights.load > 1000.0);
}

TEST_CASE(
    "a copy of a machine has tyres of its own, and a machine that takes a saved memory goes on with their stretch") {
  using Machine = mbd::Machine<integrator::VelocityVerlet>;
  const double dt = 1e-4;
  const auto lay = [](Machine& m) {
    Wheel w;
    w.body = m.add_body(
        mbd::given_body("wheel", 50.0, Vec3(3, 5, 3)).at(Vec3(0, 0, 0.484)).moving(Vec3(2, 0.1, 0), Vec3(0, 1, 0)));
    add_tyre(Assembly(m), "test", w, TyreSpec{}, Road{});
    return w;
  };
  Machine first;
  const Wheel w = lay(first);
  REQUIRE(first.run(0.1, dt));
  const TyreState then = tyre_of(first, w);
  CHECK(std::abs(then.stretch_x) > 1e-5);
  Machine second = first;
  REQUIRE(second.run(0.1, dt));
  CHECK(tyre_of(second, w).time == Approx(0.2));
  CHECK(tyre_of(first, w).time == then.time);
  CHECK(tyre_of(first, w).stretch_x == then.stretch_x);
  REQUIRE(first.run(0.1, dt));
  CHECK(first.body(w.body).position() == second.body(w.body).position());

  Machine third;
  const Wheel same = lay(third);
  Wheel bare;
  bare.body = same.body;
  mbd::Terrain &saved = mbd::terrain_of(first, w.tyre), &loaded = mbd::terrain_of(third, same.tyre);
  CHECK(saved.set_up() == loaded.set_up());
  loaded.set_memory(saved.memory());
  CHECK(tyre_of(third, same).stretch_x == tyre_of(first, w).stretch_x);
  CHECK(loaded.memory() == saved.memory());
  CHECK_THAT(message_of([&] { loaded.set_memory({1.0}); }), Contains("memory of a tyre has 1 numbers, but needs 39"));
  CHECK(loaded.memory() == saved.memory());
  CHECK_THAT(message_of([&] { tyre_of(third, bare); }), Contains("has no tyre on hard ground"));
}

TEST_CASE("a car stands on a road of heights, and the forces that telemetry tells hold each knuckle and wheel") {
  // A dip of 0.1 m under the front left wheel, wide enough for the tyre's print.
  mbd::Machine<integrator::VelocityVerlet> m;
  m.joint_tolerance = 0.5;  // m: no more sub-steps; how far joints open is not asked here
  const VehicleSpec spec = humvee({.rubber_rear = false});
  const auto dip = [](double x, double y) { return x > 0.7 && y > 0.0 ? -0.1 : 0.0; };
  const Road road{.heights = std::make_shared<RoadHeights>(RoadHeights::of(-4.0, -2.0, 8.0, 4.0, 0.05, dip))};
  Vehicle car = add_vehicle(Assembly(m, "car", Vec3(0, 0, 0.46 - spec.front.points.wheel.z())), spec, road);
  const double dt = 5e-5;
  design_for(m, dt);
  const Controls brakes{.brake = 1.0};
  for (long k = std::lround(4.0 / dt); k > 0; --k) {
    drive(m, car, brakes, dt);
    REQUIRE(m.step(dt));
  }
  CHECK(m.body(car.wheels[0].body).position().z() < m.body(car.wheels[1].body).position().z() - 0.05);
  CHECK(tyre_of(m, car.wheels[1]).load > 1.3 * tyre_of(m, car.wheels[0]).load);

  const CarSample now = sample_of(m, car, brakes, m.time());
  CHECK(now.roll < -0.01);  // to the left
  const Mat3 to_chassis = m.reference_rotation(car.chassis).transpose();
  const Vec3 gravity = to_chassis * m.gravity;
  for (std::size_t k = 0; k < 4; ++k) {
    CAPTURE(k);
    const SuspensionSample s = suspension_sample_of(m, car, k);
    const double weight = 9.81 * (spec.front.knuckle.mass + spec.wheel.mass.mass);
    // All that acts on the knuckle, and on the wheel. It still sways by mm/s after 4 s: a hundredth of the load.
    const Vec3 knuckle = s.upper_ball + s.lower_ball + s.bearing + s.rod + spec.front.knuckle.mass * gravity;
    const Vec3 ground = to_chassis * to_eigen(m.load(car.wheels[k].road).wrench.force);
    const Vec3 wheel = ground - s.bearing + spec.wheel.mass.mass * gravity;
    const double load = tyre_of(m, car.wheels[k]).load;
    CHECK(load > 3.0 * weight);
    CHECK(knuckle.norm() < 0.01 * load);
    CHECK(wheel.norm() < 0.01 * load);
    CHECK(s.spring > 0.0);
  }
}

TEST_CASE("a wheel that swings on the tread of its tyre loses nothing, with either kind of integrator") {
  const auto speed_left = []<class Integrator>(Integrator) {
    mbd::Machine<Integrator> m;
    TyreSpec tyre = TyreSpec{}.rigid();
    tyre.damping = tyre.tread_damping = 0.0;
    Wheel wheel;
    const double mass = 30.0, rest = tyre.radius - 9.81 * mass / tyre.stiffness, speed = 0.01;  // m, m/s
    // So much inertia that it does not turn.
    wheel.body = m.add_body(mbd::given_body("wheel", mass, Vec3(1e9, 1e9, 1e9)).at(Vec3(0, 0, rest)));
    m.body(wheel.body).motion.velocity = {0, speed, 0};
    add_tyre(Assembly(m), "wheel", wheel, tyre, Road{});
    // Ten half swings; the spring pulls with up to 0.01 m/s sqrt(k m) = 30 N, less than mu Fn = 235 N.
    const double swing = std::numbers::pi * std::sqrt(mass / tyre.lateral_stiffness);
    double fastest = 0.0;
    REQUIRE(m.run(10.5 * swing, 1e-3, [&] {
               if (m.time() > 9.5 * swing) fastest = std::max(fastest, m.body(wheel.body).velocity().norm());
             }).ok);
    return fastest / speed;
  };
  // omega dt = 0.1: with the newest speeds alone the predictor-corrector would lose exp(-10 pi 0.1/4), more than half.
  CHECK(speed_left(integrator::PredictorCorrector{}) == Approx(1.0).epsilon(0.01));
  CHECK(speed_left(integrator::VelocityVerlet{}) == Approx(1.0).epsilon(0.01));
}
