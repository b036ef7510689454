#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace dem::terramechanics {

/// Parameters of a curve through points, by weighted least squares.
template <std::size_t n>
struct LeastSquares {
  std::array<double, n> value{};
  std::array<double, n> error{};  ///< standard errors, s sqrt(diag (J^T W J)^-1); NaN without a point to spare
  double scatter = 0.0;           ///< s, weighted standard deviation of the residuals; NaN likewise
  double r_squared = 1.0;         ///< 1 - residual/total weighted sum of squares, about the weighted mean
  std::size_t points = 0;
};

namespace detail {

template <std::size_t n>
using SmallMatrix = std::array<std::array<double, n>, n>;

/// Inverse of a symmetric matrix by Gauss and Jordan, after scaling its diagonal to 1; false if it is singular.
template <std::size_t n>
bool invert(SmallMatrix<n> a, SmallMatrix<n>& inverse) {
  std::array<double, n> scale{};
  for (std::size_t i = 0; i < n; ++i) {
    if (!(a[i][i] > 0.0)) return false;
    scale[i] = 1.0 / std::sqrt(a[i][i]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      a[i][j] *= scale[i] * scale[j];
      inverse[i][j] = i == j ? 1.0 : 0.0;
    }
  }
  for (std::size_t k = 0; k < n; ++k) {  // positive definite, so the pivots need no search
    if (!(a[k][k] > 1e-14)) return false;
    const double pivot = 1.0 / a[k][k];
    for (std::size_t j = 0; j < n; ++j) {
      a[k][j] *= pivot;
      inverse[k][j] *= pivot;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k];
      for (std::size_t j = 0; j < n; ++j) {
        a[i][j] -= factor * a[k][j];
        inverse[i][j] -= factor * inverse[k][j];
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) inverse[i][j] *= scale[i] * scale[j];
  }
  return true;
}

/// Points with weights, and the curve that is fitted to them; see least_squares.
template <std::size_t n, class Model, class Target, class Weight>
struct FittedPoints {
  std::size_t count;
  Model& model;
  Target& target;
  Weight& weight;

  /// Weighted sum of the squared residuals.
  double cost(const std::array<double, n>& values) const {
    std::array<double, n> slopes{};
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double rest = target(i) - model(i, values, slopes);
      sum += weight(i) * rest * rest;
    }
    return sum;
  }
  /// Weighted sum of the squared targets, less `mean`.
  double squares(double mean = 0.0) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) sum += weight(i) * (target(i) - mean) * (target(i) - mean);
    return sum;
  }
  double mean() const {
    double weights = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      weights += weight(i);
      sum += weight(i) * target(i);
    }
    return sum / weights;
  }
};

/// J^T W J and J^T W r of a curve.
template <std::size_t n>
struct NormalEquations {
  SmallMatrix<n> matrix{};
  std::array<double, n> gradient{};

  template <class Points>
  NormalEquations(const Points& points, const std::array<double, n>& values) {
    std::array<double, n> slopes{};
    for (std::size_t i = 0; i < points.count; ++i) {
      const double rest = points.target(i) - points.model(i, values, slopes), w = points.weight(i);
      for (std::size_t a = 0; a < n; ++a) {
        gradient[a] += w * slopes[a] * rest;
        for (std::size_t b = 0; b < n; ++b) matrix[a][b] += w * slopes[a] * slopes[b];
      }
    }
  }
  /// The step of the parameters with the matrix's diagonal raised by a share `damping`; none if that is singular.
  std::optional<std::array<double, n>> step(double damping) const {
    SmallMatrix<n> damped = matrix, inverse{};
    for (std::size_t a = 0; a < n; ++a) damped[a][a] *= 1.0 + damping;
    if (!invert(damped, inverse)) return std::nullopt;
    std::array<double, n> step{};
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) step[a] += inverse[a][b] * gradient[b];
    }
    return step;
  }
};

/// Levenberg and Marquardt's method from `values` on, which become those of the least cost. Returns that cost.
template <std::size_t n, class Points>
double descend(const Points& points, std::array<double, n>& values) {
  const double size = std::sqrt(points.squares());
  double cost = points.cost(values), damping = 1e-3;
  for (int iteration = 0; iteration < 500; ++iteration) {
    const NormalEquations<n> equations(points, values);
    bool better = false;
    double moved = 0.0;  // by the step, in units of the data
    for (int attempt = 0; attempt < 40 && !better; ++attempt) {
      const auto step = equations.step(damping);
      if (!step) {
        damping = std::max(10.0 * damping, 1e-6);
        continue;
      }
      std::array<double, n> tried = values;
      moved = 0.0;
      for (std::size_t a = 0; a < n; ++a) {
        tried[a] += (*step)[a];
        moved = std::max(moved, std::abs((*step)[a]) * std::sqrt(equations.matrix[a][a]));
      }
      const double tried_cost = points.cost(tried);
      better = tried_cost < cost;
      damping = better ? std::max(0.1 * damping, 1e-12) : 10.0 * damping;
      if (better) {
        values = tried;
        cost = tried_cost;
      }
    }
    // Nothing to gain but rounding, or the last step moved the curve by less than 1e-13 of the data.
    if (!better || moved <= 1e-13 * size) break;
  }
  return cost;
}

}  // namespace detail

/// Fits a curve by Levenberg and Marquardt's method. `model(i, values, slopes)` returns the curve at point i and sets
/// its derivatives by the parameters; `target(i)` and `weight(i)` are the point's value and weight. `what` names the
/// fit in messages. Throws Error for too few points, and if the points do not determine the parameters.
template <std::size_t n, class Model, class Target, class Weight>
LeastSquares<n> least_squares(const char* what, std::size_t points, std::array<double, n> start, Model&& model,
                              Target&& target, Weight&& weight) {
  if (points < n) fail("{}: {} points, but {} are needed; measure more", what, points, n);
  const detail::FittedPoints<n, Model, Target, Weight> data{points, model, target, weight};
  LeastSquares<n> fit{.value = start};
  fit.points = points;
  const double cost = detail::descend(data, fit.value);
  detail::SmallMatrix<n> inverse{};
  bool determined = detail::invert(detail::NormalEquations<n>(data, fit.value).matrix, inverse);
  for (const double v : fit.value) determined &= std::isfinite(v);
  if (!determined)
    fail("{}: the {} points do not determine the {} constants; measure over a wider range", what, points, n);
  const double total = data.squares(data.mean());
  fit.r_squared = total > 0.0 ? 1.0 - cost / total : 1.0;
  fit.scatter =
      points > n ? std::sqrt(cost / static_cast<double>(points - n)) : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t a = 0; a < n; ++a) fit.error[a] = fit.scatter * std::sqrt(inverse[a][a]);
  return fit;
}

}  // namespace dem::terramechanics
