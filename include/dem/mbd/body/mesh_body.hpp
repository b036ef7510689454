#pragma once

// Bodies made from closed meshes. Not among what <dem/mbd/mbd.hpp> includes: meshes cost compiling time.

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_mass_properties.hpp>
#include <dem/geometry/mesh/mesh_topology.hpp>
#include <dem/mbd/body/body_spec.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace dem::mbd {

/// A closed triangle mesh (corners counter-clockwise seen from outside), of density in kg/m^3. Throws Error if a corner
/// index is out of range, the volume is not positive, or the mesh is not closed: what an open one encloses is anything.
DEM_LAZY inline BodyMass mesh_mass(const IndexedMesh& mesh, double density) {
  const BodyMass mass = of_density(mesh_mass_properties(mesh), density);
  const MeshTopology topology = topology_of(mesh);
  if (!topology.closed() || !topology.oriented()) {
    fail(
        "a mesh of a body is not closed: {} of its edges belong to one triangle only, {} to three or more, and along "
        "{} the two triangles look different ways; merge its vertices and turn its triangles with repaired(), and "
        "close the holes",
        topology.boundary_edges, topology.non_manifold_edges, topology.inconsistent_edges);
  }
  return mass;
}
DEM_LAZY inline BodyMass mesh_mass(std::span<const Vec3> vertices,
                                   std::span<const std::array<std::uint32_t, 3>> triangles, double density) {
  return mesh_mass(IndexedMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}}, density);
}

/// A solid that a closed mesh encloses, in the frame of the mesh (kg/m^3). Throws Error if the mesh is open or encloses
/// no volume.
DEM_LAZY inline BodySpec mesh_body(std::string name, const IndexedMesh& mesh, double density) {
  return detail::made_of(std::move(name), [&] { return mesh_mass(mesh, density); });
}

}  // namespace dem::mbd
