#pragma once

#include <dem/geometry/sphere/sphere_surface.hpp>

#include <numbers>

namespace dem::surface {

/// A cylinder about the z axis of its own frame, centred there: a solid with flat ends, a drum (a closed cavity), or a
/// tube (a wall of some thickness, open at both ends, with grains inside and outside). Seen in the half plane of radius
/// and z, the solid is a rectangle, and the nearest place on it is the contact: a face, a rim, or the lateral surface.
/// A drum is touched on lateral surface and ends, each of them once. Behind the walls of a drum grains are found up to
/// one radius deep.
class Cylinder {
 public:
  /// Feature numbers of a drum; a solid and a tube have 0 only.
  static constexpr std::uint32_t lateral = 0, low_end = 1, high_end = 2;

  /// Radius and length in m; `side` inside makes a drum. Throws Error unless both are positive.
  Cylinder(double radius, double length, Side side = Side::outside)
      : outer_(require_positive(radius, "radius of a cylinder", "m")),
        half_(0.5 * require_positive(length, "length of a cylinder", "m")),
        is_drum_(side == Side::inside) {}

  /// An open tube. Throws Error unless 0 < inner radius < outer radius and length > 0.
  static Cylinder tube(double inner_radius, double outer_radius, double length) {
    require_positive(inner_radius, "inner radius of a tube", "m");
    if (!(outer_radius > inner_radius)) {
      fail("the outer radius of a tube is {:g} m, but must exceed the inner one, {:g} m", outer_radius, inner_radius);
    }
    Cylinder c(outer_radius, length);
    c.inner_ = inner_radius;
    return c;
  }
  /// The same with n fixed points on each rim, which it shows to other bodies and to sharp grains beside those that lie
  /// nearest to them. Throws Error for n < 3.
  Cylinder with_rim_points(int n) const {
    require_within(n, 3, 4096, "points on a rim of a cylinder");
    Cylinder c = *this;
    c.rim_points_ = n;
    return c;
  }

  double radius() const { return outer_; }
  double inner_radius() const { return inner_; }
  double length() const { return 2.0 * half_; }
  bool is_drum() const { return is_drum_; }
  std::uint64_t fingerprint() const { return fingerprint_of(inner_, outer_, half_, is_drum_, rim_points_); }

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const T rho2 = p.x * p.x + p.y * p.y, z = max(p.z, -p.z);
    if (is_drum_) {
      const T free = max(T(outer_) - radius, T(0));  // rho beyond which the lateral surface may be touched
      return rho2 >= free * free || z >= T(half_) - radius;
    }
    const T reach = T(outer_) + radius, hole = max(T(inner_) - radius, T(0));
    return rho2 <= reach * reach && z <= T(half_) + radius && rho2 >= hole * hole;
  }

  template <class Callback>
  DEM_HOT void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    const double rho = std::sqrt(p.x * p.x + p.y * p.y);
    // Away from the axis; on the axis every direction is as good.
    const Vector3<double> out = rho > 0.0 ? Vector3<double>{p.x / rho, p.y / rho, 0.0} : Vector3<double>{1, 0, 0};
    if (is_drum_) {
      if (outer_ - rho < radius) callback(lateral, out, outer_ - rho);
      if (half_ + p.z < radius) callback(low_end, Vector3<double>{0, 0, -1}, half_ + p.z);
      if (half_ - p.z < radius) callback(high_end, Vector3<double>{0, 0, 1}, half_ - p.z);
      return;
    }
    const double dr = max(inner_, min(outer_, rho)) - rho, dz = max(-half_, min(half_, p.z)) - p.z;
    const double distance2 = dr * dr + dz * dz;
    if (distance2 > 0.0) {
      if (distance2 >= radius * radius) return;
      const double distance = std::sqrt(distance2);
      callback(0u, (dr / distance) * out + Vector3<double>{0, 0, dz / distance}, distance);
      return;
    }
    // The centre is inside: out through the nearest face.
    const double through_lateral = rho - outer_, through_end = std::abs(p.z) - half_;
    const double through_hole = inner_ > 0.0 ? inner_ - rho : -1e300;
    if (through_lateral >= through_end && through_lateral >= through_hole) {
      callback(0u, -out, through_lateral);
    } else if (through_end >= through_hole) {
      callback(0u, Vector3<double>{0, 0, p.z < 0.0 ? 1.0 : -1.0}, through_end);
    } else {
      callback(0u, out, through_hole);
    }
  }

  /// Fixed points of the rims, for contact with other bodies: callback(number, point, radius), numbers ascending.
  template <class Callback>
  void points(const Aabb&, Callback&& callback) const {
    rims([&](std::uint32_t rim, const Vector3<double>& middle, double r) {
      for_each_point_of_rim(rim, middle, r, [&](std::uint32_t k, const Vector3<double>& p) { callback(k, p, 0.0); });
    });
  }
  /// Points of the rims within a radius of p, for grains that offer penetration(): callback(number, point). Fixed ones,
  /// and where they are too few for a grain of that radius also the nearest point and those half a radius to either
  /// side.
  template <class Callback>
  void corners(const Vector3<double>& p, double radius, Callback&& callback) const {
    const auto show = [&](std::uint32_t number, const Vector3<double>& c) {
      if (dot(c - p, c - p) <= radius * radius) callback(number, c);
    };
    rims([&](std::uint32_t rim, const Vector3<double>& middle, double r) {
      for_each_point_of_rim(rim, middle, r, show);
    });
    rims([&](std::uint32_t rim, const Vector3<double>& middle, double r) {
      if (2.0 * std::numbers::pi * r < 0.25 * radius * rim_points_) return;
      for (std::uint32_t place = 0; place < 3; ++place) {
        const double angle = std::atan2(p.y, p.x) + (0.5 * place - 0.5) * radius / r;
        show(first_near_point + 3 * rim + place, middle + r * around(angle));
      }
    });
  }
  /// The outer lateral surface for grains that offer ball_contact(), within a radius of p: balls that fill the cylinder
  /// where it is nearest to p and half a radius on either side: callback(number, centre, radius of the ball). None for
  /// grains over a flat end or in the hole of a tube.
  template <class Callback>
  void balls(const Vector3<double>& p, double radius, Callback&& callback) const {
    if (is_drum_ || !near(p, radius)) return;
    const double middle = 0.5 * (inner_ + outer_), rho2 = p.x * p.x + p.y * p.y;
    if (rho2 < (std::abs(p.z) > half_ ? outer_ * outer_ : inner_ > 0.0 ? middle * middle : 0.0)) return;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const double z = p.z + (0.5 * k - 0.5) * radius;
      if (std::abs(z) < half_) callback(k, Vector3<double>{0, 0, z}, outer_);
    }
  }
  bool is_on_ball(const Vector3<double>& p) const { return std::abs(p.z) < half_; }
  bool has_points() const { return !is_drum_; }
  /// The rims, circles about the axis: callback(number, middle, radius); those of the hole of a tube come last. A drum
  /// shows none.
  template <class Callback>
  void rims(Callback&& callback) const {
    if (is_drum_) return;
    const Vector3<double> low = {0, 0, -half_}, high = {0, 0, half_};
    callback(0u, low, outer_);
    callback(1u, high, outer_);
    if (inner_ == 0.0) return;
    callback(2u, low, inner_);
    callback(3u, high, inner_);
  }
  /// The line of the lateral surface on the side of a direction, for contact with other bodies: false for a direction
  /// along the axis, and for a drum.
  bool lateral_line(const Vector3<double>& way, Vector3<double>& low, Vector3<double>& high) const {
    const double across = std::sqrt(way.x * way.x + way.y * way.y);
    if (is_drum_ || across < 1e-9) return false;
    low = {outer_ * way.x / across, outer_ * way.y / across, -half_};
    high = {low.x, low.y, half_};
    return true;
  }
  double bounding_radius() const { return std::sqrt(outer_ * outer_ + half_ * half_); }
  /// Cuts the range of shares of the way from tail to head to what lies in the cylinder (a tube's hole counts); false
  /// if nothing is left. A drum has no inside.
  bool clip(const Vector3<double>& tail, const Vector3<double>& head, double& from, double& to) const {
    if (is_drum_) return false;
    const Vector3<double> d = head - tail;
    if (!clip_between(tail.z, d.z, half_, from, to)) return false;
    // |tail + share d| = outer radius, seen along the axis.
    const double a = d.x * d.x + d.y * d.y, b = tail.x * d.x + tail.y * d.y,
                 c = tail.x * tail.x + tail.y * tail.y - outer_ * outer_;
    if (a == 0.0) return c < 0.0;
    const double root2 = b * b - a * c;
    if (root2 <= 0.0) return false;
    from = max(from, (-b - std::sqrt(root2)) / a);
    to = min(to, (-b + std::sqrt(root2)) / a);
    return from < to;
  }

  Aabb bounds() const {
    const double behind = is_drum_ ? outer_ : 0.0;
    const Vec3 half(outer_ + behind, outer_ + behind, half_ + behind);
    return {-half, half};
  }

 private:
  static constexpr std::uint32_t first_near_point = 4 * 4096;  ///< beyond the numbers of fixed points

  static Vector3<double> around(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }
  template <class F>
  void for_each_point_of_rim(std::uint32_t rim, const Vector3<double>& middle, double r, F&& f) const {
    for (int k = 0; k < rim_points_; ++k) {
      f(rim * static_cast<std::uint32_t>(rim_points_) + static_cast<std::uint32_t>(k),
        middle + r * around(2.0 * std::numbers::pi * k / rim_points_));
    }
  }

  double inner_ = 0.0, outer_, half_;
  bool is_drum_ = false;
  int rim_points_ = 48;
};

}  // namespace dem::surface
