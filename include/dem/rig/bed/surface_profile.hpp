#pragma once
// The surface of a bed across a track, and the ruts in it.

#include <dem/rig/steady_window.hpp>
#include <dem/soil/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace dem::rig {

/// Heights of a bed's surface in strips along x.
struct SurfaceProfile {
  std::vector<double> y = {}, z = {};  ///< m; empty where there is too little of the bed
  [[nodiscard]] double strip() const { return y.size() > 1 ? y[1] - y[0] : 0.0; }  ///< m, width of one
};

/// The surface between two places along x and two along y (m), in strips as wide as a grain is long: the mean, over
/// cells of that size along x, of the highest grain's middle plus its half-edge (m). A cell without grains is the
/// floor.
inline SurfaceProfile surface_profile(std::span<const soil::Placement> grains, double half_edge, double from_x,
                                      double to_x, double from_y, double to_y) {
  const double edge = 2.0 * half_edge;
  SurfaceProfile p;
  const auto nx = static_cast<std::size_t>(std::max(0.0, (to_x - from_x) / edge));
  const auto ny = static_cast<std::size_t>(std::max(0.0, (to_y - from_y) / edge));
  if (nx < 2 || ny < 2) return p;
  std::vector<double> highest(nx * ny, 0.0);
  const double cell = (to_y - from_y) / static_cast<double>(ny);
  for (const auto& g : grains) {
    const double x = (g.position.x() - from_x) / edge, y = (g.position.y() - from_y) / cell;
    if (!(x >= 0.0 && x < static_cast<double>(nx) && y >= 0.0 && y < static_cast<double>(ny))) continue;
    double& z = highest[static_cast<std::size_t>(y) * nx + static_cast<std::size_t>(x)];
    z = std::max(z, g.position.z() + half_edge);
  }
  for (std::size_t j = 0; j < ny; ++j) {
    p.y.push_back(from_y + (static_cast<double>(j) + 0.5) * cell);
    p.z.push_back(mean_of(std::span(highest).subspan(j * nx, nx)).mean);
  }
  return p;
}

/// Mean height (m) of surfaces: what sinkage and ruts are measured from. Not a number where there is none.
inline double mean_surface(std::span<const SurfaceProfile> profiles) {
  double sum = 0.0, count = 0.0;
  for (const SurfaceProfile& p : profiles) {
    for (const double z : p.z) sum += z, count += 1.0;
  }
  return sum / count;
}

/// A rut across a track.
struct Rut {
  double depth = std::nan("");  ///< m: the mean over the middle half of the tool's width; NaN: there is none to see
  double width =
      std::nan("");  ///< m, of the strips that hang together there and sank by more than half of that depth; NaN: none
};

/// The rut that a tool of this width (m), whose middle went along y = `middle`, left: the surface after it against the
/// surface before.
inline Rut rut_between(const SurfaceProfile& before, const SurfaceProfile& after, double middle, double tool) {
  Rut rut;
  if (before.z.size() != after.z.size() || before.z.empty()) return rut;
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < before.z.size(); ++k) {
    if (std::abs(before.y[k] - middle) < 0.25 * tool) sum += before.z[k] - after.z[k], count += 1.0;
  }
  if (count == 0.0) return rut;
  rut.depth = sum / count;
  if (!(rut.depth > 0.0)) return rut;
  rut.width = 0.0;
  // The largest such group of strips that reaches under the tool: a hollow beside the track is none of the rut.
  double together = 0.0;
  bool is_under = false;
  for (std::size_t k = 0; k < before.z.size(); ++k) {
    const bool sank = before.z[k] - after.z[k] > 0.5 * rut.depth;
    together = sank ? together + before.strip() : 0.0;
    is_under = sank && (is_under || std::abs(before.y[k] - middle) < 0.5 * tool);
    if (is_under) rut.width = std::max(rut.width, together);
  }
  return rut;
}

}  // namespace dem::rig
