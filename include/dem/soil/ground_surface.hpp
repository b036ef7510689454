#pragma once
// The surface of the grains of a world: furrows, ridges and ruts.

#include <dem/soil/height_map.hpp>
#include <dem/world/world.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace dem::soil {

/// A rectangle of ground that is looked at from above.
struct GroundPlan {
  double x0 = 0.0, y0 = 0.0;         ///< m, its corner
  double length = 0.0, width = 0.0;  ///< m, along x and y
  double cell = 0.0;                 ///< m, edge of a cell; a grain's radius shows what is there
};

/// Heights (m) of the highest grains over the cells of a rectangle; NaN where there is none. Grains count as balls of
/// their volume, so between those of a level bed it dips by up to a radius: compare with the field of before. Grains
/// that parts hold are no ground. Throws Error for a plan that has no cells, or more than 10^8.
///
///     soil::height_field(world, {.x0 = 0, .y0 = -0.1, .length = 0.4, .width = 0.2, .cell = 2e-3})
template <class Model>
HeightField height_field(const World<Model>& world, const GroundPlan& plan) {
  require_positive(plan.cell, "cell of a height field", "m");
  require_within(plan.length / plan.cell, 1.0, 1e8, "length of a height field in cells");
  require_within(plan.width / plan.cell, 1.0, 1e8 / (plan.length / plan.cell), "width of a height field in cells");
  const auto along = static_cast<std::size_t>(std::ceil(plan.length / plan.cell * (1.0 - 1e-9)));
  const auto across = static_cast<std::size_t>(std::ceil(plan.width / plan.cell * (1.0 - 1e-9)));
  HeightField field{.x0 = plan.x0, .y0 = plan.y0, .cell = plan.cell, .across = across};
  field.z.assign(along * across, std::numeric_limits<double>::quiet_NaN());
  for (const GrainId id : world.grains()) {
    const auto& kind = world.species(world.species_of(id));
    if (kind.is_held()) continue;
    const double volume = kind.shape.volume();
    const double radius = std::cbrt(0.75 * volume / std::numbers::pi);
    const Vec3 at = world.position(id);
    if (at.x() - radius > plan.x0 + plan.length) continue;  // the field would grow
    field.add(at, radius);
    field.z.resize(along * across);
  }
  return field;
}

/// A cross-section of the ground, across x.
struct CrossSection {
  std::vector<double> y, z;  ///< m; z is NaN where there is no grain
  double cell = 0.0;         ///< m, between two places

  /// m^2, of what lies below or above a level (m): the furrow, and the ridges beside it. Places without grains do not
  /// count.
  double area_below(double level) const {
    return area([level](double height) { return level - height; });
  }
  double area_above(double level) const {
    return area([level](double height) { return height - level; });
  }
  /// m, mean height; NaN where there is no grain at all.
  double mean() const {
    double sum = 0.0, count = 0.0;
    for (const double height : z) {
      if (std::isfinite(height)) sum += height, count += 1.0;
    }
    return sum / count;
  }

 private:
  template <class F>
  double area(F&& above_zero) const {
    double sum = 0.0;
    for (const double height : z) {
      if (std::isfinite(height)) sum += cell * std::max(0.0, above_zero(height));
    }
    return sum;
  }
};

/// The mean of a field's heights between two places along x (m), over each line of cells along x.
inline CrossSection cross_section(const HeightField& field, double from_x, double to_x) {
  CrossSection section{.y = {}, .z = {}, .cell = field.cell};
  for (std::size_t j = 0; j < field.across; ++j) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < field.along(); ++i) {
      const double x = field.x0 + (static_cast<double>(i) + 0.5) * field.cell, height = field.z[i * field.across + j];
      if (x >= from_x && x <= to_x && std::isfinite(height)) sum += height, count += 1.0;
    }
    section.y.push_back(field.y0 + (static_cast<double>(j) + 0.5) * field.cell);
    section.z.push_back(sum / count);
  }
  return section;
}

}  // namespace dem::soil
