#pragma once

#include <dem/core/error.hpp>

namespace dem::soil {

/// The loosest and the densest state of a soil, as solid fractions (solid volume / bulk volume).
struct DensityLimits {
  double loosest;
  double densest;
};

/// Limits of shape::cube8 grains with the thesis's contact constants (mu = 0.4). They were measured by the direct shear
/// rig with grains of half-edge 1.6 mm, away from walls. They are shares of the volume of the solid cubes. Spheres of
/// one cube reach between those of another, so values near 1 are possible. Loosest: a random cloud, rained and settled
/// at full friction. Densest: friction off and shaken until the density changes by less than 0.001 in 0.2 s. The cubes
/// are then largely in layers, so most of the way to 1 is order, not only density.
inline constexpr DensityLimits cube8_limits = {0.762, 0.960};
/// The same of sharp cubes (shape::cube) and of cubes that are superquadrics with exponents of 8, with four times the
/// thesis's K, C and cv, as a face of cube8 has on its four spheres.
inline constexpr DensityLimits sharp_cube_limits = {0.530, 0.893}, rounded_cube_limits = {0.616, 0.855};

/// Relative density as soil mechanics defines it (ASTM D4254), (e_max - e)/(e_max - e_min) with the void ratio
/// e = 1/fraction - 1: 0 at the loosest state, 1 at the densest. Not cut to that range.
inline double relative_density(double solid_fraction, const DensityLimits& limits) {
  require_within(solid_fraction, 1e-6, 1.0, "solid fraction");
  return (1.0 / limits.loosest - 1.0 / solid_fraction) / (1.0 / limits.loosest - 1.0 / limits.densest);
}

/// The solid fraction of a relative density; the inverse of relative_density.
inline double solid_fraction_at(double relative_density, const DensityLimits& limits) {
  return 1.0 / (1.0 / limits.loosest - relative_density * (1.0 / limits.loosest - 1.0 / limits.densest));
}

}  // namespace dem::soil
