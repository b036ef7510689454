#include "catch.hpp"

#include <dem/terramechanics/bevameter_fit.hpp>
#include <dem/terramechanics/confidence.hpp>

#include <cmath>
#include <vector>

using Catch::Approx;
using namespace dem::terramechanics;

TEST_CASE("Student's t is that of printed tables, and of closed forms for one and two degrees") {
  CHECK(student_t(1, 0.95) == Approx(std::tan(0.95 * std::acos(-1.0) / 2.0)).epsilon(1e-10));  // a Cauchy distribution
  CHECK(student_t(2, 0.95) == Approx(0.95 * std::sqrt(2.0 / (1.0 - 0.95 * 0.95))).epsilon(1e-10));
  // Tables have five digits.
  CHECK(student_t(3, 0.95) == Approx(3.1824).margin(5e-5));
  CHECK(student_t(7, 0.99) == Approx(3.4995).margin(5e-5));
  CHECK(student_t(12, 0.95) == Approx(2.1788).margin(5e-5));
  CHECK(student_t(30, 0.90) == Approx(1.6973).margin(5e-5));
  CHECK(student_t(100000, 0.95) == Approx(1.95996).margin(5e-5));  // nearly normal
  CHECK_THROWS_WITH(student_t(0), Catch::Contains("at least one degree"));
  CHECK_THROWS_WITH(student_t(3, 1.0), Catch::Contains("between 0 and 1"));
}

TEST_CASE("the jackknife of a mean is its textbook error") {
  const std::vector<double> x{3.0, 1.0, 4.0, 1.5, 9.0, 2.5, 6.0};
  const auto mean_of = [](std::span<const double> values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return std::array{sum / static_cast<double>(values.size())};
  };
  const double n = 7.0, mean = mean_of(x)[0];
  double squares = 0.0;
  for (const double v : x) squares += (v - mean) * (v - mean);
  const auto e = jackknife<1>(std::span<const double>(x), mean_of)[0];
  CHECK(e.value == Approx(mean));
  CHECK(e.error == Approx(std::sqrt(squares / (n - 1.0) / n)).epsilon(1e-12));
  CHECK(e.freedom == 6);
  CHECK(e.half_width(0.95) == Approx(2.4469 * e.error).epsilon(1e-4));
  CHECK_THROWS_WITH(jackknife<1>(std::span<const double>(x).first(1), mean_of), Catch::Contains("2 are needed"));
  CHECK(std::isnan(Estimate{1.0, std::nan(""), 0}.half_width()));
}

TEST_CASE(
    "where neighbouring points err alike the jackknife's intervals hold the truth, and the least squares' do not") {
  // Pressures of three plates, 8 % off in the mean, of which each point errs nearly as the one before it (0.9 of it).
  const Bekker truth{.k_c = 2e4, .k_phi = 3e6, .n = 0.9};
  std::uint64_t state = 1;
  const auto noise = [&] {  // nearly normal: the sum of 12 even numbers
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      sum += static_cast<double>(state >> 11) * 0x1.0p-53;
    }
    return sum;
  };
  int held = 0, held_by_least_squares = 0;
  constexpr int sets = 60;
  for (int set = 0; set < sets; ++set) {
    std::vector<PlateCurve> curves, pieces;
    for (const double b : {0.04, 0.06, 0.08}) {
      PlateCurve curve{.width = b, .sinkage = {}, .pressure = {}};
      double off = noise();
      for (int i = 1; i <= 100; ++i) {
        const double z = 2e-4 * i;
        off = 0.9 * off + std::sqrt(1.0 - 0.81) * noise();
        curve.sinkage.push_back(z);
        curve.pressure.push_back(truth.under(b).pressure(z) * (1.0 + 0.08 * off));
      }
      for (int k = 0; k < 5; ++k) pieces.push_back(within(curve, 4e-3 * k + 1e-9, 4e-3 * (k + 1) + 1e-9));
      curves.push_back(std::move(curve));
    }
    const auto n = jackknife<3>(std::span<const PlateCurve>(pieces), [](std::span<const PlateCurve> some) {
      const auto law = fit_bekker(some).law;
      return std::array{law.k_c, law.k_phi, law.n};
    })[2];
    const auto plain = fit_bekker(curves);
    held += std::abs(n.value - truth.n) < n.half_width(0.95) ? 1 : 0;
    held_by_least_squares += std::abs(plain.law.n - truth.n) < 1.96 * plain.error.n ? 1 : 0;
  }
  // Of 60 sets 57 in the mean, and 50 but once in a thousand times; points that err alike over 20 of them are worth a
  // fifteenth as many, so the others' intervals are four times too narrow and hold some 40 %.
  CHECK(held >= 50);
  CHECK(held_by_least_squares < 40);
}
