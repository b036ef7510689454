#pragma once

// Bodies made from closed meshes. Not among what <dem/mbd/mbd.hpp> includes: meshes cost compiling time.

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_mass_properties.hpp>
#include <dem/geometry/mesh/mesh_repair.hpp>
#include <dem/mbd/body/body_spec.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace dem::mbd {

/// A closed triangle mesh, of density in kg/m^3. Pieces that look inward are turned round; a piece within another is a
/// cavity if it looks the other way. Pieces that overlap count twice where they do. A mesh that is not closed as it is,
/// as that of an STL file, is `repaired` first. Throws Error as `repaired` does, or if it is not closed then either:
/// what an open one encloses is anything.
DEM_LAZY BodyMass mesh_mass(const IndexedMesh& mesh, double density);
DEM_LAZY BodyMass mesh_mass(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
                            double density);

/// A solid that a closed mesh encloses, in the frame of the mesh (kg/m^3). Throws Error if the mesh is open or encloses
/// no volume.
DEM_LAZY BodySpec mesh_body(std::string name, const IndexedMesh& mesh, double density);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_LAZY_INLINE BodyMass mesh_mass(const IndexedMesh& mesh, double density) {
  check_indices(mesh);
  const MeshTopology given = topology_of(mesh);
  if (given.closed()) {  // solids that touch stay apart
    IndexedMesh solid = mesh;
    dem::detail::orient(solid, MeshFacing::outward);
    if (topology_of(solid).oriented()) return of_density(mesh_mass_properties(solid), density);
  }
  const auto [solid, report] = repaired(mesh);
  if (!report.closed() || !report.oriented()) {
    fail(
        "a mesh of a body is not closed: {} of its edges belong to one triangle only, {} to three or more, and along "
        "{} the two triangles look different ways; close the holes, and split what meets in an edge",
        report.boundary_edges, report.non_manifold_edges, report.inconsistent_edges);
  }
  return of_density(mesh_mass_properties(solid), density);
}

DEM_LAZY_INLINE BodyMass mesh_mass(std::span<const Vec3> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles, double density) {
  return mesh_mass(IndexedMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}}, density);
}

DEM_LAZY_INLINE BodySpec mesh_body(std::string name, const IndexedMesh& mesh, double density) {
  return detail::made_of(std::move(name), [&] { return mesh_mass(mesh, density); });
}

}  // namespace dem::mbd

#endif
