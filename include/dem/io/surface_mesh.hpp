#pragma once
// The small mesh that bodies are drawn with.

#include <dem/core/error.hpp>
#include <dem/math/vector.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace dem::io {

/// Triangles, quads and other polygons over shared vertices, in the frame of a body [m]. Only for looking at: it need
/// not be closed.
struct SurfaceMesh {
  std::vector<Vec3> vertices = {};
  std::vector<std::array<std::int32_t, 3>> triangles = {};  ///< indices into vertices, counter-clockwise from outside
  std::vector<std::array<std::int32_t, 4>> quads = {};      ///< likewise
  std::vector<std::vector<std::int32_t>> polygons = {};     ///< likewise, with any number of corners
  bool operator==(const SurfaceMesh&) const = default;

  /// For those who keep it in a file.
  template <class V>
  void fields(V& v) {
    v("vertices", vertices, "m"), v("triangles", triangles), v("quads", quads), v("polygons", polygons);
  }
};

/// A box with edges along the axes, centred at the origin; `size` [m] are its full edge lengths, each finite and > 0.
/// Throws dem::Error otherwise.
[[nodiscard]] inline SurfaceMesh box_mesh(const Vec3& size) {
  for (int k = 0; k < 3; ++k) require_positive(size[k], "edge of a box_mesh", "m");
  SurfaceMesh mesh;
  for (unsigned corner = 0; corner < 8; ++corner) {  // bits of `corner`: x, y, z at the far side
    const auto side = [corner](unsigned axis) { return (corner >> axis & 1U) != 0 ? 0.5 : -0.5; };
    mesh.vertices.emplace_back(side(0) * size.x(), side(1) * size.y(), side(2) * size.z());
  }
  mesh.quads = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

/// A cylinder along y (a wheel that rolls along x), centred at the origin; radius and length [m] > 0, `segments` >= 3.
/// Throws dem::Error otherwise.
[[nodiscard]] inline SurfaceMesh cylinder_mesh(double radius, double length, int segments = 48) {
  require_positive(radius, "radius of a cylinder_mesh", "m");
  require_positive(length, "length of a cylinder_mesh", "m");
  if (segments < 3) fail("a cylinder_mesh has {} segments, but needs at least 3", segments);
  SurfaceMesh mesh;
  for (int i = 0; i < segments; ++i) {  // vertex 2 i lies at -y, 2 i + 1 at +y
    const double angle = 2 * std::numbers::pi * i / segments;
    const double x = radius * std::sin(angle), z = radius * std::cos(angle);
    mesh.vertices.emplace_back(x, -length / 2, z);
    mesh.vertices.emplace_back(x, length / 2, z);
  }
  mesh.vertices.emplace_back(0, -length / 2, 0);
  mesh.vertices.emplace_back(0, length / 2, 0);
  const int low = 2 * segments, high = low + 1;
  for (int i = 0; i < segments; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % segments);
    mesh.quads.push_back({a, b, b + 1, a + 1});
    mesh.triangles.push_back({low, b, a});
    mesh.triangles.push_back({high, a + 1, b + 1});
  }
  return mesh;
}

/// A rectangle in the plane z = 0 with its normal along +z, centred at the origin; edges [m] > 0 along x and y.
/// Throws dem::Error otherwise.
[[nodiscard]] inline SurfaceMesh rectangle_mesh(double size_x, double size_y) {
  require_positive(size_x, "edge of a rectangle_mesh along x", "m");
  require_positive(size_y, "edge of a rectangle_mesh along y", "m");
  const double x = size_x / 2, y = size_y / 2;
  return {.vertices = {Vec3(-x, -y, 0), Vec3(x, -y, 0), Vec3(x, y, 0), Vec3(-x, y, 0)},
          .triangles = {},
          .quads = {{0, 1, 2, 3}},
          .polygons = {}};
}

}  // namespace dem::io
