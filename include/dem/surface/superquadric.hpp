#pragma once

#include <dem/math/nearest_on_superquadric.hpp>
#include <dem/surface/sphere.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <vector>

namespace dem::surface {

/// A superquadric (thesis eq. 31) |x/r1|^p1 + |y/r2|^p2 + |z/r3|^p3 = 1 about its own axes, solid or a cavity. A grain
/// touches it once, at the nearest place. In a cavity that holds for grains that are rounder than the wall anywhere:
/// one that is stuck in a corner narrower than itself gets one of the contacts only. Behind the wall of a cavity grains
/// are found up to half its size deep.
class Superquadric {
 public:
  /// Half sizes (m) and exponents, each from 2 (round) to 40 (a box for all purposes). Throws Error otherwise.
  explicit Superquadric(const Vec3& radii, const Vec3& exponents = Vec3::Constant(2.0), Side side = Side::outside)
      : side_(side) {
    for (int k = 0; k < 3; ++k) {
      function_.radius[k] = require_positive(radii[k], "half size of a superquadric", "m");
      function_.exponent[k] = require_within(exponents[k], 2.0, 40.0, "exponent of a superquadric");
    }
    points_ = std::make_shared<std::vector<Vector3<double>>>(make_points());
  }

  Vec3 radii() const { return {function_.radius[0], function_.radius[1], function_.radius[2]}; }
  Vec3 exponents() const { return {function_.exponent[0], function_.exponent[1], function_.exponent[2]}; }
  Side side() const { return side_; }
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

  template <class Sink>
  void touch(const Vector3<double>& p, double radius, Sink&& sink) const {
    const double at[3] = {p.x, p.y, p.z};
    const bool within = function_.value(at) < 0.0;
    if (!within && radius == 0.0 && side_ == Side::outside) return;
    const SurfacePlace place = within ? nearest_from_inside(function_, p) : nearest_from_outside(function_, p);
    const double outside = dot(p - place.point, place.normal);  // negative within
    const double gap = side_ == Side::inside ? -outside : outside;
    if (gap < radius) sink(0u, side_ == Side::inside ? place.normal : -place.normal, gap);
  }

  /// Points spread over the skin, for contact with other bodies: sink(number, point, radius), numbers ascending.
  template <class Sink>
  void points(const Bounds& box, Sink&& sink) const {
    if (side_ == Side::inside) return;
    for (std::uint32_t k = 0; k < points_->size(); ++k) {
      const Vec3 p = to_eigen((*points_)[k]);
      if ((p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all()) sink(k, (*points_)[k], 0.0);
    }
  }
  /// Those within a radius of p, for grains that offer penetration(): sink(number, point).
  template <class Sink>
  void corners(const Vector3<double>& p, double radius, Sink&& sink) const {
    if (side_ == Side::inside) return;
    for (std::uint32_t k = 0; k < points_->size(); ++k) {
      const Vector3<double> from = (*points_)[k] - p;
      if (dot(from, from) <= radius * radius) sink(k, (*points_)[k]);
    }
  }
  bool has_points() const { return side_ == Side::outside; }

  Bounds bounds() const {
    const Vec3 half = side_ == Side::inside ? Vec3(1.5 * radii()) : radii();
    return {-half, half};
  }

 private:
  static constexpr std::size_t per_edge = 9;  // points of a side of the cube that is blown up to the surface

  std::vector<Vector3<double>> make_points() const {
    std::vector<Vector3<double>> points;
    const int n = static_cast<int>(per_edge);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          const bool skin = i == 0 || j == 0 || k == 0 || i == n - 1 || j == n - 1 || k == n - 1;
          if (!skin) continue;
          const auto place = [&](int c) { return std::tan(0.25 * std::numbers::pi * (2.0 * c / (n - 1) - 1.0)); };
          const Vec3 direction = Vec3(place(i), place(j), place(k)).cwiseProduct(radii());
          double low = 0.0, high = 1.0;  // the factor at which the ray leaves, by halving
          for (int step = 0; step < 60; ++step) {
            const double middle = 0.5 * (low + high);
            const Vec3 x = middle * direction;
            (function_.value(x.data()) > 0.0 ? high : low) = middle;
          }
          points.push_back(from_eigen(Vec3(low * direction)));
        }
      }
    }
    return points;
  }

  SuperquadricFunction function_;
  Side side_;
  std::shared_ptr<const std::vector<Vector3<double>>> points_;
};

}  // namespace dem::surface
