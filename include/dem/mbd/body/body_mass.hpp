#pragma once

#include <dem/core/error.hpp>
#include <dem/geometry/mass_properties.hpp>
#include <dem/geometry/mesh/mesh_topology.hpp>

#include <array>
#include <cstdint>
#include <numbers>
#include <span>

namespace dem::mbd {

/// Mass, centre of mass and inertia of a rigid body in axes of the user's choice.
struct BodyMass {
  double mass = 0.0;                   ///< kg
  Vec3 centre_of_mass = Vec3::Zero();  ///< m, in the user's frame
  Mat3 inertia = Mat3::Zero();         ///< kg m^2, about the centre of mass, in the user's axes

  /// The same body shifted and turned in the user's frame: x -> shift + turn x.
  BodyMass moved(const Vec3& shift, const Mat3& turn = Mat3::Identity()) const {
    return {mass, shift + turn * centre_of_mass, turn * inertia * turn.transpose()};
  }
};

/// Inertia of a point mass at r about the origin: m (r.r I - r r^T), the parallel axis theorem.
inline Mat3 steiner(double mass, const Vec3& r) {
  return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

/// Two bodies welded together; subtract one with a negative mass.
inline BodyMass operator+(const BodyMass& a, const BodyMass& b) {
  BodyMass sum;
  sum.mass = a.mass + b.mass;
  sum.centre_of_mass = (a.mass * a.centre_of_mass + b.mass * b.centre_of_mass) / sum.mass;
  sum.inertia = a.inertia + steiner(a.mass, a.centre_of_mass - sum.centre_of_mass) + b.inertia +
                steiner(b.mass, b.centre_of_mass - sum.centre_of_mass);
  return sum;
}

/// From volume integrals and a density (kg/m^3).
inline BodyMass of_density(const MassProperties& volume, double density) {
  require_positive(density, "density", "kg/m^3");
  require_positive(volume.volume, "volume", "m^3");
  return {density * volume.volume, volume.centre, density * volume.inertia};
}

/// A box with full edges `size` (m), centred on the origin; density in kg/m^3.
inline BodyMass box_mass(const Vec3& size, double density) {
  require_positive(size.minCoeff(), "smallest edge of a box", "m");
  return of_density(box_mass_properties(size), density);
}

/// A full cylinder about the z axis, centred on the origin (m, kg/m^3).
inline BodyMass cylinder_mass(double radius, double length, double density) {
  require_positive(radius, "radius of a cylinder", "m");
  require_positive(length, "length of a cylinder", "m");
  const double m = require_positive(density, "density", "kg/m^3") * std::numbers::pi * radius * radius * length;
  const double across = m * (3.0 * radius * radius + length * length) / 12.0;
  return {m, Vec3::Zero(), Vec3(across, across, 0.5 * m * radius * radius).asDiagonal()};
}

/// A full sphere about the origin (m, kg/m^3).
inline BodyMass sphere_mass(double radius, double density) {
  require_positive(radius, "radius of a sphere", "m");
  return of_density(sphere_mass_properties(radius), density);
}

/// A closed triangle mesh (corners counter-clockwise seen from outside), of density in kg/m^3. Throws Error if a corner
/// index is out of range, the volume is not positive, or the mesh is not closed: what an open one encloses is anything.
inline BodyMass mesh_mass(const IndexedMesh& mesh, double density) {
  const BodyMass mass = of_density(mesh_mass_properties(mesh), density);
  const MeshTopology topology = topology_of(mesh);
  if (!topology.closed() || !topology.oriented()) {
    fail(
        "a mesh of a body is not closed: {} of its edges belong to one triangle only, {} to three or more, and along "
        "{} "
        "the two triangles look different ways; merge its vertices and turn its triangles with repaired(), and close "
        "the holes",
        topology.boundary_edges, topology.non_manifold_edges, topology.inconsistent_edges);
  }
  return mass;
}
inline BodyMass mesh_mass(std::span<const Vec3> vertices, std::span<const std::array<std::uint32_t, 3>> triangles,
                          double density) {
  return mesh_mass(IndexedMesh{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}}, density);
}

}  // namespace dem::mbd
