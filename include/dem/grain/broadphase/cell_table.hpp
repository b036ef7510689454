#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::broadphase {

/// A cell that holds grains, and which: those between two places of a list that is sorted by cells.
struct Cell {
  std::uint64_t key;
  std::uint32_t first, last;
};

/// Finds occupied cells by their keys: a hash table, so memory follows the number of cells that hold grains.
class CellTable {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Takes note of cells, whose keys differ.
  void fill(const std::vector<Cell>& cells) {
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * cells.size(), 16));
    shift_ = 64 - std::countr_zero(size);
    table_.assign(size, none);
    for (std::uint32_t k = 0; k < cells.size(); ++k) {
      std::size_t s = slot(cells[k].key);
      while (table_[s] != none) s = (s + 1) & (size - 1);
      table_[s] = k;
    }
  }
  /// Which of the cells that the table was filled with has this key; `none` if none has.
  std::uint32_t find(const std::vector<Cell>& cells, std::uint64_t key) const {
    for (std::size_t s = slot(key); table_[s] != none; s = (s + 1) & (table_.size() - 1)) {
      if (cells[table_[s]].key == key) return table_[s];
    }
    return none;
  }
  std::size_t memory_bytes() const { return table_.capacity() * sizeof(std::uint32_t); }

 private:
  std::size_t slot(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> shift_);
  }
  int shift_ = 60;
  std::vector<std::uint32_t> table_;
};

}  // namespace dem::broadphase
