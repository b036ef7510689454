#pragma once

#include <dem/terramechanics/column_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace dem::terramechanics {

/// Soil that is pushed out of a rut, kept simple. A share of the volume by which columns sink for good appears at once
/// as loose soil on the columns beside those that are touched, as much on each; beside a moving part, at its two sides
/// only. It then rolls down wherever it lies steeper than its angle of repose, also back into the rut, a few columns a
/// step. It is lifted without work, and it is soil like any other when it is driven over.
struct Bulldozing {
  double share = 0.0;               ///< of the compacted volume; 0: none, 1: all, more: loosened soil takes more room
  double steepest = 0.7;            ///< tangent of the angle of repose
  static constexpr int sweeps = 4;  ///< of rolling, a step

  /// Deposits the soil that one part pushed away: the rows that it touches, ascending, the volume (m^3) by which they
  /// sank, and its velocity over the ground (m/s). Rows that any part touches in this step (number `step`) take none.
  void deposit(ColumnField& field, std::span<const std::size_t> rows, double volume, double vx, double vy,
               std::uint32_t step) {
    if (!(share * volume > 0.0)) return;
    const ColumnGrid& g = field.grid;
    const double speed2 = vx * vx + vy * vy;
    for (const bool sides_only : {speed2 > 0.0, false}) {
      border_.clear();
      double sum = 0.0;
      for (const std::size_t row : rows) {
        each_neighbour(g, row, [&](std::size_t other, double ex, double ey) {
          if (field.touched[other] == step) return;
          const double across = ex * vy - ey * vx;
          const double weight = sides_only ? across * across / speed2 : 1.0;
          if (weight > 0.0) border_.push_back({other, weight});
          sum += weight;
        });
      }
      if (!(sum > 1e-9)) continue;
      for (const Part& part : border_) {
        const double height = share * volume * part.weight / (sum * g.area());
        field.ground[part.row] += height;
        field.heap[part.row] += height;
      }
      return;
    }
  }

  /// Lets loose soil roll around a rectangle of touched columns, ends included, over columns that are not touched in
  /// this step. Returns the greatest height (m) of the ground there.
  double roll(ColumnField& field, std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1, std::uint32_t step) {
    const ColumnGrid& g = field.grid;
    x0 -= std::min(x0, margin_), y0 -= std::min(y0, margin_);
    x1 = std::min(x1 + margin_, g.nx - 1), y1 = std::min(y1 + margin_, g.ny - 1);
    const std::size_t width = x1 - x0 + 1;
    bool full = false;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      moved_.assign(width * (y1 - y0 + 1), 0.0);
      bool any = false;
      for (std::size_t iy = y0; iy <= y1; ++iy) {
        for (std::size_t ix = x0; ix <= x1; ++ix) {
          const std::size_t row = g.row(ix, iy);
          if (!(field.heap[row] > 0.0) || field.touched[row] == step) continue;
          full |= ix == x0 || ix == x1 || iy == y0 || iy == y1;
          std::array<double, 4> flow{};
          std::array<std::size_t, 4> to{};
          std::size_t n = 0;
          double sum = 0.0;
          each_neighbour(g, row, [&](std::size_t other, double, double) {
            const std::size_t ox = other % g.nx, oy = other / g.nx;
            const bool inside = ox >= x0 && ox <= x1 && oy >= y0 && oy <= y1;
            if (!inside || field.touched[other] == step) return;
            const double excess = field.surface(row) - field.surface(other) - steepest * g.spacing;
            if (!(excess > 0.0)) return;
            flow[n] = 0.2 * excess;  // stable with four neighbours
            to[n] = width * (oy - y0) + (ox - x0);
            sum += flow[n++];
          });
          if (n == 0) continue;
          const double scale = std::min(1.0, field.heap[row] / sum);
          for (std::size_t k = 0; k < n; ++k) {
            moved_[to[k]] += scale * flow[k];
            moved_[width * (iy - y0) + (ix - x0)] -= scale * flow[k];
          }
          any = true;
        }
      }
      if (!any) break;
      for (std::size_t iy = y0; iy <= y1; ++iy) {
        for (std::size_t ix = x0; ix <= x1; ++ix) {
          const double height = moved_[width * (iy - y0) + (ix - x0)];
          if (height == 0.0) continue;
          field.ground[g.row(ix, iy)] += height;
          field.heap[g.row(ix, iy)] = std::max(0.0, field.heap[g.row(ix, iy)] + height);
        }
      }
    }
    // The next step looks further where soil has come to the edge of what was looked at.
    if (full && margin_ < 200) margin_ += 2;
    double top = -1e300;
    for (std::size_t iy = y0; iy <= y1; ++iy) {
      for (std::size_t ix = x0; ix <= x1; ++ix) top = std::max(top, field.ground[g.row(ix, iy)]);
    }
    return top;
  }

 private:
  struct Part {
    std::size_t row;
    double weight;
  };

  template <class F>
  static void each_neighbour(const ColumnGrid& g, std::size_t row, F&& f) {
    const std::size_t ix = row % g.nx, iy = row / g.nx;
    if (ix > 0) f(row - 1, -1.0, 0.0);
    if (ix + 1 < g.nx) f(row + 1, 1.0, 0.0);
    if (iy > 0) f(row - g.nx, 0.0, -1.0);
    if (iy + 1 < g.ny) f(row + g.nx, 0.0, 1.0);
  }

  std::vector<Part> border_;
  std::vector<double> moved_;
  std::size_t margin_ = 4;  ///< columns
};

}  // namespace dem::terramechanics
