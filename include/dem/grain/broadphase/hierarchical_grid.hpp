#pragma once

#include <dem/grain/broadphase/cell_table.hpp>
#include <dem/grain/broadphase/curve_order.hpp>
#include <dem/parallel/serial.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace dem::broadphase {

/// A grid of cells for each size of grains: for mixtures. Cells of a level are twice as wide as those of the level
/// below. A grain is in the lowest level whose cells are as wide as the reach of two like it. So small grains are
/// looked for in small cells, however large the largest grain is. A grain looks for its like and for larger ones in the
/// 27 cells around it on each level, and for smaller ones in the cells that its reach meets.
///
/// All grains are sorted along one Z-order (Morton) curve through the smallest cells. A cell of a higher level is one
/// stretch of it. Grains whose reaches differ by less than a factor of two have one level: then the cells and the order
/// are those of a UniformGrid. That one looks up faster; outside periodic cells it also tells runs of grains.
class HierarchicalGrid {
  static constexpr unsigned most_levels = 16;  // sizes to 1 : 32,768; still smaller grains are on the lowest level

 public:
  /// Two grains are found if they are nearer than their radii and the gap. Positions and kinds are read again by the
  /// finder, where they are now.
  template <class Executor>
  void build(const Positions& positions, const Sizes& sizes, Executor& executor) {
    at_ = positions;
    kind_ = sizes.kind;
    gap_ = sizes.gap;
    radius_.assign(sizes.radius_of_kind.begin(), sizes.radius_of_kind.end());
    choose_levels();
    sorted_.sort(at_, inverse_cell_, executor);
    find_cells();
  }
  void build(const Positions& positions, const Sizes& sizes) {
    exec::Serial alone;
    build(positions, sizes, alone);
  }
  /// Grains of one size.
  void build(const Positions& positions, double reach) { build(positions, Sizes{{}, nullptr, reach}); }

  /// To be called when the grains were put in order(), so that row k is what was row order()[k]: as good as build(),
  /// and cheaper.
  void reordered() {
    std::array<std::uint32_t, most_levels + 1> next = first_;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      members_[next[level_of_key(cells_[cell_of_[order_[k]]].key)]++] = static_cast<std::uint32_t>(k);
      order_[k] = static_cast<std::uint32_t>(k);
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      for (std::uint32_t m = cells_[c].first; m < cells_[c].last; ++m) cell_of_[members_[m]] = c;
    }
  }

  /// Looks candidates up; each thread has its own. Remembers the surroundings of the last cell on each level.
  class Finder {
   public:
    explicit Finder(const HierarchicalGrid& grid) : grid_(grid) {
      for (unsigned level = 0; level < grid.levels_; ++level) around_[level].key = 0;
    }

    template <class F>
    void for_each_candidate(std::size_t i, F&& f) {
      if (grid_.cell_of_[i] != cell_) look_from(grid_.cell_of_[i]);
      for (unsigned level = own_; level < grid_.levels_; ++level) {
        const Around& around = around_[level];
        for (int k = 0; k < around.count; ++k) visit(i, around.first[k], around.last[k], f);
      }
      for (unsigned level = 0; level < own_; ++level) search_below(i, level, f);
    }

   private:
    struct Around {
      std::uint64_t key;  // of the cell in the middle; 0: nowhere yet
      int count;
      std::uint32_t first[27], last[27];  // members of the occupied cells among the 27
    };

    template <class F>
    void visit(std::size_t i, std::uint32_t first, std::uint32_t last, F& f) const {
      for (std::uint32_t m = first; m < last; ++m) {
        if (grid_.members_[m] > i) f(grid_.members_[m]);
      }
    }

    /// The surroundings of a cell on its own level and those above.
    void look_from(std::uint32_t cell) {
      const std::uint64_t key = grid_.cells_[cell].key;
      cell_ = cell;
      own_ = level_of_key(key);
      for (unsigned level = own_; level < grid_.levels_; ++level) {
        if (const std::uint64_t here = key >> 3 * (level - own_); around_[level].key != here) look_around(here, level);
      }
    }
    void look_around(std::uint64_t here, unsigned level) {
      Around& around = around_[level];
      around.key = here;
      around.count = 0;
      if (grid_.first_[level] == grid_.first_[level + 1]) return;
      const std::uint64_t mx = morton::axis(level), my = mx << 1, mz = mx << 2;
      for (const std::uint64_t z : {morton::down(here, mz), here, morton::up(here, mz)}) {
        for (const std::uint64_t y : {morton::down(z, my), z, morton::up(z, my)}) {
          for (const std::uint64_t x : {morton::down(y, mx), y, morton::up(y, mx)}) {
            const std::uint32_t other = grid_.table_.find(grid_.cells_, x);
            if (other == CellTable::none) continue;
            around.first[around.count] = grid_.cells_[other].first;
            around.last[around.count++] = grid_.cells_[other].last;
          }
        }
      }
    }

    /// Smaller grains: those in the cells that the reach of grain i meets, or all of their level if they are fewer than
    /// these cells.
    template <class F>
    void search_below(std::size_t i, unsigned level, F& f) const {
      const HierarchicalGrid& g = grid_;
      const std::uint32_t first = g.first_[level], last = g.first_[level + 1];
      if (first == last) return;
      const double per_m = g.inverse_cell_ / static_cast<double>(1u << level);
      const double reach = (g.radius(i) + g.largest_[level] + g.gap_) * (1.0 + 1e-9) * per_m;  // in cells
      const double across = 2.0 * reach + 2.0;
      // Written such that a reach that is not finite visits all.
      if (!(across * across * across < static_cast<double>(last - first))) return visit(i, first, last, f);
      const double x[3] = {g.at_.x[i] * per_m, g.at_.y[i] * per_m, g.at_.z[i] * per_m};
      std::int64_t from[3], to[3];
      for (int k = 0; k < 3; ++k) from[k] = morton::cell(x[k] - reach), to[k] = morton::cell(x[k] + reach);
      // How far the cells beside each other are from the grain, in cells, squared.
      const auto apart2 = [&x](int k, std::int64_t c) {
        const double low = static_cast<double>(c), d = std::max({0.0, low - x[k], x[k] - (low + 1.0)});
        return d * d;
      };
      // Coordinates at a level are those at the lowest one without their last bits.
      const auto lowest = [level](std::int64_t c) {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(c) << level);
      };
      for (std::int64_t cz = from[2]; cz <= to[2]; ++cz) {
        const double dz = apart2(2, cz);
        for (std::int64_t cy = from[1]; cy <= to[1]; ++cy) {
          const double dyz = dz + apart2(1, cy);
          for (std::int64_t cx = from[0]; cx <= to[0]; ++cx) {
            if (dyz + apart2(0, cx) > reach * reach) continue;
            const std::uint64_t key = morton::key(morton::code(lowest(cx), lowest(cy), lowest(cz)), level);
            const std::uint32_t c = g.table_.find(g.cells_, key);
            if (c != CellTable::none) visit(i, g.cells_[c].first, g.cells_[c].last, f);
          }
        }
      }
    }

    const HierarchicalGrid& grid_;
    std::uint32_t cell_ = CellTable::none;
    unsigned own_ = 0;  // level of the cell
    std::array<Around, most_levels> around_;
  };
  Finder finder() const { return Finder(*this); }

  std::span<const std::uint32_t> order() const { return order_; }
  unsigned levels() const { return levels_; }  ///< of cells, that of the largest grains counted

  std::size_t memory_bytes() const {
    return sorted_.memory_bytes() + cells_.capacity() * sizeof(Cell) + table_.memory_bytes() +
           (order_.capacity() + members_.capacity() + cell_of_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  static unsigned level_of_key(std::uint64_t key) { return static_cast<unsigned>(std::countl_zero(key)) / 3; }
  double radius(std::size_t i) const { return kind_ == nullptr ? 0.0 : radius_[kind_[i]]; }

  /// The highest level suits the largest grains exactly. There are as many below as suit smaller ones.
  void choose_levels() {
    is_there_.assign(radius_.size(), 0);
    if (kind_ != nullptr) {
      for (std::size_t i = 0; i < at_.n; ++i) is_there_[kind_[i]] = 1;
    }
    double smallest = HUGE_VAL, largest = 0.0;
    for (std::size_t k = 0; k < radius_.size(); ++k) {
      if (is_there_[k] == 0) continue;
      smallest = std::min(smallest, radius_[k]);
      largest = std::max(largest, radius_[k]);
    }
    const double reach = 2.0 * largest + gap_;
    levels_ = 1;
    while (levels_ < most_levels && 2.0 * smallest + gap_ <= reach / static_cast<double>(1u << levels_)) ++levels_;
    inverse_cell_ = static_cast<double>(1u << (levels_ - 1)) / reach;
    level_.assign(radius_.size(), 0);
    largest_.fill(0.0);
    for (std::size_t k = 0; k < radius_.size(); ++k) {
      if (is_there_[k] == 0) continue;
      unsigned& level = level_[k];
      while (level + 1 < levels_ && 2.0 * radius_[k] + gap_ > reach / static_cast<double>(1u << (levels_ - 1 - level)))
        ++level;
      largest_[level] = std::max(largest_[level], radius_[k]);
    }
  }
  /// Members of each level, cell after cell.
  void find_cells() {
    const auto level_of = [&](std::uint32_t grain) { return levels_ == 1 ? 0u : level_[kind_[grain]]; };
    first_.fill(0);
    for (std::uint32_t i = 0; i < at_.n; ++i) ++first_[level_of(i) + 1];
    for (unsigned level = 0; level < most_levels; ++level) first_[level + 1] += first_[level];
    order_.resize(at_.n);
    members_.resize(at_.n);
    cell_of_.resize(at_.n);
    cells_.clear();
    std::array<std::uint32_t, most_levels + 1> next = first_;
    std::array<std::uint32_t, most_levels> open;  // the cell of each level that is being filled
    open.fill(CellTable::none);
    for (std::size_t k = 0; k < at_.n; ++k) {
      const std::uint32_t grain = sorted_[k].grain;
      const unsigned level = level_of(grain);
      const std::uint64_t key = morton::key(sorted_[k].code, level);
      if (open[level] == CellTable::none || cells_[open[level]].key != key) {
        open[level] = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back({key, next[level], next[level]});
      }
      order_[k] = grain;
      members_[next[level]++] = grain;
      cells_[open[level]].last = next[level];
      cell_of_[grain] = open[level];
    }
    table_.fill(cells_);
  }

  Positions at_ = {nullptr, nullptr, nullptr, 0};
  const std::uint32_t* kind_ = nullptr;
  double gap_ = 0.0, inverse_cell_ = 1.0;  // m; 1/m, of the lowest level
  unsigned levels_ = 1;
  std::vector<double> radius_;                             // m, by kind
  std::vector<unsigned> level_;                            // by kind
  std::vector<std::uint8_t> is_there_;                     // by kind: some grain is of it
  std::array<double, most_levels> largest_ = {};           // m, radius of the largest grain of each level
  std::array<std::uint32_t, most_levels + 1> first_ = {};  // of each level's members
  CurveOrder sorted_;
  std::vector<std::uint32_t> order_, members_, cell_of_;  // grains in curve order; level by level; grain -> cell
  std::vector<Cell> cells_;
  CellTable table_;
};

}  // namespace dem::broadphase
