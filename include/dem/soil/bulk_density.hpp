#pragma once

#include <dem/soil/packing.hpp>

#include <cmath>
#include <span>

namespace dem::soil {

/// A box along the axes (m) in which something is measured.
struct Region {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  double volume() const { return (high - low).prod(); }
  /// Whether there is anything of it: a packing that is small beside the margin of inner_region has none.
  bool is_empty() const { return !((high - low).array() > 0.0).all(); }
};

/// Share of the region's volume that cubes of half-edge h (m) fill; grains that the region's border cuts count with
/// what lies inside: each cube is cut into `cuts`^3 parts, and a part counts where its middle is. Times the density of
/// the grains it is the bulk density. Throws Error for a region whose volume is not positive and finite.
inline double solid_fraction(std::span<const Placement> grains, double half_edge, const Region& region, int cuts = 4) {
  if (region.is_empty()) {
    fail(
        "the region to measure in has edges {:g}, {:g}, {:g} m, but all must be greater than zero; the packing is too "
        "small for it, so use more or smaller grains",
        region.high.x() - region.low.x(), region.high.y() - region.low.y(), region.high.z() - region.low.z());
  }
  require_positive(region.volume(), "volume of the region to measure in", "m^3");
  require_positive(half_edge, "half-edge of a grain", "m");
  require_within(cuts, 1, 64, "cuts of a cube");
  const double corner = std::sqrt(3.0) * half_edge;
  const Vec3 reach = Vec3::Constant(corner);
  const double part = 1.0 / (static_cast<double>(cuts) * cuts * cuts);
  double cubes = 0.0;
  for (const Placement& g : grains) {
    const auto x = g.position.array();
    if ((x <= (region.low - reach).array()).any() || (x >= (region.high + reach).array()).any()) continue;
    if ((x >= (region.low + reach).array()).all() && (x <= (region.high - reach).array()).all()) {
      cubes += 1.0;
      continue;
    }
    const auto at = [&](int k) { return half_edge * ((2.0 * k + 1.0) / cuts - 1.0); };
    for (int k = 0; k < cuts * cuts * cuts; ++k) {
      const Vec3 point = g.position + g.rotation * Vec3(at(k % cuts), at(k / cuts % cuts), at(k / (cuts * cuts)));
      const bool inside = (point.array() >= region.low.array()).all() && (point.array() < region.high.array()).all();
      cubes += inside ? part : 0.0;
    }
  }
  return cubes * cube_volume(half_edge) / region.volume();
}

/// The inside of a packing, `margin` (m) away from the walls, the floor, and the top. The top is a lid's underside if
/// that is given, else the height below which 90 % of the grains' centres lie.
inline Region inner_region(std::span<const Placement> grains, double length_x, double length_y, double margin,
                           double lid_height = -1.0) {
  const double top = lid_height > 0.0 ? lid_height : height_percentile(grains, 0.9);
  return {Vec3(margin - 0.5 * length_x, margin - 0.5 * length_y, margin),
          Vec3(0.5 * length_x - margin, 0.5 * length_y - margin, top - margin)};
}

/// Solid fraction of that inside, of grains of `volume` (m^3) that about fill cubes of half-edge h (m); NaN where there
/// is no inside. Where the border cuts a grain, its solid is taken as spread evenly over the cube.
inline double inner_fraction(std::span<const Placement> grains, double half_edge, double volume, double length_x,
                             double length_y, double margin, double lid_height = -1.0) {
  const Region region = inner_region(grains, length_x, length_y, margin, lid_height);
  if (region.is_empty()) return std::nan("");
  return solid_fraction(grains, half_edge, region) * volume / cube_volume(half_edge);
}

}  // namespace dem::soil
