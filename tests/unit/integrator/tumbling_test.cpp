#include "catch.hpp"
#include "run.hpp"

using Catch::Approx;
using dem::integrator::PredictorCorrector;
using dem::integrator::SymplecticEuler;
using dem::integrator::VelocityVerlet;

// Whole worlds, and the other schemes, are in tests/unit/world/tumbling_test.cpp.

TEST_CASE("the predictor-corrector keeps energy and angular momentum of a tumbling body") {
  const Tumbling body = {{1.0, 2.0, 2.5}};
  Motion m = at_rest();
  m.angular_velocity = {1.0, 0.8, -0.6};
  // 100 rad in all. A step errs by (omega dt)^3, over 1/(omega dt) steps per rad: (1.4e-3)^2 * 100 = 2e-4 at the very
  // most.
  const Motion end = run<PredictorCorrector>(m, 1e-3, 100000, body);
  CHECK(body.energy(end) == Approx(body.energy(m)).epsilon(1e-6));
  CHECK((body.momentum(end) - body.momentum(m)).norm() < 1e-5 * body.momentum(m).norm());
  CHECK((to_eigen(end.angular_velocity) - to_eigen(m.angular_velocity)).norm() > 0.1);  // it does tumble
}

TEMPLATE_TEST_CASE("an orientation stays a rotation to rounding over a million steps", "", PredictorCorrector,
                   VelocityVerlet, SymplecticEuler) {
  const Tumbling body = {{1.0, 2.0, 2.5}};
  Motion m = at_rest();
  m.angular_velocity = {1.0, 0.8, -0.6};
  double worst = 0.0;
  for (int thousand = 0; thousand < 1000; ++thousand) {
    m = run<TestType>(m, 1e-3, 1000, body);
    const dem::Mat3 r = to_eigen(m.rotation);
    worst = std::max({worst, (r.transpose() * r - dem::Mat3::Identity()).norm(), std::abs(r.determinant() - 1.0)});
  }
  // The last 40 steps since rotations were tidied round by some 1e-16 each.
  CHECK(worst < 1e-14);
}
