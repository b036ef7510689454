#include "catch.hpp"
#include "run.hpp"

using Catch::Approx;
using dem::integrator::PredictorCorrector;
using dem::integrator::SymplecticEuler;
using dem::integrator::VelocityVerlet;

namespace {

/// Amplitude of x'' = -x - 2 zeta x' after n steps of omega dt = q, from x = 1, v = 0.
template <class Integrator>
double amplitude(double q, double zeta, long n) {
  Motion m = at_rest();
  m.position.x = 1.0;
  m = run<Integrator>(m, q, n, [&](const Motion& s) {
    return Acceleration{{-s.position.x - 2.0 * zeta * s.velocity.x, 0, 0}, {0, 0, 0}};
  });
  const double size = std::hypot(m.position.x, m.velocity.x);
  return std::isfinite(size) ? size : 1e300;
}

/// The largest omega dt below which every step size is stable, by bisection.
template <class Integrator>
double limit(double zeta) {
  double low = 0.1, high = 3.0;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    (amplitude<Integrator>(middle, zeta, 20000) < 1e4 ? low : high) = middle;
  }
  return low;
}

}  // namespace

TEMPLATE_TEST_CASE("stable just below the stated limit, unstable just above", "", PredictorCorrector, VelocityVerlet,
                   SymplecticEuler) {
  const double stated = TestType::stability_limit;
  // Near the limit the amplitude of a leapfrog grows like 1/sqrt(2 - q) before it stays bounded: 100 is ample at 1 %.
  CHECK(amplitude<TestType>(0.99 * stated, 0.0, 100000) < 100.0);
  CHECK(amplitude<TestType>(0.5 * stated, 0.0, 100000) < 2.0);
  CHECK(amplitude<TestType>(1.01 * stated, 0.0, 2000) > 1e6);
}

TEST_CASE("damping lowers the stability limit of symplectic Euler and velocity Verlet") {
  // Characteristic polynomial z^2 - (2 - q^2 - 2 zeta q) z + 1 - 2 zeta q: stable while q < 2 (sqrt(1 + zeta^2) -
  // zeta).
  for (const double zeta : {0.0, 0.05, 0.2, 1.0}) {
    const double closed = 2.0 * (std::sqrt(1.0 + zeta * zeta) - zeta);
    // 20,000 steps grow by 1e4 when a step grows by 5e-4.
    CHECK(limit<SymplecticEuler>(zeta) == Approx(closed).epsilon(2e-3));
    CHECK(limit<VelocityVerlet>(zeta) == Approx(closed).epsilon(2e-3));
  }
}

TEST_CASE("the predictor-corrector stays stable when damped") {
  for (const double zeta : {0.05, 0.2}) {
    CHECK(amplitude<PredictorCorrector>(0.5 * PredictorCorrector::stability_limit, zeta, 100000) < 1.0);
  }
}

TEST_CASE("symplectic Euler and velocity Verlet keep the energy of an oscillator") {
  // Their energy swings by omega dt / 2 and (omega dt)^2 / 4, and does not drift over 16,000 periods.
  CHECK(amplitude<SymplecticEuler>(0.1, 0.0, 1000000) == Approx(1.0).margin(0.06));
  CHECK(amplitude<VelocityVerlet>(0.1, 0.0, 1000000) == Approx(1.0).margin(0.003));
}

TEST_CASE("the predictor-corrector quiets an undamped oscillator by the fourth power of the step") {
  for (const double q : {0.2, 0.1}) {
    const long n = std::lround(1.0 / std::pow(q, 4));
    const double loss = -std::log(amplitude<PredictorCorrector>(q, 0.0, n)) / static_cast<double>(n);
    CHECK(loss / std::pow(q, 4) == Approx(1.0 / 8.0).epsilon(0.1));
  }
}
