#pragma once
// A smooth curve through noisy measurements: what a rig finds, as a polynomial of the constants of its grains.

#include <dem/core/error.hpp>
#include <dem/math/solve_positive.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace dem::rig::calibrate {

/// y as a polynomial of first or second degree over places in the unit cube, by least squares. What the points scatter
/// about it is noise, and gives the standard errors.
class Surrogate {
 public:
  /// How many coefficients a polynomial has.
  static std::size_t terms(std::size_t dimensions, bool is_quadratic) {
    return 1 + dimensions + (is_quadratic ? dimensions * (dimensions + 1) / 2 : 0);
  }

  /// `places` are points, one after the other, of `dimensions` numbers from 0 to 1; `distinct` of them are different.
  /// It is of second degree where there are at least two more different places than it has coefficients. Throws Error
  /// for fewer different places than a plane has coefficients, and for no measurement to spare.
  Surrogate(std::span<const double> places, std::span<const double> values, std::size_t dimensions,
            std::size_t distinct)
      : dimensions_(dimensions), is_quadratic_(distinct >= terms(dimensions, true) + 2) {
    const std::size_t p = terms(dimensions, is_quadratic_), n = values.size();
    if (distinct < p || n < p + 1) {
      fail("a surface over {} constants needs {} different points and {} runs, but there are {} and {}; try more",
           dimensions, p, p + 1, distinct, n);
    }
    freedom_ = n - p;
    std::vector<double> normal(p * p, 0.0), right(p, 0.0), row(p);
    for (std::size_t i = 0; i < n; ++i) {
      set_row(places.subspan(i * dimensions, dimensions), row);
      for (std::size_t a = 0; a < p; ++a) {
        right[a] += row[a] * values[i];
        for (std::size_t b = 0; b < p; ++b) normal[a * p + b] += row[a] * row[b];
      }
    }
    inverse_.assign(p * p, 0.0);
    for (std::size_t a = 0; a < p; ++a) {
      std::vector<double> matrix = normal, unit(p, 0.0);
      unit[a] = 1.0;
      solve_positive(matrix, unit);
      for (std::size_t b = 0; b < p; ++b) inverse_[b * p + a] = unit[b];
    }
    coefficients_ = right;
    solve_positive(normal, coefficients_);
    double squares = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double rest = values[i] - value(places.subspan(i * dimensions, dimensions));
      squares += rest * rest;
    }
    scatter_ = std::sqrt(squares / static_cast<double>(freedom_));
  }

  [[nodiscard]] double value(std::span<const double> x) const {
    std::vector<double> row(coefficients_.size());
    set_row(x, row);
    double sum = 0.0;
    for (std::size_t a = 0; a < row.size(); ++a) sum += row[a] * coefficients_[a];
    return sum;
  }
  /// dy/dx, a number for each dimension.
  [[nodiscard]] std::vector<double> gradient(std::span<const double> x) const {
    std::vector<double> slopes(dimensions_), low(x.begin(), x.end()), high = low;
    for (std::size_t k = 0; k < dimensions_; ++k) {  // exact for a polynomial of second degree
      low[k] = x[k] - 0.25, high[k] = x[k] + 0.25;
      slopes[k] = (value(high) - value(low)) / 0.5;
      low[k] = high[k] = x[k];
    }
    return slopes;
  }
  /// Standard error of value(x).
  [[nodiscard]] double error(std::span<const double> x) const {
    const std::size_t p = coefficients_.size();
    std::vector<double> row(p);
    set_row(x, row);
    double sum = 0.0;
    for (std::size_t a = 0; a < p; ++a) {
      for (std::size_t b = 0; b < p; ++b) sum += row[a] * inverse_[a * p + b] * row[b];
    }
    return scatter_ * std::sqrt(std::fmax(0.0, sum));
  }
  [[nodiscard]] double scatter() const { return scatter_; }  ///< standard deviation of one measurement
  [[nodiscard]] std::size_t freedom() const { return freedom_; }
  [[nodiscard]] bool is_quadratic() const { return is_quadratic_; }

 private:
  /// The terms at a place, about the middle of the cube.
  void set_row(std::span<const double> x, std::vector<double>& row) const {
    std::size_t at = 0;
    row[at++] = 1.0;
    for (std::size_t i = 0; i < dimensions_; ++i) row[at++] = 2.0 * x[i] - 1.0;
    if (!is_quadratic_) return;
    for (std::size_t i = 0; i < dimensions_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) row[at++] = (2.0 * x[i] - 1.0) * (2.0 * x[j] - 1.0);
    }
  }

  std::size_t dimensions_;
  bool is_quadratic_;
  std::size_t freedom_ = 0;
  std::vector<double> coefficients_, inverse_;
  double scatter_ = 0.0;
};

}  // namespace dem::rig::calibrate
