#pragma once

#include <dem/core/error.hpp>
#include <dem/rig/direct_shear/grain_kind.hpp>
#include <dem/rig/direct_shear/results.hpp>
#include <dem/terramechanics/mohr_coulomb.hpp>

#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace dem::rig::direct_shear {

/// Means of `values` over a window (m) of displacement about each sample.
inline std::vector<double> smoothed(std::span<const Sample> samples, double Sample::*values, double window) {
  return rig::smoothed(samples, &Sample::displacement, values, window);
}

/// Finds maximum, residual and dilation in the samples; what they are too few for stays not known.
inline void evaluate(LoadResult& r, const Settings& s) {
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

/// Relative density between the limits of the grains' shape; not known for what is no solid fraction, as of grains
/// pressed together.
inline double relative_density(const Settings& s, double solid_fraction) {
  if (!(solid_fraction > 1e-6 && solid_fraction <= 1.0)) return not_known;
  return soil::relative_density(solid_fraction, density_limits(s));
}

/// Mohr-Coulomb lines of the loads that were sheared to their end; empty where there are too few for one.
struct Fits {
  std::optional<terramechanics::MohrCoulomb> free, origin, residual;
};
inline Fits fit(const Campaign& c) {
  std::vector<double> sigma, maximum, residual_sigma, residual;
  for (const LoadResult& r : c.loads) {
    if (!r.finished) continue;
    sigma.push_back(r.normal_at_maximum);
    maximum.push_back(r.maximum);
    residual_sigma.push_back(r.normal_at_residual);
    residual.push_back(r.residual);
  }
  using terramechanics::Intercept;
  const auto line = [](std::span<const double> x, std::span<const double> y,
                       Intercept intercept) -> std::optional<terramechanics::MohrCoulomb> {
    try {
      return terramechanics::fit_mohr_coulomb(x, y, intercept);
    } catch (const Error&) {  // too few loads: no reason to lose the rest of the report
      return std::nullopt;
    }
  };
  return {.free = line(sigma, maximum, Intercept::free),
          .origin = line(sigma, maximum, Intercept::zero),
          .residual = line(residual_sigma, residual, Intercept::zero)};
}

}  // namespace dem::rig::direct_shear
