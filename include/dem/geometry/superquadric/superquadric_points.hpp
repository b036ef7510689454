#pragma once

#include <dem/geometry/shared_points.hpp>
#include <dem/geometry/superquadric/box_separation.hpp>
#include <dem/geometry/superquadric/superquadric_grain.hpp>

#include <bit>

namespace dem::shape {

/// A superquadric grain after the thesis (section 2.2.4). Sample points of the surface of each grain are tried against
/// the implicit function of the other. Every point inside is a contact, with the area that belongs to it (A of eq. 25)
/// or its share of a whole contact. Depth and normal are those of SuperquadricSolid::penetration, whose overestimate is
/// of fourth order in the depth. Edges and corners that meet between sample points are felt late: the finer the points,
/// the less so.
class SuperquadricPoints : public SuperquadricGrain {
 public:
  static constexpr std::size_t most_contacts = 2 * 4096;

  /// Radii in m, exponents from 2 to 32, cells of points along an edge (6 n^2 + 2 points), and what a point weighs.
  /// Throws Error for values out of range.
  SuperquadricPoints(const Vec3& radii, const Vec3& exponents, int divisions = 6, PointArea area = PointArea::share)
      : SuperquadricGrain(radii, exponents, divisions, area) {}

  /// The most points that a pair of such grains may have in contact at once: a face of each in the other.
  contact::Patch patch() const {
    const contact::Patch one_side = surface_patch();
    return {2.0 * one_side.points, has_shares() ? 1.0 : 2.0 * one_side.weight};
  }

  /// Feature k: point k of a in b. Feature other_way + k: point k of b in a.
  static constexpr std::uint32_t other_way = 1u << 12;

  template <class Callback>
  static DEM_HOT void collide(const SuperquadricPoints& a, const double* pose_a, const SuperquadricPoints& b,
                              const double* pose_b, const Vector3<double>& separation, Callback&& callback) {
    collide_by_points(a, pose_a, b, pose_b, separation, callback);
  }
  static std::uint32_t mirrored(std::uint32_t feature) { return feature ^ other_way; }

  /// The same for any two superquadrics by the points of their boundaries.
  template <class Callback>
  static DEM_HOT void collide_by_points(const SuperquadricGrain& a, const double* pose_a, const SuperquadricGrain& b,
                                        const double* pose_b, const Vector3<double>& separation, Callback&& callback) {
    const Matrix3<double> ra = rotation(pose_a), rb = rotation(pose_b);
    const Matrix3<double> turn = transposed(ra) * rb;
    const Vector3<double> centre = transpose_times(ra, separation);
    if (separate_boxes(a.solid().radius(), b.solid().radius(), turn, centre).overlap < 0.0) return;
    const auto find = [&](auto&& found) { find_points(a, ra, b, rb, turn, centre, separation, found); };
    if (a.has_shares() && b.has_shares()) {
      share_points(find, callback);
    } else {
      find(callback);
    }
  }

 private:
  template <class Callback>
  static DEM_HOT void find_points(const SuperquadricGrain& a, const Matrix3<double>& ra, const SuperquadricGrain& b,
                                  const Matrix3<double>& rb, const Matrix3<double>& turn, const Vector3<double>& centre,
                                  const Vector3<double>& separation, Callback&& callback) {
    const double radius = a.effective_radius(b);
    points_inside(a.points(), transposed(turn), -transpose_times(rb, separation), b.solid(),
                  [&](int k, double depth, const Vector3<double>& out) {
                    const Vector3<double> normal = rb * out;
                    callback(static_cast<std::uint32_t>(k),
                             PairContactPoint<double>{-normal, depth, ra * a.points()[k] + (0.5 * depth) * normal,
                                                      radius, a.points().weight[static_cast<std::size_t>(k)]});
                  });
    points_inside(b.points(), turn, centre, a.solid(), [&](int k, double depth, const Vector3<double>& out) {
      const Vector3<double> normal = ra * out;
      callback(other_way + static_cast<std::uint32_t>(k),
               PairContactPoint<double>{normal, depth, separation + rb * b.points()[k] + (0.5 * depth) * normal, radius,
                                        b.points().weight[static_cast<std::size_t>(k)]});
    });
  }

  /// Calls found(k, depth, outward normal) for each point k, seen from the solid at turn * point + shift, that lies in
  /// it.
  template <class Found>
  static DEM_HOT void points_inside(const PointTable& points, const Matrix3<double>& turn, const Vector3<double>& shift,
                                    const SuperquadricSolid& solid, Found&& found) {
    const auto row = [&](const Vector3<double>& r, double s, const Vector3<Pack>& x) {
      return Pack(r.x) * x.x + Pack(r.y) * x.y + Pack(r.z) * x.z + Pack(s);
    };
    const Vector3<double>& box = solid.radius();
    for (int at = 0; at < points.count; at += pack_width) {
      const auto k = static_cast<std::size_t>(at);
      const Vector3<Pack> x = {load(&points.x[k]), load(&points.y[k]), load(&points.z[k])};
      const Vector3<Pack> y = {row(turn.row0, shift.x, x), row(turn.row1, shift.y, x), row(turn.row2, shift.z, x)};
      const Pack out =
          max(max(max(y.x, -y.x) - Pack(box.x), max(y.y, -y.y) - Pack(box.y)), max(y.z, -y.z) - Pack(box.z));
      if (!any_of(out < Pack(0.0))) continue;
      for (std::uint32_t in = bits(solid.value(y) < Pack(1.0)); in != 0; in &= in - 1) {
        const int lane_in = std::countr_zero(in);
        double depth;
        Vector3<double> normal;
        const Vector3<double> point = {lane(y.x, lane_in), lane(y.y, lane_in), lane(y.z, lane_in)};
        if (solid.penetration(point, depth, normal)) found(at + lane_in, depth, normal);
      }
    }
  }
};

}  // namespace dem::shape
