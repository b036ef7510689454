#pragma once

#include <dem/core/error.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// The probability that a value drawn from Student's t distribution of `freedom` degrees lies within -t and t
/// (Abramowitz and Stegun, 26.7.3 and 26.7.4). Throws Error for less than one degree.
inline double student_within(double t, std::size_t freedom) {
  if (freedom < 1) fail("Student's t needs at least one degree of freedom; measure more points than constants");
  const double angle = std::atan(t / std::sqrt(static_cast<double>(freedom)));
  const double c2 = std::cos(angle) * std::cos(angle);
  double term = freedom % 2 == 0 ? 1.0 : std::cos(angle), sum = freedom == 1 ? 0.0 : term;
  for (std::size_t k = freedom % 2 == 0 ? 2 : 3; k + 1 < freedom; k += 2) {
    term *= c2 * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  if (freedom % 2 == 0) return std::sin(angle) * sum;
  return 2.0 / std::numbers::pi * (angle + std::sin(angle) * sum);
}

/// The t that a share of all values lies within, between -t and t: 1.96 for 0.95 and many degrees of freedom, 12.7 for
/// one. Throws Error for a share that is not between 0 and 1.
inline double student_t(std::size_t freedom, double share = 0.95) {
  if (!(share > 0.0 && share < 1.0)) fail("confidence is {:g}, but must be between 0 and 1, as 0.95", share);
  double low = 0.0, high = 1.0;
  while (student_within(high, freedom) < share) high *= 2.0;
  for (int k = 0; k < 200 && high - low > 1e-14 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (student_within(middle, freedom) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// A constant that was measured.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: not known
  std::size_t freedom = 0;                                  ///< degrees of freedom of the error

  /// Half the width of the interval that holds the constant with this confidence; NaN where the error is not known.
  [[nodiscard]] double half_width(double confidence = 0.95) const {
    if (!(freedom > 0) || !std::isfinite(error)) return std::numeric_limits<double>::quiet_NaN();
    return student_t(freedom, confidence) * error;
  }
};

/// Constants with the errors that hold where neighbouring points err alike, as those of one curve do: the fit is made
/// anew without each piece in turn (the jackknife of Quenouille and Tukey, error^2 = (G - 1)/G sum (x_i - mean)^2).
/// Pieces must be longer than points err alike. `fit(pieces)` returns n constants. Throws Error for fewer pieces than
/// n + 1, and what fit throws.
template <std::size_t n, class Piece, class Fit>
std::array<Estimate, n> jackknife(std::span<const Piece> pieces, Fit&& fit) {
  const std::size_t count = pieces.size();
  if (count < n + 1) fail("{} pieces of curves, but {} are needed for errors of {} constants", count, n + 1, n);
  const std::array<double, n> all = fit(pieces);
  std::vector<std::array<double, n>> without;
  std::array<double, n> mean{};
  std::vector<Piece> others;
  for (std::size_t k = 0; k < count; ++k) {
    others.assign(pieces.begin(), pieces.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    without.push_back(fit(std::span<const Piece>(others)));
    for (std::size_t a = 0; a < n; ++a) mean[a] += without.back()[a] / static_cast<double>(count);
  }
  std::array<Estimate, n> result;
  for (std::size_t a = 0; a < n; ++a) {
    double squares = 0.0;
    for (const auto& x : without) squares += (x[a] - mean[a]) * (x[a] - mean[a]);
    const double share = static_cast<double>(count - 1) / static_cast<double>(count);
    result[a] = {all[a], std::sqrt(share * squares), count - n};
  }
  return result;
}

}  // namespace dem::terramechanics
