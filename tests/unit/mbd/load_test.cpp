#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

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

TEMPLATE_TEST_CASE("a load follows a law of its user's own", "", PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // 2 kg with 8 N s/m: v = v0 exp(-4 t), turning likewise with 0.4 N m s on 0.1 kg m^2. And a fall in air,
  // m g - b v^2: v = w tanh(g t / w) with the terminal speed w = sqrt(m g / b) = 14 m/s.
  Machine<TestType> m;
  m.gravity = {0, 0, -9.8};
  const Vec3 v0(3, -1, 0), w0(0, 0, 5);
  const BodyId puck = m.add_body(ball("puck", 2.0).moving(v0, w0));
  m.add_joint(planar("ice", m.ground(), puck, {0, 0, 0}, Z));
  const LoadId drag = m.add_load(custom_load("drag", puck, [](double, const Body& b) {
    return Wrench{from_eigen(Vec3(-8.0 * b.velocity())), from_eigen(Vec3(-0.4 * b.angular_velocity()))};
  }));
  const BodyId drop = m.add_body(ball("drop", 2.0).at({0, 5, 0}));
  m.add_load(custom_load("air", drop, [](double, const Body& b) {
    return Wrench{from_eigen(Vec3(-0.1 * b.velocity().norm() * b.velocity())), {}};
  }));
  const BodyId cart = m.add_body(ball("cart", 2.0).at({0, 9, 9}));
  m.add_load(custom_load("push", cart, [](double t, const Body&) { return Wrench{{6.0 * t, 0, 0}, {}}; }));
  const double dt = 1e-4, t = 0.5;
  REQUIRE(m.run(t, dt));
  // First order at worst, as dampers are: 4/s dt = 4e-4 for the decay, less for the fall; the push is half a step late.
  const double order = 4.0 * dt;
  CHECK((m.body(puck).velocity() - std::exp(-4.0 * t) * v0).norm() < order * v0.norm());
  CHECK((m.body(puck).angular_velocity() - std::exp(-4.0 * t) * w0).norm() < order * w0.norm());
  CHECK(m.body(drop).velocity().z() == Approx(-14.0 * std::tanh(9.8 * t / 14.0)).epsilon(order));
  CHECK(m.body(cart).velocity().x() == Approx(1.5 * t * t).epsilon(dt / t + 1e-9));
  CHECK(m.load(drag).wrench.force.x == Approx(-8.0 * m.body(puck).velocity().x()).epsilon(2.0 * order));
  REQUIRE(m.run(8.0, 1e-3));
  CHECK(m.body(drop).velocity().z() == Approx(-14.0).epsilon(1e-4));  // tanh(6)
  m.switch_on(drag, false);
  REQUIRE(m.step(1e-3));
  CHECK(norm(m.load(drag).wrench.force) == 0.0);
}

TEST_CASE("laws of loads are checked, and a NaN of theirs is named") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(ball("a"));
  check_refused([&] { custom_load("drag", a, {}); }, "load 'drag' was given no function");
  const LoadId wind = m.add_load(custom_load("wind", a, [](double t, const Body&) {
    return Wrench{{0, t > 0.05 ? std::sqrt(-t) : 0.0, 0}, {}};
  }));
  check_refused([&] { m.set_load(wind, 1.0); }, "load 'wind' has a law of its own and no size");
  const MachineReport report = m.run(0.1, 1e-3);
  CHECK_FALSE(report);
  CHECK_THAT(report.text, Contains("force or torque of load 'wind' is not a number: check the function"));
}

TEST_CASE("a load acts at a point that is somewhere, and forces put on by hand between steps are lost") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a"));
  check_refused(
      [&] {
        m.add_load(applied_force("push", a, {0, std::nan(""), 0}, X, 1.0));
      },
      "point of load 'push'", "(0, nan, 0)", "must be finite");
  REQUIRE(m.step(1e-3));
  m.body(a).apply({100, 0, 0}, {0, 0, 0});
  REQUIRE(m.step(1e-3));
  CHECK(m.body(a).velocity().norm() == 0.0);
}

TEST_CASE("a force on what is fixed for good is refused, whatever puts it on") {
  Machine<PredictorCorrector> m;
  const BodyId plate = m.add_fixed_body("plate", {0, 0, 1});
  check_refused(
      [&] {
        m.add_load(applied_force("push", plate, {0, 0, 1}, Z, 10.0));
      },
      "load 'push' acts on body 'plate'", "fixed and has no mass", "prismatic");
  check_refused([&] { m.add_load(applied_torque("twist", m.ground(), Z, 10.0)); }, "body 'ground'");
  check_refused(
      [&] {
        m.add_spring(spring("coil", m.ground(), {0, 0, 0}, plate, {0, 0, 1}, 10.0, 1.0));
      },
      "spring 'coil'", "'ground' and body 'plate'");
  check_refused(
      [&] {
        m.add_actuator(linear_actuator("jack", m.ground(), {0, 0, 0}, plate, {0, 0, 1}, 10.0, 1.0));
      },
      "actuator 'jack'");
  // One that has a mass may be set free later.
  BodySpec held = ball("held");
  held.fixed = true;
  CHECK_NOTHROW(m.add_load(applied_force("later", m.add_body(held), {0, 0, 0}, Z, 10.0)));
}

TEMPLATE_TEST_CASE("a mass that is changed between runs counts from the next step on", "", PredictorCorrector,
                   VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a", 1.0));
  m.add_load(applied_force("push", a, {0, 0, 0}, X, 5.0));
  REQUIRE(m.run(1.0, 1e-3));
  CHECK(m.body(a).velocity().x() == Approx(5.0).epsilon(1e-12));
  m.body(a).mass = 2.0;
  REQUIRE(m.run(1.0, 1e-3));
  // The predictor-corrector predicts its first stage by the acceleration of now, so the step of the change has no
  // error.
  CHECK(m.body(a).velocity().x() == Approx(7.5).epsilon(1e-12));
  m.body(a).mass = -2.0;
  check_refused([&] { (void)m.run(1.0, 1e-3); }, "mass of body 'a' is -2 kg");
}
