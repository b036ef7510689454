#pragma once
// How fast grains fall while a bed is made. A bed whose grains fall freely is packed at its top, as the last grains
// fall farthest.

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/math/vector.hpp>

namespace dem::soil {

/// Sets grains that fall along -z faster than `speed` (m/s) to it. To be called between short runs: in 2 ms gravity
/// adds 0.02 m/s.
template <class World>
void limit_fall(World& world, double speed) {
  for (const GrainId p : world.grains()) {
    const Vec3 v = world.velocity(p);
    if (v.z() < -speed) world.set_velocity(p, {v.x(), v.y(), -speed});
  }
}

/// Throws Error for a speed of falling grains (m/s) that limit_fall() does not hold them to. 0: they fall freely.
inline void require_fall_speed(double speed, const char* what) {
  constexpr double least = 0.05;  // m/s; gravity adds 0.02 between two calls
  if (speed == 0.0 || (speed >= least && speed <= 100.0)) return;
  fail("{} is {:g} m/s, but must be 0 (grains fall freely) or {:g} to 100", what, speed, least);
}

}  // namespace dem::soil
