#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/indexed_mesh.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

// Meshes that a line sweeps along z. They are centred at the origin.

namespace dem::mesh {

/// The blade of a screw (m): a closed solid that winds about z from -length/2, where it points along x, to length/2. It
/// reaches from the radius `inner` to `outer`, is `thickness` thick along z, and climbs by `pitch` a turn; it is
/// right-handed, or left-handed if the pitch is negative. `segments` (>= 8) is their number in a turn. Throws Error for
/// measures that are not positive, an `inner` that is not below `outer`, and a blade as thick as its pitch.
IndexedMesh helix(double inner, double outer, double pitch, double length, double thickness, int segments = 32);

/// The sheet that a profile of points (x, y) in m sweeps along z, from -length/2 to length/2: a trough, a chute, a
/// corrugated plate. Not closed: TriangleMesh takes it with MeshSide::two_sided. A profile that goes round
/// counter-clockwise shows its faces outwards. Throws Error for less than two points, two that are in one place, and a
/// length that is not positive.
IndexedMesh sheet(std::span<const std::array<double, 2>> profile, double length);

}  // namespace dem::mesh

#if DEM_DEFINES

namespace dem::mesh {

DEM_INLINE IndexedMesh helix(double inner, double outer, double pitch, double length, double thickness, int segments) {
  require_positive(inner, "inner radius of a helix", "m");
  require_positive(length, "length of a helix", "m");
  require_positive(thickness, "thickness of a helix", "m");
  require_positive(std::abs(pitch), "size of the pitch of a helix", "m");
  if (!(outer > inner)) fail("a helix goes from the radius {:g} m to {:g} m; let the second be larger", inner, outer);
  if (!(thickness < std::abs(pitch))) {
    fail("a helix is {:g} m thick, but its pitch is {:g} m; make it thinner than the pitch", thickness, pitch);
  }
  if (segments < 8) fail("a helix was asked for with {} segments a turn, but needs at least 8", segments);
  IndexedMesh m;
  const auto steps = static_cast<std::uint32_t>(std::ceil(segments * length / std::abs(pitch) - 1e-9));
  const double side = 0.5 * thickness;
  for (std::uint32_t k = 0; k <= steps; ++k) {
    const double z = length * (double(k) / steps - 0.5), a = 2.0 * std::numbers::pi * (z + 0.5 * length) / pitch;
    for (const auto& [r, dz] : {std::array{inner, -side}, {outer, -side}, {outer, side}, {inner, side}}) {
      m.vertices.emplace_back(r * std::cos(a), r * std::sin(a), z + dz);
    }
  }
  const auto at = [](std::uint32_t k, std::uint32_t corner) { return 4 * k + corner % 4; };
  for (std::uint32_t k = 0; k < steps; ++k) {
    // The upper side is cut along the same diagonals as the lower one, so that the blade is equally thick everywhere.
    for (const std::uint32_t c : {0, 1, 3}) m.add_quad(at(k + 1, c), at(k + 1, c + 1), at(k, c + 1), at(k, c));
    m.add_quad(at(k + 1, 3), at(k, 3), at(k, 2), at(k + 1, 2));
  }
  m.add_quad(at(0, 0), at(0, 1), at(0, 2), at(0, 3));
  m.add_quad(at(steps, 3), at(steps, 2), at(steps, 1), at(steps, 0));
  return pitch > 0.0 ? m : m.flipped();
}

DEM_INLINE IndexedMesh sheet(std::span<const std::array<double, 2>> profile, double length) {
  require_positive(length, "length of a sheet", "m");
  if (profile.size() < 2) fail("the profile of a sheet has {} points, but needs at least 2", profile.size());
  IndexedMesh m;
  for (std::uint32_t k = 0; k < profile.size(); ++k) {
    for (const double z : {-0.5 * length, 0.5 * length}) m.vertices.emplace_back(profile[k][0], profile[k][1], z);
    if (k == 0) continue;
    if (profile[k] == profile[k - 1]) fail("points {} and {} of a sheet's profile are in one place", k - 1, k);
    m.add_quad(2 * k - 2, 2 * k, 2 * k + 1, 2 * k - 1);
  }
  return m;
}

}  // namespace dem::mesh

#endif
