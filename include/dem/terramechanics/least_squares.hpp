#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

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

}  // namespace detail

/// Fits a curve by Levenberg and Marquardt's method. `model(i, values, slopes)` returns the curve at point i and sets
/// its derivatives by the parameters; `target(i)` and `weight(i)` are the point's value and weight. `what` names the
/// fit in messages. Throws Error for too few points, and if the points do not determine the parameters.
template <std::size_t n, class Model, class Target, class Weight>
LeastSquares<n> least_squares(const char* what, std::size_t points, std::array<double, n> start, Model&& model,
                              Target&& target, Weight&& weight) {
  if (points < n) fail("{}: {} points, but {} are needed; measure more", what, points, n);
  std::array<double, n> slopes{};
  const auto cost_at = [&](const std::array<double, n>& values) {
    double sum = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      const double rest = target(i) - model(i, values, slopes);
      sum += weight(i) * rest * rest;
    }
    return sum;
  };
  LeastSquares<n> fit{.value = start};
  fit.points = points;
  double cost = cost_at(start), damping = 1e-3;
  detail::SmallMatrix<n> normal{}, inverse{};
  const auto build = [&](std::array<double, n>& gradient) {
    normal = {};
    gradient = {};
    for (std::size_t i = 0; i < points; ++i) {
      const double rest = target(i) - model(i, fit.value, slopes), w = weight(i);
      for (std::size_t a = 0; a < n; ++a) {
        gradient[a] += w * slopes[a] * rest;
        for (std::size_t b = 0; b < n; ++b) normal[a][b] += w * slopes[a] * slopes[b];
      }
    }
  };
  std::array<double, n> gradient{};
  for (int iteration = 0; iteration < 500; ++iteration) {
    build(gradient);
    bool better = false;
    double step_size = 0.0;
    for (int attempt = 0; attempt < 40 && !better; ++attempt) {
      detail::SmallMatrix<n> damped = normal;
      for (std::size_t a = 0; a < n; ++a) damped[a][a] *= 1.0 + damping;
      if (!detail::invert(damped, inverse)) {
        damping = std::max(10.0 * damping, 1e-6);
        continue;
      }
      std::array<double, n> tried = fit.value;
      step_size = 0.0;
      for (std::size_t a = 0; a < n; ++a) {
        double step = 0.0;
        for (std::size_t b = 0; b < n; ++b) step += inverse[a][b] * gradient[b];
        tried[a] += step;
        step_size = std::max(step_size, std::abs(step) * std::sqrt(normal[a][a]));
      }
      const double tried_cost = cost_at(tried);
      better = tried_cost < cost;
      damping = better ? std::max(0.1 * damping, 1e-12) : 10.0 * damping;
      if (better) {
        fit.value = tried;
        cost = tried_cost;
      }
    }
    // Nothing to gain but rounding, or the last step moved the curve by less than 1e-12 of the data.
    double size = 0.0;
    for (std::size_t i = 0; i < points; ++i) size += weight(i) * target(i) * target(i);
    if (!better || step_size <= 1e-13 * std::sqrt(size)) break;
  }
  build(gradient);
  bool determined = detail::invert(normal, inverse);
  for (const double v : fit.value) determined &= std::isfinite(v);
  if (!determined)
    fail("{}: the {} points do not determine the {} constants; measure over a wider range", what, points, n);
  double weights = 0.0, mean = 0.0, total = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    weights += weight(i);
    mean += weight(i) * target(i);
  }
  mean /= weights;
  for (std::size_t i = 0; i < points; ++i) total += weight(i) * (target(i) - mean) * (target(i) - mean);
  fit.r_squared = total > 0.0 ? 1.0 - cost / total : 1.0;
  fit.scatter =
      points > n ? std::sqrt(cost / static_cast<double>(points - n)) : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t a = 0; a < n; ++a) fit.error[a] = fit.scatter * std::sqrt(inverse[a][a]);
  return fit;
}

}  // namespace dem::terramechanics
