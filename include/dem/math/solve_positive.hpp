#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace dem {

/// Cholesky's factor, in place, of a small symmetric positive semi-definite A (n x n, rows one after the other; only
/// its lower triangle is read). A row of which rows before it leave less than `tolerance` of its diagonal is left out:
/// its part of the factor is 0. The root of the tolerance is the angle between the row and what the others span.
inline void factorise_positive(std::vector<double>& A, std::size_t n, double tolerance) {
  const auto at = [&](std::size_t i, std::size_t k) -> double& { return A[i * n + k]; };
  for (std::size_t i = 0; i < n; ++i) {
    const double size = at(i, i);
    for (std::size_t k = 0; k <= i; ++k) {
      double sum = at(i, k);
      for (std::size_t j = 0; j < k; ++j) sum -= at(i, j) * at(k, j);
      if (i == k) {
        at(i, i) = sum > tolerance * size ? std::sqrt(sum) : 0.0;
      } else {
        at(i, k) = at(k, k) > 0.0 ? sum / at(k, k) : 0.0;
      }
    }
  }
}

/// Solves A x = b in place (b becomes x) by Cholesky's factors; A as in factorise_positive, overwritten. A row that
/// depends on rows before it is left out, its x is 0. Rows may have any units. Rounding leaves some (n + 10) 1e-16 of a
/// row that depends: a tenth of the default tolerance for 90 rows.
inline void solve_positive(std::vector<double>& A, std::vector<double>& b, double tolerance = 1e-13) {
  const std::size_t n = b.size();
  const auto at = [&](std::size_t i, std::size_t k) -> double& { return A[i * n + k]; };
  factorise_positive(A, n, tolerance);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (at(i, k) != 0.0) b[i] -= at(i, k) * b[k];  // what is no number stays with the rows that it belongs to
    }
    b[i] = at(i, i) > 0.0 ? b[i] / at(i, i) : 0.0;
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) {
      if (at(k, i) != 0.0) b[i] -= at(k, i) * b[k];
    }
    b[i] = at(i, i) > 0.0 ? b[i] / at(i, i) : 0.0;
  }
}

}  // namespace dem
