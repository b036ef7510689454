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
      m.run(0.05, 1e-4);
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
      m.run(0.05, 1e-4);
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
      m.run(0.05, 1e-4);
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
    m.run(0.1, 1e-4);
    m.step(1e-4);
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
  m.run(0.5, 1e-4);
  CHECK(m.speed(guide) == Approx(6.0 / 2.0 * 0.5).epsilon(1e-9));
  CHECK(m.actuator(ram).force == 6.0);
  CHECK(m.actuator(ram).power() == Approx(6.0 * 1.5).epsilon(1e-3));
  m.switch_on(ram, false);
  m.run(0.1, 1e-4);
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
    n.step(1e-4);
  }
  CHECK(n.speed(rail) == Approx(3.0 * (0.5 - 2.0 / 200.0)).epsilon(1e-3));
}

TEST_CASE("a motor follows its torque-speed curve") {
  // T = 10 - 0.5 w on I = 0.2: w = 20 (1 - exp(-2.5 t)).
  Machine<PredictorCorrector> m;
  const BodyId rotor = m.add_body(ball("rotor", 1.0, 0.2));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), rotor, {0, 0, 0}, Z));
  const ActuatorId e = m.add_actuator(motor("motor", axle, {{0, 10}, {20, 0}}));
  m.run(0.6, 1e-4);
  CHECK(m.speed(axle) == Approx(20.0 * (1.0 - std::exp(-1.5))).epsilon(1e-6));
  m.set_throttle(e, 0.0);
  m.step(1e-4);
  CHECK(m.actuator(e).force == 0.0);
  CHECK_THAT(message_of([&] { m.set_throttle(e, 2.0); }), Contains("throttle of a motor is 2"));
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
  m.run(3.0, 1e-4);
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
  m.run(t, 1e-4);
  CHECK(m.body(a).velocity().x() == Approx(4.0 * t * t / 2.0 / 2.0).epsilon(1e-6));
  // Direction (cos 2t, sin 2t), 0.5 m/s^2.
  CHECK(m.body(b).velocity().x() == Approx(0.5 * std::sin(2 * t) / 2).epsilon(1e-6));
  CHECK(m.body(b).velocity().y() == Approx(0.5 * (1 - std::cos(2 * t)) / 2).epsilon(1e-6));
  m.switch_on(id, false);
  const Vec3 v = m.body(b).velocity();
  m.run(0.1, 1e-4);
  CHECK((m.body(b).velocity() - v).norm() < 1e-4);
}

TEMPLATE_TEST_CASE("prescribed motion is met exactly and reports its drive force", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const SensorId cell = m.add_sensor(drive_sensor("cell", drive, 0.0));
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  for (int k = 0; k < 3000; ++k) m.step(dt);
  const double t = m.time();
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  CHECK(m.speed(guide) == Approx(0.01 * w * std::cos(w * t)).epsilon(1e-9));
  // Mass times acceleration, of the middle of the step, and one step late in the sensor.
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * (t - dt / 2))).epsilon(1e-3));
  CHECK(m.sensor(cell).latest().force.x == Approx(m.motion(drive).drive.force).epsilon(5e-3));
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
  m.run(1.0, 1e-3);
  CHECK(m.body(a).position().z() == 3.0);
  CHECK(m.body(a).velocity().z() == 0.0);
  CHECK(m.motion(lift).drive.force == Approx(9.81).epsilon(1e-9));  // it holds the weight
  CHECK(m.body(wall).position().x() == Approx(0.5));
  CHECK(m.body(wall).velocity().x() == Approx(0.5));
  CHECK((m.body(wheel).rotation() - Eigen::AngleAxisd(3.0, Y).toRotationMatrix()).norm() < 1e-9);
  CHECK((m.body(wheel).angular_velocity() - 3.0 * Y).norm() < 1e-12);
  CHECK((m.body(flyer).position() - Vec3(1, 1, 0)).norm() < 1e-9);
  m.switch_on(lift, false);
  m.run(0.1, 1e-3);
  CHECK(m.body(a).velocity().z() == Approx(-0.981).epsilon(1e-2));
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
  m.run(0.1, 2e-5);
  double worst = 0.0;
  m.run(0.7, 2e-5, [&] {
    const double q = w * m.time();
    worst = std::max(
        worst, std::abs(m.coordinate(guide) - (r * std::cos(q) + std::sqrt(l * l - std::pow(r * std::sin(q), 2)))));
  });
  CHECK(worst < 2e-6);
}
