#pragma once

#include <dem/soil/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace dem::soil {

/// One place of a surface that is looked at from above.
struct SurfacePoint {
  double x, y;  ///< m
  double z;     ///< m; 0 where there is no grain
};

/// Heights over a strip of ground that grows along x, as a bed does that a machine drives over: the highest place of
/// the grains over each cell of a square lattice. Grains count as balls.
struct HeightField {
  double x0 = 0.0, y0 = 0.0;   ///< m, corner of the first cell
  double cell = 1.0;           ///< m, edge of a cell
  std::size_t across = 1;      ///< cells along y
  std::vector<double> z = {};  ///< m, over the middles of the cells, row after row along x; NaN where there is no grain

  std::size_t along() const { return z.size() / across; }
  /// A ball of radius r (m) lies there; what it covers of the strip's ground, and beyond x0, grows by it.
  void add(const Vec3& at, double r) {
    const auto first = [&](double low) { return static_cast<std::ptrdiff_t>(std::ceil(low / cell - 0.5)); };
    const std::ptrdiff_t i0 = std::max<std::ptrdiff_t>(0, first(at.x() - r - x0)), i1 = first(at.x() + r - x0);
    const std::ptrdiff_t j0 = std::max<std::ptrdiff_t>(0, first(at.y() - r - y0));
    const std::ptrdiff_t j1 = std::min(static_cast<std::ptrdiff_t>(across), first(at.y() + r - y0));
    for (std::ptrdiff_t i = i0; i < i1; ++i) {
      if (static_cast<std::size_t>(i) >= along()) {
        z.resize((static_cast<std::size_t>(i) + 1) * across, std::numeric_limits<double>::quiet_NaN());
      }
      for (std::ptrdiff_t j = j0; j < j1; ++j) {
        const double dx = x0 + (static_cast<double>(i) + 0.5) * cell - at.x();
        const double dy = y0 + (static_cast<double>(j) + 0.5) * cell - at.y(), depth = r * r - dx * dx - dy * dy;
        if (!(depth > 0.0)) continue;
        double& here = z[static_cast<std::size_t>(i) * across + static_cast<std::size_t>(j)];
        const double top = at.z() + std::sqrt(depth);
        if (!(here >= top)) here = top;  // so that it replaces a NaN
      }
    }
  }
  template <class V>
  void fields(V& v) {
    v("x0", x0, "m"), v("y0", y0, "m"), v("cell", cell, "m"), v("across", across), v.numbers("z", z);
  }
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
