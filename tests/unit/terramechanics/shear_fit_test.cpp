#include <dem/terramechanics/shear_fit.hpp>
#include <dem/terramechanics/soil.hpp>

#include <cmath>
#include <vector>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

ShearCurve measured(const JanosiHanamoto& law, double sigma, double to, double wave = 0.0) {
  ShearCurve curve{.normal_stress = sigma, .displacement = {}, .stress = {}};
  for (int k = 0; k <= 60; ++k) {
    const double j = to * k / 60;
    curve.displacement.push_back(j);
    curve.stress.push_back(law.stress(sigma, j) + (k % 2 == 0 ? wave : -wave));
  }
  return curve;
}

}  // namespace

TEST_CASE("a curve of Janosi and Hanamoto gives back its K and strength") {
  const JanosiHanamoto law = mojave_martian_simulant.shear;
  for (const double to : {0.3e-3, 2e-3, 6e-3}) {  // from far below the strength to far beyond
    const auto fit = fit_janosi(measured(law, 20e3, to));
    CHECK(fit.displacement == Approx(0.6e-3).epsilon(1e-8));
    CHECK(fit.strength == Approx(law.strength(20e3)).epsilon(1e-8));
    CHECK(fit.displacement_error < 1e-6 * 0.6e-3);
    CHECK(fit.r_squared == Approx(1.0));
    CHECK(fit.points == 61);
  }
}

TEST_CASE("the standard errors of a shear curve are those of its linear model") {
  // Residuals of +-w on a fine curve: s^2 = w^2 N/(N - 2), and the normal matrix of (tau_max, K) is summed here by
  // hand.
  const JanosiHanamoto law = {.cohesion = 0.0, .friction_angle = radians(40.0), .displacement = 1e-3};
  const double w = 20.0, strength = law.strength(30e3);
  const auto fit = fit_janosi(measured(law, 30e3, 8e-3, w));
  double aa = 0.0, ab = 0.0, bb = 0.0;
  for (int k = 0; k <= 60; ++k) {
    const double x = 8.0 * k / 60, a = 1.0 - std::exp(-x), b = -strength * x * std::exp(-x) / 1e-3;
    aa += a * a;
    ab += a * b;
    bb += b * b;
  }
  const double s = w * std::sqrt(61.0 / 59.0), det = aa * bb - ab * ab;
  // The wave shifts the parameters by less than their errors, so the matrix by some parts in a thousand.
  CHECK(fit.strength_error == Approx(s * std::sqrt(bb / det)).epsilon(0.01));
  CHECK(fit.displacement_error == Approx(s * std::sqrt(aa / det)).epsilon(0.01));
  CHECK(std::abs(fit.displacement - 1e-3) < 2.0 * fit.displacement_error);
}

TEST_CASE("shear curves at several loads give the soil's constants") {
  const JanosiHanamoto law = {.cohesion = 600.0, .friction_angle = radians(35.0), .displacement = 0.6e-3};
  std::vector<ShearCurve> curves;
  for (const double sigma : {5e3, 20e3, 60e3}) curves.push_back(measured(law, sigma, 5e-3));
  const auto fit = fit_shear(curves);
  CHECK(fit.law.cohesion == Approx(600.0).epsilon(1e-6));
  CHECK(fit.law.friction_angle == Approx(radians(35.0)).epsilon(1e-8));
  CHECK(fit.law.displacement == Approx(0.6e-3).epsilon(1e-8));
  CHECK(fit.displacement_error < 1e-9);
  CHECK(fit.curves.size() == 3);
  // K of 0.5, 0.6 and 0.7 mm: deviation 0.1 mm, of the mean 0.1/sqrt(3).
  curves.clear();
  for (const double k : {0.5e-3, 0.6e-3, 0.7e-3}) {
    curves.push_back(measured({.cohesion = 0.0, .friction_angle = 0.6, .displacement = k}, 2e7 * k, 5e-3));
  }
  const auto spread = fit_shear(curves, Intercept::zero);
  CHECK(spread.law.displacement == Approx(0.6e-3).epsilon(1e-8));
  CHECK(spread.displacement_error == Approx(0.1e-3 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(spread.law.cohesion == 0.0);
  CHECK(std::isnan(fit_shear(std::vector<ShearCurve>{curves[0]}, Intercept::zero).displacement_error));
}

TEST_CASE("shear curves that cannot be fitted are refused") {
  const std::vector<double> line = {0.0, 1e-3, 2e-3, 3e-3};
  CHECK_THROWS_WITH(fit_janosi({1e4, line, {0.0, 1e3, 2e3, 3e3}}),
                    ContainsSubstring("does not bend towards a strength"));
  CHECK_THROWS_WITH(fit_janosi({1e4, line, {0.0, 1e3}}), ContainsSubstring("4 displacements and 2 stresses"));
  CHECK_THROWS_WITH(fit_janosi({1e4, {1e-3}, {1e3}}), ContainsSubstring("1 points, but 2 are needed"));
  CHECK_THROWS_WITH(fit_janosi({1e4, {0.0, std::nan("")}, {0.0, 1e3}}), ContainsSubstring("must be finite"));
  CHECK_THROWS_WITH(fit_janosi({1e4, line, {0.0, -1e3, -2e3, -2e3}}),
                    ContainsSubstring("in the direction of shearing"));
}

TEST_CASE(
    "below a known strength K alone is fitted: exact on the law's curve, and of the travel's size where it rises") {
  ShearCurve exact{.normal_stress = 1e4, .displacement = {}, .stress = {}}, rising = exact;
  for (int i = 1; i <= 200; ++i) {
    const double j = 2e-5 * i;
    exact.displacement.push_back(j);
    exact.stress.push_back(-7e3 * std::expm1(-j / 8e-4));
    rising.displacement.push_back(j);
    rising.stress.push_back(7e3 * j / 4e-3);
  }
  CHECK(fit_janosi_below(exact, 7e3).displacement == Approx(8e-4).epsilon(1e-6));
  CHECK(fit_janosi_below(exact, 7e3).strength == 7e3);
  // The least squares of x - 1 + exp(-x/k) over 0 to 1 have k = 0.6143 (by a search of its own).
  CHECK(fit_janosi_below(rising, 7e3).displacement == Approx(0.6143 * 4e-3).epsilon(0.01));
  CHECK_THROWS_WITH(fit_janosi_below(exact, 2e4), Catch::Contains("does not reach two thirds"));
  CHECK_THROWS_WITH(fit_janosi_below(exact, 0.0), Catch::Contains("strength"));
  exact.stress[150] = std::nan("");
  CHECK_THROWS_WITH(fit_janosi_below(exact, 7e3), Catch::Contains("point 150") && Catch::Contains("must be finite"));
}
