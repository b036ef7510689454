#pragma once

#include <dem/core/error.hpp>
#include <dem/surface/surface.hpp>

#include <cmath>

namespace dem::surface {

/// A solid box, centred in its own frame. A sphere touches it once: on a face, an edge or a corner.
class Box {
 public:
  /// Edge lengths in m. Throws Error unless all are positive.
  explicit Box(const Vec3& edges) : half_{0.5 * edges.x(), 0.5 * edges.y(), 0.5 * edges.z()} {
    for (int k = 0; k < 3; ++k) require_positive(edges[k], "edge length of a box", "m");
  }

  Vec3 edges() const { return 2.0 * to_eigen(half_); }

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const T x = outside(p.x, half_.x), y = outside(p.y, half_.y), z = outside(p.z, half_.z);
    return x * x + y * y + z * z < radius * radius;
  }

  template <class Sink>
  DEM_HOT void touch(const Vector3<double>& p, double radius, Sink&& sink) const {
    // From the point to the nearest point of the solid box.
    const Vector3<double> to_box = {clamped(p.x, half_.x) - p.x, clamped(p.y, half_.y) - p.y,
                                    clamped(p.z, half_.z) - p.z};
    const double distance2 = dot(to_box, to_box);
    if (distance2 >= radius * radius) {
      if (distance2 > 0.0 || radius > 0.0) return;
    }
    if (distance2 > 0.0) {
      const double distance = std::sqrt(distance2);
      sink(0u, (1.0 / distance) * to_box, distance);
      return;
    }
    // The centre is inside: out through the nearest face.
    const double dx = std::abs(p.x) - half_.x, dy = std::abs(p.y) - half_.y, dz = std::abs(p.z) - half_.z;
    Vector3<double> normal = {0, 0, 0};
    if (dx >= dy && dx >= dz) {
      normal.x = p.x < 0.0 ? 1.0 : -1.0;
      sink(0u, normal, dx);
    } else if (dy >= dz) {
      normal.y = p.y < 0.0 ? 1.0 : -1.0;
      sink(0u, normal, dy);
    } else {
      normal.z = p.z < 0.0 ? 1.0 : -1.0;
      sink(0u, normal, dz);
    }
  }

  Bounds bounds() const { return {-to_eigen(half_), to_eigen(half_)}; }

 private:
  /// How far a coordinate lies outside [-limit, limit].
  template <class T>
  static DEM_HOT T outside(const T& value, double limit) {
    return max(max(value, -value) - T(limit), T(0));
  }
  static DEM_HOT double clamped(double value, double limit) { return max(-limit, min(limit, value)); }

  Vector3<double> half_;
};

}  // namespace dem::surface
