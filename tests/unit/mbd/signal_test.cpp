#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("a jump of a set point gives a damper's whole impulse, whatever the time step is", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // A speed controller on 2 kg, m x'' = -c (x' - set'): over all time the impulses sum up to c (jump - way) = 0, so the
  // cart comes to rest after exactly the jump. The jump falls on a step, beside one and between two.
  for (const double dt : {1e-3, 1e-4}) {
    for (const double at : {0.1, 0.1 + 1e-8, 0.1 + 0.37 * dt}) {
      Machine<TestType> m;
      m.gravity.setZero();
      const BodyId cart = m.add_body(ball("cart", 2.0));
      const JointId rail = m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, X));
      const auto jump = Signal::function([=](double t) { return t < at ? 0.0 : 0.05; });
      m.add_actuator(joint_actuator("drive", rail, 0.0, 40.0, jump));
      REQUIRE(m.run(0.1 - 2.0 * dt, dt));
      CHECK(m.coordinate(rail) == 0.0);
      // The impulse is there after two steps: 40 N s/m 0.05 m = 2 N s on 2 kg, less what c dt/m brakes meanwhile.
      REQUIRE(m.run(4.0 * dt, dt));
      CHECK(m.speed(rail) == Approx(1.0).epsilon(3.0 * 20.0 * dt));
      REQUIRE(m.run(1.9, dt));
      // exp(-38) of the speed is left; the integrators weigh the speeds of a step alike to order (c dt/m)^2.
      CHECK(m.coordinate(rail) == Approx(0.05).epsilon(std::pow(20.0 * dt, 2) + 1e-9));
    }
  }
}

TEST_CASE("a function without a rate has that of its means over the time step") {
  const auto wave = Signal::function([](double t) { return std::sin(3.0 * t); });
  // sin(3 dt/2) / (3 dt/2) of the exact rate.
  for (const double dt : {0.1, 0.01, 1e-3}) {
    CHECK(wave(0.4, dt).rate == Approx(3.0 * std::cos(1.2) * std::sin(1.5 * dt) / (1.5 * dt)).epsilon(1e-12));
  }
  // Without a step 2e-6 s: exact but for the rounding of 1e-16 over it.
  CHECK(wave(0.4).rate == Approx(3.0 * std::cos(1.2)).epsilon(1e-9));
  CHECK(wave(0.4, 0.1).value == std::sin(3.0 * 0.4));
  CHECK(Signal::function([](double t) { return t * t; }).as_rate()(2.0, 0.1).rate == 4.0);
}

TEST_CASE("a prescribed value that jumps takes one step to do so") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(ball("cart", 2.0));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, X));
  m.add_motion(prescribed_joint("hop", rail, Signal::function([](double t) { return t < 0.1 ? 0.0 : 5e-4; })));
  double fastest = 0.0;
  REQUIRE(m.run(0.2, 1e-3, [&] { fastest = std::max(fastest, m.speed(rail)); }));
  CHECK(m.coordinate(rail) == Approx(5e-4).epsilon(1e-12));
  CHECK(fastest == Approx(5e-4 / 1e-3).epsilon(1e-9));
  CHECK(std::abs(m.speed(rail)) < 1e-12);
}
