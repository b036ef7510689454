#include "results.hpp"

#include <dem/core/error.hpp>

#include <algorithm>
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
  double residual = 0.0, normal = 0.0, count = 0.0, mismatch = not_known, lid = 0.0;
  r.maximum = not_known;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double x = r.samples[i].displacement, weight = s.normal_stress(r.load, x);
    const bool whole_window = x >= 0.5 * s.smoothing && x <= last - 0.5 * s.smoothing;
    if (whole_window && !(stress[i] <= r.maximum)) {
      r.maximum = stress[i];
      r.at_maximum = x;
      r.plane_stress = plane[i];
      r.normal_at_maximum = weight;
    }
    // Before that the drive also speeds up the mass of top box and lid.
    const bool steady = x >= s.shear_speed * s.ramp_time + s.smoothing;
    if (whole_window && steady) mismatch = std::fmax(mismatch, std::abs(drive[i] - stress[i]));
    if (x >= (1.0 - s.residual_share) * s.travel) {
      residual += r.samples[i].stress;
      normal += weight;
      count += 1.0;
    }
    lid += r.samples[i].lid_stress / weight;
  }
  r.residual = count > 0.0 ? residual / count : not_known;
  r.normal_at_residual = count > 0.0 ? normal / count : not_known;
  r.dilation = r.samples.back().lid_rise;
  r.drive_mismatch = r.maximum > 0.0 ? mismatch / r.maximum : not_known;
  r.lid_share = lid / static_cast<double>(stress.size());
}

double relative_density(const Settings& s, double solid_fraction) {
  if (!(solid_fraction > 1e-6 && solid_fraction <= 1.0)) return not_known;
  return dem::soil::relative_density(solid_fraction, density_limits(s));
}

Fits fit(const Campaign& c) {
  std::vector<double> sigma, maximum, residual_sigma, residual;
  for (const LoadResult& r : c.loads) {
    if (!r.finished) continue;
    sigma.push_back(r.normal_at_maximum);
    maximum.push_back(r.maximum);
    residual_sigma.push_back(r.normal_at_residual);
    residual.push_back(r.residual);
  }
  using dem::terramechanics::Intercept;
  const auto line = [](std::span<const double> x, std::span<const double> y,
                       Intercept intercept) -> std::optional<dem::terramechanics::MohrCoulomb> {
    try {
      return dem::terramechanics::fit_mohr_coulomb(x, y, intercept);
    } catch (const dem::Error&) {  // too few loads: no reason to lose the rest of the report
      return std::nullopt;
    }
  };
  return {.free = line(sigma, maximum, Intercept::free),
          .origin = line(sigma, maximum, Intercept::zero),
          .residual = line(residual_sigma, residual, Intercept::zero)};
}

}  // namespace direct_shear
