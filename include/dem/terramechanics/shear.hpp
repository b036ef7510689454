#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <numbers>

namespace dem::terramechanics {

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

/// Shear stress under a plate or a wheel that slides over the soil, tau = (c + p tan phi) (1 - exp(-j/K)): Mohr and
/// Coulomb's strength (thesis eq. 10), reached after Janosi and Hanamoto (1961; thesis eq. 9).
struct JanosiHanamoto {
  double cohesion = 0.0;        ///< c, Pa
  double friction_angle = 0.0;  ///< phi, rad
  double displacement = 0.0;    ///< K, m: where the first slope would reach the strength; 63 % of it are reached there

  /// Pa at a pressure (Pa); tau for j -> infinity.
  double strength(double pressure) const { return cohesion + pressure * std::tan(friction_angle); }
  /// Share of the strength, from 0 to 1, after a shear displacement (m, its size counts).
  double mobilised(double shear_displacement) const {
    return -std::expm1(-std::abs(shear_displacement) / displacement);
  }
  /// Pa at a pressure (Pa) after a shear displacement (m, its size counts).
  double stress(double pressure, double shear_displacement) const {
    return strength(pressure) * mobilised(shear_displacement);
  }
};

/// Throws Error unless c >= 0, 0 <= phi < 90 degrees and K > 0.
inline void check_shear(const JanosiHanamoto& shear) {
  require_non_negative(shear.cohesion, "cohesion of the soil", "Pa");
  if (!(shear.friction_angle >= 0.0 && shear.friction_angle < 0.5 * std::numbers::pi)) {
    fail(
        "friction angle of the soil is {:g} rad, but must be at least 0 and less than pi/2; give it in rad "
        "(radians(35) "
        "is 35 degrees)",
        shear.friction_angle);
  }
  require_positive(shear.displacement, "shear displacement K of the soil", "m");
}

}  // namespace dem::terramechanics
