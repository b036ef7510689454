// Engines of a vehicle: the rotor with its clutch and gears, the single actuator of the thesis, and the sum of their
// work.

#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/lane_driver.hpp>

#include <cmath>

using namespace dem;
using namespace dem::vehicle;
using Catch::Matchers::Contains;

namespace {

using Machine = mbd::Machine<integrator::VelocityVerlet>;

/// An engine in a fixed housing, and a shaft of 50 kg m^2 that it drives: what the car is to it in its first gear.
struct Bench {
  Machine m;
  BodyId shaft;
  JointId turn;
  Engine engine;
  double dt = 1e-4;

  explicit Bench(EngineSpec s, double spin = 0.0) {
    m.gravity = Vec3::Zero();
    const Assembly in(m);
    shaft = in.body("shaft", {500.0, Vec3(50, 50, 50)}, Vec3::Zero(), Vec3(spin, 0, 0));
    turn = in.joint(mbd::JointKind::revolute, "shaft", m.ground(), shaft, Vec3::Zero(), Vec3::UnitX());
    engine = add_engine(in, m.ground(), turn, s, Vec3(0, 0, 1), Vec3::UnitX(), spin);
    m.design_for(dt);
  }
  void run(double seconds, double throttle) {
    for (long k = std::lround(seconds / dt); k > 0; --k) {
      engine.work += dt * m.actuator(engine.drive).power();
      set_throttle(m, engine, throttle);
      work_gears(m, engine, m.speed(turn), dt);
      REQUIRE(m.step(dt));
    }
  }
  double rotor() const { return m.speed(engine.crank); }
  void set_speed(double s) { m.parts().bodies[shaft.index()].motion.angular_velocity = {s, 0, 0}; }
};

EngineSpec small() {
  EngineSpec s;
  s.kind = EngineSpec::Kind::geared;
  s.torque = {{0, 200}, {300, 200}};
  s.drag = {{0, 0}, {100, -20}, {300, -20}};
  s.gears = {4.0, 2.0, 1.0};
  s.rotor = {50.0, Vec3(1, 1, 1)};
  s.idle = 80.0, s.clutch_speed = 120.0, s.clutch_torque = 300.0;
  s.shift_up = 250.0, s.shift_down = 100.0, s.shift_wait = 0.2;
  return s;
}

}  // namespace

TEST_CASE(
    "an engine idles with an open clutch, drives a shaft from rest through its gears, and its work is accounted for") {
  Bench b(small());
  b.run(2.0, 0.0);
  CHECK(b.rotor() == Approx(80.0).margin(8.0));  // the governor gives 16 to 20 N m of 200, of 0.05 for a rad/s
  CHECK(b.m.speed(b.turn) == 0.0);               // which is below 80 rad/s, so the clutch holds nothing
  CHECK(b.engine.gear == 0);

  b.run(1.0, 1.0);
  // 800 N m on the shaft's 50 kg m^2 and the rotor's 16: 12.1 rad/s^2, as soon as the clutch holds; before it passes as
  // much, and the rotor takes less.
  CHECK(b.m.speed(b.turn) == Approx(12.1).epsilon(0.15));
  b.run(1.5, 1.0);
  CHECK(b.rotor() == Approx(4.0 * b.m.speed(b.turn)).epsilon(1e-3));  // the clutch holds
  // 250/4 = 62.5 rad/s are reached after some 5 s, 250/2 another 62.5/(400/54) = 8.4 s later.
  b.run(4.0, 1.0);
  CHECK(b.engine.gear == 1);
  b.run(9.0, 1.0);
  CHECK(b.engine.gear == 2);
  CHECK(b.rotor() == Approx(b.m.speed(b.turn)).epsilon(1e-3));
  const auto& plates = b.m.clutch(b.engine.clutch);
  const double moving = mbd::energy_of(b.m.parts(), b.m.gravity).kinetic - 0.5 * 80.0 * 80.0;
  // Work is summed with the force and speed of the step before: a step is 1e-4 of the shortest rise, a second.
  CHECK(b.engine.work == Approx(moving + plates.history.slip_work).epsilon(1e-4));
  CHECK(plates.history.slip_work > 0.0);
}

TEST_CASE("gears wait for each other, shift back as the shaft slows, and do not hunt") {
  Bench b(small());
  b.set_speed(200.0);
  int shifts = 0;
  std::size_t gear = 0;
  for (int k = 0; k < 100; ++k) {
    b.run(0.01, 0.5);
    if (b.engine.gear != gear) ++shifts, gear = b.engine.gear;
    if (k < 19) CHECK(b.engine.gear <= 1);  // the second shift waits for 0.2 s
  }
  CHECK(shifts == 2);
  b.set_speed(20.0);
  b.run(1.0, 0.0);
  CHECK(b.engine.gear == 0);
}

TEST_CASE("an engine starts in the gear of its shaft's speed, and brakes the shaft by its drag") {
  Bench b(small(), 150.0);  // 600, 300 and 150 rad/s of the input; up to 250
  CHECK(b.engine.gear == 2);
  CHECK(b.rotor() == Approx(150.0));
  b.run(1.0, 0.0);
  // 20 N m on 50 kg m^2 of the shaft and 1 kg m^2 of the rotor.
  CHECK(b.m.speed(b.turn) == Approx(150.0 - 20.0 / 51.0).epsilon(1e-4));
  // Pushed on from rest the shaft closes the clutch as well: 30 rad/s are 120 of the input, beyond the 80 of idling.
  // The shaft's spin and four times the rotor's come to one speed, which four times the drag lowers for half a second.
  Bench rest(small());
  rest.run(0.1, 0.0);
  rest.set_speed(30.0);
  rest.run(0.5, 0.0);
  CHECK(rest.rotor() == Approx(4.0 * rest.m.speed(rest.turn)).epsilon(1e-3));
  CHECK(rest.m.speed(rest.turn) == Approx((50.0 * 30.0 + 4.0 * 80.0 - 0.5 * 80.0) / 66.0).epsilon(0.01));
}

TEST_CASE("what an actuator may give is kept: a vehicle that is built anew takes it over") {
  Machine m, anew;
  const VehicleSpec spec = humvee(with_engine({.rubber_rear = false}, "actuator"));
  Vehicle v = add_vehicle(Assembly(m), spec), again = add_vehicle(Assembly(anew), spec);
  const auto limit = [](Machine& of, const Vehicle& car) {
    return of.actuator(car.driveline.engine.drive).spec.max_force;
  };
  drive(m, v, {.throttle = 0.25}, 1e-4);
  CHECK(limit(m, v) == Approx(0.25 * 793.0 / 0.3));
  again.driveline.engine.share = v.driveline.engine.share;
  take_controls(anew, again);
  CHECK(limit(anew, again) == limit(m, v));
}

TEST_CASE("an actuator as engine pushes with the throttle's share of its torque, up to the governor's speed") {
  Machine m;
  m.gravity = Vec3::Zero();
  m.joint_tolerance = 1.0;  // m: light shafts wind up, and only speeds are compared
  Vehicle v = add_vehicle(Assembly(m), humvee(with_engine({.rubber_rear = false}, "actuator")));
  m.set_fixed(v.chassis);
  for (std::size_t k = 0; k < 4; ++k) m.set_fixed(v.suspension[k].knuckle);
  const double dt = 5e-5;
  design_for(m, dt);
  const auto run = [&](double seconds, const Controls& c) {
    for (long k = std::lround(seconds / dt); k > 0; --k) {
      drive(m, v, c, dt);
      REQUIRE(m.step(dt));
    }
  };
  run(0.05, {.throttle = 0.25});
  CHECK(m.actuator(v.driveline.engine.drive).force == Approx(0.25 * 793.0 / 0.3));
  run(1.0, turn_rims(0.0, 2.0));
  CHECK(rim_speed_of(m, v) == Approx(2.0).epsilon(0.01));
  run(0.01, {});
  CHECK(m.actuator(v.driveline.engine.drive).force == 0.0);
  // What it gave is in the wheels, shafts and pinions, but for what dampers of joints took.
  const double moving = mbd::energy_of(m.parts(), m.gravity).kinetic;
  CHECK(v.driveline.engine.work == Approx(moving).epsilon(0.2));
  CHECK(v.driveline.engine.work > moving);
}

TEST_CASE("engines are chosen by name, and what cannot be is refused in words") {
  CHECK(humvee(with_engine({}, "low-range")).driveline.engine.transfer == 2.72);
  CHECK(humvee(with_engine({}, "gears")).driveline.engine.gears.size() == 6);
  CHECK_THAT(message_of([] { with_engine({}, "turbine"); }), Contains("there is no engine 'turbine'"));
  const auto refused = [](auto&& change) {
    return message_of([&] {
      EngineSpec s = small();
      change(s);
      Bench bench(s);
    });
  };
  CHECK_THAT(refused([](EngineSpec& e) { e.gears.clear(); }), Contains("the engine has no gears"));
  CHECK_THAT(refused([](EngineSpec& e) { e.gears = {1.0, 2.0}; }), Contains("ratios must fall from gear to gear"));
  CHECK_THAT(refused([](EngineSpec& e) { e.shift_down = 200.0; }), Contains("would shift back at once"));
  CHECK_THAT(refused([](EngineSpec& e) { e.clutch_speed = 70.0; }), Contains("the latter must be faster"));
  CHECK_THAT(refused([](EngineSpec& e) { e.drag = {}; }), Contains("no curve of its drag"));
  CHECK_THAT(refused([](EngineSpec& e) { e.kind = EngineSpec::Kind::motor; }), Contains("a motor has 3 gears"));
}
