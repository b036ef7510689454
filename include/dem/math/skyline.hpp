#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem {

/// The factors L D L^T of a symmetric positive semi-definite matrix whose entries lie near its diagonal. Of row i the
/// entries from the first one that is not zero up to the diagonal are stored. A row of which rows before it leave less
/// than a tolerance of its diagonal is left out: its unknown is 0. Rows may have any units.
class Skyline {
 public:
  /// `first[i]` <= i is the first column of row i.
  void lay_out(std::vector<std::uint32_t> first) {
    first_ = std::move(first);
    start_.assign(1, 0);
    for (std::size_t i = 0; i < first_.size(); ++i) start_.push_back(start_.back() + i + 1 - first_[i]);
    values_.resize(start_.back());
    inverse_.resize(first_.size());
  }
  std::size_t size() const { return first_.size(); }

  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }
  /// An entry of the lower triangle, first[i] <= k <= i.
  double& at(std::size_t i, std::size_t k) { return values_[start_[i] + k - first_[i]]; }

  /// Turns the entries into the factors.
  void factorise(double tolerance) {
    for (std::size_t i = 0; i < size(); ++i) {
      double* const row = &values_[start_[i]];  // row[k - f] is entry k
      const std::size_t f = first_[i];
      const double diagonal = row[i - f];
      for (std::size_t k = f + 1; k < i; ++k) {
        const std::size_t from = std::max(f, std::size_t{first_[k]});
        row[k - f] -= product(row + (from - f), &values_[start_[k]] + (from - first_[k]), k - from);
      }
      double left = diagonal;
      for (std::size_t k = f; k < i; ++k) {
        const double l = row[k - f] * inverse_[k];
        left -= l * row[k - f];
        row[k - f] = l;
      }
      inverse_[i] = left > tolerance * diagonal ? 1.0 / left : 0.0;
    }
  }
  /// Solves in place, with the factors.
  void solve(std::vector<double>& b) const {
    const std::size_t n = size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t f = first_[i];
      b[i] -= product(&values_[start_[i]], &b[f], i - f);
    }
    for (std::size_t i = 0; i < n; ++i) b[i] *= inverse_[i];
    for (std::size_t i = n; i-- > 0;) {
      const double* const row = &values_[start_[i]];
      const double x = b[i];
      for (std::size_t k = first_[i]; k < i; ++k) b[k] -= row[k - first_[i]] * x;
    }
  }

 private:
  static double product(const double* a, const double* b, std::size_t n) {
    double sum[4] = {0, 0, 0, 0};
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) {
      for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < n; ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }

  std::vector<std::uint32_t> first_;
  std::vector<std::size_t> start_;
  std::vector<double> values_, inverse_;  ///< of D, 0 for rows that are left out
};

}  // namespace dem
