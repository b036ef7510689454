// The Humvee: what it is made of (Table 6.2 of the thesis), its joints, its brakes, tyres, engine and driver.

#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/open_loop.hpp>

#include <cmath>
#include <limits>
#include <string>

using namespace dem;
using namespace dem::vehicle;
using Catch::Matchers::Contains;

namespace {

using Machine = mbd::Machine<integrator::VelocityVerlet>;

int count(const mbd::Mechanism& m, mbd::JointKind kind) {
  int n = 0;
  for (const mbd::Joint& j : m.parts().joints) n += j.kind == kind;
  return n;
}

}  // namespace

TEST_CASE("the Humvee has the bodies, joints and actuators of Table 6.2") {
  using mbd::JointKind;
  for (const auto engine : {EngineSpec::Kind::actuator, EngineSpec::Kind::motor}) {
    Machine m;
    add_vehicle(Assembly(m), humvee({.engine = engine}));
    CHECK(m.bodies().size() == 34);
    CHECK(count(m, JointKind::prismatic) == 3);
    CHECK(count(m, JointKind::revolute) == 16);
    CHECK(count(m, JointKind::spherical) == 6);
    CHECK(count(m, JointKind::constant_velocity) == 4);
    CHECK(m.parts().actuators.size() == 5);
    for (const mbd::Actuator& a : m.parts().actuators) {
      CHECK(m.joint(a.spec.joint).kind == JointKind::revolute);
    }
    // What the table does not list, but the car needs.
    CHECK(count(m, JointKind::bushing) == 4);
    CHECK(count(m, JointKind::distance) == 2);
    CHECK(count(m, JointKind::universal) == 6);
    CHECK(count(m, JointKind::cylindrical) == 6);
    CHECK(m.parts().joints.size() == 47);
    CHECK(m.parts().couplings.size() == 5);
  }
}

TEST_CASE("the Humvee weighs what the thesis says") {
  Machine m;
  const Vehicle v = add_vehicle(Assembly(m), humvee());
  double sprung = 0.0, wheels = 0.0;
  for (const Body& b : m.bodies()) {
    for (const char* part : {"chassis", "rack", "pinion", "cage", "drive shaft", "side shaft"}) {
      if (b.name.find(part) != std::string::npos) sprung += b.mass;
    }
    if (b.name.find("wheel") != std::string::npos) wheels += b.mass;
  }
  CHECK(sprung == Approx(4430.0).epsilon(1e-12));
  CHECK(wheels == Approx(200.0).epsilon(1e-12));
  CHECK(v.spec.wheelbase() == Approx(3.378 - 0.076).margin(1e-3));  // the wheels stand 0.04 and 0.036 m further in
  CHECK_THAT(message_of([] { humvee({.sprung_mass = 50.0}); }), Contains("sprung mass is 50 kg"));
}

TEST_CASE("a brake holds up to its torque and slips beyond it") {
  // A wheel of 2 kg m^2 on a fixed knuckle; brake of 100 N m. A sudden 60 N m swing up to 81 N m before they rest.
  for (const double torque : {60.0, 150.0}) {
    Machine m;
    m.gravity = Vec3::Zero();
    const Assembly in(m);
    Wheel w = add_wheel(in, "test", m.ground(), Vec3::Zero(),
                        {.mass = {20.0, Vec3(1, 2, 1)}, .brake = 100.0, .brake_stiffness = 1e5});
    m.add_load(mbd::applied_torque("drive", w.body, Vec3::UnitY(), torque));
    const double dt = 1e-4;
    for (int k = 0; k < 20000; ++k) {
      set_brake(m, w, 1.0);
      REQUIRE(m.step(dt));
    }
    if (torque < 100.0) {
      // It is wound up by M/k, and from there on nothing moves.
      CHECK(m.coordinate(w.turn) == Approx(torque / 1e5).margin(1e-8));
      CHECK(std::abs(m.speed(w.turn)) < 1e-8);
    } else {
      // (150 - 100)/2 = 25 rad/s^2 for 2 s. Until it is wound up by 1 mrad, for 9 ms at the most, the brake holds less:
      // 100 N m of 2 kg m^2 for so long are 0.45 rad/s.
      CHECK(m.speed(w.turn) > 50.0);
      CHECK(m.speed(w.turn) < 50.45);
    }
  }
}

TEST_CASE("a tyre carries, rolls, corners and slides as its constants say") {
  TyreSpec tyre;
  const Road road{.friction = 0.5};
  Body wheel;
  const double d = 0.02, load = tyre.stiffness * d;
  wheel.motion.position = {0, 0, tyre.radius - d};
  const auto rolled = [&](double speed, double turning, double drift) {
    TyreState s;
    wheel.motion.velocity = {speed, drift, 0};
    wheel.motion.angular_velocity = {0, turning, 0};
    for (int k = 0; k <= 20000; ++k) tyre_wrench(tyre, road, wheel, Vec3::UnitY(), 1e-4 * k, s);
    return s;
  };
  const double loaded = tyre.radius - d, v = 5.0;
  CHECK(rolled(v, v / loaded, 0.0).load == Approx(load));
  CHECK(rolled(v, v / loaded, 0.0).pull == Approx(0.0).margin(1e-6 * load));
  // 1 % of slip: kx L 0.01; 1 mrad of slip angle: ky L 0.001. After 2 s, 33 relaxation lengths, to e^-33.
  CHECK(rolled(v, 1.01 * v / loaded, 0.0).pull == Approx(0.01 / 1.01 * tyre.tread_stiffness * 0.3).epsilon(1e-6));
  CHECK(rolled(v, 1.01 * v / loaded, 0.0).slip == Approx(0.01 / 1.01).epsilon(1e-9));
  CHECK(rolled(v, v / loaded, 0.005).side == Approx(-0.001 * tyre.lateral_stiffness * 0.3).epsilon(1e-6));
  // A locked wheel slides on mu Fn, the road's share included.
  CHECK(rolled(v, 0.0, 0.0).pull == Approx(-0.8 * 0.5 * load));
  CHECK(rolled(v, 0.0, 0.0).slip == Approx(-1.0));
  // A rigid tread of a standing wheel is a spring.
  tyre = tyre.rigid();
  CHECK(rolled(0.0, 0.0, 1e-3).side == Approx(-tyre.lateral_stiffness * 2e-3 - tyre.tread_damping * 1e-3));
  CHECK_THAT(message_of([] { check_tyre({.relaxation_length = 0.0}); }), Contains("relaxation length of a tyre is 0"));
}

TEST_CASE("half shafts turn the wheels by the ratio of the axle, straight or bent") {
  Machine m;
  m.gravity = Vec3::Zero();
  m.joint_tolerance = 1.0;  // m: light shafts wind up under the engine's torque, and only speeds are compared
  Vehicle v = add_vehicle(Assembly(m), humvee({.rubber_rear = false}));
  m.set_fixed(v.chassis);
  for (std::size_t k = 0; k < 4; ++k) m.set_fixed(v.suspension[k].knuckle);
  set_throttle(m, v.driveline.engine, 0.2);
  REQUIRE(m.run(0.5, 5e-5));
  const double shaft = m.speed(v.driveline.shaft_turn);
  CHECK(shaft > 5.0);
  // Sides of equal load turn alike. A universal joint bent by 1 deg ripples by b^2/2 = 2e-4; the gears wind up while
  // the speed grows.
  for (const Wheel& w : v.wheels) CHECK(m.speed(w.turn) == Approx(shaft / 5.0).epsilon(2e-3));
}

TEST_CASE("an engine without gears, or with gears that hunt, is refused") {
  const auto refused = [](auto&& change) {
    return message_of([&] {
      VehicleSpec s = humvee({.engine = EngineSpec::Kind::geared});
      change(s.driveline.engine);
      Machine m;
      add_vehicle(Assembly(m), s);
    });
  };
  CHECK_THAT(refused([](EngineSpec& e) { e.gears.clear(); }), Contains("the engine has no gears"));
  CHECK_THAT(refused([](EngineSpec& e) { e.gears = {1.0, 2.0}; }), Contains("ratios must fall from gear to gear"));
  CHECK_THAT(refused([](EngineSpec& e) { e.shift_down = 300.0; }), Contains("would shift back at once"));
}

TEST_CASE("a driver holds a speed, and follows a circle") {
  // A mass of 1 unit, pushed by at most 3 and held back by 8 m/s^2, against a drag of 0.5 m/s^2.
  SpeedHold hold;
  double v = 0.0, fastest = 0.0;
  for (int k = 0; k < 6000; ++k) {
    const Controls c = hold(v, 5.0, 0.01);
    v += 0.01 * (3.0 * c.throttle - 8.0 * c.brake - 0.5);
    fastest = std::max(fastest, v);
  }
  CHECK(v == Approx(5.0).epsilon(1e-3));  // the integral leaves no error
  CHECK(fastest < 6.0);                   // and does not wind up while the throttle is at its limit
  // What a rise of the speed is known to take is given at once, so that nothing has to unwind at its end.
  hold = {};
  v = fastest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const double wanted = std::min(5.0, 0.01 * k);
    const Controls c = hold(v, wanted, 0.01, wanted < 5.0 ? 1.0 / 3.0 : 0.0);
    v += 0.01 * (3.0 * c.throttle - 8.0 * c.brake - 0.5);
    fastest = std::max(fastest, v);
  }
  CHECK(v == Approx(5.0).epsilon(0.01));
  CHECK(fastest < 5.1);
  // The integral stands still while something else eases the throttle off.
  const double before = hold.sum;
  hold(3.0, 5.0, 0.01, 0.0, true);
  CHECK(hold.sum == before);
  // A kinematic car on a circle of 20 m, drawn with pieces of 0.5 m; with the trim as well, as there is no offset.
  for (const double trim : {0.0, 1.0}) {
    PathFollower path;
    path.wheelbase = 3.378;
    path.preview = 3.0, path.preview_time = 0.0, path.trim = trim;
    const double r = 20.0;
    for (int k = 0; k <= 400; ++k) {
      const double a = 0.025 * k;
      path.path.push_back(Vec3(r * std::sin(a), r - r * std::cos(a), 0));
    }
    Vec3 at = Vec3::Zero();
    double yaw = 0.0, worst = 0.0;
    for (int k = 0; k < 3000 && !path.at_end(); ++k) {
      const Vec3 heading(std::cos(yaw), std::sin(yaw), 0);
      const double steer = path(at, heading, 5.0);
      at += 0.01 * 5.0 * heading;
      yaw += 0.01 * 5.0 * std::tan(steer) / path.wheelbase;
      worst = std::max(worst, std::abs((at - Vec3(0, r, 0)).norm() - r));
    }
    CHECK(yaw > 6.0);
    // Pure pursuit of a circle is exact; chords of 0.5 m lie 1.6 mm inside.
    CHECK(worst < 0.05);
  }
  CHECK_THAT(message_of([] { PathFollower{}({0, 0, 0}, {1, 0, 0}, 1.0); }), Contains("a path has 0 points"));
}

TEST_CASE("a car that drifts off a side slope comes back to its path with trim, and stays beside it without") {
  // It goes 1 m to the right for 10 m that it drives. To stay on the line it heads 0.0997 rad to the left. Without trim
  // the point that it aims at must then be 0.0997 rad to the left of the path: it stands reach x sin of that beside it.
  for (const double trim : {0.0, 1.0}) {
    PathFollower follow;
    follow.path = {Vec3(-10, 0, 0), Vec3(1000, 0, 0)};
    follow.wheelbase = 3.378;
    follow.preview = 4.0, follow.preview_time = 0.0, follow.trim = trim;
    Vec3 at = Vec3::Zero();
    double yaw = 0.0;
    for (int k = 0; k < 4000; ++k) {
      const double steer = follow(at, Vec3(std::cos(yaw), std::sin(yaw), 0), 2.0);
      at += 0.02 * (Vec3(std::cos(yaw), std::sin(yaw), 0) + Vec3(0, -0.1, 0));
      yaw += 0.02 * std::tan(steer) / follow.wheelbase;
    }
    CHECK(yaw == Approx(std::asin(0.1)).epsilon(0.01));
    CHECK(follow.offset(at) == Approx(trim > 0.0 ? 0.0 : -0.4).margin(0.002));
  }
}

TEST_CASE("a path with a sharp corner and doubled points is followed to its end, with and without trim") {
  for (const double trim : {0.0, 1.0}) {
    CAPTURE(trim);
    PathFollower follow{.path = {Vec3(-10, 0, 0), Vec3(30, 0, 0), Vec3(30, 0, 0), Vec3(0, 20, 0), Vec3(-60, 60, 0)},
                        .wheelbase = 3.378,
                        .preview = 3.0,
                        .preview_time = 0.0,
                        .trim = trim};
    Vec3 at = Vec3::Zero();
    double yaw = 0.0;
    int k = 0;
    for (; k < 20000 && !follow.at_end(); ++k) {
      const double steer = follow(at, Vec3(std::cos(yaw), std::sin(yaw), 0), 3.0);
      at += 0.01 * Vec3(std::cos(yaw), std::sin(yaw), 0);
      yaw += 0.01 * std::tan(steer) / follow.wheelbase;
    }
    CHECK(follow.at_end());
    CHECK(k < 18000);  // the path is 138 m long
    CHECK(std::abs(follow.offset(at)) < 0.3);
    CHECK((at - Vec3(-60, 60, 0)).norm() < 3.1);
  }
  PathFollower straight{.path = {Vec3(0, 0, 0), Vec3(100, 0, 0)}, .wheelbase = 3.378};
  straight(Vec3::Zero(), Vec3::UnitX(), 1.0);
  CHECK(!straight.at_end());
  CHECK_THAT(message_of([] { PathFollower{}.offset({0, 0, 0}); }), Contains("a path has 0 points"));
  straight.wheelbase = 0.0;
  check_refused([&] { straight(Vec3::Zero(), Vec3::UnitX(), 1.0); }, "wheelbase of a path follower is 0 m",
                "VehicleSpec::wheelbase()");
}

TEST_CASE("a motor's governor takes the throttle back between two speeds of the rims") {
  Controls c{.throttle = 1.0};
  CHECK(c.governed(1e6) == 1.0);  // none unless asked for
  c.ease_from = 2.0, c.ease_to = 4.0;
  CHECK(c.governed(-1.0) == 1.0);
  CHECK(c.governed(2.5) == Approx(0.75));
  CHECK(c.governed(4.0) == 0.0);
  c.ease_to = 2.0;  // a limit without a band
  CHECK(c.governed(2.0) == 1.0);
  CHECK(c.governed(2.1) == 0.0);
  CHECK_NOTHROW(c.check());
  c.ease_from = Controls::no_limit;
  CHECK_THAT(message_of([&] { c.check(); }), Contains("give both ease_from and ease_to"));
}

TEST_CASE("inputs of a driver are straight lines between their rows, held outside, and may step") {
  const OpenLoop inputs({{1.0, 0.0, 1.0, 0.0}, {2.0, 1.0, 0.0, 0.2}, {2.0, 0.5, 0.0, -0.2}, {4.0, 0.5, 0.5, 0.0}});
  CHECK(inputs.end() == 4.0);
  CHECK(inputs(0.0).brake == 1.0);
  CHECK(inputs(1.25).throttle == Approx(0.25));
  CHECK(inputs(1.25).steer == Approx(0.05));
  CHECK(inputs(2.0 - 1e-12).throttle == Approx(1.0));
  CHECK(inputs(2.0).throttle == 0.5);
  CHECK(inputs(2.0).steer == -0.2);
  CHECK(inputs(3.0).brake == Approx(0.25));
  CHECK(inputs(9.0).brake == 0.5);
  CHECK(OpenLoop({{0.0, 0.3, 0.0, 0.0}})(7.0).throttle == 0.3);
  const auto refused = [](std::vector<OpenLoop::Row> rows) { return message_of([&] { OpenLoop(std::move(rows)); }); };
  CHECK_THAT(refused({}), Contains("have no rows"));
  CHECK_THAT(refused({{1.0, 0, 0, 0}, {0.5, 0, 0, 0}}), Contains("the time 0.5 s after 1 s"));
  CHECK_THAT(refused({{0.0, 1.5, 0, 0}}), Contains("row 1 of a driver's inputs: its throttle must be from 0 to 1"));
  CHECK_THAT(refused({{0.0, 0, -0.1, 0}}), Contains("its brake"));
  CHECK_THAT(refused({{0.0, 0, 0, 12.0}}), Contains("0.8 rad"));
  CHECK_THAT(refused({{std::nan(""), 0, 0, 0}}), Contains("its time is not finite"));
}
