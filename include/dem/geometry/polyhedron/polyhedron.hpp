#pragma once

#include <dem/geometry/contact_shares.hpp>
#include <dem/geometry/polyhedron/polyhedron_contact.hpp>
#include <dem/geometry/polyhedron/polyhedron_nearest.hpp>
#include <dem/geometry/principal_axes.hpp>
#include <dem/geometry/shape.hpp>

#include <memory>
#include <numbers>
#include <span>
#include <vector>

namespace dem::shape {

/// A convex polyhedron with up to 64 corners. Its corners, faces and edges are kept once per species; copies share
/// them. A grain adds its rotation. The contact code uses it to put one body into the frame of the other, where faces
/// do not move.
///
/// Contacts are patches of points with shares (FacePatch): contact::ContactPoint::weight is the share of a point,
/// without unit. A face on a face has the normal stiffness K of the law, however many points there are, an edge K/2 and
/// a corner K/3. The effective radius is r_i r_j/(r_i + r_j) of the spheres of the same volumes.
class Polyhedron {
 public:
  static constexpr int pose_size = 9;
  static constexpr bool has_orientation = true;
  static constexpr std::size_t most_contacts = PolyhedronContact::most_points;
  template <class T>
  using PairContactPoint = contact::ContactPoint<T>;

  /// The convex hull of a cloud of points in any frame (m). The grain's own frame is then moved to the centre of mass
  /// and turned to the principal axes; `frame_centre` and `frame_rotation` tell where it went. Throws Error if there
  /// are fewer than four points, they lie in one plane, or the hull has more than 64 corners.
  explicit Polyhedron(std::span<const Vec3> points) : Polyhedron(hull_mesh(points)) {}
  /// From faces: triangles or polygons. Throws Error, with what is wrong and where, if they are no convex body; see
  /// convex_mesh.
  Polyhedron(std::span<const Vec3> corners, std::vector<std::vector<int>> faces)
      : Polyhedron(convex_mesh(corners, std::move(faces))) {}

  explicit Polyhedron(ConvexMesh mesh) {
    const MassProperties mass = mesh.mass_properties();
    const PrincipalAxes axes = principal_axes(mass.inertia);
    volume_ = require_positive(mass.volume, "volume of a polyhedron", "m^3");
    unit_inertia_ = axes.moments;
    frame_centre_ = mass.centre;
    frame_rotation_ = axes.rotation;
    for (Vec3& p : mesh.corners) {
      p = axes.rotation.transpose() * (p - mass.centre);
      bounding_radius_ = std::max(bounding_radius_, p.norm());
    }
    mesh.normals.clear();
    mesh.offsets.clear();
    detail::set_planes(mesh);
    auto tables = std::make_shared<PolyhedronTables>(mesh);
    tables->radius = std::cbrt(0.75 * volume_ / std::numbers::pi);
    mesh_ = std::make_shared<const ConvexMesh>(std::move(mesh));
    tables_ = std::move(tables);
  }

  double bounding_radius() const { return bounding_radius_; }
  double volume() const { return volume_; }
  const Vec3& unit_inertia() const { return unit_inertia_; }
  /// Of the corners, in the grain's frame, and the faces.
  std::uint64_t fingerprint() const { return fingerprint_of(mesh_->corners, mesh_->faces); }
  const Vec3& frame_centre() const { return frame_centre_; }
  const Mat3& frame_rotation() const { return frame_rotation_; }
  /// Radius of the sphere of the same volume, m.
  double radius() const { return tables_->radius; }
  /// Corners, faces and edges in the grain's frame.
  const ConvexMesh& mesh() const { return *mesh_; }
  const PolyhedronTables& tables() const { return *tables_; }

  DEM_HOT void orient(const Matrix3<double>& r, double* pose) const {
    const Vector3<double>* rows[3] = {&r.row0, &r.row1, &r.row2};
    for (int k = 0; k < 3; ++k) {
      pose[3 * k] = rows[k]->x;
      pose[3 * k + 1] = rows[k]->y;
      pose[3 * k + 2] = rows[k]->z;
    }
  }
  static DEM_HOT Matrix3<double> rotation(const double* pose) {
    return {{pose[0], pose[1], pose[2]}, {pose[3], pose[4], pose[5]}, {pose[6], pose[7], pose[8]}};
  }

  template <class Callback>
  static void collide(const Polyhedron& a, const double* pose_a, const Polyhedron& b, const double* pose_b,
                      const Vector3<double>& separation, Callback&& callback) {
    const Matrix3<double> turn_a = rotation(pose_a), turn_b = rotation(pose_b);
    const PolyhedronContact found(*a.tables_, turn_a, *b.tables_, turn_b, separation);
    const double ra = a.radius(), rb = b.radius();
    double total_share = contact::least_total_share;
    for (int k = 0; k < found.count(); ++k) total_share += found[k].share;
    for (int k = 0; k < found.count(); ++k) {
      const PatchPoint& p = found[k];
      callback(p.of_first << element_bits | p.of_second,
               PairContactPoint<double>{found.normal(), p.depth, p.point, ra * rb / (ra + rb), p.share, total_share});
    }
  }
  /// All contacts of a pair are one patch.
  static constexpr bool is_patch(std::uint32_t) { return true; }
  /// A feature names the element (face, edge or corner) of each body.
  static std::uint32_t mirrored(std::uint32_t feature) {
    return (feature & ((1u << element_bits) - 1u)) << element_bits | feature >> element_bits;
  }

  /// The corners, as points with shares: 1/n for each corner of a face with n corners, such that a body that lies flat
  /// on a surface has the normal stiffness K. A corner whose faces have different numbers of corners takes the mean of
  /// their shares, as it cannot know on which of them the body lies.
  template <class Callback>
  DEM_HOT void sample_points(const double* pose, Callback&& callback) const {
    const Matrix3<double> turn = rotation(pose);
    for (int k = 0; k < tables_->corners; ++k) {
      callback(static_cast<std::uint32_t>(k), contact::SamplePoint{turn * tables_->corner(k), 0.0, tables_->radius,
                                                                   tables_->corner_share[static_cast<std::size_t>(k)]});
    }
  }

  /// Points of a grain on a surface are shares of one contact.
  static constexpr bool has_shares() { return true; }
  static constexpr contact::Fit shares_fit = contact::Fit::if_more;

  /// The contact of a ball (centre in m from the grain's, global axes) with a face, an edge or a corner. False if they
  /// are apart.
  bool ball_contact(const double* pose, const Vector3<double>& centre, double radius,
                    contact::BallContactPoint& contact) const {
    const Matrix3<double> turn = rotation(pose);
    NearestPoint nearest;
    if (!nearest_point(*tables_, transpose_times(turn, centre), radius, nearest)) return false;
    const double overlap = radius - nearest.height;
    contact.normal = turn * nearest.outward;
    contact.overlap = overlap;
    contact.point = centre - (radius - 0.5 * overlap) * contact.normal;
    return true;
  }

  /// True if a point (m, from the grain's centre, global axes) is inside; then how deep, and which way is out, through
  /// the nearest face.
  DEM_HOT bool penetration(const double* pose, const Vector3<double>& point, double& depth,
                           Vector3<double>& outward_normal) const {
    const Matrix3<double> turn = rotation(pose);
    const Vector3<double> p = transpose_times(turn, point);
    const PolyhedronTables& t = *tables_;
    double highest = -1e300;
    int face = 0;
    for (int f = 0; f < t.faces; ++f) {
      const double height = dot(t.normal(f), p) - t.offset[static_cast<std::size_t>(f)];
      if (height >= 0.0) return false;
      if (height <= highest) continue;
      highest = height;
      face = f;
    }
    depth = -highest;
    outward_normal = turn * t.normal(face);
    return true;
  }

 private:
  static constexpr int element_bits = 12;  // 64 corners have at most 186 edges and 124 faces
  std::shared_ptr<const ConvexMesh> mesh_;
  std::shared_ptr<const PolyhedronTables> tables_;
  double bounding_radius_ = 0.0;
  double volume_ = 0.0;
  Vec3 unit_inertia_ = Vec3::Zero();
  Vec3 frame_centre_ = Vec3::Zero();
  Mat3 frame_rotation_ = Mat3::Identity();
};

}  // namespace dem::shape
