#pragma once

#include <dem/math/vector.hpp>
#include <dem/terramechanics/shear.hpp>

#include <algorithm>
#include <cmath>

namespace dem::terramechanics {

/// What a column remembers of the sliding over it: the shear stress as a share of the strength, in global axes and
/// along the contact's tangent plane; |mobilised| = 1 - exp(-j/K) after a straight way j.
struct ShearMemory {
  Vector3<double> mobilised = {0, 0, 0};
  double strength = 0.0;  ///< Pa, when the share was taken
};

/// The memory after a part slid by `way` (m, global axes, along the tangent plane of the unit `normal`) under a
/// strength (Pa). Along a straight way the share is Janosi and Hanamoto's; when the way turns, it goes over to the new
/// direction within some K, dm = (d - m) |dj|/K: so sliding to and fro takes energy each time. While the soil gives way
/// downwards (`compacts`) the share stays and the stress grows with the strength, as in eq. 9. Where the strength
/// changes elastically, K tau^2/(2 strength) stays: soil gives back no more than this (dE = strength m.dm K is at most
/// the work strength m.dj of each slide), so no loop of loads and slides makes energy. The stress then goes with the
/// root of the strength, up to the strength, and comes back with it: a load that trembles does not make a part creep.
inline ShearMemory slide(const ShearMemory& before, const Vector3<double>& way, const Vector3<double>& normal,
                         double strength, bool compacts, double k) {
  ShearMemory after = before;
  after.strength = strength;
  // The contact turns while a wheel rolls over the column: into the new tangent plane, with the same size.
  const double size = norm(before.mobilised);
  if (size > 0.0) {
    const Vector3<double> flat = before.mobilised - dot(before.mobilised, normal) * normal;
    const double left = norm(flat);
    after.mobilised = left > 1e-9 * size ? (size / left) * flat : Vector3<double>{0, 0, 0};
    if (!compacts && strength > 0.0) {
      const double grown = std::min(size * std::sqrt(before.strength / strength), 1.0);
      after.mobilised = (grown / size) * after.mobilised;
    }
  }
  const double length = norm(way);
  if (length > 0.0) {
    const double forget = std::exp(-length / k);
    after.mobilised = forget * after.mobilised + ((1.0 - forget) / length) * way;
  }
  return after;
}

}  // namespace dem::terramechanics
