#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_minima.hpp>
#include <dem/geometry/mesh/mesh_parts.hpp>
#include <dem/math/fingerprint.hpp>

#include <algorithm>
#include <memory>
#include <numbers>

namespace dem::surface {

/// From which side a mesh may be touched.
enum class MeshSide {
  solid,      ///< closed; what comes behind the surface is inside and is pushed out
  one_sided,  ///< a sheet that is touched from the side its triangles look to; what comes behind is pushed back
  two_sided   ///< a sheet without thickness that balls touch from both sides; points (radius 0) would pass it, so World
              ///< refuses polyhedra, superquadrics and sharp bodies on it
};

struct MeshOptions {
  MeshSide side = MeshSide::solid;
  MeshFacing facing = MeshFacing::outward;  ///< inward: the solid is outside (a drum)
  /// degrees; contacts closer than this in direction are one, the deepest, as on the facets of a round surface: there
  /// the force turns at once by the angle between two facets. For true polygons, as a drum of 16 sides (22.5 degrees),
  /// choose less: both sides then push in a corner, up to twice as stiff, and the force is steady for overlaps up to
  /// r (1 - cos(angle)).
  double smooth_angle = 25.0;
  double depth = 0.0;  ///< m, how far behind the surface a sample point is still found and pushed out; 0: spheres to
                       ///< their radius, points (radius 0) as deep as their grains or
                       ///< bodies may go, up to half the solid
  double point_spacing = 0.0;  ///< m, of fixed points on sharp edges, where sheets may pass between the vertices; 0:
                               ///< none. Sharp grains and solids find edges without
  double tolerance = 0.0;      ///< m, within which vertices are one; 0: 1e-9 of the mesh's diagonal
};

/// A surface of triangles. The contacts of a sphere are the local minima of the distance from its centre to the
/// surface: a flat mesh gives one contact as a plane does, an edge or a corner pushes once, a concave edge once from
/// each side. On a finely cut concave surface several facets may be such minima; of contacts whose normals differ by
/// less than `smooth_angle` the deepest counts. Its overlap is a steady function of the sphere's place, so no energy
/// comes from the edges, though the force F turns there by F times the angle: sharing it out between the facets would
/// make that steady at the price of the potential. Contacts are remembered by groups of triangles (MeshGroups), not by
/// triangles, and within a group by their direction: a feature is the group's number, then the direction_code of the
/// normal.
class TriangleMesh {
 public:
  static constexpr bool names_directions = true;

  /// Repairs the mesh (geometry/mesh/mesh_repair.hpp). Throws Error if an option is out of range, and if a solid is not
  /// closed.
  DEM_LAZY explicit TriangleMesh(const IndexedMesh& mesh, const MeshOptions& o = {});

  const MeshReport& report() const { return data_->report; }
  /// As repaired; triangles are in the order of the tree.
  const IndexedMesh& mesh() const { return data_->mesh; }
  const MeshData& data() const { return *data_; }
  const MeshOptions& options() const { return options_; }
  /// Of what it was made from. How deep points are found behind it is none of that: it depends on the grains.
  std::uint64_t fingerprint() const;

  template <class T>
  DEM_HOT auto near(const Vector3<T>& p, const T& radius) const {
    const T x = max(max(T(low_.x) - p.x, p.x - T(high_.x)), T(0)),
            y = max(max(T(low_.y) - p.y, p.y - T(high_.y)), T(0)),
            z = max(max(T(low_.z) - p.z, p.z - T(high_.z)), T(0));
    return x * x + y * y + z * z <= radius * radius;
  }

  /// False only if no sample point in a sphere of that radius can touch: cheap for grains that are near the mesh's
  /// bounding box but not near its triangles. `points`: whether any sample point has no radius.
  bool close(const Vector3<double>& p, double radius, bool points) const {
    const double reach = radius + (points ? point_depth_ : options_.depth);
    return data_->tree.reaches(p, reach * reach);
  }

  /// callback(feature, normal, gap) for each contact of a sphere.
  template <class Callback>
  void contacts(const Vector3<double>& p, double radius, Callback&& callback) const {
    contacts_to(p, radius, radius > 0.0 ? options_.depth : point_depth_, callback);
  }
  /// Of a point that is also held at a gap (m) before the surface: the gap is no radius, and may be less than how deep
  /// the point lies behind it.
  template <class Callback>
  void point_contacts(const Vector3<double>& p, double gap, Callback&& callback) const {
    contacts_to(p, gap, point_depth_, callback);
  }

  /// Points for contact with other surfaces: callback(number, point, radius), numbers ascending.
  template <class Callback>
  void points(const Aabb& box, Callback&& callback) const {
    data_->points.for_each_in(box, [&](std::uint32_t k, const Vector3<double>& p) { callback(k, p, 0.0); });
  }
  /// What sticks out within a radius of p, for grains that offer penetration(): vertices, and points of the edges near
  /// p (points_of_edge): callback(number, point, weight).
  template <class Callback>
  void corners(const Vector3<double>& p, double radius, Callback&& callback) const {
    data_->corners.for_each_near(p, radius, [&](std::uint32_t k, const Vector3<double>& c) { callback(k, c, 1.0); });
    data_->edges.for_each_point_near(p, radius, [&](std::uint32_t k, const Vector3<double>& c, double weight) {
      callback(first_edge + k, c, weight);
    });
  }
  bool has_points() const { return true; }
  bool lets_points_through() const { return options_.side == MeshSide::two_sided; }
  /// Edges that stick out and may lie in a box, for contact with other bodies: callback(number, one end, other end),
  /// most_parts numbers an edge.
  template <class Callback>
  void edges(const Aabb& box, Callback&& callback) const {
    const auto numbered_from = [&](std::size_t first) {
      return [first, &callback](std::uint32_t k, const Vector3<double>& tail, const Vector3<double>& head) {
        // As many as the keys of contacts can tell apart.
        const std::size_t number = first_edge + most_parts * (first + k);
        if (number < 2 * first_edge) callback(static_cast<std::uint32_t>(number), tail, head);
      };
    };
    data_->edges.for_each_in(box, numbered_from(0));
    data_->bends.for_each_in(box, numbered_from(data_->edges.size()));
  }
  /// The parts of the way from tail to head that lie in the solid: callback(from, to), shares of the way, ascending. A
  /// sheet has none.
  template <class Callback>
  void parts_inside(const Vector3<double>& tail, const Vector3<double>& head, Callback&& callback) const {
    if (options_.side == MeshSide::solid) surface::parts_inside(*data_, tail, head, callback);
  }

  /// Whether a point of the solid is so far (m) from its surface that no sample point of a grain with that bounding
  /// radius about it is found. `points`: whether any sample point has no radius. A sheet, a cavity
  /// and what stands in it hide nothing.
  bool hides(const Vector3<double>& p, double radius, bool points) const {
    if (options_.side != MeshSide::solid || options_.facing == MeshFacing::inward || !near(p, 0.0)) return false;
    Minimum nearest;
    if (distance().find_nearest(p, radius + (points ? point_depth_ : options_.depth), nearest)) return false;
    return lies_inside(*data_, p, norm(high_ - low_));
  }

  Aabb bounds() const { return {to_eigen(low_), to_eigen(high_)}; }

  /// Points of partners that may be so deep (m) are found behind the surface, if no `depth` was chosen: a solid's to
  /// that depth, a sheet's to a quarter of it, as there may be others beyond.
  void find_points_to(double depth) {
    if (options_.depth > 0.0 || options_.side == MeshSide::two_sided) return;
    set_point_depth(std::max(point_depth_, options_.side == MeshSide::solid ? depth : 0.25 * depth));
  }

 private:
  static constexpr std::uint32_t most_groups = 1u << 20;  // a feature has 28 bits
  static constexpr std::uint32_t first_edge = 1u << 22;   // beyond the numbers of points
  using Minimum = MeshMinimum;
  using Found = MeshMinima::Items;

  DistanceToMesh distance() const { return {*data_, options_.side != MeshSide::two_sided}; }

  /// Contacts up to a reach before the surface, and if there are none, of a centre up to a depth behind it.
  template <class Callback>
  void contacts_to(const Vector3<double>& p, double radius, double depth, Callback&& callback) const {
    if (radius > 0.0 && contacts_of_minima(p, radius, callback)) return;
    if (!(depth > radius)) return;
    Minimum nearest;
    if (distance().find_nearest(p, depth, nearest) && nearest.behind)
      callback(nearest.name(), nearest.normal, -nearest.distance);
  }
  /// False if there are none within the radius.
  template <class Callback>
  bool contacts_of_minima(const Vector3<double>& p, double radius, Callback&& callback) const {
    MeshMinima list;
    Found& found = list.items;
    distance().find_minima(p, radius, found);
    if (found.empty()) return false;
    sort(found, [](const Minimum& a, const Minimum& b) { return a.distance < b.distance; });
    if (found[0].behind) {  // the centre is inside: out the shortest way
      callback(found[0].name(), found[0].normal, -found[0].distance);
      return true;
    }
    reduce(found);
    sort(found, [](const Minimum& a, const Minimum& b) { return a.name() < b.name(); });
    std::uint32_t next = 0;
    for (const Minimum& m : found) {
      const std::uint32_t name = std::max(next, m.name());
      callback(name, m.normal, m.distance);
      next = name + 1;
    }
    return true;
  }

  /// Equal ones keep their order. By insertion where there are few, as nearly always.
  template <class Before>
  static void sort(Found& found, Before&& before) {
    if (found.size() > 32) {
      std::stable_sort(found.begin(), found.end(), before);
      return;
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
      for (std::size_t at = k; at > 0 && before(found[at], found[at - 1]); --at) std::swap(found[at], found[at - 1]);
    }
  }
  /// Of contacts with nearly the same normal the deepest stays; what is seen from behind lies beyond the solid.
  void reduce(Found& found) const {
    std::size_t kept = 0;
    for (const Minimum& m : found) {
      bool is_new = !m.behind;
      for (std::size_t other = 0; other < kept; ++other) is_new &= dot(m.normal, found[other].normal) < merge_cosine_;
      if (is_new) found[kept++] = m;
    }
    found.resize(kept);
  }

  void set_point_depth(double depth);

  MeshOptions options_;
  double merge_cosine_ = 1.0, point_depth_ = 0.0;
  Vector3<double> low_, high_;
  std::shared_ptr<const MeshData> data_;
};

}  // namespace dem::surface

#if DEM_DEFINES

namespace dem::surface {

DEM_LAZY_INLINE TriangleMesh::TriangleMesh(const IndexedMesh& mesh, const MeshOptions& o) : options_(o) {
  require_within(o.smooth_angle, 0.0, 60.0, "smooth angle of a mesh in degrees");
  require_non_negative(o.depth, "depth of a mesh", "m (0 chooses one)");
  require_non_negative(o.point_spacing, "point spacing of a mesh", "m (0: only vertices)");
  const double angle = o.smooth_angle * std::numbers::pi / 180.0;
  auto data = std::make_shared<MeshData>(build_mesh(mesh, o.facing, angle, o.point_spacing, o.tolerance));
  if (o.side == MeshSide::solid && (!data->report.closed() || !data->report.oriented())) {
    fail(
        "a solid must be enclosed by its mesh, but this one is not closed. {}Close it, or take a sheet: side = "
        "MeshSide::one_sided or two_sided",
        data->report.text());
  }
  if (o.side == MeshSide::one_sided && !data->report.oriented()) {
    fail("a one-sided sheet must have sides. {}Take MeshSide::two_sided", data->report.text());
  }
  if (data->groups.count > most_groups) {
    fail(
        "a mesh has {} regions that concave edges part from each other, but at most {} can be told apart; raise "
        "smooth_angle (now {:g} degrees), simplify it, or cut it into several surfaces",
        data->groups.count, most_groups, o.smooth_angle);
  }
  merge_cosine_ = std::min(std::cos(angle), 1.0 - 1e-9);
  data_ = std::move(data);
  if (o.side == MeshSide::two_sided) options_.depth = 0.0;
  set_point_depth(o.side == MeshSide::two_sided ? 0.0 : o.depth > 0.0 ? o.depth : 0.25 * data_->mean_edge);
}

DEM_INLINE std::uint64_t TriangleMesh::fingerprint() const {
  const MeshOptions& o = options_;
  return fingerprint_of(mesh().vertices, mesh().triangles, o.side, o.facing, o.smooth_angle, o.depth, o.point_spacing);
}

DEM_INLINE void TriangleMesh::set_point_depth(double depth) {
  const Aabb& box = data_->bounds;
  if (options_.depth == 0.0 && options_.side == MeshSide::solid) {
    depth = std::min(depth, 0.5 * (box.high - box.low).minCoeff());
  }
  point_depth_ = depth;
  // What is behind a cavity or a sheet lies outside of the box of the triangles.
  const bool box_holds_solid = options_.side == MeshSide::solid && data_->report.enclosed_volume > 0.0;
  const double grow = box_holds_solid ? 0.0 : depth;
  low_ = from_eigen(Vec3(box.low - filled(grow)));
  high_ = from_eigen(Vec3(box.high + filled(grow)));
}

}  // namespace dem::surface

#endif
