#pragma once

#include <dem/geometry/mass_properties.hpp>

#include <span>
#include <vector>

namespace dem {

/// Volume integrals of the solid inside closed faces (any polyhedron, convex or not), whose corners run
/// counter-clockwise seen from outside. Each face is cut into triangles, each triangle makes a tetrahedron with a point
/// inside, and the integrals of 1, x and x x^T over a tetrahedron with corners 0, a, b, c are
///   V = a . (b x c)/6,   V s/4,   V (s s^T + a a^T + b b^T + c c^T)/20   with s = a + b + c.
/// A volume below zero says that the faces are turned inside out.
inline MassProperties polyhedron_mass_properties(std::span<const Vec3> corners,
                                                 std::span<const std::vector<int>> faces) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : corners) middle += p / static_cast<double>(corners.size());
  const auto corner = [&](int k) -> Vec3 { return corners[static_cast<std::size_t>(k)] - middle; };
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& face : faces) {
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Vec3 a = corner(face[0]), b = corner(face[k - 1]), c = corner(face[k]), s = a + b + c;
      const double v = a.dot(cross(b, c)) / 6.0;
      volume += v;
      first += v / 4.0 * s;
      second += v / 20.0 * (outer(s, s) + outer(a, a) + outer(b, b) + outer(c, c));
    }
  }
  const Vec3 offset = volume != 0.0 ? Vec3(first / volume) : Vec3(Vec3::Zero());
  const Mat3 about_centre = second - outer(volume * offset, offset);
  return {volume, middle + offset, scaled_identity(about_centre.trace()) - about_centre};
}

}  // namespace dem
