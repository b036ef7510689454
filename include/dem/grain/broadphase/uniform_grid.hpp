#pragma once

#include <dem/grain/broadphase/block_table.hpp>
#include <dem/grain/broadphase/broad_phase.hpp>
#include <dem/grain/broadphase/morton.hpp>
#include <dem/grain/broadphase/nearly_sorted.hpp>

#include <algorithm>
#include <bit>

namespace dem::broadphase {

/// The Cartesian grid of thesis section 2.2.3 without a domain: only cells that hold grains exist, in a hash table, so
/// memory follows the number of grains, and a grain may go anywhere. Cells are as large as the reach, so the candidates
/// of a grain are in the 27 cells around it. Cells and the grains in them are sorted along a Z-order (Morton) curve.
class UniformGrid {
 public:
  void build(const Positions& p, double reach) {
    inverse_cell_ = 1.0 / reach;
    is_in_order_ = false;
    cell_of_.resize(p.n);
    sorted_.resize(p.n);
    for (std::size_t i = 0; i < p.n; ++i) {
      sorted_[i] = {morton::code(morton::cell(p.x[i] * inverse_cell_), morton::cell(p.y[i] * inverse_cell_),
                                 morton::cell(p.z[i] * inverse_cell_)),
                    static_cast<std::uint32_t>(i)};
    }
    sort_nearly_sorted(
        sorted_, [](const Entry& a, const Entry& b) { return a.code != b.code ? a.code < b.code : a.grain < b.grain; });
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
    is_in_order_ = true;
  }

  /// Looks candidates up; each thread has its own. Remembers the surroundings of the last cell, as grains that follow
  /// each other are mostly in one cell.
  class Finder {
   public:
    explicit Finder(const UniformGrid& grid) : grid_(grid) {}

    template <class F>
    void for_each_candidate(std::size_t i, F&& f) {
      if (grid_.is_in_order_) {
        for_each_run(i, [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t j = first; j < last; ++j) f(j);
        });
        return;
      }
      if (grid_.cell_of_[i] != cell_) look_around(grid_.cell_of_[i]);
      for (int k = 0; k < count_; ++k) {
        for (std::uint32_t m = first_[k]; m < last_[k]; ++m) {
          if (grid_.order_[m] > i) f(grid_.order_[m]);
        }
      }
    }

    bool has_runs() const { return grid_.is_in_order_; }
    /// The same as runs of grains that follow each other: calls f(first, last).
    template <class F>
    void for_each_run(std::size_t i, F&& f) {
      if (grid_.cell_of_[i] != cell_) look_around(grid_.cell_of_[i]);
      for (int k = 0; k < count_; ++k) {
        const std::uint32_t first = std::max(first_[k], static_cast<std::uint32_t>(i) + 1);
        if (first < last_[k]) f(first, last_[k]);
      }
    }

   private:
    /// The occupied cells among the 27. Where grains are in the order of the cells, one run for each block holds them
    /// and what lies between them; cells before this one are left out, as no later grain is there.
    void look_around(std::uint32_t cell) {
      const std::uint64_t here = grid_.cells_[cell].key;
      cell_ = cell;
      count_ = 0;
      if (here >> 3 != block_) block_ = here >> 3, known_ = 0;
      // Along each axis the three cells are two in the block of this one, and one in the block before or after it.
      constexpr unsigned first_half[] = {0x55, 0x33, 0x0f};  // places of the first cell along x, y and z
      for (unsigned other = 0; other < 8; ++other) {
        unsigned places = 0xff;
        int side[3] = {0, 0, 0};
        for (unsigned k = 0; k < 3; ++k) {
          if (!(other >> k & 1)) continue;
          const bool is_second = here >> k & 1;
          side[k] = is_second ? 1 : -1;
          places &= is_second ? first_half[k] : ~first_half[k] & 0xffu;
        }
        const Block* block = block_beside(side);
        if (block == nullptr) continue;
        if (grid_.is_in_order_ && other == 0) places &= 0xffu << (here & 7);
        places &= block->places;
        if (places == 0) continue;
        if (grid_.is_in_order_) {
          // One run, from the first of these cells to the last: what lies between them is soon tried.
          add(block->cell_at(static_cast<unsigned>(std::countr_zero(places))),
              block->cell_at(static_cast<unsigned>(std::bit_width(places)) - 1));
          continue;
        }
        for (; places != 0; places &= places - 1) {
          const std::uint32_t found = block->cell_at(static_cast<unsigned>(std::countr_zero(places)));
          add(found, found);
        }
      }
    }
    void add(std::uint32_t first_cell, std::uint32_t last_cell) {
      first_[count_] = grid_.cells_[first_cell].first;
      last_[count_++] = grid_.cells_[last_cell].last;
    }
    /// The block so many blocks aside along each axis; null if no cell of it holds grains, or where it is left out. Is
    /// searched for once for all cells of a block.
    const Block* block_beside(const int (&side)[3]) {
      const auto at = static_cast<unsigned>(13 + side[0] + 3 * side[1] + 9 * side[2]);
      if (!(known_ >> at & 1)) {
        known_ |= 1u << at;
        std::uint64_t key = block_;
        for (unsigned k = 0; k < 3; ++k) {
          const std::uint64_t axis = morton::axis(1) << k;
          if (side[k] > 0) key = morton::up(key, axis);
          if (side[k] < 0) key = morton::down(key, axis);
        }
        beside_[at] = grid_.is_in_order_ && key < block_ ? nullptr : grid_.table_.find(key);
      }
      return beside_[at];
    }

    const UniformGrid& grid_;
    std::uint32_t cell_ = CellTable::none, first_[27], last_[27];  // runs of grains in order()
    int count_ = 0;
    std::uint64_t block_ = ~std::uint64_t{0};  // of the cell
    const Block* beside_[27];                  // the blocks around it
    std::uint32_t known_ = 0;                  // which of them have been searched for
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
  bool is_in_order_ = false;  // row k is order_[k] = k
  std::vector<Entry> sorted_;
  std::vector<std::uint32_t> order_, cell_of_;  // grains in curve order; grain -> cell
  std::vector<Cell> cells_;                     // occupied cells, and their grains in order_
  BlockTable table_;
};

}  // namespace dem::broadphase
