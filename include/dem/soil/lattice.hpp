#pragma once

#include <dem/soil/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <numbers>
#include <random>
#include <vector>

// Grains before they are poured: lattices in which no two grains touch, over a box with the floor z = 0 and the middle
// x = y = 0. Random numbers come from std::mt19937_64, whose sequence the standard fixes, through functions of our own:
// the same seed gives the same lattice with every compiler.

namespace dem::soil {

/// A number in [0, 1) with 53 random bits.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

/// A rotation drawn evenly from all rotations (K. Shoemake, Graphics Gems III, 1992).
inline Mat3 random_rotation(std::mt19937_64& random) {
  const double u = uniform(random), a = 2.0 * std::numbers::pi * uniform(random),
               b = 2.0 * std::numbers::pi * uniform(random);
  const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
  return Quaternion(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b)).toRotationMatrix();
}

/// Radius (m) of the smallest sphere about a shape::cube8 of half-edge h.
inline double cube_bounding_radius(double half_edge) { return (0.5 * std::sqrt(3.0) + 0.5) * half_edge; }

namespace detail {

/// Room for `count` grains. Throws Error where there is none.
inline std::vector<Placement> places_for(std::size_t count) {
  constexpr std::size_t most = 100'000'000;  // as a packing file may hold
  if (count > most) fail("{} grains were asked for, but at most {} are placed at once", count, most);
  try {
    return std::vector<Placement>(count);
  } catch (const std::bad_alloc&) {
    fail("the places of {} grains alone need {:.2g} GB of memory, more than there is; ask for fewer", count,
         1e-9 * static_cast<double>(count * sizeof(Placement)));
  }
}

/// How many cells fit into a length, at most 2^53: as far as doubles count.
inline std::uint64_t cells_in(double length, double cell) {
  return static_cast<std::uint64_t>(std::min(length / cell, 0x1.0p53));
}

/// Throws Error unless the box has a floor.
inline void require_floor(double length_x, double length_y) {
  require_positive(length_x, "length of a box along x", "m");
  require_positive(length_y, "length of a box along y", "m");
}

}  // namespace detail

/// Grains in a simple cubic lattice that fills the box from the floor up, each turned at random and shifted by up to
/// half of the room between bounding spheres: a loose cloud to be rained. `room` is that room in bounding diameters,
/// `bounding_radius` (m) is that of a shape::cube8 unless given. Throws Error for lengths that are not positive and
/// finite, if not even one grain fits beside the walls, and for more than 100 million grains.
inline std::vector<Placement> random_lattice(std::size_t count, double half_edge, double length_x, double length_y,
                                             std::uint64_t seed, double room = 0.05, double bounding_radius = 0.0) {
  require_positive(half_edge, "half-edge of a grain", "m");
  require_non_negative(room, "room between grains", "bounding diameters");
  require_non_negative(bounding_radius, "bounding radius of a grain (0: that of cube8)", "m");
  detail::require_floor(length_x, length_y);
  const double radius = bounding_radius > 0.0 ? bounding_radius : cube_bounding_radius(half_edge);
  const double cell = 2.0 * (1.0 + room) * radius;
  const std::uint64_t nx = detail::cells_in(length_x, cell), ny = detail::cells_in(length_y, cell);
  if (nx < 1 || ny < 1) {
    fail("a box of {:g} m x {:g} m has no place for a grain that needs {:g} m; lower the half-edge or enlarge the box",
         length_x, length_y, cell);
  }
  std::mt19937_64 random(seed);
  const double free = cell - 2.0 * radius;
  std::vector<Placement> grains = detail::places_for(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vec3 corner(static_cast<double>(i % nx) / static_cast<double>(nx) * length_x - 0.5 * length_x,
                      static_cast<double>(i / nx % ny) / static_cast<double>(ny) * length_y - 0.5 * length_y,
                      static_cast<double>(i / nx / ny) * cell);
    // Cells are stretched to fill the box; a grain's own cube of side `cell` sits in the middle of its cell.
    const Vec3 middle(0.5 * length_x / static_cast<double>(nx), 0.5 * length_y / static_cast<double>(ny), 0.5 * cell);
    const double dx = uniform(random), dy = uniform(random), dz = uniform(random);
    grains[i].position = corner + middle + free * Vec3(dx - 0.5, dy - 0.5, dz - 0.5);
    grains[i].rotation = random_rotation(random);
  }
  return grains;
}

/// The thesis's start: grains in a regular block, all turned alike, the whole block tilted by the same angle (rad)
/// about x, y and z. The block is as wide as the box allows, but no wider than one layer of all grains, and as tall as
/// it must be; its lowest corner hangs a half-edge above the floor. `pitch` is the lattice constant in cube edges.
/// Throws Error for lengths that are not positive and finite, if no block fits, and for more than 100 million grains.
inline std::vector<Placement> tilted_block(std::size_t count, double half_edge, double length_x, double length_y,
                                           double tilt, double pitch = 1.02) {
  require_positive(half_edge, "half-edge of a grain", "m");
  require_within(tilt, 0.0, 0.5 * std::numbers::pi, "tilt of the block (rad)");
  require_within(pitch, 1.0, 10.0, "pitch of the block in cube edges");
  detail::require_floor(length_x, length_y);
  std::vector<Placement> grains = detail::places_for(count);
  const double cell = 2.0 * half_edge * pitch;
  const Mat3 turn = (Quaternion(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitZ())) *
                     Quaternion(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY())) *
                     Quaternion(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX())))
                        .toRotationMatrix();
  const Mat3 size = turn.cwiseAbs();
  const auto one_layer = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::uint64_t n = std::min(detail::cells_in(std::min(length_x, length_y), cell), one_layer); n >= 1; --n) {
    const std::uint64_t layers = (count + n * n - 1) / (n * n);
    const Vec3 edges = cell * Vec3(static_cast<double>(n), static_cast<double>(n), static_cast<double>(layers));
    const Vec3 extent = size * edges;
    if (extent.x() > length_x || extent.y() > length_y) continue;
    for (std::uint64_t i = 0; i < count; ++i) {
      const Vec3 in_block(static_cast<double>(i % n) + 0.5, static_cast<double>(i / n % n) + 0.5,
                          static_cast<double>(i / (n * n)) + 0.5);
      grains[i].position = turn * (cell * in_block - 0.5 * edges) + Vec3(0, 0, 0.5 * extent.z() + half_edge);
      grains[i].rotation = turn;
    }
    return grains;
  }
  if (count == 0) return grains;
  fail(
      "a block of {} grains tilted by {:g} rad fits nowhere in a box of {:g} m x {:g} m; lower the tilt or the number "
      "of "
      "grains",
      count, tilt, length_x, length_y);
}

}  // namespace dem::soil
