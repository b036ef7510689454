#pragma once

#include <dem/core/aligned.hpp>
#include <dem/geometry/contact_shares.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/geometry/superquadric/superquadric_boundary.hpp>
#include <dem/geometry/superquadric/superquadric_integrals.hpp>
#include <dem/geometry/superquadric/superquadric_search.hpp>

#include <numbers>

namespace dem::shape {

/// What the points of a grain's surface weigh.
enum class PointArea {
  share,     ///< fitted to each contact (contact::fit_weights): constants are those of a whole contact, for any law
  physical,  ///< m^2 (A of eq. 25): stiffness and damping are per area, N/m^3 and N s/m^3. Laws that take more than
             ///< these from a contact (Hertz, Mindlin, DMT, JKR, rolling, damping by restitution) are wrong with it
  relative,  ///< share of the surface over the mean share: stiffness and damping of a mean point, N/m and N s/m; as
             ///< above
};

/// Points of a grain's surface in whole packs; the last ones are padded with points that nothing contains.
struct PointTable {
  AlignedVector<double> x, y, z, weight;  // m; the weight as contact::Geometry's
  int count = 0;

  Vector3<double> operator[](int k) const {
    const auto at = static_cast<std::size_t>(k);
    return {x[at], y[at], z[at]};
  }
};

/// What superquadric grains of either contact policy share: the solid |x/a|^p + |y/b|^q + |z/c|^r <= 1 with its mass
/// properties, its rotation as the pose, and points on its surface.
class SuperquadricGrain {
 public:
  static constexpr int pose_size = 9;  ///< the rotation, by rows
  static constexpr bool has_orientation = true;
  template <class T>
  using PairContactPoint = contact::ContactPoint<T>;

  const SuperquadricSolid& solid() const { return solid_; }
  const PointTable& points() const { return points_; }
  /// Points on a cube's edge, less one.
  std::uint64_t fingerprint() const { return fingerprint_of(solid_.radius(), solid_.exponent(), divisions_, area_); }
  double bounding_radius() const { return bounding_radius_; }
  double volume() const { return mass_.volume; }
  Vec3 unit_inertia() const { return mass_.inertia.diagonal(); }
  /// m, of the sphere of the same volume: the radius that contact laws see.
  double mean_radius() const { return mean_radius_; }
  DEM_HOT double effective_radius(const SuperquadricGrain& other) const {
    return mean_radius_ * other.mean_radius_ / (mean_radius_ + other.mean_radius_);
  }
  /// Whether it is a ball, with exponents of 2 and equal radii.
  bool is_ball() const {
    const Vector3<double>&e = solid_.exponent(), &r = solid_.radius();
    return e.x == 2.0 && e.y == 2.0 && e.z == 2.0 && r.x == r.y && r.y == r.z;
  }
  /// Whether contacts are whole ones, of which points have shares.
  bool has_shares() const { return area_ == PointArea::share; }
  static constexpr contact::Fit shares_fit = contact::Fit::always;
  /// The most points that may lie on a surface at once (of weight 1 where they share it). On each of the three sides
  /// these are the points no deeper behind the tangent plane than a tenth of the mean radius, the default overlap
  /// limit. They are weighted by the square of the cosine of their normals. The largest of the three counts.
  contact::Patch surface_patch() const { return patch_; }

  DEM_HOT void orient(const Matrix3<double>& r, double* pose) const {
    const double rows[pose_size] = {r.row0.x, r.row0.y, r.row0.z, r.row1.x, r.row1.y,
                                    r.row1.z, r.row2.x, r.row2.y, r.row2.z};
    std::copy_n(rows, pose_size, pose);
  }
  static DEM_HOT Matrix3<double> rotation(const double* pose) {
    return {{pose[0], pose[1], pose[2]}, {pose[3], pose[4], pose[5]}, {pose[6], pose[7], pose[8]}};
  }

  /// The points of the surface.
  template <class Callback>
  DEM_HOT void sample_points(const double* pose, Callback&& callback) const {
    const Matrix3<double> r = rotation(pose);
    for (int k = 0; k < points_.count; ++k) {
      callback(static_cast<std::uint32_t>(k),
               contact::SamplePoint{r * points_[k], 0.0, mean_radius_, points_.weight[static_cast<std::size_t>(k)]});
    }
  }
  /// The point of the surface that lies farthest along a direction (global axes): where a plane touches first.
  DEM_HOT Vector3<double> support(const double* pose, const Vector3<double>& direction) const {
    const Matrix3<double> r = rotation(pose);
    Vector3<double> local;
    solid_.support(transpose_times(r, direction), local);
    return r * local;
  }
  /// A point as far out as support(), but in the middle of what is farthest in directions that differ by a few
  /// milliradians. On a flat side, where rounding decides which point is the farthest, it is the middle of the side.
  Vector3<double> even_support(const double* pose, const Vector3<double>& direction) const {
    const Matrix3<double> r = rotation(pose);
    const Vector3<double> n = transpose_times(r, direction);
    const Vector3<double> across = std::abs(n.x) < 0.6 ? Vector3<double>{1, 0, 0} : Vector3<double>{0, 1, 0};
    const Vector3<double> u = cross(n, across), v = cross(n, u);
    Vector3<double> farthest, middle = {0, 0, 0}, p;
    solid_.support(n, farthest);
    for (const Vector3<double>& aside : {u + v, u - v, v - u, -u - v}) {
      solid_.support(n + 3e-3 * aside, p);
      middle += 0.25 * p;
    }
    return r * (middle + dot(farthest - middle, n) * n);
  }
  /// The weight of a sample point beside the support point of a flat surface with that normal (all in m from the
  /// grain's centre, global axes). Within a third of the mean radius it is almost nothing. A round grain touches over
  /// less than that, so it rests and rolls on its support point alone. At the far end of a flat side it is the whole
  /// weight.
  DEM_HOT double beside_support(const Vector3<double>& point, const Vector3<double>& support,
                                const Vector3<double>& normal) const {
    const Vector3<double> d = point - support;
    const double height = dot(d, normal), third = mean_radius_ / 3.0;
    const double ratio = (dot(d, d) - height * height) / (third * third);
    return ratio * ratio / (1.0 + ratio * ratio);
  }
  /// The contact of a ball (centre in m from the grain's, global axes) along the common normal. False if they are
  /// farther apart than the gap (m).
  bool ball_contact(const double* pose, const Vector3<double>& centre, double radius,
                    contact::BallContactPoint& contact, double gap = 0.0) const {
    const Matrix3<double> r = rotation(pose);
    CommonNormal found;
    if (!find_ball_contact(solid_, transpose_times(r, centre), radius, found, gap)) return false;
    contact = {r * found.normal, found.overlap, r * found.point};
    return true;
  }
  /// Whether a point (m, from the grain's centre, global axes) lies inside; then its depth and the outward normal
  /// there, as SuperquadricSolid::penetration defines them.
  DEM_HOT bool penetration(const double* pose, const Vector3<double>& point, double& depth,
                           Vector3<double>& outward_normal) const {
    const Matrix3<double> r = rotation(pose);
    Vector3<double> local;
    if (!solid_.penetration(transpose_times(r, point), depth, local)) return false;
    outward_normal = r * local;
    return true;
  }

 protected:
  SuperquadricGrain(const Vec3& radii, const Vec3& exponents, int divisions, PointArea area)
      : solid_(radii, exponents), divisions_(divisions), area_(area) {
    mass_ = superquadric_mass_properties(radii, exponents);
    bounding_radius_ = superquadric_bounding_radius(radii, exponents);
    mean_radius_ = std::cbrt(mass_.volume * 0.75 / std::numbers::pi);
    const SuperquadricBoundary boundary = superquadric_boundary(solid_, divisions);
    double total = 0.0;
    for (const double a : boundary.areas) total += a;
    const double unit = area == PointArea::physical ? 1.0 : total / static_cast<double>(boundary.areas.size());

    points_.count = static_cast<int>(boundary.points.size());
    const auto padded = static_cast<std::size_t>(round_up_to_pack(points_.count));
    for (auto* column : {&points_.x, &points_.y, &points_.z}) column->assign(padded, 1e30);
    points_.weight.assign(padded, 0.0);
    Vec3 weight_across = Vec3::Zero(), points_across = Vec3::Zero();
    for (std::size_t k = 0; k < boundary.points.size(); ++k) {
      const SurfacePoint& point = boundary.points[k];
      points_.x[k] = point.position.x;
      points_.y[k] = point.position.y;
      points_.z[k] = point.position.z;
      points_.weight[k] = boundary.areas[k] / unit;
      for (int axis = 0; axis < 3; ++axis) {
        if (to_eigen(point.position)[axis] < radii[axis] - 0.1 * mean_radius_) continue;
        const double cosine = to_eigen(point.normal)[axis];
        weight_across[axis] += points_.weight[k] * cosine * cosine;
        points_across[axis] += cosine * cosine;
      }
    }
    patch_ = {std::max(1.0, points_across.maxCoeff()), weight_across.maxCoeff()};
    if (area == PointArea::share) patch_.weight = 1.0;
  }

 private:
  SuperquadricSolid solid_;
  PointTable points_;
  MassProperties mass_;
  contact::Patch patch_;
  int divisions_;
  PointArea area_;
  double bounding_radius_, mean_radius_;
};

}  // namespace dem::shape
