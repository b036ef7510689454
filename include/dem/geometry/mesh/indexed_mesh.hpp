#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/vector.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace dem {

/// Triangles over shared vertices. Corners are counter-clockwise seen from outside.
struct IndexedMesh {
  std::vector<Vec3> vertices;                           ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices

  Vec3 corner(std::size_t triangle, int k) const { return vertices[triangles[triangle][static_cast<std::size_t>(k)]]; }
  /// Twice the area (m^2) along the outward normal.
  Vec3 area_vector(std::size_t t) const { return cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)); }
  double area() const;

  /// The same mesh shifted and turned: x -> shift + turn x.
  IndexedMesh moved(const Vec3& shift, const Mat3& turn = Mat3::Identity()) const;
  /// In another unit of length: x -> factor x, e.g. 1e-3 for a drawing in mm. Throws Error unless factor > 0.
  IndexedMesh scaled(double factor) const;
  /// The same surface seen from the other side: a solid becomes a cavity.
  IndexedMesh flipped() const;
  /// Both meshes in one; shared vertices are not merged.
  IndexedMesh& operator+=(const IndexedMesh& other);

  void add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
};

/// Throws Error if a triangle names a vertex that is not there, or a coordinate is not a finite number.
DEM_LAZY void check_indices(const IndexedMesh& mesh);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE double IndexedMesh::area() const {
  double sum = 0.0;
  for (std::size_t t = 0; t < triangles.size(); ++t) sum += 0.5 * area_vector(t).norm();
  return sum;
}

DEM_INLINE IndexedMesh IndexedMesh::moved(const Vec3& shift, const Mat3& turn) const {
  IndexedMesh m = *this;
  for (Vec3& v : m.vertices) v = shift + turn * v;
  return m;
}

DEM_INLINE IndexedMesh IndexedMesh::scaled(double factor) const {
  require_positive(factor, "scale of a mesh", "(no unit)");
  IndexedMesh m = *this;
  for (Vec3& v : m.vertices) v *= factor;
  return m;
}

DEM_INLINE IndexedMesh IndexedMesh::flipped() const {
  IndexedMesh m = *this;
  for (auto& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

DEM_INLINE IndexedMesh& IndexedMesh::operator+=(const IndexedMesh& other) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) triangles.push_back({base + t[0], base + t[1], base + t[2]});
  return *this;
}

DEM_INLINE void IndexedMesh::add_quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangles.push_back({a, b, c});
  triangles.push_back({a, c, d});
}

DEM_LAZY_INLINE void check_indices(const IndexedMesh& mesh) {
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    if (!is_finite(mesh.vertices[k])) {
      fail("vertex {} of a mesh has a coordinate that is not a finite number; correct or remove it", k);
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v >= mesh.vertices.size()) {
        fail("triangle {} of a mesh names vertex {}, but there are {} (0 to {}); correct the index", t, v,
             mesh.vertices.size(), static_cast<long long>(mesh.vertices.size()) - 1);
      }
    }
  }
}

}  // namespace dem

#endif
