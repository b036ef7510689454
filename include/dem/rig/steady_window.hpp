#pragma once
// Where a run has become steady, and means over that part.

#include <cmath>
#include <cstddef>
#include <span>

namespace dem::rig {

/// A mean and the standard deviation of what it is the mean of.
struct MeanAndDeviation {
  double mean = std::nan(""), deviation = std::nan("");
  template <class V>
  void fields(V& v) {
    v("mean", mean), v("deviation", deviation);
  }
};
inline MeanAndDeviation mean_of(std::span<const double> values) {
  if (values.empty()) return {};
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  const double n = static_cast<double>(values.size()), mean = sum / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / n)};
}

/// Standard error of the mean of values that follow each other in time and may err alike: that of the means of ten
/// parts of equal length, each longer than values err alike. NaN of less than ten values.
inline double error_of_mean(std::span<const double> values) {
  constexpr std::size_t parts = 10;
  const std::size_t length = values.size() / parts;
  if (length == 0) return std::nan("");
  values = values.last(parts * length);
  const double mean = mean_of(values).mean;
  double squares = 0.0;
  for (std::size_t k = 0; k < parts; ++k) {
    const double m = mean_of(values.subspan(k * length, length)).mean;
    squares += (m - mean) * (m - mean);
  }
  return std::sqrt(squares / static_cast<double>(parts * (parts - 1)));
}

/// The steady end of a run.
struct SteadyWindow {
  std::size_t first = 0;   ///< value that it begins with
  bool is_steady = false;  ///< false: the rule finds no steady part, and the window is the last half
};

/// The marginal standard error rule MSER-5 (K. P. White, Simulation 69, 1997, 323-334): means of 5 values each; as many
/// of them are left out at the start as make the standard error of the mean of the others least, at most half of all.
/// Where that least is at the half, the run has not become steady. So has none of less than 50 values, and none that
/// drifts: the means of the two halves of the window must not differ by more than the window's standard deviation. The
/// rule alone takes a run that drifts and swings ever more for one that was steady at its quiet start.
inline SteadyWindow steady_window(std::span<const double> values) {
  constexpr std::size_t batch = 5;
  const std::size_t count = values.size() / batch;
  if (count < 10) return {values.size() / 2, false};
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t d = 0; d <= count / 2; ++d) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t j = d; j < count; ++j) {
      const double m = mean_of(values.subspan(batch * j, batch)).mean;
      sum += m;
      squares += m * m;
    }
    const double n = static_cast<double>(count - d), error = (squares - sum * sum / n) / (n * n);
    if (error < least) {
      least = error;
      best = d;
    }
  }
  const auto window = values.subspan(batch * best);
  const double drift = mean_of(window.first(window.size() / 2)).mean - mean_of(window.last(window.size() / 2)).mean;
  if (best == count / 2 || std::abs(drift) > mean_of(window).deviation) return {batch * (count / 2), false};
  return {batch * best, true};
}

}  // namespace dem::rig
