#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/surface.hpp>
#include <dem/math/fingerprint.hpp>

namespace dem::surface {

/// On which side of a closed surface the grains are.
enum class Side {
  outside,  ///< the surface encloses a solid
  inside    ///< the surface encloses a cavity in a solid: a drum, a tank
};

/// A ball, or a round cavity, centred in its own frame. A grain touches it once. Behind the wall of a cavity grains are
/// found up to one radius deep. A cavity shows no points to other bodies: they show theirs to it.
class Sphere {
 public:
  /// Radius in m. Throws Error unless it is positive.
  explicit Sphere(double radius, Side side = Side::outside)
      : radius_(require_positive(radius, "radius of a sphere", "m")), side_(side) {}

  double radius() const { return radius_; }
  Side side() const { return side_; }
  std::uint64_t fingerprint() const { return fingerprint_of(radius_, side_); }
  /// A body contact needs no points of the other surface: the ball finds all of it.
  bool is_ball() const { return side_ == Side::outside; }

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const T distance2 = dot(p, p);
    if (side_ == Side::inside) return distance2 >= max(T(radius_) - radius, T(0)) * max(T(radius_) - radius, T(0));
    return distance2 <= (T(radius_) + radius) * (T(radius_) + radius);
  }

  template <class Callback>
  DEM_HOT void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    const double distance = norm(p);
    const double gap = side_ == Side::inside ? radius_ - distance : distance - radius_;
    if (!(gap < radius)) return;
    // At the centre every way out is as good; up is taken.
    const Vector3<double> outward = distance > 0.0 ? (1.0 / distance) * p : Vector3<double>{0, 0, 1};
    callback(0u, side_ == Side::inside ? outward : -outward, gap);
  }

  /// A ball shows itself to other bodies: callback(number, point, radius).
  template <class Callback>
  void points(const Aabb&, Callback&& callback) const {
    if (side_ == Side::outside) callback(0u, Vector3<double>{0, 0, 0}, radius_);
  }
  bool has_points() const { return side_ == Side::outside; }

  /// m, effective radius of a grain's boundary of that radius on the ball: 1/(1/r + 1/R). A cavity counts as flat.
  DEM_HOT double radius_on(double radius) const {
    return side_ == Side::inside ? radius : 1.0 / (1.0 / radius + 1.0 / radius_);
  }
  /// For grains that offer ball_contact(): callback(number, centre, radius of the ball).
  template <class Callback>
  void balls(const Vector3<double>&, double, Callback&& callback) const {
    if (is_ball()) callback(0u, Vector3<double>{0, 0, 0}, radius_);
  }
  bool is_on_ball(const Vector3<double>&) const { return true; }

  Aabb bounds() const {
    const Vec3 half = filled(side_ == Side::inside ? 2.0 * radius_ : radius_);
    return {-half, half};
  }

 private:
  double radius_;
  Side side_;
};

}  // namespace dem::surface
