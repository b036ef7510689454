#pragma once
// Surfaces of machine parts as meshes to look at.

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/geometry/plane/plane.hpp>
#include <dem/geometry/sphere/sphere_surface.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>
#include <dem/io/surface_mesh.hpp>

#include <variant>

namespace dem::io {

[[nodiscard]] inline SurfaceMesh drawn(const IndexedMesh& mesh) {
  SurfaceMesh result;
  result.vertices = mesh.vertices;
  for (const auto& t : mesh.triangles) {
    result.triangles.push_back(
        {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
  }
  return result;
}

/// A surface in its own frame. A plane has no end: a square of edge `plane_size` (m) is drawn.
[[nodiscard]] inline SurfaceMesh drawn(const surface::Plane&, double plane_size = 1.0) {
  return rectangle_mesh(plane_size, plane_size);
}
[[nodiscard]] inline SurfaceMesh drawn(const surface::Box& s, double = 1.0) { return box_mesh(s.edges()); }
[[nodiscard]] inline SurfaceMesh drawn(const surface::Sphere& s, double = 1.0) {
  const IndexedMesh mesh = mesh::sphere(s.radius(), 3);
  return drawn(s.side() == surface::Side::inside ? mesh.flipped() : mesh);
}
[[nodiscard]] inline SurfaceMesh drawn(const surface::Cylinder& s, double = 1.0) {
  const double h = 0.5 * s.length(), r = s.radius(), hole = s.inner_radius();
  if (hole > 0.0) return drawn(mesh::revolved({{hole, -h}, {r, -h}, {r, h}, {hole, h}}, 64));
  const IndexedMesh mesh = mesh::cylinder(r, s.length(), 64);
  return drawn(s.is_drum() ? mesh.flipped() : mesh);
}
/// A cube of 16 cells an edge, blown up until its points lie on the surface.
[[nodiscard]] inline SurfaceMesh drawn(const surface::Superquadric& s, double = 1.0) {
  IndexedMesh mesh = mesh::box({2, 2, 2}, 16);
  for (Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) v[k] = std::tan(0.25 * std::numbers::pi * v[k]) * s.radii()[k];
    double low = 0.0, high = 1.0;  // the factor at which the ray from the centre leaves
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      const Vec3 x = middle * v;
      (s.function().value(x.data()) > 0.0 ? high : low) = middle;
    }
    v *= low;
  }
  return drawn(s.side() == surface::Side::inside ? mesh.flipped() : mesh);
}
[[nodiscard]] inline SurfaceMesh drawn(const surface::TriangleMesh& s, double = 1.0) { return drawn(s.mesh()); }

/// Whichever kind a model's surface is: drawn(world.state().surfaces[k].geometry), at its origin and axes.
template <class... Kinds>
[[nodiscard]] SurfaceMesh drawn(const std::variant<Kinds...>& surface, double plane_size = 1.0) {
  return std::visit([&](const auto& s) { return drawn(s, plane_size); }, surface);
}

}  // namespace dem::io
