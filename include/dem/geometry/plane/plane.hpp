#pragma once

#include <dem/geometry/surface.hpp>

namespace dem::surface {

/// The half space z < 0 of its own frame: endless, solid below.
class Plane {
 public:
  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    return p.z < radius;
  }

  template <class Callback>
  DEM_HOT void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    if (p.z < radius) callback(0u, Vector3<double>{0, 0, -1}, p.z);
  }

  Aabb bounds() const {
    const double far = 1e150;
    return {filled(-far), Vec3(far, far, 0.0)};
  }
};

}  // namespace dem::surface
