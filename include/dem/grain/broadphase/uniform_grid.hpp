#pragma once

#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/broadphase/cell_table.hpp>
#include <dem/grain/broadphase/morton.hpp>

#include <algorithm>

namespace dem::broadphase {

/// The Cartesian grid of thesis section 2.2.3 without a domain: only cells that hold grains exist, in a hash table, so
/// memory follows the number of grains, and a grain may go anywhere. Cells are as large as the reach, so the candidates
/// of a grain are in the 27 cells around it. Cells and the grains in them are sorted along a Z-order (Morton) curve.
class UniformGrid {
 public:
  void build(const Positions& p, double reach) {
    inverse_cell_ = 1.0 / reach;
    cell_of_.resize(p.n);
    sorted_.resize(p.n);
    for (std::size_t i = 0; i < p.n; ++i) {
      sorted_[i] = {morton::code(morton::cell(p.x[i] * inverse_cell_), morton::cell(p.y[i] * inverse_cell_),
                                 morton::cell(p.z[i] * inverse_cell_)),
                    static_cast<std::uint32_t>(i)};
    }
    std::sort(sorted_.begin(), sorted_.end(),
              [](const Entry& a, const Entry& b) { return a.code != b.code ? a.code < b.code : a.grain < b.grain; });
    order_.resize(p.n);
    cells_.clear();
    for (std::size_t k = 0; k < p.n; ++k) {
      if (k == 0 || sorted_[k].code != sorted_[k - 1].code) {
        cells_.push_back({sorted_[k].code, static_cast<std::uint32_t>(k), 0});
      }
      cells_.back().last = static_cast<std::uint32_t>(k + 1);
      order_[k] = sorted_[k].grain;
      cell_of_[sorted_[k].grain] = static_cast<std::uint32_t>(cells_.size() - 1);
    }
    table_.fill(cells_);
  }

  /// To be called when the grains were put in order(), so that row k is what was row order()[k]: as good as build(),
  /// and cheaper.
  void reordered() {
    for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = static_cast<std::uint32_t>(k);
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      std::fill(cell_of_.begin() + cells_[c].first, cell_of_.begin() + cells_[c].last, c);
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
      const std::uint64_t mx = morton::axis(0), my = mx << 1, mz = mx << 2;
      const std::uint64_t c = grid_.cells_[cell].key;
      cell_ = cell;
      count_ = 0;
      for (const std::uint64_t z : {morton::down(c, mz), c, morton::up(c, mz)}) {
        for (const std::uint64_t y : {morton::down(z, my), z, morton::up(z, my)}) {
          for (const std::uint64_t x : {morton::down(y, mx), y, morton::up(y, mx)}) {
            const std::uint32_t other = grid_.table_.find(grid_.cells_, x);
            if (other == CellTable::none) continue;
            first_[count_] = grid_.cells_[other].first;
            last_[count_++] = grid_.cells_[other].last;
          }
        }
      }
    }

    const UniformGrid& grid_;
    std::uint32_t cell_ = CellTable::none, first_[27], last_[27];
    int count_ = 0;
  };
  Finder finder() const { return Finder(*this); }

  std::span<const std::uint32_t> order() const { return order_; }

  std::size_t memory_bytes() const {
    return sorted_.capacity() * sizeof(Entry) + cells_.capacity() * sizeof(Cell) + table_.memory_bytes() +
           (order_.capacity() + cell_of_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  struct Entry {
    std::uint64_t code;
    std::uint32_t grain;
  };
  double inverse_cell_ = 1.0;
  std::vector<Entry> sorted_;
  std::vector<std::uint32_t> order_, cell_of_;  // grains in curve order; grain -> cell
  std::vector<Cell> cells_;                     // occupied cells, and their grains in order_
  CellTable table_;
};

}  // namespace dem::broadphase
