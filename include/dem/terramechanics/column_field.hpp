#pragma once

#include <dem/core/error.hpp>
#include <dem/terramechanics/column_law.hpp>
#include <dem/terramechanics/column_shape.hpp>
#include <dem/terramechanics/column_shear.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem::terramechanics {

/// Columns of a grid: files from_x to to_x of the rows from_y to to_y.
struct ColumnRange {
  std::size_t from_x, to_x, from_y, to_y;
};

/// A field of soil columns on a square grid; column (ix, iy) has its middle at low + (ix + 1/2, iy + 1/2) spacing.
struct ColumnGrid {
  double low_x = 0.0, low_y = 0.0;  ///< m, the corner
  double spacing = 0.01;            ///< m
  std::size_t nx = 0, ny = 0;

  std::size_t size() const { return nx * ny; }
  std::size_t row(std::size_t ix, std::size_t iy) const { return iy * nx + ix; }
  double x(std::size_t ix) const { return low_x + (static_cast<double>(ix) + 0.5) * spacing; }
  double y(std::size_t iy) const { return low_y + (static_cast<double>(iy) + 0.5) * spacing; }
  /// The column's square, and its point: moved along x by a fraction that changes from row to row, along y from file to
  /// file, in the order 0, 4, 2, 6, 1, 5, 3, 7 of eighths.
  ColumnPlace place(std::size_t ix, std::size_t iy) const {
    const auto fraction = [](std::size_t k) {
      return static_cast<double>((k & 1) << 2 | (k & 2) | (k & 4) >> 2) / 8.0 - 7.0 / 16.0;
    };
    return {x(ix), y(iy), spacing, x(ix) + fraction(iy) * spacing, y(iy) + fraction(ix) * spacing};
  }
  double high_x() const { return low_x + spacing * static_cast<double>(nx); }  ///< m, the other corner
  double high_y() const { return low_y + spacing * static_cast<double>(ny); }  ///< m
  /// Whether a rectangle of the ground lies on the field as a whole, and in part.
  bool holds(const PlanBox& box) const {
    return !(box.low_x < low_x || box.high_x > high_x() || box.low_y < low_y || box.high_y > high_y());
  }
  bool meets(const PlanBox& box) const {
    return !(box.high_x < low_x || box.low_x > high_x() || box.high_y < low_y || box.low_y > high_y());
  }
  /// The columns with their points in a rectangle, and some more: a column whose middle is a spacing away holds a point
  /// half of one away.
  ColumnRange around(const PlanBox& box) const {
    const auto index = [&](double at, double low, std::size_t n) {
      return static_cast<std::size_t>(std::clamp(std::floor((at - low) / spacing), 0.0, static_cast<double>(n - 1)));
    };
    const double h = 0.5 * spacing;
    return {index(box.low_x - h, low_x, nx), index(box.high_x + h, low_x, nx), index(box.low_y - h, low_y, ny),
            index(box.high_y + h, low_y, ny)};
  }
  double area() const { return spacing * spacing; }  ///< m^2, of a column
};

/// What the columns remember, an array each; by ColumnGrid::row.
struct ColumnField {
  ColumnGrid grid;
  std::vector<double> ground;    ///< m, height that sinkage counts from
  std::vector<double> deepest;   ///< m, greatest sinkage under `modulus`
  std::vector<double> modulus;   ///< k, Pa/m^n, of the curve that `deepest` belongs to; 0: never loaded
  std::vector<double> sunk;      ///< m, sinkage that stays when the load is gone
  std::vector<double> heap;      ///< m, loose soil on top, pushed there; see resting()
  std::vector<double> pressure;  ///< Pa, when the column was touched last
  std::vector<ShearMemory> shear;
  std::vector<std::uint32_t> touched;    ///< number of the step that touched the column last
  std::vector<std::int32_t> touched_by;  ///< part of that step; -1: none yet
  std::vector<std::uint8_t> soil;        ///< number of the column's soil; empty: all are of the first

  /// m, height of the soil's surface without load.
  double surface(std::size_t row) const { return ground[row] - sunk[row] + heap[row]; }
  /// m, height that a column's sinkage counts from: with the loose soil on top where none was pressed before. In a rut
  /// loose soil gives way to what was compacted.
  double reference(std::size_t row) const { return deepest[row] > 0.0 ? ground[row] : ground[row] + heap[row]; }
  /// m, height at which a column begins to resist.
  double resting(std::size_t row) const { return reference(row) - sunk[row]; }

  void resize(double height) {
    const std::size_t n = grid.size();
    ground.assign(n, height);
    for (auto* column : {&deepest, &modulus, &sunk, &heap, &pressure}) column->assign(n, 0.0);
    shear.assign(n, {});
    touched.assign(n, 0);
    touched_by.assign(n, -1);
  }
  /// Gives the ground the heights height(x, y) in m, and returns the highest. Throws Error if one is not finite.
  template <class F>
  double shape(F&& height) {
    double top = -1e300;
    for (std::size_t iy = 0; iy < grid.ny; ++iy) {
      for (std::size_t ix = 0; ix < grid.nx; ++ix) {
        const double z = height(grid.x(ix), grid.y(iy));
        if (!std::isfinite(z))
          fail("the soil's height at ({:g}, {:g}) m is {:g}, but must be finite", grid.x(ix), grid.y(iy), z);
        ground[grid.row(ix, iy)] = z;
        top = std::max(top, z);
      }
    }
    return top;
  }
  /// Numbers the columns' soils, 0 to `most`, by which(x, y) at their places (m). Throws Error for another number, and
  /// leaves the field as it was.
  template <class F>
  void lay(std::size_t most, F&& which) {
    std::vector<std::uint8_t> number(grid.size());
    for (std::size_t iy = 0; iy < grid.ny; ++iy) {
      for (std::size_t ix = 0; ix < grid.nx; ++ix) {
        const auto k = static_cast<long long>(which(grid.x(ix), grid.y(iy)));
        if (k < 0 || k > static_cast<long long>(most))
          fail("soil {} is to lie at ({:g}, {:g}) m, but there are 0 to {}", k, grid.x(ix), grid.y(iy), most);
        number[grid.row(ix, iy)] = static_cast<std::uint8_t>(k);
      }
    }
    soil = std::move(number);
  }
};

/// What happened to a column in a step, before it is kept.
struct ColumnChange {
  std::size_t row = 0;
  std::int32_t part = -1;
  double deepest = 0.0, modulus = 0.0, sunk = 0.0, pressure = 0.0;
  ShearMemory shear;
  bool on_base = false;
};

/// m, the deepest sinkage of a column for a curve of another modulus: that which leaves the same rut.
inline double deepest_for(const ColumnField& field, std::size_t row, const ColumnLaw& law) {
  if (field.modulus[row] == law.curve.modulus || field.deepest[row] == 0.0) return field.deepest[row];
  return law.deepest_of(field.sunk[row]);
}

}  // namespace dem::terramechanics
