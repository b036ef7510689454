#pragma once

#include <dem/terramechanics/column_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace dem::terramechanics {

/// Soil that is pushed out of a rut, kept simple. A share of the volume by which columns sink for good appears at once
/// as loose soil on the columns beside those that are touched, as much for each side by which a column meets one;
/// beside a moving part, at its two sides only. It then rolls down wherever it lies steeper than its angle of repose,
/// also back into the rut, near what is touched and one column a step. It is lifted without work. Where soil was never
/// pressed it is soil like any other once it is driven over; in a rut it is pressed into what was compacted there,
/// without resistance.
struct Bulldozing {
  double share = 0.0;     ///< of the compacted volume; 0: none, 1: all, more: loosened soil takes more room
  double steepest = 0.7;  ///< tangent of the angle of repose

  /// Deposits the soil that one part pushed away: the rows that it touches, ascending, the volume (m^3) by which they
  /// sank, and its velocity over the ground (m/s). Rows that any part touches in this step (number `step`) take none.
  void deposit(ColumnField& field, std::span<const std::size_t> rows, double volume, double vx, double vy,
               std::uint32_t step) {
    if (!(share * volume > 0.0)) return;
    const ColumnGrid& g = field.grid;
    const double speed = std::sqrt(vx * vx + vy * vy);
    // Across the motion, m: the sides are beyond the outermost columns. Within, what is touched ends in teeth.
    const auto across = [&](std::size_t row) { return (vx * g.y(row / g.nx) - vy * g.x(row % g.nx)) / speed; };
    double most = -1e300, least = 1e300;
    for (const std::size_t row : rows) {
      if (!(speed > 0.0)) break;
      most = std::max(most, across(row));
      least = std::min(least, across(row));
    }
    const double beyond = 0.1 * g.spacing;
    for (const bool sides_only : {speed > 0.0, false}) {
      border_.clear();
      for (const std::size_t row : rows) {
        each_neighbour(g, row, [&](std::size_t other) {
          if (field.touched[other] == step) return;
          if (sides_only && across(other) < most + beyond && across(other) > least - beyond) return;
          border_.push_back(other);
        });
      }
      if (border_.empty()) continue;
      const double height = share * volume / (static_cast<double>(border_.size()) * g.area());
      for (const std::size_t row : border_) field.heap[row] += height;
      return;
    }
  }

  /// Lets loose soil roll around the rows that a part touches (at least one), over columns that none touches in this
  /// step. Returns the greatest height (m) from which sinkage counts there.
  double roll(ColumnField& field, std::span<const std::size_t> rows, std::uint32_t step) {
    const ColumnGrid& g = field.grid;
    std::size_t x0 = g.nx, x1 = 0, y0 = g.ny, y1 = 0;
    for (const std::size_t row : rows) {
      x0 = std::min(x0, row % g.nx), x1 = std::max(x1, row % g.nx);
      y0 = std::min(y0, row / g.nx), y1 = std::max(y1, row / g.nx);
    }
    x0 -= std::min(x0, margin_), y0 -= std::min(y0, margin_);
    x1 = std::min(x1 + margin_, g.nx - 1), y1 = std::min(y1 + margin_, g.ny - 1);
    const std::size_t width = x1 - x0 + 1;
    bool full = false;
    moved_.assign(width * (y1 - y0 + 1), 0.0);
    for (std::size_t iy = y0; iy <= y1; ++iy) {
      for (std::size_t ix = x0; ix <= x1; ++ix) {
        const std::size_t row = g.row(ix, iy), here = width * (iy - y0) + (ix - x0);
        if (!(field.heap[row] > 0.0) || field.touched[row] == step) continue;
        const double height = field.surface(row) - steepest * g.spacing;
        std::array<double, 4> flow{};
        const auto excess = [&](bool inside, bool on_grid, std::size_t other) {
          if (!on_grid || field.touched[other] == step) return 0.0;
          const double over = height - field.surface(other);
          full |= !inside && over > 1e-3 * g.spacing;
          return inside ? std::max(0.0, 0.2 * over) : 0.0;  // a fifth is stable with four neighbours
        };
        flow[0] = excess(ix > x0, ix > 0, row - 1);
        flow[1] = excess(ix < x1, ix + 1 < g.nx, row + 1);
        flow[2] = excess(iy > y0, iy > 0, row - g.nx);
        flow[3] = excess(iy < y1, iy + 1 < g.ny, row + g.nx);
        const double sum = flow[0] + flow[1] + flow[2] + flow[3];
        if (!(sum > 0.0)) continue;
        const double scale = std::min(1.0, field.heap[row] / sum);
        if (flow[0] > 0.0) moved_[here - 1] += scale * flow[0];
        if (flow[1] > 0.0) moved_[here + 1] += scale * flow[1];
        if (flow[2] > 0.0) moved_[here - width] += scale * flow[2];
        if (flow[3] > 0.0) moved_[here + width] += scale * flow[3];
        moved_[here] -= scale * sum;
      }
    }
    double top = -1e300;
    for (std::size_t iy = y0; iy <= y1; ++iy) {
      for (std::size_t ix = x0; ix <= x1; ++ix) {
        const std::size_t row = g.row(ix, iy);
        field.heap[row] = std::max(0.0, field.heap[row] + moved_[width * (iy - y0) + (ix - x0)]);
        top = std::max(top, field.reference(row));
      }
    }
    // The next step looks further where soil would roll out of what was looked at.
    if (full && margin_ < 50) ++margin_;
    return top;
  }

  /// Columns around what is touched where soil rolls: it grows as it has to, and is part of the state.
  std::size_t margin() const { return margin_; }
  void set_margin(std::size_t columns) { margin_ = columns; }

 private:
  template <class F>
  static void each_neighbour(const ColumnGrid& g, std::size_t row, F&& f) {
    const std::size_t ix = row % g.nx, iy = row / g.nx;
    if (ix > 0) f(row - 1);
    if (ix + 1 < g.nx) f(row + 1);
    if (iy > 0) f(row - g.nx);
    if (iy + 1 < g.ny) f(row + g.nx);
  }

  std::vector<std::size_t> border_;  ///< some more than once
  std::vector<double> moved_;
  std::size_t margin_ = 4;  ///< columns
};

}  // namespace dem::terramechanics
