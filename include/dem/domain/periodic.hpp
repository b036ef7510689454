#pragma once

#include <dem/geometry/surface.hpp>
#include <dem/math/eager.hpp>
#include <dem/math/vector.hpp>

#include <array>
#include <cmath>

namespace dem::domain {

/// Space that repeats itself in some directions: what leaves a cell on one side comes in on the other. The cell is
/// WorldOptions::domain, the directions are WorldOptions::periodic.
///
///     struct Sand : dem::Model { using Domain = dem::domain::Periodic; };
///     dem::World<Sand> world({.domain = {{{0, 0, 0}, {0.1, 0.1, 1}}}, .periodic = {.x = true, .y = true}});
///
/// Positions are put back into the cell when neighbours are listed, so that between lists a grain may be beyond it by
/// half the skin. Surfaces of machine parts act across borders. Bodies do not touch each other there, and their
/// positions are not put back: a wheel may roll through any number of cells.
class Periodic {
 public:
  using Cell = Periodic;  ///< the kind of cell, whoever shares its grains
  static constexpr bool has_images = true, has_ranks = false;

  Periodic() = default;
  /// Directions that repeat have finite corners, low < high.
  Periodic(const surface::Aabb& cell, const std::array<bool, 3>& repeats) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!repeats[k]) continue;
      low_[k] = cell.low.data()[k];
      period_[k] = cell.high.data()[k] - cell.low.data()[k];
    }
  }

  /// m, along each axis; 0 where space is open.
  const std::array<double, 3>& period() const { return period_; }
  double low(std::size_t axis) const { return low_[axis]; }

  /// A point's image in the cell. What is not finite stays.
  Vector3<double> wrapped(const Vector3<double>& x) const {
    return {wrapped(x.x, 0), wrapped(x.y, 1), wrapped(x.z, 2)};
  }

  /// Calls f(image) for a point and its images in the cells around.
  template <class F>
  void for_each_image(const Vec3& x, F&& f) const {
    const auto cells = [&](std::size_t k) { return period_[k] > 0.0 ? 1 : 0; };
    for (int k = -cells(2); k <= cells(2); ++k) {
      for (int j = -cells(1); j <= cells(1); ++j) {
        for (int i = -cells(0); i <= cells(0); ++i) f(Vec3(x + Vec3(i * period_[0], j * period_[1], k * period_[2])));
      }
    }
  }

  /// The image of x that is nearest to another point.
  Vector3<double> beside(const Vector3<double>& x, const Vector3<double>& y) const {
    const auto image = [&](double a, double b, std::size_t k) {
      return period_[k] == 0.0 ? a : a + period_[k] * std::round((b - a) / period_[k]);
    };
    return {image(x.x, y.x, 0), image(x.y, y.y, 1), image(x.z, y.z, 2)};
  }

  /// Whether a thing that extends so far (m) is met as one image at a time by grains that reach so far. Larger ones,
  /// as a floor, stand as they are and fill the cell.
  bool repeats(std::size_t axis, double extent, double reach) const { return extent + 2.0 * reach < period_[axis]; }

  /// The image of x that is nearest to the middle of a box, in the directions in which the box repeats.
  Vector3<double> nearest(const Vector3<double>& x, const Vec3& low, const Vec3& high, double reach) const {
    return {nearest(x.x, 0, low, high, reach), nearest(x.y, 1, low, high, reach), nearest(x.z, 2, low, high, reach)};
  }

  /// Whether box a and any image of box b, which is widened by the reach already, share a point.
  bool boxes_overlap(const Vec3& low_a, const Vec3& high_a, const Vec3& low_b, const Vec3& high_b, double reach) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const double *la = low_a.data(), *ha = high_a.data(), *lb = low_b.data(), *hb = high_b.data();
      double shift = 0.0;
      if (repeats(k, hb[k] - lb[k], reach)) shift = period_[k] * std::ceil((la[k] - hb[k]) / period_[k]);
      if (!(la[k] <= hb[k] + shift && lb[k] + shift <= ha[k])) return false;
    }
    return true;
  }

  template <class V>
  void fields(V& v) {
    for (std::size_t k = 0; k < 3; ++k) {
      constexpr const char *from[] = {"from_x", "from_y", "from_z"}, *by[] = {"period_x", "period_y", "period_z"};
      v.given(from[k], low_[k], "m"), v.given(by[k], period_[k], "m");
    }
  }

 private:
  double wrapped(double x, std::size_t k) const {
    if (period_[k] == 0.0 || (x >= low_[k] && x < low_[k] + period_[k])) return x;
    const double inside = x - period_[k] * std::floor((x - low_[k]) / period_[k]);
    return inside >= low_[k] + period_[k] ? low_[k] : inside;  // where rounding leads to the upper border
  }
  double nearest(double x, std::size_t k, const Vec3& low, const Vec3& high, double reach) const {
    const double l = low.data()[k], h = high.data()[k];
    if (!repeats(k, h - l, reach)) return x;
    return x + period_[k] * std::round((0.5 * (l + h) - x) / period_[k]);
  }

  std::array<double, 3> low_ = {0, 0, 0}, period_ = {0, 0, 0};
};

}  // namespace dem::domain
