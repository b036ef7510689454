#pragma once

#include <dem/core/error.hpp>
#include <dem/soil/height_map.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace dem::soil {

/// A place on a slope: how far down the slope's line it is, and in which direction (or strip) of several.
struct SlopePoint {
  double s;  ///< m, along the slope's horizontal line: the distance from a heap's axis, or from a back wall
  double z;  ///< m; 0 where there is no grain
  std::size_t direction;  ///< from 0
};

/// What is taken as the flank: from where the mean profile first falls below `high` times its top to where it falls
/// below `low` times it. So neither the rounded top nor the foot, a grain or two thin, count.
struct FlankOptions {
  double low = 0.2, high = 0.8;
  std::size_t directions = 12;
};

/// Straight lines through a flank, one for each direction.
struct Flank {
  double angle = std::numeric_limits<double>::quiet_NaN();    ///< rad, mean over the directions; not known: NaN
  double scatter = std::numeric_limits<double>::quiet_NaN();  ///< rad, standard deviation over the directions
  double height = 0.0;                                        ///< m, of the mean profile's top
  double from = 0.0, to = 0.0;                                ///< m, of s: the flank
  std::vector<double> angles = {};                            ///< rad, of the directions that have a flank
  std::vector<double> profile_s = {}, profile_z = {};         ///< m, the mean profile
  template <class V>
  void fields(V& v) {
    v("angle", angle, "rad"), v("scatter", scatter, "rad"), v("height", height, "m"), v("from", from, "m");
    v("to", to, "m"), v("angles", angles), v("profile_s", profile_s), v("profile_z", profile_z);
  }
};

/// Fits the flank of a slope that falls with s: the mean profile over strips of `width` (m) says where the flank is,
/// and each direction's places in that range of s get a line of least squares, z over s. Places are chosen by s and not
/// by their height, as that would flatten the line. A direction with fewer than 5 places has no line.
inline Flank fit_flank(std::span<const SlopePoint> points, double width, const FlankOptions& o = {}) {
  require_positive(width, "width of a strip of a profile", "m");
  require_within(o.high, 0.0, 1.0, "upper share of a flank");
  require_within(o.low, 0.0, o.high, "lower share of a flank");
  Flank flank;
  std::vector<double> sum, count;
  for (const SlopePoint& p : points) {
    if (!(p.s >= 0.0)) continue;
    const auto k = static_cast<std::size_t>(p.s / width);
    if (k >= sum.size()) sum.resize(k + 1), count.resize(k + 1);
    sum[k] += p.z;
    count[k] += 1.0;
  }
  std::size_t top = 0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    flank.profile_s.push_back((static_cast<double>(k) + 0.5) * width);
    flank.profile_z.push_back(count[k] > 0.0 ? sum[k] / count[k] : 0.0);
    if (flank.profile_z[k] > flank.profile_z[top]) top = k;
  }
  if (sum.empty() || !(flank.profile_z[top] > 0.0)) return flank;
  flank.height = flank.profile_z[top];
  std::size_t k = top;
  while (k < sum.size() && flank.profile_z[k] > o.high * flank.height) ++k;
  flank.from = static_cast<double>(k) * width;
  while (k < sum.size() && flank.profile_z[k] > o.low * flank.height) ++k;
  flank.to = static_cast<double>(k) * width;

  for (std::size_t d = 0; d < o.directions; ++d) {
    double n = 0.0, s = 0.0, z = 0.0, ss = 0.0, sz = 0.0;
    for (const SlopePoint& p : points) {
      if (p.direction != d || !(p.z > 0.0) || p.s < flank.from || p.s > flank.to) continue;
      n += 1.0, s += p.s, z += p.z, ss += p.s * p.s, sz += p.s * p.z;
    }
    const double spread = n * ss - s * s;
    if (n < 5.0 || !(spread > 0.0)) continue;
    flank.angles.push_back(std::atan(-(n * sz - s * z) / spread));
  }
  if (flank.angles.empty()) return flank;
  double mean = 0.0, square = 0.0;
  for (const double a : flank.angles) mean += a / static_cast<double>(flank.angles.size());
  for (const double a : flank.angles) square += (a - mean) * (a - mean);
  flank.angle = mean;
  if (flank.angles.size() > 1) flank.scatter = std::sqrt(square / static_cast<double>(flank.angles.size() - 1));
  return flank;
}

/// The flank of a heap about the z axis on the plane z = 0: directions are sectors. `radius` (m) is that of a sphere of
/// a grain's volume, `reach` (m) how far out the heap is looked at.
inline Flank flank_of_heap(std::span<const Placement> grains, double radius, double reach, const FlankOptions& o = {}) {
  std::vector<SlopePoint> points;
  const auto sectors = static_cast<double>(o.directions);
  for (const SurfacePoint& p : height_map(grains, radius, reach)) {
    const double s = std::hypot(p.x, p.y);
    if (s > reach) continue;
    const double turn = 0.5 + std::atan2(p.y, p.x) / (2.0 * std::numbers::pi);
    points.push_back({s, p.z, std::min(static_cast<std::size_t>(sectors * turn), o.directions - 1)});
  }
  return fit_flank(points, 2.0 * radius, o);
}

/// The flank of a slope between the walls y = -half_width and half_width that falls along x, from x = back to x = foot
/// (m): directions are strips along x. The places next to the walls do not count.
inline Flank flank_of_slope(std::span<const Placement> grains, double radius, double back, double foot,
                            double half_width, const FlankOptions& o = {}) {
  std::vector<SlopePoint> points;
  const double half = half_width - 2.0 * radius, strips = static_cast<double>(o.directions);
  const double reach = std::max({std::abs(back), std::abs(foot), half_width});
  for (const SurfacePoint& p : height_map(grains, radius, reach)) {
    if (std::abs(p.y) > half || p.x < back || p.x > foot) continue;
    const auto strip = static_cast<std::size_t>(strips * 0.5 * (p.y + half) / half);
    points.push_back({p.x - back, p.z, std::min(strip, o.directions - 1)});
  }
  return fit_flank(points, 2.0 * radius, o);
}

}  // namespace dem::soil
