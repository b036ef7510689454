#include <dem/math/solve_positive.hpp>

#include <random>

#include "catch.hpp"

using namespace dem;

namespace {

/// G G^T of a random G with n rows and `rank` columns, its rows scaled to units that differ by up to 1e6.
std::vector<double> random_gram(std::size_t n, std::size_t rank, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<double> G(n * rank), A(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double scale = std::pow(10.0, 6.0 * static_cast<double>(i) / static_cast<double>(n));
    for (std::size_t k = 0; k < rank; ++k) G[i * rank + k] = scale * normal(rng);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < rank; ++k) A[i * n + j] += G[i * rank + k] * G[j * rank + k];
    }
  }
  return A;
}

}  // namespace

TEST_CASE("a small positive system is solved, whatever the units of its rows") {
  const std::size_t n = 7;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::vector<double> A = random_gram(n, n + 3, seed);
    std::vector<double> x(n), b(n, 0.0), factors = A;
    for (std::size_t i = 0; i < n; ++i) x[i] = 1.0 + 0.3 * static_cast<double>(i);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < n; ++k) b[i] += A[i * n + k] * x[k];
    }
    std::vector<double> residual = b;
    solve_positive(factors, b);
    for (std::size_t i = 0; i < n; ++i) {
      const double size = std::abs(residual[i]);
      for (std::size_t k = 0; k < n; ++k) residual[i] -= A[i * n + k] * b[k];
      CHECK(std::abs(residual[i]) < 1e-9 * size + 1e-9 * A[i * n + i]);  // backward stable: rounding, scaled by the row
    }
  }
}

TEST_CASE("a row that depends on those before it is left out") {
  // The third row is the sum of the first two; a consistent right side is met by all three.
  std::vector<double> A = {2, 0, 0, 0.5, 3, 0, 2.5, 3.5, 6};
  std::vector<double> b = {1, 2, 3};
  solve_positive(A, b);
  CHECK(b[2] == 0.0);
  CHECK(2 * b[0] + 0.5 * b[1] == Approx(1));
  CHECK(0.5 * b[0] + 3 * b[1] == Approx(2));
  CHECK(2.5 * b[0] + 3.5 * b[1] == Approx(3));
  std::vector<double> nothing, none;
  solve_positive(nothing, none);
  std::vector<double> zero = {0}, one = {1};
  solve_positive(zero, one);
  CHECK(one[0] == 0.0);
}
