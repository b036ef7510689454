#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

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

TEST_CASE("an actuator that is given no set point holds what is at assembly") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(ball("cart").at({0.7, 0, 0})), disc = m.add_body(ball("disc").at({0, 3, 0}));
  m.add_joint(prismatic("rail", m.ground(), cart, {0.7, 0, 0}, X));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), disc, {0, 3, 0}, Z).starting_at(0.7));
  const ActuatorId brake = m.add_actuator(joint_actuator("brake", hinge, 1e3, 20.0));
  const ActuatorId ram = m.add_actuator(linear_actuator("ram", m.ground(), {0, 0, 0}, cart, {0.7, 0, 0}, 1e4, 200.0));
  const ActuatorId servo =
      m.add_actuator(rotational_actuator("servo", m.ground(), {0, 3, 0}, {1, 3, 0}, disc, {0, 4, 0}, 1e3, 20.0));
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.actuator(ram).force == Approx(0.0).margin(1e-9));  // 1e4 N/m times rounding of the length
  CHECK(m.actuator(servo).coordinate == Approx(pi / 2).epsilon(1e-12));
  CHECK(m.coordinate(hinge) == Approx(0.7).epsilon(1e-12));
  CHECK(m.actuator(brake).force == Approx(0.0).margin(1e-9));
  CHECK(m.body(cart).position().x() == Approx(0.7).epsilon(1e-12));
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

TEST_CASE("a speed actuator drives to the speed that it is told, which may change") {
  // I w' = -c (w - w_set): w = w_set (1 - exp(-c t/I)); behind a ramp of rate a it lags by a I/c.
  Machine<PredictorCorrector> m;
  const BodyId rotor = m.add_body(ball("rotor", 1.0, 0.2));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), rotor, {0, 0, 0}, Z));
  const ActuatorId e = m.add_actuator(speed_actuator("motor", axle, 0.5, 3.0));
  REQUIRE(m.run(0.6, 1e-4));
  CHECK(m.speed(axle) == Approx(3.0 * (1.0 - std::exp(-0.6 * 0.5 / 0.2))).epsilon(1e-4));
  REQUIRE(m.run(6.0, 1e-4));
  CHECK(m.speed(axle) == Approx(3.0).epsilon(1e-5));
  CHECK(std::abs(m.actuator(e).force) < 1e-4);
  m.set_target(e, -1.0);
  REQUIRE(m.run(6.0, 1e-4));
  CHECK(m.speed(axle) == Approx(-1.0).epsilon(1e-5));
  m.set_target(e, Signal::smooth_step(-1.0, 2.0, m.time(), m.time() + 0.2));
  REQUIRE(m.run(6.0, 1e-4));
  CHECK(m.speed(axle) == Approx(2.0).epsilon(1e-5));

  const JointId other = m.add_joint(revolute("other", m.ground(), m.add_body(ball("wheel", 1.0, 0.2)), {0, 0, 0}, Z));
  m.add_actuator(speed_actuator("start", other, 0.5, Signal::ramp(0.0, 2.0, m.time())));
  REQUIRE(m.run(4.0, 1e-4));
  CHECK(m.speed(other) == Approx(2.0 * (4.0 - 0.2 / 0.5)).epsilon(1e-3));
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
  const JointId axle = m.add_joint(revolute("axle", m.ground(), m.add_body(ball("wheel")), {0, 0, 0}, Z));
  const ActuatorId engine = m.add_actuator(motor("engine", axle, {{0, 10}, {20, 0}}));
  check_refused([&] { m.add_actuator(joint_actuator("idler", axle, 0.0, 1.0, 4.0)); },
                "actuator 'idler' has no position_gain", "to drive at this speed", "Signal::ramp(0, 4)");
  const ActuatorId idler = m.add_actuator(joint_actuator("idler", axle, 0.0, 1.0));
  check_refused([&] { m.set_target(idler, 4.0); }, "actuator 'idler' has no position_gain", "Signal::ramp(0, 4)");
  m.set_target(idler, 0.0);       // a brake
  m.set_target(idler, 4.0, 0.0);  // a controller whose rate passes through zero
  m.add_actuator(linear_actuator("shock", m.ground(), {-1, 0, 0}, cart, {0, 0, 0}, 0.0, 1.0, 1.0));  // a damper
  check_refused([&] { m.set_throttle(engine, nan); }, "throttle of a motor is nan");
  check_refused([&] { m.set_throttle(ram, 1.0); }, "actuator 'ram' is no motor", "use set_target");
  check_refused([&] { m.set_target(engine, 1.0); }, "actuator 'engine' is a motor", "use set_throttle");
  check_refused([&] { m.set_load(push, nan); }, "is nan, but must be finite");
  check_refused([&] { prescribed_joint("drive", guide, nan); }, "is nan, but must be finite");
  check_refused([&] { m.add_actuator(joint_actuator("lost", JointId(), 1.0, 0.0)); },
                "was given no joint and no bodies");
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

TEST_CASE("the table of a spring goes on outside its range as its curve does") {
  Machine<PredictorCorrector> m;
  const BodyId cart = m.add_body(ball("cart"));
  const Curve buffer = {{0, 0}, {0.020, 1000}};  // N over m of compression, from 0.30 m on
  const SpringSpec on = spring_table("goes on", cart, X, m.ground(), Y, 0.30, buffer);
  const SpringSpec held = spring_table("held", cart, X, m.ground(), Y, 0.30, buffer.held_outside());
  CHECK(on.force_over_length(0.29) == Approx(500.0));
  CHECK(held.force_over_length(0.29) == Approx(500.0));
  CHECK(on.force_over_length(0.35) == Approx(-2500.0));  // it pulls
  CHECK(held.force_over_length(0.35) == 0.0);
  CHECK(on.force_over_length(0.27) == Approx(1500.0));
  CHECK(held.force_over_length(0.27) == Approx(1000.0));
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
