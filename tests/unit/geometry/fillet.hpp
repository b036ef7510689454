#pragma once

#include <dem/geometry/mesh/indexed_mesh.hpp>

#include <cmath>
#include <numbers>

/// A floor z = 0 and a wall x = 0, long in y, joined by a concave fillet of `radius` (m) cut into `pieces`; both end
/// `length` away from the corner.
inline dem::IndexedMesh fillet(double radius, int pieces, double length) {
  std::vector<dem::Vec3> profile = {{length, 0, 0}};
  for (int k = 0; k <= pieces; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / pieces;
    profile.emplace_back(radius * (1 - std::sin(angle)), 0, radius * (1 - std::cos(angle)));
  }
  profile.emplace_back(0, 0, length);
  dem::IndexedMesh mesh;
  for (const dem::Vec3& p : profile) {
    for (const double y : {-length, length}) mesh.vertices.push_back(p + dem::Vec3(0, y, 0));
  }
  for (std::uint32_t k = 0; k + 1 < profile.size(); ++k) mesh.add_quad(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2);
  return mesh;
}
