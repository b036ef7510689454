#pragma once

#include <dem/math/vector.hpp>

namespace dem::friction {

/// What spring laws share: force k x + c v of a spring and a dashpot beside it, limited to `limit`. The spring slips,
/// so that it never holds more than the limit; the dashpot only gets what the spring leaves.
template <class T>
DEM_HOT Vector3<T> slide(Vector3<T>& spring_force, const T& damping, const Vector3<T>& velocity, const T& limit) {
  const T tiny = T(1e-300);  // keeps 0/0 away; far below any force that matters
  const T stretch = norm(spring_force);
  spring_force = select(stretch > limit, limit / max(stretch, tiny), T(1)) * spring_force;
  const Vector3<T> sum = spring_force + damping * velocity;
  const T size = norm(sum);
  return select(size > limit, limit / max(size, tiny), T(1)) * sum;
}

/// Tangential mass of two solid spheres in contact in units of their effective mass: 1/(1 + m r^2/I), I = 2/5 m r^2.
inline constexpr double tangential_mass_share = 2.0 / 7.0;

// Damping ratios b of the spring laws are those of that swing, c = 2 b sqrt(2/7 m* kt), so a sticking contact of solid
// spheres swings back with e = exp(-pi b/sqrt(1 - b^2)) of its speed. Codes after Tsuji et al. 1992 take the whole
// effective mass, many c = 2 sqrt(5/6) b sqrt(m* kt): to have their dashpot, b is sqrt(5/6 7/2) = 1.71 times as large
// here.

}  // namespace dem::friction
