#pragma once

#include <dem/core/error.hpp>
#include <dem/core/text.hpp>
#include <dem/math/fingerprint.hpp>
#include <dem/math/matrix3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// Heights of hard ground over points of a grid with equal spacing along x and y, straight lines between them. Beyond
/// the grid the ground goes on as high as at its edge.
class RoadHeights {
 public:
  /// The first point lies at (x0, y0), m; `heights` (m) are rows along y, one after the other along x, `across` points
  /// each. Throws Error for a grid of less than two points either way, a last row that is not full, or a height that is
  /// not finite.
  RoadHeights(double x0, double y0, double spacing, std::size_t across, std::vector<double> heights)
      : x0_(x0), y0_(y0), spacing_(spacing), across_(across), heights_(std::move(heights)) {
    require_positive(spacing, "spacing of the heights of a road", "m");
    if (!std::isfinite(x0) || !std::isfinite(y0)) fail("the heights of a road begin at ({:g}, {:g}) m", x0, y0);
    if (across < 2 || heights_.size() < 2 * across || heights_.size() % across != 0) {
      fail("a road has {} heights in rows of {}, but needs at least 2 full rows of at least 2", heights_.size(),
           across);
    }
    for (std::size_t k = 0; k < heights_.size(); ++k) {
      if (!std::isfinite(heights_[k])) fail("height {} of a road is not finite; give a height in m", k);
    }
  }

  /// f(x, y) over a rectangle from (x0, y0), all in m. The spacing is made smaller, so that it fits into length_x;
  /// along y the last row may lie up to a spacing beyond length_y. Throws Error for none or more than 1e8 cells.
  template <class F>
  static RoadHeights of(double x0, double y0, double length_x, double length_y, double spacing, F&& f) {
    require_positive(spacing, "spacing of the heights of a road", "m");
    require_positive(length_x, "length of the heights of a road along x", "m");
    require_positive(length_y, "length of the heights of a road along y", "m");
    const double count = length_x / spacing * (length_y / spacing);
    if (!(count >= 1.0 && count <= 1e8)) {
      fail("a road of {:g} m x {:g} m has {:g} cells of {:g} m, but must have 1 to 1e8; change the spacing", length_x,
           length_y, count, spacing);
    }
    const double cells = std::ceil(length_x / spacing * (1.0 - 1e-12)), fitted = length_x / cells;
    const auto along = static_cast<std::size_t>(cells) + 1;
    const auto across = static_cast<std::size_t>(std::ceil(length_y / fitted * (1.0 - 1e-12))) + 1;
    std::vector<double> heights;
    heights.reserve(along * across);
    for (std::size_t i = 0; i < along; ++i) {
      for (std::size_t j = 0; j < across; ++j) {
        heights.push_back(f(x0 + static_cast<double>(i) * fitted, y0 + static_cast<double>(j) * fitted));
      }
    }
    return RoadHeights(x0, y0, fitted, across, std::move(heights));
  }

  /// m, at a place (m).
  double operator()(double x, double y) const {
    const std::size_t along = heights_.size() / across_;
    const auto [i, u] = cell_of((x - x0_) / spacing_, along);
    const auto [j, v] = cell_of((y - y0_) / spacing_, across_);
    const double* h = &heights_[i * across_ + j];
    return (1.0 - u) * ((1.0 - v) * h[0] + v * h[1]) + u * ((1.0 - v) * h[across_] + v * h[across_ + 1]);
  }

  /// Words that differ where heights differ.
  std::string in_words() const {
    return text("{} heights in rows of {} every {} m from ({}, {}) m, hash {:016x}", heights_.size(), across_, spacing_,
                x0_, y0_, fingerprint_of(heights_));
  }

 private:
  /// The cell, and how far into it.
  static std::pair<std::size_t, double> cell_of(double at, std::size_t points) {
    const double within = std::clamp(at, 0.0, static_cast<double>(points - 1));
    const std::size_t cell = std::min(static_cast<std::size_t>(within), points - 2);
    return {cell, within - static_cast<double>(cell)};
  }

  double x0_, y0_, spacing_;
  std::size_t across_;
  std::vector<double> heights_;
};

/// Hard ground under tyres: a plane, or heights over x and y. Give one of them: add_tyre() refuses both.
struct Road {
  Vec3 point = Vec3::Zero();                        ///< m, of the plane
  Vec3 normal = Vec3::UnitZ();                      ///< out of the plane, of any length
  double friction = 1.0;                            ///< times the friction of a tyre
  std::shared_ptr<const RoadHeights> heights = {};  ///< in place of the plane, where given
  double print = 0.2;  ///< m, between points ahead and behind, left and right, that make the plane: a tyre does not
                       ///< follow what is shorter

  /// The plane that a wheel of a radius (m) with its middle at `centre` (m) stands on: the plane itself, or the one
  /// through four points about the print under the wheel.
  Road under(const Vec3& centre, double radius) const {
    if (!heights) return *this;
    // The print lies below the middle along the normal, which is known from a first look straight below it.
    Road plane = at(centre.x(), centre.y());
    const Vec3 foot = centre - radius * plane.normal;
    return at(foot.x(), foot.y());
  }

 private:
  Road at(double x, double y) const {
    const RoadHeights& h = *heights;
    const double a = 0.5 * print;
    const double ahead = h(x + a, y), behind = h(x - a, y), left = h(x, y + a), right = h(x, y - a);
    return {.point = Vec3(x, y, 0.25 * (ahead + behind + left + right)),
            .normal = Vec3((behind - ahead) / print, (right - left) / print, 1.0).normalized(),
            .friction = friction};
  }
};

/// Throws Error for a road that cannot be.
DEM_SETUP inline void check_road(const Road& road) {
  const Vec3 &p = road.point, &n = road.normal;
  require_non_negative(road.friction, "friction of a road", "(no unit)");
  require_positive(road.print, "print of a road under a tyre", "m");
  if (road.heights) {
    if (p == Vec3::Zero() && n == Vec3::UnitZ()) return;
    fail(
        "a road has heights, and a plane through ({:g}, {:g}, {:g}) m with the normal ({:g}, {:g}, {:g}) as well; give "
        "the heights alone, or the plane alone",
        p.x(), p.y(), p.z(), n.x(), n.y(), n.z());
  }
  if (!p.allFinite()) fail("a road goes through ({:g}, {:g}, {:g}) m; give a finite point", p.x(), p.y(), p.z());
  if (!n.allFinite() || !(n.norm() > 1e-9)) {
    fail("the normal of a road is ({:g}, {:g}, {:g}); give a finite direction out of the ground, such as (0, 0, 1)",
         n.x(), n.y(), n.z());
  }
}

}  // namespace dem::vehicle
