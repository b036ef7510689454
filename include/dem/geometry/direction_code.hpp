#pragma once

#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>

namespace dem::surface {

/// The last bits of a feature say roughly where the normal points, on surfaces that may be touched in several places at
/// once. The code is the square of a cube around the unit sphere that the normal goes through. Each side of the cube is
/// cut into 6 x 6 squares, of 25 degrees from corner to corner at most. By the code a contact is found again among its
/// neighbours (coupling::follow_turns). Two contacts in one square take consecutive numbers.
inline constexpr int direction_bits = 8;
inline constexpr std::uint32_t directions = 216;

DEM_HOT std::uint32_t direction_code(const Vector3<double>& n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const auto cell = [](double along, double longest) {
    return static_cast<std::uint32_t>(std::min(5, static_cast<int>(3.0 * along / longest + 3.0)));
  };
  if (z >= x && z >= y) return (n.z > 0.0 ? 36u : 0u) + 6u * cell(n.x, z) + cell(n.y, z);
  if (y >= x) return (n.y > 0.0 ? 108u : 72u) + 6u * cell(n.x, y) + cell(n.z, y);
  return (n.x > 0.0 ? 180u : 144u) + 6u * cell(n.y, x) + cell(n.z, x);
}
/// The middle of the square.
inline Vector3<double> direction_of(std::uint32_t code) {
  code = std::min(code, directions - 1u);
  const std::uint32_t side = code / 36u, place = code % 36u;
  const double along = (place / 6u - 2.5) / 3.0, across = (place % 6u - 2.5) / 3.0, out = side % 2u == 1u ? 1.0 : -1.0;
  const Vector3<double> d = side < 2u   ? Vector3<double>{along, across, out}
                            : side < 4u ? Vector3<double>{along, out, across}
                                        : Vector3<double>{out, along, across};
  return (1.0 / norm(d)) * d;
}

/// A surface whose features end in the direction of their contact; what comes before is a name that contacts share.
template <class S>
concept NamesDirections = S::names_directions;

/// The name that contacts share, without the direction; of other surfaces the whole feature.
template <class S>
constexpr std::uint32_t family_of(std::uint32_t feature) {
  if constexpr (NamesDirections<S>) {
    return feature >> direction_bits;
  } else {
    return feature;
  }
}

}  // namespace dem::surface
