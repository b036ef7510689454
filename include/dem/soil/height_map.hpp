#pragma once

#include <dem/soil/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace dem::soil {

/// One place of a surface that is looked at from above.
struct SurfacePoint {
  double x, y;  ///< m
  double z;     ///< m; 0 where there is no grain
};

/// The upper side of a heap: vertical rays on a square lattice, and the highest grain that each of them meets. Grains
/// count as spheres of `radius` (m), that of their volume; rays are one radius apart, within `reach` (m) of the z axis
/// along x and y. Throws Error for a radius that is not positive, and for more than 10^8 rays.
inline std::vector<SurfacePoint> height_map(std::span<const Placement> grains, double radius, double reach) {
  require_positive(radius, "radius of a grain of a height map", "m");
  require_within(reach / radius, 1.0, 5000.0, "reach of a height map in radii of a grain");
  const auto half = static_cast<std::ptrdiff_t>(reach / radius), side = 2 * half + 1;
  std::vector<SurfacePoint> rays;
  rays.reserve(static_cast<std::size_t>(side * side));
  for (std::ptrdiff_t j = -half; j <= half; ++j) {
    for (std::ptrdiff_t i = -half; i <= half; ++i) {
      rays.push_back({static_cast<double>(i) * radius, static_cast<double>(j) * radius, 0.0});
    }
  }
  for (const Placement& g : grains) {
    if (!(std::abs(g.position.x()) < reach + radius && std::abs(g.position.y()) < reach + radius)) continue;
    const auto ci = static_cast<std::ptrdiff_t>(std::floor(g.position.x() / radius)),
               cj = static_cast<std::ptrdiff_t>(std::floor(g.position.y() / radius));
    for (std::ptrdiff_t j = std::max(cj - 1, -half); j <= std::min(cj + 2, half); ++j) {
      for (std::ptrdiff_t i = std::max(ci - 1, -half); i <= std::min(ci + 2, half); ++i) {
        SurfacePoint& ray = rays[static_cast<std::size_t>((j + half) * side + i + half)];
        const double dx = ray.x - g.position.x(), dy = ray.y - g.position.y();
        const double depth = radius * radius - dx * dx - dy * dy;
        if (depth > 0.0) ray.z = std::max(ray.z, g.position.z() + std::sqrt(depth));
      }
    }
  }
  return rays;
}

}  // namespace dem::soil
