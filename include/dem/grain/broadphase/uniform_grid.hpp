#pragma once

#include <dem/core/macros.hpp>
#include <dem/grain/broadphase/broad_phase.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace dem::broadphase {

/// The Cartesian grid of thesis section 2.2.3 without a domain: only cells that hold grains exist, in a hash table, so
/// memory follows the number of grains, and a grain may go anywhere. Cells are as large as the reach, so the candidates
/// of a grain are in the 27 cells around it. Cells and the grains in them are sorted along a Z-order (Morton) curve.
class UniformGrid {
  static constexpr std::uint32_t empty = 0xffffffffu;

 public:
  void build(const Positions& p, double reach) {
    inverse_cell_ = 1.0 / reach;
    cell_of_.resize(p.n);
    sorted_.resize(p.n);
    for (std::size_t i = 0; i < p.n; ++i) {
      sorted_[i] = {code(coordinate(p.x[i]), coordinate(p.y[i]), coordinate(p.z[i])), static_cast<std::uint32_t>(i)};
    }
    std::sort(sorted_.begin(), sorted_.end(),
              [](const Entry& a, const Entry& b) { return a.code != b.code ? a.code < b.code : a.grain < b.grain; });
    order_.resize(p.n);
    cells_.clear();
    for (std::size_t k = 0; k < p.n; ++k) {
      if (k == 0 || sorted_[k].code != sorted_[k - 1].code) {
        cells_.push_back({sorted_[k].code, static_cast<std::uint32_t>(k)});
      }
      order_[k] = sorted_[k].grain;
      cell_of_[sorted_[k].grain] = static_cast<std::uint32_t>(cells_.size() - 1);
    }
    cells_.push_back({0, static_cast<std::uint32_t>(p.n)});  // end mark
    fill_table();
  }

  /// To be called when the grains were put in order(), so that row k is what was row order()[k]: as good as build(),
  /// and cheaper.
  void reordered() {
    for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = static_cast<std::uint32_t>(k);
    for (std::uint32_t c = 0; c + 1 < cells_.size(); ++c) {
      std::fill(cell_of_.begin() + cells_[c].first, cell_of_.begin() + cells_[c + 1].first, c);
    }
  }

  /// Looks candidates up; each thread has its own. Remembers the surroundings of the last cell, as grains that follow
  /// each other are mostly in one cell.
  class Finder {
   public:
    explicit Finder(const UniformGrid& grid) : grid_(grid) {}

    template <class F>
    void for_each_candidate(std::size_t i, F&& f) {
      if (grid_.cell_of_[i] != cell_) look_around(grid_.cell_of_[i]);
      for (int k = 0; k < count_; ++k) {
        for (std::uint32_t m = first_[k]; m < last_[k]; ++m) {
          if (grid_.order_[m] > i) f(grid_.order_[m]);
        }
      }
    }

   private:
    /// The occupied cells among the 27.
    void look_around(std::uint32_t cell) {
      constexpr std::uint64_t mx = 0x1249249249249249ULL, my = mx << 1, mz = mx << 2;
      const std::uint64_t c = grid_.cells_[cell].code;
      cell_ = cell;
      count_ = 0;
      for (const std::uint64_t z : {down(c, mz), c, up(c, mz)}) {
        for (const std::uint64_t y : {down(z, my), z, up(z, my)}) {
          for (const std::uint64_t x : {down(y, mx), y, up(y, mx)}) {
            const std::uint32_t other = grid_.find(x);
            if (other == empty) continue;
            first_[count_] = grid_.cells_[other].first;
            last_[count_++] = grid_.cells_[other + 1].first;
          }
        }
      }
    }

    const UniformGrid& grid_;
    std::uint32_t cell_ = empty, first_[27], last_[27];
    int count_ = 0;
  };
  Finder finder() const { return Finder(*this); }

  std::span<const std::uint32_t> order() const { return order_; }

  std::size_t memory_bytes() const {
    return sorted_.capacity() * sizeof(Entry) + cells_.capacity() * sizeof(Cell) +
           (order_.capacity() + cell_of_.capacity() + table_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  struct Entry {
    std::uint64_t code;
    std::uint32_t grain;
  };
  struct Cell {
    std::uint64_t code;
    std::uint32_t first;
  };
  static constexpr std::uint64_t coordinate_mask = (1u << 21) - 1;

  /// Cell coordinate modulo 2^21. Cells that far apart share a code, which brings needless candidates but loses none.
  std::uint64_t coordinate(double x) const {
    const double c = std::floor(x * inverse_cell_);
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(c, -4e18, 4e18))) & coordinate_mask;
  }
  static std::uint64_t spread(std::uint64_t v) {  // abc -> a00b00c00
    v = (v | v << 32) & 0x1f00000000ffffULL;
    v = (v | v << 16) & 0x1f0000ff0000ffULL;
    v = (v | v << 8) & 0x100f00f00f00f00fULL;
    v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
    return (v | v << 2) & 0x1249249249249249ULL;
  }
  static std::uint64_t code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return spread(x) | spread(y) << 1 | spread(z) << 2;
  }
  /// One step up or down in one interleaved coordinate, modulo 2^21 (arithmetic on the dilated bits alone).
  static std::uint64_t up(std::uint64_t c, std::uint64_t m) { return (((c | ~m) + (m & (0 - m))) & m) | (c & ~m); }
  static std::uint64_t down(std::uint64_t c, std::uint64_t m) { return (((c & m) - (m & (0 - m))) & m) | (c & ~m); }

  std::size_t slot(std::uint64_t c) const { return static_cast<std::size_t>((c * 0x9e3779b97f4a7c15ULL) >> shift_); }
  void fill_table() {
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * cells_.size(), 16));
    shift_ = 64 - std::countr_zero(size);
    table_.assign(size, empty);
    for (std::uint32_t k = 0; k + 1 < cells_.size(); ++k) {
      std::size_t s = slot(cells_[k].code);
      while (table_[s] != empty) s = (s + 1) & (size - 1);
      table_[s] = k;
    }
  }
  std::uint32_t find(std::uint64_t c) const {
    for (std::size_t s = slot(c); table_[s] != empty; s = (s + 1) & (table_.size() - 1)) {
      if (cells_[table_[s]].code == c) return table_[s];
    }
    return empty;
  }
  double inverse_cell_ = 1.0;
  int shift_ = 60;
  std::vector<Entry> sorted_;
  std::vector<std::uint32_t> order_, cell_of_;  // grains in curve order; grain -> cell
  std::vector<Cell> cells_;                     // first grain (in order_) of each occupied cell, and an end mark
  std::vector<std::uint32_t> table_;            // hash table of cells
};

}  // namespace dem::broadphase
