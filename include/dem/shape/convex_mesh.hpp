#pragma once

#include <dem/core/error.hpp>
#include <dem/math/convex_hull.hpp>
#include <dem/math/polyhedron_mass.hpp>

#include <algorithm>
#include <map>
#include <span>
#include <vector>

namespace dem::shape {

/// The skin of a convex body: corners, flat faces (as large as they can be: no two in one plane), and each edge once.
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
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// Area vector of a polygon (Newell): its length is the area, its direction the normal of the side from which the
/// corners run counter-clockwise.
inline Vec3 area_vector(std::span<const Vec3> corners, const std::vector<int>& face) {
  Vec3 sum = Vec3::Zero();
  const Vec3 origin = corners[static_cast<std::size_t>(face[0])];
  for (std::size_t k = 2; k < face.size(); ++k) {
    sum += 0.5 * (corners[static_cast<std::size_t>(face[k - 1])] - origin)
                     .cross(Vec3(corners[static_cast<std::size_t>(face[k])] - origin));
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

/// Faces from the triangles of a hull: all corners in the plane of a triangle, in order around their middle. Large
/// triangles first: their planes are the surest.
inline void merge_triangles(ConvexMesh& mesh, const std::vector<Triangle>& triangles, double tolerance) {
  const auto at = [&](int k) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(k)]; };
  const auto area = [&](const Triangle& t) -> Vec3 { return (at(t[1]) - at(t[0])).cross(Vec3(at(t[2]) - at(t[0]))); };
  // Sizes and angles are taken once and then sorted by: taken again, they might round differently.
  std::vector<std::pair<double, Triangle>> by_size;
  for (const Triangle& t : triangles) by_size.emplace_back(-area(t).norm(), t);
  std::sort(by_size.begin(), by_size.end());
  std::vector<std::vector<int>> sorted_faces;
  for (const auto& entry : by_size) {
    const Triangle& t = entry.second;
    const bool known = std::any_of(sorted_faces.begin(), sorted_faces.end(), [&](const std::vector<int>& f) {
      return std::all_of(t.begin(), t.end(), [&](int k) { return std::binary_search(f.begin(), f.end(), k); });
    });
    if (known) continue;
    const Vec3 normal = area(t).normalized();
    std::vector<int> face;
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < static_cast<int>(mesh.corners.size()); ++k) {
      if (std::abs(normal.dot(at(k) - at(t[0]))) > tolerance) continue;
      face.push_back(k);
      middle += at(k);
    }
    sorted_faces.push_back(face);
    middle /= static_cast<double>(face.size());
    const Vec3 x = (at(t[0]) - middle).normalized(), y = normal.cross(x);
    std::vector<std::pair<double, int>> around;
    for (const int k : face) around.emplace_back(std::atan2(y.dot(at(k) - middle), x.dot(at(k) - middle)), k);
    std::sort(around.begin(), around.end());
    for (std::size_t k = 0; k < face.size(); ++k) face[k] = around[k].second;
    mesh.faces.push_back(face);
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
    if (!corners[k].allFinite()) fail("corner {} of a polyhedron is not finite", k);
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

/// The convex hull of a cloud of points (m). Throws Error if there are fewer than four, one is not finite, or all lie
/// in one plane.
inline ConvexMesh hull_mesh(std::span<const Vec3> points) {
  std::vector<Triangle> triangles = convex_hull(points);
  ConvexMesh mesh;
  std::map<int, int> number;
  for (Triangle& t : triangles) {
    for (int& k : t) {
      const auto [known, is_new] = number.emplace(k, static_cast<int>(mesh.corners.size()));
      if (is_new) mesh.corners.push_back(points[static_cast<std::size_t>(k)]);
      k = known->second;
    }
  }
  detail::merge_triangles(mesh, triangles, 1e-8 * detail::size_of(points));
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
