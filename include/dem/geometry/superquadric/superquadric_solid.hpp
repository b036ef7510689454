#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/superquadric/power.hpp>

#include <algorithm>
#include <array>

namespace dem::shape {

/// A point on the surface of a solid.
struct SurfacePoint {
  Vector3<double> position;  ///< m, from the solid's centre
  Vector3<double> normal;    ///< unit vector, outward
};

/// The solid F(x) = |x/a|^p + |y/b|^q + |z/c|^r <= 1 in its own frame (thesis eqs. 31-33, with the absolute values that
/// odd exponents need), convex for exponents >= 2 and symmetric about its centre.
class SuperquadricSolid {
 public:
  /// F with its gradient and its second derivatives, which are diagonal.
  struct Jet {
    double value;
    Vector3<double> gradient, curvature;
  };

  /// A ball of radius r (m > 0).
  explicit SuperquadricSolid(double r) : radius_{r, r, r}, exponent_{2, 2, 2} { derive(); }
  /// Radii in m, exponents without unit. Throws Error unless the radii are positive and the exponents lie between 2
  /// and 32: the curvature of lower ones has no bound, and higher ones are boxes.
  SuperquadricSolid(const Vec3& radii, const Vec3& exponents)
      : radius_(from_eigen(radii)), exponent_(from_eigen(exponents)) {
    for (int k = 0; k < 3; ++k) {
      require_positive(radii[k], "radius of a superquadric", "m");
      require_within(exponents[k], 2.0, 32.0, "exponent of a superquadric");
    }
    derive();
  }

  const Vector3<double>& radius() const { return radius_; }
  const Vector3<double>& exponent() const { return exponent_; }
  DEM_FN double smallest_radius() const { return std::min({radius_.x, radius_.y, radius_.z}); }

  /// F(x), for one point or a pack of points: at most 1 inside.
  template <class T>
  DEM_HOT T value(const Vector3<T>& x) const {
    const Vector3<T> u = {x.x * T(inverse_.x), x.y * T(inverse_.y), x.z * T(inverse_.z)};
    return power_[0](max(u.x, -u.x)) * u.x * u.x + power_[1](max(u.y, -u.y)) * u.y * u.y +
           power_[2](max(u.z, -u.z)) * u.z * u.z;
  }

  DEM_HOT Jet jet(const Vector3<double>& x) const {
    const Vector3<double> u = times(inverse_, x);
    const Vector3<double> high = powers({std::abs(u.x), std::abs(u.y), std::abs(u.z)});  // |u|^(p-2)
    const Vector3<double> once = times(high, u);
    return {dot(once, u), times(slope_, once), times(bend_, high)};
  }

  /// The scale at which a copy of the solid about its centre has x on its surface: below 1 inside. 1-homogeneous and
  /// convex.
  DEM_FN double gauge(const Vector3<double>& x) const {
    if (same_exponents_) return std::pow(value(x), 1.0 / exponent_.x);
    const Vector3<double> u = times(inverse_, x);
    return std::exp(balance({log_of(u.x), log_of(u.y), log_of(u.z)}, exponent_, -1.0));
  }

  /// The support function h(n), the largest n . x of the solid, and the point that has it; n need not be a unit vector.
  DEM_FN double support(const Vector3<double>& n, Vector3<double>& point) const {
    const Vector3<double> w = times(radius_, n);
    // u_i = (s |w_i| / p_i)^(1/(p_i - 1)) with the multiplier s that makes the sum of u_i^p_i one.
    const Vector3<double> logs = {log_of(w.x / exponent_.x), log_of(w.y / exponent_.y), log_of(w.z / exponent_.z)};
    const double s = balance(logs, dual_, 1.0);
    const auto u = [&](double log, double p, double sign) {
      return std::copysign(std::exp((log + s) / (p - 1)), sign);
    };
    const Vector3<double> at = {u(logs.x, exponent_.x, n.x), u(logs.y, exponent_.y, n.y), u(logs.z, exponent_.z, n.z)};
    point = times(radius_, at);
    return dot(n, point);
  }
  /// Support function of the box around the solid: an upper bound of h(n) that costs nothing.
  DEM_HOT double box_support(const Vector3<double>& n) const {
    return radius_.x * std::abs(n.x) + radius_.y * std::abs(n.y) + radius_.z * std::abs(n.z);
  }

  /// Where the ray from the centre through x leaves the solid; x must not be the centre.
  DEM_FN SurfacePoint radial(const Vector3<double>& x) const {
    const Vector3<double> at = (1.0 / gauge(x)) * x;
    const Vector3<double> g = jet(at).gradient;
    return {at, (1.0 / norm(g)) * g};
  }

  /// Whether x lies inside; then its depth below a tangent plane close to x, and that plane's outward normal. The ray
  /// from the centre through x leaves through a first plane; the ray through the foot of x in it leaves through the one
  /// that is used. The depth is never less than the distance d to the surface, and more by at most
  ///   d (d/r)^3 t^2 (1 + t^2/2)^2 / 2
  /// to leading order, where t is the tangent of the angle between ray and normal and r the smallest radius of
  /// curvature nearby: the overestimate is of fourth order in d. It is r/2 times the square of the angle by which the
  /// normal is off, which is so at most (d/r)^2 t (1 + t^2/2): of second order.
  DEM_FN bool penetration(const Vector3<double>& x, double& depth, Vector3<double>& normal) const {
    if (!(value(x) < 1.0)) return false;
    if (value(1e3 * x) < 1e-3) {  // the centre itself has no ray
      const double r = smallest_radius();
      normal = {r == radius_.x ? 1.0 : 0.0, r != radius_.x && r == radius_.y ? 1.0 : 0.0, 0.0};
      normal.z = normal.x + normal.y > 0.0 ? 0.0 : 1.0;
      depth = r - dot(normal, x);
      return true;
    }
    const SurfacePoint first = radial(x);
    const SurfacePoint out = radial(x + dot(first.normal, first.position - x) * first.normal);
    normal = out.normal;
    depth = dot(normal, out.position - x);
    return true;
  }

 private:
  static DEM_HOT Vector3<double> times(const Vector3<double>& a, const Vector3<double>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
  }
  static DEM_HOT double log_of(double value) { return std::log(std::max(std::abs(value), 1e-300)); }
  DEM_HOT Vector3<double> powers(const Vector3<double>& magnitude) const {
    if (same_exponents_) return power_[0](magnitude);
    return {power_[0](magnitude.x), power_[1](magnitude.y), power_[2](magnitude.z)};
  }

  /// The s for which the sum of exp(e_i (log_i + sign s)) is 1. The logarithm of that sum is convex in s, with slopes
  /// between the smallest and the largest e_i, so Newton's iteration converges from anywhere; at once if all are equal.
  static DEM_FN double balance(const Vector3<double>& log, const Vector3<double>& e, double sign) {
    double s = -sign * std::max({log.x, log.y, log.z});
    for (int k = 0; k < 20; ++k) {
      const Vector3<double> t = {std::exp(e.x * (log.x + sign * s)), std::exp(e.y * (log.y + sign * s)),
                                 std::exp(e.z * (log.z + sign * s))};
      const double sum = t.x + t.y + t.z;
      const double step = std::log(sum) * sum / dot(e, t);
      s -= sign * step;
      if (std::abs(step) < 1e-15) break;
      if (e.x == e.y && e.y == e.z) break;
    }
    return s;
  }

  void derive() {
    const Vector3<double>& p = exponent_;
    inverse_ = {1 / radius_.x, 1 / radius_.y, 1 / radius_.z};
    slope_ = times(p, inverse_);
    bend_ = times(times({p.x - 1, p.y - 1, p.z - 1}, slope_), inverse_);
    dual_ = {p.x / (p.x - 1), p.y / (p.y - 1), p.z / (p.z - 1)};
    power_ = {Power(p.x - 2), Power(p.y - 2), Power(p.z - 2)};
    same_exponents_ = p.x == p.y && p.y == p.z;
  }

  Vector3<double> radius_, exponent_;
  Vector3<double> inverse_, slope_, bend_, dual_;
  std::array<Power, 3> power_;
  bool same_exponents_ = false;
};

}  // namespace dem::shape
