#pragma once

#include <dem/core/error.hpp>
#include <dem/rig/direct_shear/settings.hpp>

namespace dem::rig::direct_shear {

/// The kinds of grain that --shape names. Throws Error for another name.
inline const GrainKind& kind_named(const std::string& shape) {
  // Looser sharp or rounded cubes leave columns in corners that stand out of the box.
  static const GrainKind kinds[] = {
      {"cube8", "cubes of 8 spheres", 2e4, 0.015, 0.18, 0.0, soil::cube8_limits},
      {"polyhedron", "polyhedral cubes", 8e4, 0.06, 0.5, 0.18, soil::sharp_cube_limits},
      {"superquadric", "superquadric cubes", 8e4, 0.06, 0.5, 0.0, soil::rounded_cube_limits}};
  for (const GrainKind& kind : kinds) {
    if (shape == kind.name) return kind;
  }
  fail("--shape is '{}', but must be cube8, polyhedron or superquadric", shape);
}

/// The kind of the grains of these settings.
inline const GrainKind& kind_of(const Settings& s) { return s.own_kind ? *s.own_kind : kind_named(s.shape); }

/// The loosest and the densest state of the grains' shape, which relative densities are counted between.
inline const soil::DensityLimits& density_limits(const Settings& s) { return kind_of(s).limits; }

/// What a coarser grain's stiffness is multiplied by (its square: damping). Overlap/size under a stress P is P d/K and
/// the damping ratio is C/sqrt(K m), so that K ~ d and C ~ d^2 keep both: a coarse specimen deforms as the fine one
/// does. 1 for the full size.
inline double contact_scale(const Settings& s) { return s.scale_contacts ? s.half_edge / s.constants_for : 1.0; }

/// What the files of a load (kg) are called, by its normal stress.
inline std::string load_name(const Settings& s, double load) {
  return text("load_{:.1f}kPa", 1e-3 * s.normal_stress(load));
}

}  // namespace dem::rig::direct_shear
