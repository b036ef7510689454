#include <dem/terramechanics/bevameter_fit.hpp>
#include <dem/terramechanics/soil.hpp>

#include <cmath>
#include <random>
#include <vector>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr PlateFit kinds[] = {PlateFit::pressures, PlateFit::weighted_logarithms, PlateFit::logarithms};

/// The law's curve at 40 depths to 30 mm, each pressure off by a share of normal scatter.
template <class Law>
PlateCurve measured(const Law& law, double width, double scatter = 0.0, unsigned seed = 1) {
  PlateCurve curve{.width = width, .sinkage = {}, .pressure = {}};
  std::mt19937 engine(seed);
  const auto uniform = [&] { return (static_cast<double>(engine()) + 0.5) / 4294967296.0; };
  for (int k = 1; k <= 40; ++k) {
    const double z = 0.03 * k / 40,
                 normal = std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::acos(-1.0) * uniform());
    curve.sinkage.push_back(z);
    curve.pressure.push_back(law.under(width).pressure(z) * std::exp(scatter * normal));
  }
  return curve;
}

const Bekker mojave = std::get<Bekker>(mojave_martian_simulant.pressure);

}  // namespace

TEST_CASE("points of a power give back its constants, without error") {
  for (const PlateFit kind : kinds) {
    for (const double n : {0.4, 1.0, 1.9}) {
      const auto fit = fit_plate(measured(Bekker{0.0, 3e6, n}, 0.05), kind);
      CHECK(fit.curve.modulus == Approx(3e6).epsilon(1e-9));
      CHECK(fit.curve.exponent == Approx(n).epsilon(1e-9));
      CHECK(fit.modulus_error < 1e-7 * 3e6);
      CHECK(fit.exponent_error < 1e-7);
      CHECK(fit.r_squared == Approx(1.0).epsilon(1e-12));
      CHECK(fit.points == 40);
    }
  }
}

TEST_CASE("the fit of logarithms is the straight line's of textbooks") {
  // ln z = 0, 1, 2 and ln p = 1, 2, 4: slope 3/2, intercept 5/6; residuals 1/6, -1/3, 1/6, so s^2 = 1/6.
  const double e = std::exp(1.0);
  const auto fit = fit_plate({0.1, {1.0, e, e * e}, {e, e * e, e * e * e * e}}, PlateFit::logarithms);
  CHECK(fit.curve.exponent == Approx(1.5).epsilon(1e-9));
  CHECK(fit.curve.modulus == Approx(std::exp(5.0 / 6.0)).epsilon(1e-9));
  CHECK(fit.exponent_error == Approx(std::sqrt(1.0 / 6.0 / 2.0)).epsilon(1e-9));
  CHECK(fit.modulus_error == Approx(fit.curve.modulus * std::sqrt(1.0 / 6.0 * (1.0 / 3.0 + 1.0 / 2.0))).epsilon(1e-9));
  CHECK(fit.r_squared == Approx(1.0 - (1.0 / 6.0) / (14.0 / 3.0)).epsilon(1e-9));
}

TEST_CASE("three plates give back Bekker's and Reece's constants") {
  const Reece clay = {.k_c = 30.0, .k_phi = 60.0, .n = 0.8, .cohesion = 2000.0, .unit_weight = 16e3};
  const Reece sand = {.k_c = 0.0, .k_phi = 60.0, .n = 0.8, .cohesion = 0.0, .unit_weight = 16e3};
  for (const PlateFit kind : kinds) {
    std::vector<PlateCurve> bekker, reece, one;
    for (const double b : {0.03, 0.05, 0.07}) {
      bekker.push_back(measured(mojave, b));
      reece.push_back(measured(clay, b));
    }
    one.push_back(measured(sand, 0.05));
    const auto fit = fit_bekker(bekker, kind);
    CHECK(fit.law.k_c == Approx(mojave.k_c).epsilon(1e-8));
    CHECK(fit.law.k_phi == Approx(mojave.k_phi).epsilon(1e-8));
    CHECK(fit.law.n == Approx(mojave.n).epsilon(1e-8));
    CHECK(fit.points == 120);
    const auto other = fit_reece(reece, 2000.0, 16e3, kind);
    CHECK(other.law.k_c == Approx(30.0).epsilon(1e-8));
    CHECK(other.law.k_phi == Approx(60.0).epsilon(1e-8));
    CHECK(other.law.n == Approx(0.8).epsilon(1e-8));
    CHECK(other.law.under(0.1).pressure(0.01) == Approx(clay.under(0.1).pressure(0.01)).epsilon(1e-8));
    const auto dry = fit_reece(one, 0.0, 16e3, kind);
    CHECK(dry.law.k_c == 0.0);
    CHECK(dry.law.k_phi == Approx(60.0).epsilon(1e-8));
  }
}

TEST_CASE("plates of which wider ones carry more than Bekker expects give a negative modulus, and say so") {
  std::vector<PlateCurve> plates;
  for (const double b : {0.03, 0.05, 0.07}) plates.push_back(measured(Bekker{-2e4, 2e6, 1.1}, b));
  const auto fit = fit_bekker(plates);
  CHECK(fit.law.k_c == Approx(-2e4).epsilon(1e-6));
  CHECK_THROWS_WITH(check_pressure(fit.law), ContainsSubstring("where a fit over plates gives such"));
}

TEST_CASE("the standard errors are the scatter of repeated measurements") {
  // 400 tests with 5 % scatter: a standard deviation of 400 samples is itself known to 1/sqrt(800) = 3.5 %, and the
  // mean of the errors to less; 12 % is more than three of them. The bias of the mean is below 3/sqrt(400) = 0.15
  // deviations.
  constexpr int tests = 400;
  double sum[3] = {}, square[3] = {}, error[3] = {};
  for (int t = 0; t < tests; ++t) {
    std::vector<PlateCurve> plates;
    for (const double b : {0.03, 0.05, 0.07}) {
      plates.push_back(measured(mojave, b, 0.05, static_cast<unsigned>(3 * t) + static_cast<unsigned>(100 * b)));
    }
    const auto fit = fit_bekker(plates, PlateFit::logarithms);
    const double off[3] = {fit.law.k_c - mojave.k_c, fit.law.k_phi - mojave.k_phi, fit.law.n - mojave.n};
    const double claimed[3] = {fit.error.k_c, fit.error.k_phi, fit.error.n};
    for (int k = 0; k < 3; ++k) {
      sum[k] += off[k] / tests;
      square[k] += off[k] * off[k] / tests;
      error[k] += claimed[k] / tests;
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double deviation = std::sqrt(square[k] - sum[k] * sum[k]);
    CHECK(error[k] == Approx(deviation).epsilon(0.12));
    CHECK(std::abs(sum[k]) < 0.2 * deviation);
  }
}

TEST_CASE("sinkage begins where the pressure first is 1 kPa") {
  const PlateCurve curve = {0.05, {0.0, 1e-3, 2e-3, 3e-3, 4e-3}, {0.0, 500.0, 1500.0, 900.0, 4000.0}};
  const PlateCurve z = zeroed(curve);
  CHECK(z.width == 0.05);
  REQUIRE(z.sinkage.size() == 3);
  CHECK(z.sinkage[0] == Approx(0.5e-3));
  CHECK(z.sinkage[2] == Approx(2.5e-3));
  CHECK(z.pressure == std::vector<double>{1500.0, 900.0, 4000.0});
  CHECK(zeroed(curve, 250.0).sinkage[0] == Approx(0.5e-3));
  const PlateCurve at_once = {0.05, {0.002, 0.003}, {1200.0, 1500.0}};
  CHECK(zeroed(at_once).sinkage == std::vector<double>{0.0, 0.003 - 0.002});
  CHECK(within(z, 1e-3, 2e-3).pressure == std::vector<double>{900.0});
  CHECK_THROWS_WITH(zeroed(curve, 5000.0), ContainsSubstring("never reaches 5000 Pa"));
}

TEST_CASE("plate curves that cannot be fitted are refused") {
  const PlateCurve good = measured(mojave, 0.05);
  CHECK_THROWS_WITH(fit_plate({0.05, {0.01}, {1e3}}), ContainsSubstring("1 points, but 2 are needed"));
  CHECK_THROWS_WITH(fit_plate({0.05, {0.0, 0.01}, {1e3, 2e3}}), ContainsSubstring("point 0 of the plate of 0.05 m"));
  CHECK_THROWS_WITH(fit_plate({0.05, {0.01, 0.02}, {-1e3, 2e3}}), ContainsSubstring("both must be positive"));
  CHECK_THROWS_WITH(fit_plate({0.05, {0.01, 0.02}, {1e3}}), ContainsSubstring("2 sinkages and 1 pressures"));
  CHECK_THROWS_WITH(fit_plate({0.05, {0.01, 0.01}, {1e3, 2e3}}), ContainsSubstring("one sinkage"));
  CHECK_THROWS_WITH(fit_plate({0.05, {0.01, std::nan("")}, {1e3, 2e3}}), ContainsSubstring("must be finite"));
  CHECK_THROWS_WITH(fit_plate({0.0, {0.01, 0.02}, {1e3, 2e3}}), ContainsSubstring("width of a plate"));
  CHECK_THROWS_WITH(fit_bekker(std::vector<PlateCurve>{good, good}), ContainsSubstring("2 plates of one width"));
  CHECK_THROWS_WITH(fit_reece(std::vector<PlateCurve>{good}, 100.0, 16e3), ContainsSubstring("one width"));
  CHECK_THROWS_WITH(fit_reece(std::vector<PlateCurve>{good}, 0.0, 0.0), ContainsSubstring("unit weight"));
  CHECK_THROWS_WITH(fit_bekker({}), ContainsSubstring("0 plates"));
}
