#pragma once

#include <dem/math/vector.hpp>

namespace dem {

/// What contacts read of a partner, a grain or a machine part, side by side in memory: a partner may be anywhere, and
/// nine columns would be nine cache lines. Three rows of four doubles, for grain::relative_motions().
struct alignas(32) PartnerView {
  Vector3<double> position;          ///< m, of the centre of mass
  double radius;                     ///< m, of a grain's bounding sphere
  Vector3<double> velocity;          ///< m/s
  double inverse_mass;               ///< 1/kg; 0 for what never moves
  Vector3<double> angular_velocity;  ///< rad/s, global axes
  double unused = 0.0;

  const double* row(int k) const { return &position.x + 4 * k; }
};
static_assert(sizeof(PartnerView) == 12 * sizeof(double));

}  // namespace dem
