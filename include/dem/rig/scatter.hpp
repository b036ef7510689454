#pragma once
// How values that were measured several times scatter.

#include <dem/rig/number.hpp>

#include <cmath>
#include <cstddef>
#include <span>

namespace dem::rig {

/// The mean of values that do not depend on each other, as of beds of several seeds, and how they scatter.
struct Scatter {
  std::size_t count = 0;
  double mean = not_known;
  double deviation = not_known;  ///< the sample's standard deviation, by count - 1; NaN of one value

  /// The standard error of the mean; NaN of one value.
  [[nodiscard]] double error() const { return deviation / std::sqrt(static_cast<double>(count)); }
};

/// Values that are not known (NaN) are left out.
inline Scatter scatter_of(std::span<const double> values) {
  double sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v, ++count;
  }
  if (count == 0) return {};
  const double n = static_cast<double>(count), mean = sum / n;
  for (const double v : values) {
    if (std::isfinite(v)) squares += (v - mean) * (v - mean);
  }
  return {count, mean, count > 1 ? std::sqrt(squares / (n - 1.0)) : not_known};
}

}  // namespace dem::rig
