#pragma once
// Polyhedral grains as meshes for write_vtk_bodies: one BodyMesh a grain, which may share the mesh of their species.

#include <dem/geometry/polyhedron/polyhedron.hpp>
#include <dem/io/surface_mesh.hpp>

namespace dem::io {

/// The boundary of a polyhedron, in the grain's frame: each face one polygon.
[[nodiscard]] inline SurfaceMesh polyhedron_mesh(const shape::Polyhedron& body) {
  SurfaceMesh mesh;
  mesh.vertices = body.mesh().corners;
  for (const auto& face : body.mesh().faces) mesh.polygons.emplace_back(face.begin(), face.end());
  return mesh;
}

/// The same by the name under which write_vtk_grains looks for the mesh of a shape.
[[nodiscard]] inline SurfaceMesh grain_mesh(const shape::Polyhedron& body, int = 0) { return polyhedron_mesh(body); }

}  // namespace dem::io
