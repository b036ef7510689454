#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

BodySpec ball(const std::string& name, double mass = 1.0, double inertia = 0.1) {
  return given_body(name, mass, Vec3(inertia, inertia, inertia));
}

}  // namespace

TEST_CASE("a PD actuator's step response is that of a damped oscillator") {
  // m x'' + c x' + K (x - xd) = 0 from rest: x = xd (1 - exp(-z w t)(cos wd t + z w/wd sin wd t)).
  const double mass = 2.0, K = 800.0, c = 16.0, xd = 0.05;
  const double w = std::sqrt(K / mass), z = c / (2.0 * std::sqrt(K * mass)), wd = w * std::sqrt(1 - z * z);
  const auto exact = [&](double t) {
    return xd * (1.0 - std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t)));
  };
  SECTION("on a joint's slide") {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId cart = m.add_body(ball("cart", mass));
    const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X));
    const ActuatorId ram = m.add_actuator(joint_actuator("ram", guide, K, c, xd));
    for (int k = 0; k < 10; ++k) {
      REQUIRE(m.run(0.05, 1e-4));
      // Second order: (w dt)^2 = 4e-6 of the step.
      CHECK(m.coordinate(guide) == Approx(exact(m.time())).margin(4e-6 * xd));
    }
    CHECK(m.actuator(ram).force == Approx(-K * (m.coordinate(guide) - xd) - c * m.speed(guide)).margin(1e-2));
  }
  SECTION("between two points, guided by two cylindrical joints in parallel as in the thesis") {
    Machine<VelocityVerlet> m;
    m.gravity.setZero();
    const BodyId cart = m.add_body(ball("cart", mass));
    m.add_joint(cylindrical("rail 1", m.ground(), cart, {0, 0.2, 0}, X));
    m.add_joint(cylindrical("rail 2", m.ground(), cart, {0, -0.2, 0}, X));
    m.add_actuator(linear_actuator("ram", m.ground(), {-1, 0, 0}, cart, {0, 0, 0}, K, c, 1.0 + xd));
    for (int k = 0; k < 10; ++k) {
      REQUIRE(m.run(0.05, 1e-4));
      // Dampers see the half-step speed: first order in c dt / m = 8e-4 of the step.
      CHECK(m.body(cart).position().x() == Approx(exact(m.time())).margin(8e-4 * xd));
    }
  }
  SECTION("as a torque about a hinge, over whole turns") {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId disc = m.add_body(ball("disc", 1.0, mass));
    const JointId hinge = m.add_joint(revolute("hinge", m.ground(), disc, {0, 0, 0}, Z));
    m.add_actuator(joint_actuator("motor", hinge, K, c, 400.0 * xd));
    for (int k = 0; k < 10; ++k) {
      REQUIRE(m.run(0.05, 1e-4));
      CHECK(m.coordinate(hinge) == Approx(400.0 * exact(m.time())).margin(4e-6 * 400.0 * xd));
    }
  }
  SECTION("between three points") {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId disc = m.add_body(ball("disc", 1.0, mass));
    m.add_joint(revolute("hinge", m.ground(), disc, {0, 0, 0}, Z));
    const ActuatorId servo =
        m.add_actuator(rotational_actuator("servo", m.ground(), {0, 0, 0}, X, disc, X + Y, K, c, pi / 4 + xd));
    REQUIRE(m.run(0.1, 1e-4));
    REQUIRE(m.step(1e-4));
    CHECK(m.actuator(servo).coordinate - pi / 4 == Approx(exact(m.time())).margin(1e-5 * xd + 1e-6));
    CHECK_THAT(message_of([&] {
                 m.add_actuator(rotational_actuator("flat", m.ground(), {0, 0, 0}, X, disc, X, K, c));
               }),
               Contains("three points of actuator 'flat' lie on a line"));
  }
}

TEST_CASE("actuators obey their limits, their switch, and a set point from outside") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(ball("cart", 2.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X));
  const ActuatorId ram = m.add_actuator(joint_actuator("ram", guide, 1e5, 1e3, 1.0).with_max_force(6.0));
  REQUIRE(m.run(0.5, 1e-4));
  CHECK(m.speed(guide) == Approx(6.0 / 2.0 * 0.5).epsilon(1e-9));
  CHECK(m.actuator(ram).force == 6.0);
  CHECK(m.actuator(ram).power() == Approx(6.0 * 1.5).epsilon(1e-3));
  m.switch_on(ram, false);
  REQUIRE(m.run(0.1, 1e-4));
  CHECK(m.speed(guide) == Approx(1.5).epsilon(2e-4));  // the trapezoidal rule still counts half a step of the old force
  CHECK(m.actuator(ram).force == 0.0);

  // A speed controller (no position gain) follows a speed that is set every step: v' = c (v_set - v) / m, lag m/c.
  Machine<PredictorCorrector> n;
  n.gravity.setZero();
  const BodyId sled = n.add_body(ball("sled", 2.0));
  const JointId rail = n.add_joint(prismatic("rail", n.ground(), sled, {0, 0, 0}, X));
  const ActuatorId drive = n.add_actuator(joint_actuator("drive", rail, 0.0, 200.0));
  for (int k = 0; k < 5000; ++k) {
    n.set_target(drive, 0.0, 3.0 * n.time());
    REQUIRE(n.step(1e-4));
  }
  CHECK(n.speed(rail) == Approx(3.0 * (0.5 - 2.0 / 200.0)).epsilon(1e-3));
}

TEST_CASE("a motor follows its torque-speed curve") {
  // T = 10 - 0.5 w on I = 0.2: w = 20 (1 - exp(-2.5 t)).
  Machine<PredictorCorrector> m;
  const BodyId rotor = m.add_body(ball("rotor", 1.0, 0.2));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), rotor, {0, 0, 0}, Z));
  const ActuatorId e = m.add_actuator(motor("motor", axle, {{0, 10}, {20, 0}}));
  REQUIRE(m.run(0.6, 1e-4));
  CHECK(m.speed(axle) == Approx(20.0 * (1.0 - std::exp(-1.5))).epsilon(1e-6));
  m.set_throttle(e, 0.0);
  REQUIRE(m.step(1e-4));
  CHECK(m.actuator(e).force == 0.0);
  CHECK_THAT(message_of([&] { m.set_throttle(e, 2.0); }), Contains("throttle of a motor is 2"));
  check_refused([&] { motor("idle", axle, {{0, 10}, {20, 0}}, 5.0); }, "throttle of motor 'idle' is 5");
  check_refused([&] { motor("idle", axle, Curve()); }, "motor 'idle' has no torque curve");
}

TEST_CASE("a motor in reverse is the mirror image of itself forward") {
  // Full throttle back: w = -20 (1 - exp(-2.5 t)). Half of it: the same speed, reached half as fast. Full throttle back
  // at 10 rad/s forward: the curve goes on to the left of 0, 10 + 0.5 10 = 15 N m of braking.
  for (const double throttle : {-1.0, -0.5}) {
    Machine<PredictorCorrector> m;
    const BodyId rotor = m.add_body(ball("rotor", 1.0, 0.2));
    const JointId axle = m.add_joint(revolute("axle", m.ground(), rotor, {0, 0, 0}, Z));
    m.add_actuator(motor("motor", axle, {{0, 10}, {20, 0}}, throttle));
    REQUIRE(m.run(0.6, 1e-4));
    CHECK(m.speed(axle) == Approx(-20.0 * (1.0 - std::exp(1.5 * throttle))).epsilon(1e-6));
    REQUIRE(m.run(6.0, 1e-4));
    CHECK(m.speed(axle) == Approx(-20.0).epsilon(1e-3));
  }
  Machine<PredictorCorrector> m;
  const BodyId rotor = m.add_body(ball("rotor", 1.0, 0.2).moving(Vec3::Zero(), {0, 0, 10.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), rotor, {0, 0, 0}, Z));
  const ActuatorId e = m.add_actuator(motor("motor", axle, {{0, 10}, {20, 0}}, -1.0));
  REQUIRE(m.step(1e-6));
  CHECK(m.actuator(e).force == Approx(-15.0).epsilon(1e-4));
}

TEST_CASE("set points, loads and motions that are no numbers are refused where they are given") {
  Machine<PredictorCorrector> m;
  const double nan = std::nan(""), inf = HUGE_VAL;
  const BodyId cart = m.add_body(ball("cart"));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X));
  const ActuatorId ram = m.add_actuator(joint_actuator("ram", guide, 1.0, 1.0));
  const LoadId push = m.add_load(applied_force("push", cart, {0, 0, 0}, X, 1.0));
  check_refused([&] { m.set_target(ram, nan); }, "is nan, but must be finite");
  check_refused([&] { m.set_target(ram, 0.0, inf); }, "rate of a signal is inf");
  check_refused([&] { m.set_throttle(ram, nan); }, "throttle of a motor is nan");
  check_refused([&] { m.set_load(push, nan); }, "is nan, but must be finite");
  check_refused([&] { prescribed_joint("drive", guide, nan); }, "is nan, but must be finite");
  check_refused([&] { Signal::ramp(0.0, nan); }, "ramp is nan");
  check_refused([&] { Signal::sine(1.0, inf); }, "sine is inf");
  check_refused([&] { Signal::table({}); }, "has no points");
  check_refused([&] { spring_table("s", cart, X, m.ground(), Y, 1.0, {{0, 0}, {1, 1}}, -1.0); }, "damping", "-1");
}

TEST_CASE("springs with a stiffness and with a table carry a weight at the right length") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(ball("a", 10.0)), b = m.add_body(ball("b", 10.0).at({1, 0, 0}));
  m.add_joint(prismatic("guide a", m.ground(), a, {0, 0, 0}, Z));
  m.add_joint(prismatic("guide b", m.ground(), b, {1, 0, 0}, Z));
  m.add_spring(spring("coil", m.ground(), {0, 0, -0.5}, a, {0, 0, 0}, 5000.0, 300.0));
  // 98.1 N lie on the second piece of the table: 50 N at 10 mm, then 10 N/mm.
  const SpringId s = m.add_spring(
      spring_table("pack", m.ground(), {1, 0, -0.5}, b, {1, 0, 0}, 0.5, {{0, 0}, {0.010, 50}, {0.020, 150}}, 300.0));
  REQUIRE(m.run(3.0, 1e-4));
  CHECK(m.body(a).position().z() == Approx(-98.1 / 5000.0).epsilon(1e-6));
  CHECK(m.body(b).position().z() == Approx(-(0.010 + 48.1 / 10000.0)).epsilon(1e-6));
  CHECK(m.spring(s).force == Approx(98.1).epsilon(1e-6));
}

TEST_CASE("loads push along fixed and turning directions, as functions of time") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a", 2.0));
  m.add_load(applied_force("push", a, {0, 0, 0}, X, Signal::ramp(0.0, 4.0)));
  const BodyId b = m.add_body(ball("b", 2.0).moving(Vec3::Zero(), {0, 0, 2.0}));
  LoadSpec thruster = applied_force("thruster", b, {0, 0, 0}, X, 1.0);
  thruster.follows_body = true;
  const LoadId id = m.add_load(thruster);
  const double t = 0.75;
  REQUIRE(m.run(t, 1e-4));
  CHECK(m.body(a).velocity().x() == Approx(4.0 * t * t / 2.0 / 2.0).epsilon(1e-6));
  // Direction (cos 2t, sin 2t), 0.5 m/s^2.
  CHECK(m.body(b).velocity().x() == Approx(0.5 * std::sin(2 * t) / 2).epsilon(1e-6));
  CHECK(m.body(b).velocity().y() == Approx(0.5 * (1 - std::cos(2 * t)) / 2).epsilon(1e-6));
  m.switch_on(id, false);
  const Vec3 v = m.body(b).velocity();
  REQUIRE(m.run(0.1, 1e-4));
  CHECK((m.body(b).velocity() - v).norm() < 1e-4);
}

TEST_CASE("a load is given another size while a machine runs") {
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a", 2.0));
  const LoadId push = m.add_load(applied_force("push", a, {0, 0, 0}, X, 4.0));
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.body(a).velocity().x() == Approx(1.0));
  m.set_load(push, -6.0);
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.body(a).velocity().x() == Approx(1.0 - 1.5));
  m.set_load(push, Signal::ramp(0.0, 8.0, 1.0));  // 8 N/s over 0.5 s: an impulse of 1 N s, less half a step's
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.body(a).velocity().x() == Approx(-0.5 + 0.5).margin(0.5 * 8.0 * 0.5 * 1e-3 / 2.0 + 1e-9));
}

TEMPLATE_TEST_CASE("prescribed motion is met exactly and reports its drive force", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const SensorId cell = m.add_sensor(drive_sensor("cell", drive, 0.0));
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  for (int k = 0; k < 3000; ++k) REQUIRE(m.step(dt));
  const double t = m.time();
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  CHECK(m.speed(guide) == Approx(0.01 * w * std::cos(w * t)).epsilon(1e-9));
  // Mass times acceleration, of the middle of the step, and one step late in the sensor.
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * (t - dt / 2))).epsilon(1e-3));
  CHECK(m.sensor(cell).latest().force.x == Approx(m.motion(drive).drive.force).epsilon(5e-3));
}

TEMPLATE_TEST_CASE("prescribed motion holds in the sub-steps that a world asks for", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // As a world steps it: the contact forces (none here) first, then several machine steps; of two stages the second
  // starts again.
  Machine<TestType> m;
  m.substeps = 4;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const double dt = 4e-4, w = 2.0 * pi * 2.0;
  m.design_for(dt);
  m.initialise(0.0, Vec3::Zero());
  for (int s = 0; s < 800; ++s) {
    for (int stage = 0; stage < TestType::stages; ++stage) {
      if (TestType::predicts_before_forces) m.advance_substeps(stage, dt, Vec3::Zero());
      m.clear_forces();
      m.hold_contacts(stage);
      if (!TestType::predicts_before_forces) m.advance_substeps(stage, dt, Vec3::Zero());
    }
  }
  const double t = m.time();
  CHECK(t == Approx(0.32));
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * (t - dt / 8))).epsilon(1e-3));
}

TEST_CASE("any freedom of a joint may be prescribed, each by its own motion") {
  Machine<VelocityVerlet> m;
  const BodyId rod = m.add_body(ball("rod"));
  const JointId guide = m.add_joint(cylindrical("guide", m.ground(), rod, {0, 0, 0}, Z));
  m.add_motion(prescribed_joint("out", guide, Signal::sine(0.02, 1.0)).along(Freedom::slide));
  m.add_motion(prescribed_joint("round", guide, Signal::ramp(0.0, 3.0)).along(Freedom::turn));
  const BodyId cross = m.add_body(ball("cross").at({1, 0, 0}));
  const JointId bent = m.add_joint(universal("bent", m.ground(), cross, {1, 0, 0}, Z, Z));
  m.add_motion(prescribed_joint("bend", bent, Signal::sine(0.3, 0.5)).along(Freedom::bend_x));
  REQUIRE(m.run(0.6, 1e-4));
  const double t = m.time();
  CHECK(m.coordinate(guide, Freedom::slide) == Approx(0.02 * std::sin(2 * pi * t)).epsilon(1e-12));
  CHECK(m.coordinate(guide, Freedom::turn) == Approx(3.0 * t).epsilon(1e-12));
  CHECK(m.speed(guide, Freedom::turn) == Approx(3.0).epsilon(1e-9));
  CHECK(m.coordinate(bent, Freedom::bend_x) == Approx(0.3 * std::sin(pi * t)).epsilon(1e-9));
  check_refused([&] { m.add_motion(prescribed_joint("no", guide, 0.0).along(Freedom::bend)); }, "'no'", "bend",
                "which has only");
  const MotionSpec plain = prescribed_joint("no", bent, 0.0);  // refined without being spent, as other specs are
  check_refused([&] { m.add_motion(plain.along(Freedom::bend)); }, "'no' drives the bend of a universal joint",
                "bend_x and bend_y");
  const MotionId pose =
      m.add_motion(prescribed_pose("still", m.add_fixed_body("flyer"), [](double) { return Pose{}; }));
  check_refused([&] { m.add_sensor(drive_sensor("cell", pose, 0.1)); }, "sensor 'cell'", "'still'", "no single force");
}

TEMPLATE_TEST_CASE("a joint's drive moves its body a where b is fixed", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  // The coordinate is that of the ground seen from the box, so the box goes the other way, and a force that makes the
  // coordinate grow pushes the box back.
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0)), crank = m.add_body(ball("crank", 2.0, 0.3).at({0.5, 3, 0}));
  const JointId guide = m.add_joint(prismatic("guide", box, m.ground(), {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const JointId hinge = m.add_joint(revolute("hinge", crank, m.ground(), {0, 3, 0}, Y));
  const MotionId turn = m.add_motion(prescribed_joint("turn", hinge, Signal::smooth_step(0.0, 1.0, 0.0, 0.5)));
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  for (int k = 0; k < 3000; ++k) REQUIRE(m.step(dt));
  const double t = m.time(), middle = t - dt / 2;
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  // The axis is the box's, which tilts and sags in its guide by 1e-6: of second order.
  CHECK(m.body(box).position().x() == Approx(-0.01 * std::sin(w * t)).epsilon(1e-9));
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * middle)).epsilon(1e-3));
  CHECK((m.body(m.ground()).position()).norm() == 0.0);
  // The crank, I = 0.3 + 2 0.5^2 about the hinge, turns by -angle about Y; its weight m g r cos(angle) pulls it towards
  // +Y, that is against the coordinate.
  const double s = middle / 0.5, angle = s * s * s * (10 - s * (15 - 6 * s));
  const double acceleration = 60.0 * s * (1 - s) * (1 - 2 * s) / 0.25;
  const double inertial = (0.3 + 2.0 * 0.25) * acceleration, weight = 2.0 * 9.81 * 0.5 * std::cos(angle);
  // The hinge pulls the centre of mass along less than a step late, and the torque changes by 550 N m/s.
  CHECK(m.motion(turn).drive.force == Approx(inertial + weight).margin(550.0 * dt));
}

TEMPLATE_TEST_CASE("a drive between two free bodies pushes both, and keeps momentum", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  // 3 kg and 1 kg on a slide: the coordinate is shared as 1 : 3. The drive carries the reduced mass of 3/4 kg.
  const BodyId a = m.add_body(ball("a", 3.0)), b = m.add_body(ball("b", 1.0).at({0.2, 0, 0}));
  const JointId slide = m.add_joint(prismatic("slide", a, b, {0.1, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", slide, Signal::sine(0.01, 2.0)));
  // 0.3 and 0.1 kg m^2 on a hinge.
  const BodyId c = m.add_body(ball("c", 1.0, 0.3).at({0, 3, 0})), d = m.add_body(ball("d", 1.0, 0.1).at({0, 3, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", c, d, {0, 3, 0}, Z));
  m.add_motion(prescribed_joint("turn", hinge, Signal::ramp(0.0, 2.0)));
  // An arm swung about a hinge that is off both centres of mass, which wobbles about all axes.
  const BodyId e = m.add_body(brick("e", {0, 6, 0}, 2.0)), f = m.add_body(brick("f", {0.3, 6.1, 0.2}, 1.0));
  const JointId wrist = m.add_joint(revolute("wrist", e, f, {0.1, 6, 0.05}, Vec3(1, 2, 3)));
  m.add_motion(prescribed_joint("swing", wrist, Signal::smooth_step(0.0, 1.0, 0.0, 0.3)));
  REQUIRE(m.run(0.3, dt));
  const double t = m.time(), q = 0.01 * std::sin(w * t);
  CHECK(m.coordinate(slide) == Approx(q).epsilon(1e-12));
  CHECK(m.body(a).position().x() == Approx(-q / 4).epsilon(1e-9));
  CHECK(m.body(b).position().x() == Approx(0.2 + 0.75 * q).epsilon(1e-9));
  CHECK(m.motion(drive).drive.force == Approx(-0.75 * 0.01 * w * w * std::sin(w * (t - dt / 2))).epsilon(1e-3));
  CHECK(m.coordinate(hinge) == Approx(2.0 * t).epsilon(1e-12));
  CHECK(m.body(c).angular_velocity().z() == Approx(-0.5).epsilon(1e-9));
  CHECK(m.body(d).angular_velocity().z() == Approx(1.5).epsilon(1e-9));
  CHECK(m.coordinate(wrist) == Approx(1.0).epsilon(1e-9));
  const Body &body_e = m.body(e), &body_f = m.body(f);
  CHECK((body_e.mass * body_e.velocity() + body_f.mass * body_f.velocity()).norm() < 1e-12);
  // Angular momentum to first order in dt, of terms of order 0.04 kg m^2 5 rad/s: they pass through it and come to
  // rest.
  CHECK((angular_momentum(body_e) + angular_momentum(body_f)).norm() < 1e-4);
  CHECK(m.violation(wrist).displacement < 1e-4);
}

TEST_CASE("a drive on a driven carrier counts the carrier's acceleration") {
  // The carrier of a lift falls with 3 m/s^2 while the cage is held still in it: the drive feels m (g - 3).
  Machine<PredictorCorrector> m;
  const BodyId carrier = m.add_body(ball("carrier", 5.0)), cage = m.add_body(ball("cage", 2.0));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), carrier, {0, 0, 0}, Z));
  const JointId guide = m.add_joint(prismatic("guide", carrier, cage, {0, 0, 0}, Z));
  const auto fall = [](double t) { return -1.5 * t * t; };
  const MotionId falls =
      m.add_motion(prescribed_joint("fall", rail, Signal::function(fall, [](double t) { return -3.0 * t; })));
  const MotionId hold = m.add_motion(prescribed_joint("hold", guide, 0.0));
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.body(cage).position().z() == Approx(-1.5 * 0.25));
  CHECK(m.motion(hold).drive.force == Approx(2.0 * (9.81 - 3.0)).epsilon(1e-9));
  CHECK(m.motion(falls).drive.force == Approx(7.0 * (9.81 - 3.0)).epsilon(1e-9));  // it carries both
}

TEMPLATE_TEST_CASE("drives of an arm carry what hangs on them, in whatever order they are added", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // Two links of 1 m, held still at 30 and 75 degrees above the horizontal. Statics: the elbow carries the forearm's
  // weight at half its length, the shoulder both weights. The joints sag by m g / k, some 1e-6 m.
  const bool shoulder_first = GENERATE(true, false);
  const double q1 = pi / 6, q2 = 5 * pi / 12;
  const Vec3 elbow_at(std::cos(q1), 0, std::sin(q1)), hand = elbow_at + Vec3(std::cos(q2), 0, std::sin(q2));
  Machine<TestType> m;
  const BodyId upper = m.add_body(ball("upper", 4.0).at(0.5 * elbow_at));
  const BodyId fore = m.add_body(ball("fore", 3.0).at(0.5 * (elbow_at + hand)));
  const JointId shoulder = m.add_joint(revolute("shoulder", m.ground(), upper, {0, 0, 0}, -Y));
  const JointId elbow = m.add_joint(revolute("elbow", upper, fore, elbow_at, -Y));
  MotionId up, bend;
  if (shoulder_first) up = m.add_motion(prescribed_joint("up", shoulder, 0.0));
  bend = m.add_motion(prescribed_joint("bend", elbow, 0.0));
  if (!shoulder_first) up = m.add_motion(prescribed_joint("up", shoulder, 0.0));
  REQUIRE(m.run(0.5, 1e-4));
  const double g = 9.81, at_elbow = 3.0 * g * 0.5 * std::cos(q2);
  CHECK(m.motion(bend).drive.force == Approx(at_elbow).epsilon(1e-4));
  CHECK(m.motion(up).drive.force == Approx(at_elbow + (4.0 * 0.5 + 3.0) * g * std::cos(q1)).epsilon(1e-4));
  CHECK(std::abs(m.coordinate(shoulder)) < 1e-14);
  CHECK(std::abs(m.coordinate(elbow)) < 1e-14);
  CHECK(m.reaction(shoulder).force.z == Approx(7.0 * g).epsilon(1e-4));
  // A drive that is switched off carries nothing: the arm falls, and only the elbow is still held.
  m.switch_on(up, false);
  REQUIRE(m.run(0.05, 1e-4));
  CHECK(m.motion(up).drive.force == 0.0);
  CHECK(m.coordinate(shoulder) < -1e-3);
  CHECK(std::abs(m.coordinate(elbow)) < 1e-14);
}

TEMPLATE_TEST_CASE("a drive pulls where the joint is, and leaves the body free to turn", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  const double g = 9.81, a = 4.0;
  const auto speeding_up = Signal::function([=](double t) { return 0.5 * a * t * t; }, [=](double t) { return a * t; });
  SECTION("a pendulum on a rail hangs at atan(a / g) while the rail drives it with a constant acceleration") {
    const double tilt = std::atan2(a, g), length = 0.4;
    Machine<TestType> m;
    const BodyId bob = m.add_body(ball("bob", 2.0, 0.01).at(length * Vec3(-std::sin(tilt), 0, -std::cos(tilt))));
    const JointId rail = m.add_joint(joint(JointKind::point_on_line, "rail", m.ground(), bob, {0, 0, 0}, X));
    const MotionId drive = m.add_motion(prescribed_joint("drive", rail, speeding_up));
    REQUIRE(m.run(1.0, 1e-4));
    CHECK(m.coordinate(rail) == Approx(0.5 * a).epsilon(1e-12));
    // It starts with the rail unloaded: the sag, m g / k = 1e-5 m, makes it swing by sqrt(2 g sag) / l / 5 rad/s.
    CHECK((m.body(bob).rotation() - Mat3::Identity()).norm() < 5e-3);
    CHECK(m.motion(drive).drive.force == Approx(2.0 * a).epsilon(2e-2));
  }
  SECTION("a plate in a plane, pulled beside its centre of mass") {
    // F (1/m + r^2/I) = a at the start; the plate turns by 1e-3 rad in 0.01 s.
    const double r = 0.3, inertia = 0.1;
    Machine<TestType> m;
    m.gravity.setZero();
    const BodyId plate = m.add_body(ball("plate", 2.0, inertia));
    JointSpec in_plane = joint(JointKind::planar, "floor", m.ground(), plate, {0, r, 0}, Z);
    const JointId floor = m.add_joint(in_plane.with_x(X));
    const MotionId pull = m.add_motion(prescribed_joint("pull", floor, speeding_up).along(Freedom::slide_x));
    REQUIRE(m.run(0.01, 1e-5));
    const double force = a / (1.0 / 2.0 + r * r / inertia);
    CHECK(m.motion(pull).drive.force == Approx(force).epsilon(1e-3));
    CHECK(m.body(plate).velocity().x() == Approx(force / 2.0 * 0.01).epsilon(1e-3));
    CHECK(m.body(plate).angular_velocity().z() == Approx(-force * r / inertia * 0.01).epsilon(1e-3));
    CHECK(m.coordinate(floor, Freedom::slide_x) == Approx(0.5 * a * 1e-4).epsilon(1e-12));
  }
}

TEST_CASE("a carriage that is driven in one direction feels the drives of what it carries") {
  // The carriage goes up with 2 m/s^2 and hangs on a spring beside; its arm is swung about the upright axis, and the
  // carriage, free to turn, turns back.
  Machine<VelocityVerlet> m;
  const BodyId carriage = m.add_body(ball("carriage", 5.0, 0.3)), arm = m.add_body(ball("arm", 1.0, 0.1));
  const JointId axle = m.add_joint(revolute("axle", carriage, arm, {0, 0, 0}, Z));
  const MotionId lift =
      m.add_motion(prescribed_position("lift", carriage, Z, Signal::function([](double t) { return t * t; })));
  m.add_motion(prescribed_joint("swing", axle, Signal::smooth_step(0.0, 1.0, 0.0, 0.3)));
  REQUIRE(m.run(0.2, 1e-4));
  const double turned = -0.25 * m.coordinate(axle);  // 0.3 and 0.1 kg m^2 share the swing
  CHECK(m.body(carriage).rotation()(1, 0) == Approx(std::sin(turned)).epsilon(1e-6));
  CHECK(m.body(carriage).position().z() == Approx(0.04).epsilon(1e-12));
  CHECK(m.motion(lift).drive.force == Approx(6.0 * (9.81 + 2.0)).epsilon(1e-3));
}

TEMPLATE_TEST_CASE("a wheel driven by its speed takes hold at any angle, and a switched-off wall stands still", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId wheel = m.add_body(ball("wheel", 2.0, 0.2).moving(Vec3::Zero(), {0, 0, 30.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  REQUIRE(m.run(1.0, 1e-3));
  REQUIRE(m.coordinate(axle) == Approx(30.0));
  const MotionId drive = m.add_motion(prescribed_speed("drive", axle, Signal::ramp(30.0, 5.0, 1.0)));
  const BodyId wall = m.add_fixed_body("wall");
  const MotionId push = m.add_motion(prescribed_position("push", wall, X, Signal::ramp(0.0, 0.5, 1.0)));
  REQUIRE(m.run(1.0, 1e-3));
  CHECK(m.speed(axle) == Approx(35.0).epsilon(1e-12));
  CHECK(m.coordinate(axle) == Approx(30.0 + 32.5).epsilon(1e-3));  // first order in the integrators' own way
  CHECK(m.motion(drive).drive.force == Approx(0.2 * 5.0).epsilon(1e-9));
  CHECK(m.body(wall).velocity().x() == 0.5);
  m.switch_on(push, false);
  CHECK(m.body(wall).velocity().norm() == 0.0);
  m.set_motion(drive, 10.0);
  REQUIRE(m.step(1e-3));
  CHECK(m.speed(axle) == Approx(10.0).epsilon(1e-12));
}

TEMPLATE_TEST_CASE("a drive takes hold of a hinge beside the centre of mass without pulling it apart", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // 0.9 mrad off with an arm of 0.3 m: turned about its centre of mass the hinge would part by 0.27 mm.
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId arm = m.add_body(ball("arm", 1.0, 0.01).at({0.3, 0, 0}));
  const BodyId base = m.add_body(ball("base", 3.0, 0.1));
  const JointId hinge = m.add_joint(revolute("hinge", base, arm, {0, 0, 0}, Z));
  m.add_motion(prescribed_joint("steer", hinge, 9e-4));
  REQUIRE(m.step(1e-3));
  CHECK(m.coordinate(hinge) == Approx(9e-4).epsilon(1e-12));
  CHECK(m.violation(hinge).displacement < 1e-12);
  CHECK(m.body(arm).velocity().norm() < 1e-9);
}

TEST_CASE("a motion takes values from outside every step, however fast they go") {
  // 50 rad/s in steps of 1e-3 s: 0.05 rad each, far more than a motion may be off when it takes hold.
  Machine<VelocityVerlet> m;
  const BodyId wheel = m.add_body(ball("wheel", 1.0, 0.1).moving(Vec3::Zero(), {0, 0, 50.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const MotionId drive = m.add_motion(prescribed_joint("drive", axle, Signal::held(0.0, 50.0)));
  m.design_for(1e-3);
  m.initialise(0.0, Vec3::Zero());
  for (int k = 1; k <= 300; ++k) {
    m.set_motion(drive, 0.05 * k, 50.0);
    REQUIRE(m.step(1e-3));
    CHECK(m.coordinate(axle) == Approx(0.05 * k).epsilon(1e-12));
  }
  CHECK(std::abs(m.motion(drive).drive.force) < 1e-6);  // it keeps its speed
}

TEST_CASE("drives that repeat or contradict each other, and those that start off the mark") {
  Machine<VelocityVerlet> m;
  m.gravity = {0, 0, -10.0};
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, Z));
  const MotionId one = m.add_motion(prescribed_joint("one", guide, 0.0));
  const MotionId two = m.add_motion(prescribed_position("two", box, Z, 0.0));
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.motion(one).drive.force == Approx(30.0));  // the earlier one carries the weight
  CHECK(m.motion(two).drive.force == 0.0);
  m.set_motion(two, 2e-4, 0.0);
  REQUIRE(m.run(0.01, 1e-3));
  CHECK(std::abs(m.coordinate(guide)) < 1e-15);
  Machine<VelocityVerlet> off;
  const BodyId door = off.add_body(ball("door"));
  const JointId hinge = off.add_joint(revolute("hinge", off.ground(), door, {0, 0, 0}, Z));
  off.add_motion(prescribed_joint("opener", hinge, Signal::ramp(0.3, 1.0)));
  check_refused([&] { (void)off.step(1e-3); }, "motion 'opener' is 0.3", "starting_at");
  Machine<VelocityVerlet> still;
  const BodyId wall = still.add_fixed_body("wall");
  const JointId gap = still.add_joint(free_joint("gap", still.ground(), wall, {0, 0, 0}, Z));
  check_refused([&] { still.add_motion(prescribed_joint("push", gap, 0.0)); }, "'ground' and 'wall'", "both fixed");
}

TEST_CASE("prescribed positions, turns and poses") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(ball("a").at({1, 2, 3}));
  const BodyId wheel = m.add_body(ball("wheel").at({5, 0, 0}));
  const BodyId wall = m.add_fixed_body("wall");
  const BodyId flyer = m.add_fixed_body("flyer");
  const MotionId lift = m.add_motion(prescribed_position("lift", a, Z, 0.0));
  m.add_motion(prescribed_position("push", wall, X, Signal::ramp(0.0, 0.5)));
  m.add_motion(prescribed_rotation("spin", wheel, Y, Signal::ramp(0.0, 3.0)));
  m.add_motion(prescribed_pose(
      "fly", flyer, [](double t) { return Pose{.position = Vec3(t, t * t, 0), .velocity = Vec3(1, 2 * t, 0)}; }));
  REQUIRE(m.run(1.0, 1e-3));
  CHECK(m.body(a).position().z() == 3.0);
  CHECK(m.body(a).velocity().z() == 0.0);
  CHECK(m.motion(lift).drive.force == Approx(9.81).epsilon(1e-9));  // it holds the weight
  CHECK(m.body(wall).position().x() == Approx(0.5));
  CHECK(m.body(wall).velocity().x() == Approx(0.5));
  CHECK((m.body(wheel).rotation() - Eigen::AngleAxisd(3.0, Y).toRotationMatrix()).norm() < 1e-9);
  CHECK((m.body(wheel).angular_velocity() - 3.0 * Y).norm() < 1e-12);
  CHECK((m.body(flyer).position() - Vec3(1, 1, 0)).norm() < 1e-9);
  m.switch_on(lift, false);
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.body(a).velocity().z() == Approx(-0.981).epsilon(1e-2));
  CHECK(m.motion(lift).drive.force == 0.0);
  check_refused(
      [&] {
        m.switch_on(lift);
        (void)m.step(1e-3);
      },
      "motion 'lift' is 0.0", "let its signal start there");
  // Switched on where it is, it takes the fall out of the body within one step.
  const double speed = m.body(a).velocity().z();
  m.set_motion(lift, m.body(a).position().z() - 3.0);
  REQUIRE(m.step(1e-3));
  CHECK(m.motion(lift).drive.force == Approx(-speed / 1e-3 + 9.81).epsilon(1e-9));
}

TEST_CASE("a prescribed pose that gives no velocities has those of its motion") {
  // On a circle of 0.5 m with 2 rad/s, turning with it about an axis that leans.
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  const auto pose = [&](double t) {
    return Pose{.position = 0.5 * Vec3(std::cos(2 * t), std::sin(2 * t), 0),
                .rotation = Eigen::AngleAxisd(2 * t, axis).toRotationMatrix()};
  };
  Machine<PredictorCorrector> m;
  const BodyId arm = m.add_body(ball("arm").at({0.5, 0, 0}));
  const MotionId drive = m.add_motion(prescribed_pose("fly", arm, pose));
  REQUIRE(m.run(0.3, 1e-3));
  const double t = m.time();
  // Central differences of 1e-16 m over 2e-6 s: rounding of 1e-10 m/s.
  CHECK((m.body(arm).velocity() - Vec3(-std::sin(2 * t), std::cos(2 * t), 0)).norm() < 1e-9);
  CHECK((m.body(arm).angular_velocity() - 2 * axis).norm() < 1e-9);
  // What is given counts, and no signal takes a pose's place.
  check_refused([&] { m.set_motion(drive, 0.0); }, "'fly' is a whole pose", "set_pose");
  check_refused([&] { m.set_motion(drive, 0.0, 0.0); }, "'fly' is a whole pose");
  const Vec3 here = m.body(arm).position();
  const Mat3 turned = m.body(arm).rotation();
  m.set_pose(drive, [=](double) { return Pose{.position = here, .rotation = turned, .velocity = Vec3(7, 0, 0)}; });
  REQUIRE(m.step(1e-3));
  CHECK(m.body(arm).velocity().x() == 7.0);
  CHECK(m.body(arm).angular_velocity().norm() < 1e-9);
  m.set_pose(drive, [=](double) { return Pose{.position = here + X, .rotation = turned}; });
  check_refused([&] { (void)m.step(1e-3); }, "'fly' is 1 m or rad off");
  CHECK((m.body(arm).position() - here).norm() == 0.0);
}

TEMPLATE_TEST_CASE("a refused motion leaves a machine as it was", "", PredictorCorrector, VelocityVerlet) {
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, Z));
  REQUIRE(m.run(0.1, 1e-3));
  const double fallen = m.coordinate(guide), speed = m.speed(guide);
  const MotionId lift = m.add_motion(prescribed_joint("lift", guide, 0.0));
  for (int again = 0; again < 2; ++again) {
    check_refused([&] { (void)m.step(1e-3); }, "motion 'lift' is 0.0");
    CHECK(m.coordinate(guide) == fallen);
    CHECK(m.speed(guide) == speed);
    CHECK(m.time() == Approx(0.1));
  }
  // Also one that is added between two steps of a run.
  m.switch_on(lift, false);
  check_refused(
      [&] {
        (void)m.run(0.1, 1e-3, [&] {
          if (m.time() > 0.15) m.switch_on(lift);
        });
      },
      "motion 'lift' is 0.1");
  m.set_motion(lift, m.coordinate(guide));
  REQUIRE(m.run(0.05, 1e-3));
  CHECK(std::abs(m.speed(guide)) < 1e-15);  // set exactly, to rounding
}

TEST_CASE("a slider-crank follows its kinematics") {
  const double r = 0.1, l = 0.3, w = 10.0;
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId crank = m.add_body(ball("crank", 0.5, 0.001).at({r / 2, 0, 0}));
  const BodyId rod = m.add_body(ball("rod", 0.3, 0.002).at({r + l / 2, 0, 0}));
  const BodyId piston = m.add_body(ball("piston", 0.2, 0.001).at({r + l, 0, 0}));
  const JointId main = m.add_joint(revolute("main", m.ground(), crank, {0, 0, 0}, Z));
  m.add_joint(revolute("big end", crank, rod, {r, 0, 0}, Z));
  m.add_joint(revolute("small end", rod, piston, {r + l, 0, 0}, Z));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), piston, {r + l, 0, 0}, X).starting_at(r + l));
  m.add_motion(prescribed_joint("drive", main, Signal::ramp(0.0, w)));
  // The piston starts at rest and is pulled into motion: compare after the first 0.1 s. With dt = 2e-5 each of four
  // joints gives way by F/k, about 5 N / 1e7 N/m.
  REQUIRE(m.run(0.1, 2e-5));
  double worst = 0.0;
  REQUIRE(m.run(0.7, 2e-5, [&] {
    const double q = w * m.time();
    worst = std::max(
        worst, std::abs(m.coordinate(guide) - (r * std::cos(q) + std::sqrt(l * l - std::pow(r * std::sin(q), 2)))));
  }));
  CHECK(worst < 2e-6);
}
