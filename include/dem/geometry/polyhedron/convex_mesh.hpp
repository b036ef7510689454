#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/polyhedron/convex_hull.hpp>
#include <dem/geometry/polyhedron/polyhedron_mass.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <vector>

namespace dem::shape {

/// The boundary of a convex body: corners, flat faces (as large as they can be), and each edge once.
struct ConvexMesh {
  struct Edge {
    int tail, head;   ///< corners
    int left, right;  ///< faces; `left` runs from tail to head, `right` back
  };
  std::vector<Vec3> corners;            ///< m
  std::vector<std::vector<int>> faces;  ///< corners, counter-clockwise seen from outside
  std::vector<Vec3> normals;            ///< of the faces, unit vectors outwards
  std::vector<double> offsets;          ///< m, of the faces' planes: normal . x = offset
  std::vector<Edge> edges;

  MassProperties mass_properties() const { return polyhedron_mass_properties(corners, faces); }
};

namespace detail {

using DirectedEdges = std::map<std::pair<int, int>, int>;  ///< (from, to) -> face that runs along it

inline double size_of(std::span<const Vec3> points) {
  Vec3 low = filled(1e300), high = -low;
  for (const Vec3& p : points) {
    low = lower(low, p);
    high = upper(high, p);
  }
  return (high - low).norm();
}

/// Area vector of a polygon (Newell): its length is the area, its direction the normal of the side from which the
/// corners run counter-clockwise.
inline Vec3 area_vector(std::span<const Vec3> corners, const std::vector<int>& face) {
  Vec3 sum = Vec3::Zero();
  const Vec3 origin = corners[static_cast<std::size_t>(face[0])];
  for (std::size_t k = 2; k < face.size(); ++k) {
    const Vec3 a = corners[static_cast<std::size_t>(face[k - 1])] - origin;
    const Vec3 b = corners[static_cast<std::size_t>(face[k])] - origin;
    sum += cross(0.5 * a, b);
  }
  return sum;
}

inline void set_planes(ConvexMesh& mesh) {
  for (const auto& face : mesh.faces) {
    Vec3 middle = Vec3::Zero();
    for (const int k : face) middle += mesh.corners[static_cast<std::size_t>(k)] / static_cast<double>(face.size());
    mesh.normals.push_back(area_vector(mesh.corners, face).normalized());
    mesh.offsets.push_back(mesh.normals.back().dot(middle));
  }
}

/// Who runs along each edge in which direction. Throws Error when two faces run along one in the same direction.
inline DirectedEdges directed_edges(const std::vector<std::vector<int>>& faces) {
  DirectedEdges runs;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const std::pair<int, int> edge = {faces[f][k], faces[f][(k + 1) % faces[f].size()]};
      const auto [known, is_new] = runs.emplace(edge, static_cast<int>(f));
      if (is_new) continue;
      fail(
          "faces {} and {} of a polyhedron both run from corner {} to corner {}; turn one of them round (corners "
          "counter-clockwise seen from outside), or remove it if it is there twice",
          known->second, f, edge.first, edge.second);
    }
  }
  for (const auto& [edge, face] : runs) {
    if (runs.contains({edge.second, edge.first})) continue;
    fail("the polyhedron is open: the edge from corner {} to corner {} of face {} has no face on its other side",
         edge.first, edge.second, face);
  }
  return runs;
}

/// Joins the triangles of a hull to flat faces. A face starts as the largest triangle that is left, as its plane is the
/// surest, and takes in one neighbour after the other. Only neighbours are asked, not all corners near the plane. So
/// every triangle ends up in one face, and the faces close as the triangles do, whatever rounding says about planes.
class FaceGrower {
 public:
  /// `tolerance`: how far (m) a corner may be from a plane and still lie in it.
  FaceGrower(std::span<const Vec3> points, const std::vector<std::vector<int>>& triangles, double tolerance)
      : points_(points),
        triangles_(triangles),
        triangle_along_(directed_edges(triangles)),
        taken_(triangles.size(), false),
        tolerance_(tolerance) {}

  /// Corners are points of the cloud, counter-clockwise.
  std::vector<std::vector<int>> faces() {
    std::vector<std::pair<double, std::size_t>> by_size;
    for (std::size_t t = 0; t < triangles_.size(); ++t) by_size.emplace_back(-area(t).norm(), t);
    std::sort(by_size.begin(), by_size.end());
    std::vector<std::vector<int>> result;
    for (const auto& [minus_area, seed] : by_size) {
      if (taken_[seed]) continue;
      // Where slopes are so gentle that the plane runs out amid a neighbour, a face may get a notch. It is grown again
      // within less, and stays a triangle at last, which has none.
      Face face;
      for (const double tolerance : {tolerance_, 0.1 * tolerance_, 0.01 * tolerance_, -1.0}) {
        face = grown(seed, tolerance);
        if (is_convex(face.ring, area(seed))) break;
      }
      for (const std::size_t t : face.triangles) taken_[t] = true;
      result.push_back(face.ring);
    }
    return result;
  }

 private:
  struct Face {
    std::vector<int> ring;  ///< its corners
    std::vector<std::size_t> triangles;
  };

  const Vec3& at(int k) const { return points_[static_cast<std::size_t>(k)]; }
  Vec3 area(std::size_t t) const { return area_vector(points_, triangles_[t]); }

  /// Whether a triangle looks the way a plane does, or is too thin to look anywhere. What lies behind a knife's edge
  /// does not, even where it is within the tolerance.
  bool faces_along(const Vec3& normal, std::size_t t) const {
    const std::vector<int>& c = triangles_[t];
    const double longest =
        std::max({(at(c[1]) - at(c[0])).norm(), (at(c[2]) - at(c[1])).norm(), (at(c[0]) - at(c[2])).norm()});
    return 2.0 * normal.dot(area(t)) >= -tolerance_ * longest;
  }

  /// A triangle and, through its sides and theirs, those that lie within the tolerance of its plane. The ring never
  /// touches itself. Corners inside of it are no more corners of the body: they stand out by less than the tolerance.
  Face grown(std::size_t seed, double tolerance) const {
    const Vec3 normal = area(seed).normalized(), origin = at(triangles_[seed][0]);
    Face face = {triangles_[seed], {seed}};
    std::vector<int>& ring = face.ring;
    for (std::size_t k = 0; k < ring.size();) {
      const std::size_t n = ring.size(), next = (k + 1) % n;
      const auto t = static_cast<std::size_t>(triangle_along_.at({ring[next], ring[k]}));
      const int tip = triangles_[t][0] + triangles_[t][1] + triangles_[t][2] - ring[k] - ring[next];
      const bool fits = !taken_[t] && std::abs(normal.dot(at(tip) - origin)) <= tolerance && faces_along(normal, t);
      const bool closes_before = n > 3 && tip == ring[(k + n - 1) % n],
                 closes_after = n > 3 && tip == ring[(k + 2) % n];
      const bool is_new = std::find(ring.begin(), ring.end(), tip) == ring.end();
      if (!fits || !(is_new || closes_before || closes_after)) {
        ++k;
        continue;
      }
      if (is_new) ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(k + 1), tip);
      else ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(closes_before ? k : next));
      face.triangles.push_back(t);
      k = 0;  // what did not fit the ring before may do so now
    }
    return face;
  }

  /// Whether no corner lies beyond the line of a side.
  bool is_convex(const std::vector<int>& ring, const Vec3& normal) const {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3 &from = at(ring[k]), &to = at(ring[(k + 1) % ring.size()]);
      const Vec3 outward = cross(to - from, normal).normalized();
      for (const int other : ring) {
        if (outward.dot(at(other) - from) > tolerance_) return false;
      }
    }
    return true;
  }

  std::span<const Vec3> points_;
  const std::vector<std::vector<int>>& triangles_;
  DirectedEdges triangle_along_;
  std::vector<bool> taken_;
  double tolerance_;
};

/// Takes out corners that only two faces have: points amid the edge of the two, which stand out by rounding alone.
inline void drop_points_of_edges(std::vector<std::vector<int>>& faces) {
  std::map<int, std::vector<std::vector<int>*>> faces_of;
  for (auto& face : faces) {
    for (const int k : face) faces_of[k].push_back(&face);
  }
  for (const auto& [corner, at] : faces_of) {
    if (at.size() != 2 || at[0]->size() < 4 || at[1]->size() < 4) continue;
    for (std::vector<int>* face : at) std::erase(*face, corner);
  }
}

inline void set_edges(ConvexMesh& mesh) {
  const DirectedEdges runs = directed_edges(mesh.faces);
  for (const auto& [edge, left] : runs) {
    if (edge.first > edge.second) continue;
    mesh.edges.push_back({edge.first, edge.second, left, runs.at({edge.second, edge.first})});
  }
}

/// Throws Error, in words, unless the faces close a convex body; turns all of them round if they face inwards.
inline void check_faces(std::span<const Vec3> corners, std::vector<std::vector<int>>& faces) {
  const double size = size_of(corners);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (!is_finite(corners[k])) fail("corner {} of a polyhedron is not finite", k);
    for (std::size_t m = 0; m < k; ++m) {
      const double distance = (corners[k] - corners[m]).norm();
      if (distance > 1e-9 * size) continue;
      fail("corners {} and {} of a polyhedron are {:.3g} m apart: the same point twice; let faces share it", m, k,
           distance);
    }
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size() < 3) fail("face {} of a polyhedron has {} corners, but needs at least 3", f, faces[f].size());
    for (const int k : faces[f]) {
      if (k >= 0 && static_cast<std::size_t>(k) < corners.size()) continue;
      fail("face {} of a polyhedron names corner {}, but there are {} (0 to {})", f, k, corners.size(),
           static_cast<std::ptrdiff_t>(corners.size()) - 1);
    }
  }
  if (faces.size() < 4) fail("a polyhedron was given {} faces, but needs at least 4", faces.size());
  directed_edges(faces);
  const double volume = polyhedron_mass_properties(corners, faces).volume;
  if (!(std::abs(volume) > 1e-9 * size * size * size)) {
    fail("the polyhedron is flat: {:.3g} m across, but its volume is {:.3g} m^3", size, std::abs(volume));
  }
  if (volume < 0.0) {
    for (auto& face : faces) std::reverse(face.begin(), face.end());
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Vec3 area = area_vector(corners, faces[f]);
    if (!(area.norm() > 1e-12 * size * size)) fail("face {} of a polyhedron has no area", f);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const double above = area.normalized().dot(corners[k] - corners[static_cast<std::size_t>(faces[f][0])]);
      if (above <= 1e-6 * size) continue;
      fail(
          "the polyhedron is not convex: corner {} stands {:.3g} m above the plane of face {} (the body is {:.3g} m "
          "across); use the convex hull of its corners, or several grains",
          k, above, f, size);
    }
  }
}

}  // namespace detail

/// The convex hull of a cloud of points (m). Corners that lie in one plane to within 1e-6 of the body's size make one
/// face. So a body from a file of single precision has the faces it was drawn with. Throws Error if there are fewer
/// than four points, one is not finite, or all lie in one plane.
inline ConvexMesh hull_mesh(std::span<const Vec3> points) {
  std::vector<std::vector<int>> triangles;
  for (const Triangle& t : convex_hull(points)) triangles.emplace_back(t.begin(), t.end());
  const double size = detail::size_of(points);
  ConvexMesh mesh;
  mesh.faces = detail::FaceGrower(points, triangles, 1e-6 * size).faces();
  detail::drop_points_of_edges(mesh.faces);
  if (mesh.faces.size() < 4)
    fail("the points of a convex hull lie in one plane: they are {:g} m across, but less than {:.3g} m thick", size,
         1e-6 * size);
  std::map<int, int> number;
  for (auto& face : mesh.faces) {
    for (int& k : face) {
      const auto [known, is_new] = number.emplace(k, static_cast<int>(mesh.corners.size()));
      if (is_new) mesh.corners.push_back(points[static_cast<std::size_t>(k)]);
      k = known->second;
    }
  }
  detail::set_planes(mesh);
  detail::set_edges(mesh);
  return mesh;
}

/// A closed convex body from its faces: triangles or polygons, corners counter-clockwise seen from outside (or all of
/// them clockwise, which is mended). Faces in one plane become one. Throws Error, with what is wrong and where, if the
/// faces do not close, do not agree on outside, or the body is flat or not convex (by more than 1e-6 of its size), or a
/// corner is there twice.
inline ConvexMesh convex_mesh(std::span<const Vec3> corners, std::vector<std::vector<int>> faces) {
  detail::check_faces(corners, faces);
  return hull_mesh(corners);
}

}  // namespace dem::shape
