#include "results.hpp"

#include <cmath>

namespace direct_shear {

double thesis_maximum(double normal_stress) {
  for (const Reference& r : thesis) {
    if (std::abs(normal_stress / r.normal_stress - 1.0) < 0.005) return r.maximum;
  }
  return not_known;
}

std::vector<double> smoothed(std::span<const Sample> samples, double Sample::*values, double window) {
  std::vector<double> mean(samples.size());
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // The window shrinks towards both ends, so that it stays in the middle of its samples.
    const double x = samples[i].displacement;
    const double half = std::min({0.5 * window, x - samples.front().displacement, samples.back().displacement - x});
    while (from < i && samples[from].displacement < x - half) ++from;
    while (to < samples.size() && samples[to].displacement <= x + half) ++to;
    double sum = 0.0;
    for (std::size_t k = from; k < std::max(to, i + 1); ++k) sum += samples[k].*values;
    mean[i] = sum / static_cast<double>(std::max(to, i + 1) - from);
  }
  return mean;
}

void evaluate(LoadResult& r, const Settings& s) {
  if (r.samples.empty()) return;
  const auto stress = smoothed(r.samples, &Sample::stress, s.smoothing);
  const auto drive = smoothed(r.samples, &Sample::drive_stress, s.smoothing);
  const auto plane = smoothed(r.samples, &Sample::plane_stress, s.smoothing);
  const double last = r.samples.back().displacement;
  double residual = 0.0, count = 0.0, mismatch = 0.0;
  r.maximum = 0.0;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double x = r.samples[i].displacement;
    const bool whole_window = x >= 0.5 * s.smoothing && x <= last - 0.5 * s.smoothing;
    if (whole_window && stress[i] > r.maximum) {
      r.maximum = stress[i];
      r.at_maximum = x;
      r.plane_stress = plane[i];
    }
    // Before that the drive also speeds up the mass of top box and lid.
    const bool steady = x >= s.shear_speed * s.ramp_time + s.smoothing;
    if (whole_window && steady) mismatch = std::max(mismatch, std::abs(drive[i] - stress[i]));
    if (x >= (1.0 - s.residual_share) * s.travel) {
      residual += r.samples[i].stress;
      count += 1.0;
    }
  }
  r.residual = count > 0.0 ? residual / count : not_known;
  r.dilation = r.samples.back().lid_rise;
  r.drive_mismatch = r.maximum > 0.0 ? mismatch / r.maximum : not_known;
}

}  // namespace direct_shear
