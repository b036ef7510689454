#include "catch.hpp"

#include <dem/terramechanics/mohr_coulomb.hpp>

#include <numbers>
#include <vector>

namespace mohr_coulomb_test {

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::terramechanics::fit_mohr_coulomb;
using dem::terramechanics::Intercept;

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

}  // namespace

TEST_CASE("points on a line give back its angle and cohesion, without error") {
  const std::vector<double> sigma = {10e3, 40e3, 70e3, 90e3};
  std::vector<double> tau;
  for (const double s : sigma) tau.push_back(1500.0 + s * std::tan(35.0 / degrees));
  const auto m = fit_mohr_coulomb(sigma, tau);
  CHECK(m.points == 4);
  CHECK(degrees * m.friction_angle == Approx(35.0).epsilon(1e-12));
  CHECK(m.cohesion == Approx(1500.0).epsilon(1e-9));
  CHECK(m.friction_angle_error == Approx(0.0).margin(1e-12));
  CHECK(m.cohesion_error == Approx(0.0).margin(1e-6));
  CHECK(m.r_squared == Approx(1.0).epsilon(1e-12));
  CHECK(m.strength(20e3) == Approx(1500.0 + 20e3 * std::tan(35.0 / degrees)));
}

TEST_CASE("scatter gives the standard errors of least squares") {
  // x = 1 2 3, y = 1 3 2: slope 1/2, intercept 1, residuals -0.5 1 -0.5, so s^2 = 1.5/1.
  const std::vector<double> sigma = {1.0, 2.0, 3.0}, tau = {1.0, 3.0, 2.0};
  const auto m = fit_mohr_coulomb(sigma, tau);
  CHECK(std::tan(m.friction_angle) == Approx(0.5));
  CHECK(m.cohesion == Approx(1.0));
  CHECK(m.r_squared == Approx(1.0 - 1.5 / 2.0));
  const double slope_error = std::sqrt(1.5 / 2.0);
  CHECK(m.friction_angle_error == Approx(slope_error / (1.0 + 0.25)));  // d(atan b) = db/(1 + b^2)
  CHECK(m.cohesion_error == Approx(std::sqrt(1.5 * (1.0 / 3.0 + 4.0 / 2.0))));
}

TEST_CASE("through the origin") {
  // slope = sum(xy)/sum(xx) = 13/14; residual sum = sum(yy) - 13^2/14 = 14 - 169/14.
  const std::vector<double> sigma = {1.0, 2.0, 3.0}, tau = {1.0, 3.0, 2.0};
  const auto m = fit_mohr_coulomb(sigma, tau, Intercept::zero);
  CHECK(std::tan(m.friction_angle) == Approx(13.0 / 14.0));
  CHECK(m.cohesion == 0.0);
  CHECK(m.cohesion_error == 0.0);
  CHECK(m.r_squared == Approx(169.0 / 196.0));
  const double slope_error = std::sqrt((14.0 - 169.0 / 14.0) / 2.0 / 14.0);
  CHECK(m.friction_angle_error == Approx(slope_error / (1.0 + std::pow(13.0 / 14.0, 2))));
}

TEST_CASE("errors are unknown where there are no points to tell them from") {
  const std::vector<double> one = {2.0}, two = {1.0, 3.0};
  CHECK(std::isnan(fit_mohr_coulomb(one, one, Intercept::zero).friction_angle_error));
  CHECK(std::isnan(fit_mohr_coulomb(two, two).cohesion_error));
  CHECK(std::tan(fit_mohr_coulomb(one, one, Intercept::zero).friction_angle) == Approx(1.0));
}

TEST_CASE("what cannot be fitted is refused") {
  const std::vector<double> one = {1.0}, same = {2.0, 2.0}, two = {1.0, 2.0}, bad = {1.0, std::nan("")};
  CHECK_THROWS_WITH(fit_mohr_coulomb(one, one), ContainsSubstring("1 points, but 2 are needed"));
  CHECK_THROWS_WITH(fit_mohr_coulomb({}, {}, Intercept::zero), ContainsSubstring("0 points"));
  CHECK_THROWS_WITH(fit_mohr_coulomb(same, two), ContainsSubstring("needs different ones"));
  CHECK_THROWS_WITH(fit_mohr_coulomb(two, one), ContainsSubstring("2 normal and 1 shear"));
  CHECK_THROWS_WITH(fit_mohr_coulomb(two, bad), ContainsSubstring("point 1"));
}

}  // namespace mohr_coulomb_test
