#include "catch.hpp"
#include "run.hpp"

using Catch::Approx;
using dem::Vec3;
using dem::integrator::PredictorCorrector;
using dem::integrator::SymplecticEuler;
using dem::integrator::VelocityVerlet;

namespace {

// The measured slope approaches the order as dt does zero; at the steps used here it is within a few per cent.
constexpr double slope_tolerance = 0.1;

/// Error of position and velocity of x'' = -x - 2 zeta x' after t = 3, from x = 1, v = 0.
template <class Integrator>
double oscillator_order(double zeta) {
  std::vector<double> errors;
  for (const long n : {200, 400, 800}) {
    Motion m = at_rest();
    m.position.x = 1.0;
    m = run<Integrator>(m, 3.0 / static_cast<double>(n), n, [&](const Motion& s) {
      return Acceleration{{-s.position.x - 2.0 * zeta * s.velocity.x, 0, 0}, {0, 0, 0}};
    });
    const double w = std::sqrt(1.0 - zeta * zeta), e = std::exp(-zeta * 3.0);
    const double x = e * (std::cos(3 * w) + zeta / w * std::sin(3 * w)), v = -e / w * std::sin(3 * w);
    errors.push_back(std::hypot(m.position.x - x, m.velocity.x - v));
    CHECK(errors.back() < 0.05);
  }
  return order(errors);
}

/// Error of a tumbling body's spin and orientation against a far finer run of the classical Runge-Kutta scheme.
template <class Integrator>
double tumbling_order() {
  const Tumbling body = {{1.0, 2.0, 2.5}};
  Motion start = at_rest();
  start.angular_velocity = {1.0, 0.8, -0.6};

  // y = (w, R by columns): w' = Euler's equations, R' = R [w]x.
  struct Y {
    Vec3 w;
    dem::Mat3 r;
  };
  const auto slope = [&](const Y& y) {
    const Vec3 l = body.moments.cwiseProduct(y.w);
    dem::Mat3 cross;
    cross << 0, -y.w.z(), y.w.y(), y.w.z(), 0, -y.w.x(), -y.w.y(), y.w.x(), 0;
    return Y{Vec3((-y.w.cross(l)).cwiseQuotient(body.moments)), dem::Mat3(y.r * cross)};
  };
  const auto moved = [](const Y& y, double h, const Y& k) { return Y{Vec3(y.w + h * k.w), dem::Mat3(y.r + h * k.r)}; };
  Y exact = {to_eigen(start.angular_velocity), dem::Mat3::Identity()};
  const int steps = 3000;  // error 1e-13
  const double h = 3.0 / steps;
  for (int n = 0; n < steps; ++n) {
    const Y a = slope(exact), b = slope(moved(exact, h / 2, a)), c = slope(moved(exact, h / 2, b)),
            d = slope(moved(exact, h, c));
    exact = moved(moved(moved(moved(exact, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
  }

  std::vector<double> errors;
  for (const long n : {300, 600, 1200}) {
    const Motion m = run<Integrator>(start, 3.0 / static_cast<double>(n), n, body);
    errors.push_back((to_eigen(m.angular_velocity) - exact.w).norm() + (to_eigen(m.rotation) - exact.r).norm());
    CHECK(errors.back() < 0.1);
  }
  return order(errors);
}

}  // namespace

TEST_CASE("order of accuracy of an undamped oscillator") {
  CHECK(oscillator_order<PredictorCorrector>(0.0) == Approx(2.0).margin(slope_tolerance));
  CHECK(oscillator_order<VelocityVerlet>(0.0) == Approx(2.0).margin(slope_tolerance));
  CHECK(oscillator_order<SymplecticEuler>(0.0) == Approx(1.0).margin(slope_tolerance));
}

TEST_CASE("order of accuracy of a damped oscillator") {
  CHECK(oscillator_order<PredictorCorrector>(0.2) == Approx(2.0).margin(slope_tolerance));
  // Forces see the half-step velocity, half a step old: damping is of first order.
  CHECK(oscillator_order<VelocityVerlet>(0.2) == Approx(1.0).margin(slope_tolerance));
  CHECK(oscillator_order<SymplecticEuler>(0.2) == Approx(1.0).margin(slope_tolerance));
}

TEST_CASE("order of accuracy of a tumbling body") {
  CHECK(tumbling_order<PredictorCorrector>() == Approx(2.0).margin(slope_tolerance));
  CHECK(tumbling_order<VelocityVerlet>() >= 1.0 - slope_tolerance);
  CHECK(tumbling_order<SymplecticEuler>() >= 1.0 - slope_tolerance);
}

TEMPLATE_TEST_CASE("free flight and steady spin are exact", "", PredictorCorrector, VelocityVerlet, SymplecticEuler) {
  Motion m = at_rest();
  m.velocity = {1.0, -2.0, 0.5};
  m.angular_velocity = {0.6, 0.0, 0.8};
  m = run<TestType>(m, 0.01, 100, [](const Motion&) { return Acceleration{{0, 0, 0}, {0, 0, 0}}; });
  // 100 steps of one rounding each.
  CHECK((to_eigen(m.position) - Vec3(1.0, -2.0, 0.5)).norm() < 1e-14);
  const dem::Mat3 expected = Eigen::AngleAxisd(1.0, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
  CHECK((to_eigen(m.rotation) - expected).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("a constant force is integrated exactly by the schemes of second order") {
  const auto falling = [](const Motion&) { return Acceleration{{0, 0, -9.81}, {0, 0, 0}}; };
  for (const Motion& m :
       {run<PredictorCorrector>(at_rest(), 0.01, 100, falling), run<VelocityVerlet>(at_rest(), 0.01, 100, falling)}) {
    CHECK(m.position.z == Approx(-0.5 * 9.81).epsilon(1e-13));
    CHECK(m.velocity.z == Approx(-9.81).epsilon(1e-13));
  }
  // Symplectic Euler is ahead by half a step: g t dt / 2.
  const Motion m = run<SymplecticEuler>(at_rest(), 0.01, 100, falling);
  CHECK(m.position.z == Approx(-0.5 * 9.81 * 1.01).epsilon(1e-13));
}
