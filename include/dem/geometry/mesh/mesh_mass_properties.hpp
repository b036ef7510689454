#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mass_properties.hpp>
#include <dem/geometry/mesh/indexed_mesh.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace dem {

/// A closed triangle mesh, by summing the signed tetrahedra that the triangles span with the first vertex. Throws Error
/// if a corner index is out of range or the volume is not positive.
MassProperties mesh_mass_properties(std::span<const Vec3> vertices,
                                    std::span<const std::array<std::uint32_t, 3>> triangles);
inline MassProperties mesh_mass_properties(const IndexedMesh& mesh) {
  return mesh_mass_properties(mesh.vertices, mesh.triangles);
}

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE MassProperties mesh_mass_properties(std::span<const Vec3> vertices,
                                               std::span<const std::array<std::uint32_t, 3>> triangles) {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();   // integral of x
  Mat3 second = Mat3::Zero();  // integral of x x^T
  for (const auto& t : triangles) {
    for (const auto corner : t) {
      if (corner >= vertices.size()) {
        fail("a triangle of a mesh names corner {}, but there are {} vertices", corner, vertices.size());
      }
    }
    // Relative to the first vertex, so that a mesh far from the origin loses no digits.
    const Vec3 a = vertices[t[0]] - vertices[0], b = vertices[t[1]] - vertices[0], c = vertices[t[2]] - vertices[0];
    const double v = a.dot(cross(b, c)) / 6.0;
    const Vec3 sum = a + b + c;
    volume += v;
    first += v / 4.0 * sum;
    second += v / 20.0 * (outer(sum, sum) + outer(a, a) + outer(b, b) + outer(c, c));
  }
  if (!(volume > 0.0)) {
    fail(
        "a mesh encloses {:g} m^3, but a body needs a positive volume: close the mesh and order the corners of each "
        "triangle counter-clockwise seen from outside",
        volume);
  }
  const Vec3 c = first / volume;
  const Mat3 covariance = second - outer(volume * c, c);
  return {volume, c + vertices[0], scaled_identity(covariance.trace()) - covariance};
}

}  // namespace dem

#endif
