#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mass_properties.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace dem {

struct Ball {
  Vec3 centre;    ///< m
  double radius;  ///< m
};

/// Volume integrals of a union of balls, overlapping parts counted once: the union is cut into columns of a square
/// grid, and each column integrated exactly along its axis. With the default grid the error is up to 2e-4 of the
/// volume.
MassProperties union_mass_properties(std::span<const Ball> balls, int columns_per_edge = 400);

/// Whether two balls share more than a contact point: overlaps of less than a millionth of the smaller radius, whose
/// volume is lost in rounding, count as one.
bool any_overlap(std::span<const Ball> balls);

/// Volume integrals of balls that do not overlap, by Steiner's theorem: exact.
MassProperties separate_mass_properties(std::span<const Ball> balls);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE MassProperties union_mass_properties(std::span<const Ball> balls, int columns_per_edge) {
  Vec3 low = filled(1e300), high = -low;
  for (const Ball& b : balls) {
    low = lower(low, b.centre - filled(b.radius));
    high = upper(high, b.centre + filled(b.radius));
  }
  const double dx = (high.x() - low.x()) / columns_per_edge, dy = (high.y() - low.y()) / columns_per_edge;
  double m = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  std::vector<std::pair<double, double>> spans;
  for (int i = 0; i < columns_per_edge; ++i) {
    for (int j = 0; j < columns_per_edge; ++j) {
      const double x = low.x() + (i + 0.5) * dx, y = low.y() + (j + 0.5) * dy;
      spans.clear();
      for (const Ball& b : balls) {
        const double u = x - b.centre.x(), v = y - b.centre.y();
        const double h2 = b.radius * b.radius - u * u - v * v;
        if (h2 > 0.0) spans.emplace_back(b.centre.z() - std::sqrt(h2), b.centre.z() + std::sqrt(h2));
      }
      std::sort(spans.begin(), spans.end());
      for (std::size_t k = 0; k < spans.size();) {
        double from = spans[k].first, to = spans[k].second;
        while (++k < spans.size() && spans[k].first <= to) to = std::max(to, spans[k].second);
        const double l = to - from, l2 = (to * to - from * from) / 2, l3 = (to * to * to - from * from * from) / 3;
        m += l;
        first += Vec3(x * l, y * l, l2);
        second += (Mat3() << x * x * l, x * y * l, x * l2, x * y * l, y * y * l, y * l2, x * l2, y * l2, l3).finished();
      }
    }
  }
  const double cell = dx * dy;
  MassProperties p;
  p.volume = m * cell;
  p.centre = first / m;
  const Mat3 about_centre = cell * second - outer(p.volume * p.centre, p.centre);
  p.inertia = scaled_identity(about_centre.trace()) - about_centre;
  return p;
}

DEM_INLINE bool any_overlap(std::span<const Ball> balls) {
  for (std::size_t k = 0; k < balls.size(); ++k) {
    for (std::size_t m = 0; m < k; ++m) {
      const double r = balls[k].radius, s = balls[m].radius;
      if ((balls[k].centre - balls[m].centre).norm() < r + s - 1e-6 * std::min(r, s)) return true;
    }
  }
  return false;
}

DEM_INLINE MassProperties separate_mass_properties(std::span<const Ball> balls) {
  MassProperties p;
  for (const Ball& b : balls) {
    const double volume = sphere_mass_properties(b.radius).volume;
    p.volume += volume;
    p.centre += volume * b.centre;
  }
  p.centre /= p.volume;
  for (const Ball& b : balls) {
    const MassProperties ball = sphere_mass_properties(b.radius);
    const Vec3 arm = b.centre - p.centre;
    p.inertia += ball.inertia + ball.volume * (scaled_identity(arm.squaredNorm()) - outer(arm, arm));
  }
  return p;
}

}  // namespace dem

#endif
