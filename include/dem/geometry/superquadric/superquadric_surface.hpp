#pragma once

#include <dem/geometry/sphere/sphere_surface.hpp>
#include <dem/geometry/superquadric/nearest_on_superquadric.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>

#include <algorithm>
#include <memory>

namespace dem::surface {

/// A superquadric (thesis eq. 31) |x/r1|^p1 + |y/r2|^p2 + |z/r3|^p3 = 1 about its own axes, solid or a cavity. A grain
/// touches it once, at the nearest place. In a cavity that holds for grains that are rounder than the wall anywhere:
/// one that is stuck in a corner narrower than itself gets one of the contacts only. Behind the wall of a cavity grains
/// are found up to half its size deep. To other bodies and to sharp grains it shows the boundary of the grain of that
/// shape: fixed points, and the one that lies deepest in another body.
///
/// A model names it, as the default set of surfaces does not have it:
///
///     using Surfaces = dem::surface::Set<dem::surface::Plane, dem::surface::Superquadric>;
class Superquadric {
 public:
  /// Half sizes (m) and exponents, each from 2 (round) to 32 (a box for all purposes). Throws Error otherwise.
  explicit Superquadric(const Vec3& radii, const Vec3& exponents = filled(2.0), Side side = Side::outside)
      : side_(side) {
    for (int k = 0; k < 3; ++k) {
      function_.radius[k] = require_positive(radii[k], "half size of a superquadric", "m");
      function_.exponent[k] = require_within(exponents[k], 2.0, 32.0, "exponent of a superquadric");
    }
    if (side == Side::outside) grain_ = std::make_shared<shape::Superquadric>(radii, exponents, pieces);
  }

  Vec3 radii() const { return {function_.radius[0], function_.radius[1], function_.radius[2]}; }
  Vec3 exponents() const { return {function_.exponent[0], function_.exponent[1], function_.exponent[2]}; }
  Side side() const { return side_; }
  std::uint64_t fingerprint() const { return fingerprint_of(radii(), exponents(), side_); }
  const SuperquadricFunction& function() const { return function_; }

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const auto beyond = [&](const T& x, int k) { return max(x, -x) - T(function_.radius[k]); };
    const T x = beyond(p.x, 0), y = beyond(p.y, 1), z = beyond(p.z, 2);
    if (side_ == Side::inside) {
      // |x/r|^p with p of 2 and more is largest for p = 2: inside that ellipsoid, shrunk by the grain, nothing touches.
      const double smallest = std::min({function_.radius[0], function_.radius[1], function_.radius[2]});
      const T u = p.x / T(function_.radius[0]), v = p.y / T(function_.radius[1]), w = p.z / T(function_.radius[2]);
      const T free = max(T(1) - radius / T(smallest), T(0));
      return u * u + v * v + w * w >= free * free;
    }
    return max(x, max(y, z)) <= radius;
  }

  template <class Callback>
  void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    const double at[3] = {p.x, p.y, p.z};
    const bool within = function_.value(at) < 0.0;
    if (!within && radius == 0.0 && side_ == Side::outside) return;
    const SurfacePlace place = within ? nearest_from_inside(function_, p) : nearest_from_outside(function_, p);
    const double outside = dot(p - place.point, place.normal);  // negative within
    const double gap = side_ == Side::inside ? -outside : outside;
    if (gap < radius) callback(0u, side_ == Side::inside ? place.normal : -place.normal, gap);
  }

  /// Points spread over the boundary, for contact with other bodies: callback(number, point, radius), numbers
  /// ascending.
  template <class Callback>
  void points(const Aabb& box, Callback&& callback) const {
    const Vector3<double> low = from_eigen(box.low), high = from_eigen(box.high);
    for_each_point([&](std::uint32_t k, const Vector3<double>& p) {
      if (p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z)
        callback(k, p, 0.0);
    });
  }
  /// Those within a radius of p, for grains that offer penetration(): callback(number, point).
  template <class Callback>
  void corners(const Vector3<double>& p, double radius, Callback&& callback) const {
    for_each_point([&](std::uint32_t k, const Vector3<double>& c) {
      if (dot(c - p, c - p) <= radius * radius) callback(k, c);
    });
  }
  /// The same shape as a grain; nothing for a cavity.
  const shape::Superquadric* grain() const { return grain_.get(); }
  bool has_points() const { return side_ == Side::outside; }

  Aabb bounds() const {
    const Vec3 half = side_ == Side::inside ? Vec3(1.5 * radii()) : radii();
    return {-half, half};
  }

 private:
  static constexpr int pieces = 8;  ///< of an edge, between points

  template <class F>
  void for_each_point(F&& f) const {
    if (!grain_) return;
    for (int k = 0; k < grain_->points().count; ++k) f(static_cast<std::uint32_t>(k), grain_->points()[k]);
  }

  SuperquadricFunction function_;
  Side side_;
  std::shared_ptr<const shape::Superquadric> grain_;
};

}  // namespace dem::surface
