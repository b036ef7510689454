// A vehicle of one's own: what the page include/dem/vehicle/README.md shows, letter by letter, and what is refused.

#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/telemetry.hpp>
#include <dem/vehicle/vehicle.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

using namespace dem;
using namespace dem::vehicle;

namespace {

// clang-format off
VehicleSpec buggy() {
  VehicleSpec s;  // m, kg, s; the origin is the middle between the wheels
  const auto corner = [](double x, double in) {  // of a left wheel; in: 1 or -1, the way to the middle of the vehicle
    return WishbonePoints{.wheel = {x, .7, 0}, .knuckle = {x, .6, 0},
        .upper_front = {x + .1, .3, .15}, .upper_back = {x - .1, .3, .15}, .upper_ball = {x, .55, .13},
        .lower_front = {x + .15, .25, -.1}, .lower_back = {x - .15, .25, -.1}, .lower_ball = {x, .6, -.12},
        .rod_inner = {x + .15 * in, .3, -.05}, .rod_outer = {x + .15 * in, .6, -.05}, .spring_chassis = {x, .4, .35},
        .spring_arm = {x, .45, -.11}, .shock_chassis = {x + .05, .4, .35}, .shock_arm = {x + .05, .45, -.11}};
  };
  const auto wishbones = [](const WishbonePoints& points) {
    return DoubleWishboneSpec{.points = points, .upper_arm = {3, {.02, .02, .04}}, .lower_arm = {6, {.05, .05, .1}},
        .knuckle = {12, {.1, .1, .05}}, .spring_free_length = .463 + .076,  // as drawn, and compressed by 4.6 kN
        .spring_force = mbd::Curve{{-1, 0}, {0, 0}, {.2, 12200}}, .shock = 5000};  // 61 N/mm, pushes only
  };
  s.front = wishbones(corner(1, -1)), s.rear = wishbones(corner(-1, 1));
  s.wheel = {.mass = round_part(25, .3, .2, 1), .brake = 1500};
  s.tyre = {.radius = .35, .width = .2, .stiffness = 2e5, .damping = 1e3};
  s.steering = {.rod_inner = s.front.points.rod_inner, .rod_outer = s.front.points.rod_outer,
      .rack = round_part(4, .02, .6, 1), .pinion = round_part(1, .05, .04, 0), .rod = round_part(2, .02, .3, 1)};
  const auto axle = [](const WishbonePoints& points, double ahead) {  // of its differential the pinion is
    return AxleSpec{.middle = {points.wheel.x(), 0, 0}, .outer = points.knuckle, .pinion_ahead = ahead,
        .pinion = round_part(3, .04, .15, 0), .cage = round_part(12, .08, .15, 1),
        .side_shaft = round_part(3, .04, .2, 1), .half_shaft = round_part(4, .03, .4, 1), .ratio = 4};
  };
  s.driveline = {.front = axle(s.front.points, -.12), .rear = axle(s.rear.points, .12),
      .shaft = round_part(10, .04, 1.7, 0), .engine = {.torque = {{0, 150}, {600, 150}, {800, 0}}, .gears = {2.0}}};
  s.chassis = {1000, {250, 900, 1000}}, s.chassis_centre = {0, 0, .25};
  return s;
}
// clang-format on

struct Driven {
  double speed, yaw_rate, travel;
};

int drive_buggy(Driven& driven) {
  // clang-format off
mbd::Machine<integrator::VelocityVerlet> m;  // gravity is 9.81 m/s^2 along -z
m.joint_tolerance = 0.5;                     // m
Vehicle car = add_vehicle(Assembly(m, "buggy", {0, 0, .34}), buggy(), Road{});
const double dt = 5e-5;
design_for(m, dt);
for (SpeedHold hold; m.time() < 5.0;) {
  Controls c = hold(speed_of(m, car), 4.0, dt);
  c.steer = m.time() > 3.0 ? 0.1 : 0.0;
  drive(m, car, c, dt);
  if (const auto report = m.step(dt); !report) return fmt::print("{}\n", report.text), 1;
}
  // clang-format on
  driven = {.speed = speed_of(m, car), .yaw_rate = m.body(car.chassis).angular_velocity().z(), .travel = 0.0};
  for (std::size_t k = 0; k < 4; ++k) driven.travel += 0.25 * travel_of(m, car, k);
  return 0;
}

struct Parked {
  mbd::Machine<integrator::VelocityVerlet> m;
  VehicleSpec spec = buggy();
  Vehicle car = add_vehicle(Assembly(m, "car", {0, 0, .34}), spec, Road{});

  std::string refusal_of(const Controls& c, double dt = 5e-5, double steer_rate = 0.5) {
    return message_of([&] { drive(m, car, c, dt, steer_rate); });
  }
};

}  // namespace

TEST_CASE("the vehicle of the page gains speed, turns, and stands as high as it is drawn") {
  Driven driven{};
  REQUIRE(drive_buggy(driven) == 0);
  CHECK(driven.speed == Approx(4.0).margin(0.4));
  // v tan(0.1)/wheelbase, less what the tyres slip.
  CHECK(driven.yaw_rate == Approx(driven.speed * std::tan(0.1) / 2.0).epsilon(0.15));
  CHECK(std::abs(driven.travel) < 0.01);
}

TEST_CASE("a vehicle whose left side is drawn on the right, or whose axles are swapped, is refused") {
  const auto refusal = [](auto&& change) {
    return message_of([&] {
      mbd::Machine<integrator::VelocityVerlet> m;
      VehicleSpec s = buggy();
      change(s);
      add_vehicle(Assembly(m), s);
    });
  };
  using Catch::Matchers::Contains;
  CHECK(refusal([](VehicleSpec&) {}) == "(no dem::Error was thrown)");
  CHECK_THAT(refusal([](VehicleSpec& s) { s.front = s.front.mirrored(), s.rear = s.rear.mirrored(); }),
             Contains("y = -0.7 m (front)") && Contains("draw the left side"));
  CHECK_THAT(refusal([](VehicleSpec& s) { s.rear = s.rear.mirrored(); }), Contains("-0.7 m (rear)"));
  CHECK_THAT(refusal([](VehicleSpec& s) { std::swap(s.front, s.rear); }),
             Contains("x = -1 m") && Contains("the front one must be ahead"));
}

TEST_CASE("controls out of range, and times and rates that are not positive, are refused before anything moves") {
  using Catch::Matchers::Contains;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Parked p;
  CHECK_THAT(p.refusal_of({.throttle = 50.0}), Contains("throttle is 50, but must be from 0 to 1"));
  CHECK_THAT(p.refusal_of({.throttle = nan}), Contains("throttle is nan"));
  CHECK_THAT(p.refusal_of({.brake = -1.0}), Contains("brake is -1, but must be from 0 to 1"));
  CHECK_THAT(p.refusal_of({.brake = nan}), Contains("brake is nan"));
  CHECK_THAT(p.refusal_of({.steer = 10.0}), Contains("steer is 10, but must be from -0.8 to 0.8 rad"));
  CHECK_THAT(p.refusal_of({.steer = nan}), Contains("steer is nan"));
  CHECK_THAT(p.refusal_of({.steer = 0.1}, 0.0), Contains("time from one call of drive to the next is 0 s"));
  CHECK_THAT(p.refusal_of({.steer = 0.1}, nan), Contains("is nan s"));
  CHECK_THAT(p.refusal_of({.steer = 0.1}, 5e-5, -1.0), Contains("wheels are steered is -1 rad/s"));
  CHECK(p.car.driveline.engine.work == 0.0);
  // Rounding is let pass.
  CHECK(p.refusal_of({.throttle = 1.0 + 1e-15, .brake = -1e-15, .steer = 0.8}) == "(no dem::Error was thrown)");
}

TEST_CASE("shafts go on turning as the machine raises its sub-steps") {
  mbd::Machine<integrator::VelocityVerlet> m;  // with the default joint_tolerance, which asks for them
  m.gravity = Vec3::Zero();
  const Vehicle car = add_vehicle(Assembly(m, "car", {0, 0, .34}, Mat3::Identity(), 5.0), buggy());
  const double dt = 5e-5;
  design_for(m, dt);
  const double shaft = m.speed(car.driveline.shaft_turn);
  REQUIRE(m.run(80 * dt, dt));
  CHECK(m.substeps > 1);
  // Pinion and shaft are held by joints that differ in direction by what they open. Nothing brakes them: 1e-5 was seen.
  CHECK(m.speed(car.driveline.shaft_turn) == Approx(shaft).epsilon(1e-4));
  CHECK(m.speed(car.driveline.front.pinion_turn) == Approx(shaft).epsilon(1e-4));
}
