#pragma once

#include <dem/core/macros.hpp>
#include <dem/grain/broadphase/block_table.hpp>
#include <dem/grain/broadphase/curve_order.hpp>
#include <dem/parallel/any_executor.hpp>

#include <algorithm>
#include <array>
#include <bit>

namespace dem::broadphase {

/// The Cartesian grid of thesis section 2.2.3 without a domain: only cells that hold grains exist, in a hash table, so
/// memory follows the number of grains, and a grain may go anywhere. Cells are as large as the reach, so the candidates
/// of a grain are in the 27 cells around it. Cells and the grains in them are sorted along a Z-order (Morton) curve.
class UniformGrid {
 public:
  DEM_VALUE(UniformGrid)

  DEM_LAZY void build(const Positions& p, double reach);
  void build(const Positions& p, double reach, exec::AnyExecutor executor);

  /// To be called when the grains were put in order(), so that row k is what was row order()[k]: as good as build(),
  /// and cheaper.
  DEM_LAZY void reordered();
  void reordered(exec::AnyExecutor executor);

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
    /// The same as runs of grains that follow each other: calls f(first, last) for one run after the other.
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
      for (const Beside& beside : around[here & 7]) {
        const Block* block = block_beside(beside.block);
        if (block == nullptr) continue;
        unsigned places = beside.places & block->places;
        if (grid_.is_in_order_ && beside.block == middle) places &= 0xffu << (here & 7);
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
    /// One run more; where grains are in order, runs are kept in order, too.
    void add(std::uint32_t first_cell, std::uint32_t last_cell) {
      const std::uint32_t first = grid_.cells_[first_cell].first;
      int k = count_++;
      for (; grid_.is_in_order_ && k > 0 && first < first_[k - 1]; --k) {
        first_[k] = first_[k - 1];
        last_[k] = last_[k - 1];
      }
      first_[k] = first;
      last_[k] = grid_.cells_[last_cell].last;
    }
    /// One of the 27 blocks around that of the cell; null if no cell of it holds grains, or where it is left out. Is
    /// searched for once for all cells of a block.
    const Block* block_beside(unsigned at) {
      if (!(known_ >> at & 1)) {
        known_ |= 1u << at;
        const unsigned side[] = {at % 3, at / 3 % 3, at / 9};  // 0: before, 1: the same, 2: behind
        std::uint64_t key = block_;
        for (unsigned k = 0; k < 3; ++k) {
          const std::uint64_t axis = morton::axis(1) << k;
          if (side[k] == 2) key = morton::up(key, axis);
          if (side[k] == 0) key = morton::down(key, axis);
        }
        beside_[at] = grid_.is_in_order_ && key < block_ ? nullptr : grid_.table_.find(key);
      }
      return beside_[at];
    }

    /// Which of the 27 blocks around that of a cell have cells among the 27 around it, and at which places.
    struct Beside {
      std::uint8_t block, places;
    };
    static constexpr unsigned middle = 13;
    // Along each axis the three cells are two in the block of this one, and one in the block before or after it.
    static constexpr std::array<std::array<Beside, 8>, 8> around = [] {  // of a cell, by its place in its block
      constexpr unsigned first_half[] = {0x55, 0x33, 0x0f};              // places of the first cell along x, y and z
      std::array<std::array<Beside, 8>, 8> all = {};
      for (unsigned here = 0; here < 8; ++here) {
        for (unsigned other = 0; other < 8; ++other) {
          unsigned block = middle, places = 0xff;
          for (unsigned k = 0, stride = 1; k < 3; ++k, stride *= 3) {
            if (!(other >> k & 1)) continue;
            const bool is_second = here >> k & 1;
            block = is_second ? block + stride : block - stride;
            places &= is_second ? first_half[k] : ~first_half[k] & 0xffu;
          }
          all[here][other] = {static_cast<std::uint8_t>(block), static_cast<std::uint8_t>(places)};
        }
      }
      return all;
    }();

    const UniformGrid& grid_;
    std::uint32_t cell_ = CellTable::none, first_[27], last_[27];  // runs of grains in order()
    int count_ = 0;
    std::uint64_t block_ = ~std::uint64_t{0};  // of the cell
    const Block* beside_[27];                  // the blocks around it
    std::uint32_t known_ = 0;                  // which of them have been searched for
  };
  Finder finder() const { return Finder(*this); }

  /// By what order() sorts: grains of lower numbers come first, those of one number by their rows.
  static std::uint64_t place(const Vector3<double>& x, double reach) { return CurveOrder::code(x, 1.0 / reach); }

  std::span<const std::uint32_t> order() const { return order_; }

  std::size_t memory_bytes() const;

 private:
  bool is_in_order_ = false;  // row k is order_[k] = k
  CurveOrder sorted_;
  std::vector<std::uint32_t> order_, cell_of_;  // grains in curve order; grain -> cell
  std::vector<Cell> cells_;                     // occupied cells, and their grains in order_
  BlockTable table_;
};

}  // namespace dem::broadphase

#if DEM_DEFINES
#include <dem/parallel/blocks.hpp>
#include <dem/parallel/serial.hpp>

#include <numeric>

namespace dem::broadphase {

DEM_DEFINE_VALUE(UniformGrid)

DEM_INLINE void UniformGrid::build(const Positions& p, double reach, exec::AnyExecutor executor) {
  is_in_order_ = false;
  sorted_.sort(p, 1.0 / reach, executor);
  const auto begins_cell = [&](std::size_t k) { return k == 0 || sorted_[k].code != sorted_[k - 1].code; };
  std::vector<std::uint32_t> cells_before(p.n / exec::block_size + 2, 0);  // of each block of grains
  exec::for_each_block(executor, p.n, [&](std::size_t first, std::size_t last) {
    std::uint32_t count = 0;
    for (std::size_t k = first; k < last; ++k) count += begins_cell(k) ? 1U : 0U;
    cells_before[first / exec::block_size + 1] = count;
  });
  std::partial_sum(cells_before.begin(), cells_before.end(), cells_before.begin());
  cells_.resize(cells_before.back());
  order_.resize(p.n);
  cell_of_.resize(p.n);
  exec::for_each_block(executor, p.n, [&](std::size_t first, std::size_t last) {
    std::uint32_t next = cells_before[first / exec::block_size];
    for (std::size_t k = first; k < last; ++k) {
      if (begins_cell(k)) {
        cells_[next].key = sorted_[k].code;
        cells_[next].first = static_cast<std::uint32_t>(k);
        if (next > 0) cells_[next - 1].last = static_cast<std::uint32_t>(k);
        ++next;
      }
      order_[k] = sorted_[k].grain;
      cell_of_[sorted_[k].grain] = next - 1;
    }
  });
  if (!cells_.empty()) cells_.back().last = static_cast<std::uint32_t>(p.n);
  table_.fill(cells_);
}

DEM_INLINE void UniformGrid::reordered(exec::AnyExecutor executor) {
  exec::for_each_block(executor, cells_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      for (std::uint32_t k = cells_[c].first; k < cells_[c].last; ++k) {
        order_[k] = k;
        cell_of_[k] = static_cast<std::uint32_t>(c);
      }
    }
  });
  is_in_order_ = true;
}

DEM_LAZY_INLINE void UniformGrid::build(const Positions& p, double reach) {
  exec::Serial alone;
  build(p, reach, alone);
}

DEM_LAZY_INLINE void UniformGrid::reordered() {
  exec::Serial alone;
  reordered(alone);
}

DEM_INLINE std::size_t UniformGrid::memory_bytes() const {
  return sorted_.memory_bytes() + cells_.capacity() * sizeof(Cell) + table_.memory_bytes() +
         (order_.capacity() + cell_of_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace dem::broadphase

#endif
