#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::soil {

/// Where a grain is.
struct Placement {
  Vec3 position = Vec3::Zero();      ///< m, centre of mass
  Mat3 rotation = Mat3::Identity();  ///< grain frame -> global
  template <class V>
  void fields(V& v) {
    v("position", position, "m"), v("rotation", rotation);
  }
};

/// Grains of one size at rest in a box: what a rig starts from. The floor of the box is z = 0, its middle is x = y = 0.
struct Packing {
  double half_edge = 0.0;  ///< m, of the cubical grain (shape::cube8)
  double length_x = 0.0;   ///< m, inner size of the box
  double length_y = 0.0;   ///< m
  std::string note = {};   ///< one line: how it was made
  std::vector<Placement> grains = {};
  std::string shape = "cube8";  ///< of the grains, in one word
  template <class V>
  void fields(V& v) {
    v("half_edge", half_edge, "m"), v("length_x", length_x, "m"), v("length_y", length_y, "m"), v("note", note);
    v("grains", grains), v("shape", shape);
  }
};

/// Volume (m^3) of a grain: that of the solid cube of edge 2 h, which is also what gives it its mass.
inline double cube_volume(double half_edge) { return 8.0 * half_edge * half_edge * half_edge; }

namespace detail {

/// Throws Error unless all heights are finite: an order among numbers that are none is no order.
inline void require_heights(std::span<const Placement> grains) {
  for (std::size_t k = 0; k < grains.size(); ++k) {
    const double z = grains[k].position.z();
    if (!std::isfinite(z)) fail("grain {} of a packing is at the height {:g} m, but must be somewhere", k, z);
  }
}

}  // namespace detail

/// The height (m) below which the given share of the grains' centres lie. Throws Error without grains, or if one of
/// them has no finite height.
inline double height_percentile(std::span<const Placement> grains, double share) {
  require_within(share, 0.0, 1.0, "share of the grains");
  if (grains.empty()) fail("no grains, so there is no height to find; add some");
  detail::require_heights(grains);
  std::vector<double> z;
  z.reserve(grains.size());
  for (const Placement& g : grains) z.push_back(g.position.z());
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(z.size() - 1) + 0.5);
  std::nth_element(z.begin(), z.begin() + k, z.end());
  return z[static_cast<std::size_t>(k)];
}

/// Takes the highest grains off, a share of all of them, as a straight edge levels a specimen; the others keep their
/// order. Throws Error for a share that is not from 0 to 1, and a grain without a finite height.
inline void strike_off(std::vector<Placement>& grains, double share) {
  require_within(share, 0.0, 1.0, "share of the grains to strike off");
  detail::require_heights(grains);
  const auto kept = grains.size() - static_cast<std::size_t>(share * static_cast<double>(grains.size()));
  if (kept == grains.size()) return;
  std::vector<std::size_t> by_height(grains.size());
  std::iota(by_height.begin(), by_height.end(), std::size_t{0});
  std::stable_sort(by_height.begin(), by_height.end(),
                   [&](std::size_t a, std::size_t b) { return grains[a].position.z() < grains[b].position.z(); });
  by_height.resize(kept);
  std::sort(by_height.begin(), by_height.end());
  std::vector<Placement> left;
  for (const std::size_t k : by_height) left.push_back(grains[k]);
  grains = std::move(left);
}

/// Where the grains of a world are, in the order of their ids.
template <class World>
std::vector<Placement> placements(const World& world) {
  std::vector<Placement> grains;
  for (const GrainId p : world.grains()) grains.push_back({world.position(p), world.rotation(p)});
  return grains;
}

}  // namespace dem::soil
