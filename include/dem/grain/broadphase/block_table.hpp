#pragma once

#include <dem/grain/broadphase/cell_table.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::broadphase {

/// Eight cells, two along each axis, of which some hold grains: the cells whose Morton numbers differ in the last three
/// bits alone. Those bits are a cell's place in the block.
struct Block {
  std::uint64_t key;    ///< number of its cells without the last three bits
  std::uint32_t first;  ///< its first cell that holds grains; the others follow
  std::uint8_t places;  ///< bit k: the cell at place k holds grains

  /// Which cell is at a place that holds grains.
  std::uint32_t cell_at(unsigned place) const {
    return first + static_cast<std::uint32_t>(std::popcount(places & ((1u << place) - 1u)));
  }
};

/// Finds the occupied cells around a cell of one size. Cells are in the order of their Morton numbers, so a block is a
/// stretch of them, and the 27 cells around one are in eight blocks, which are found in a hash table.
class BlockTable {
 public:
  /// Takes note of cells, in the order of their Morton numbers.
  void fill(const std::vector<Cell>& cells) {
    blocks_.clear();
    for (std::uint32_t k = 0; k < cells.size(); ++k) {
      const std::uint64_t key = cells[k].key >> 3;
      if (blocks_.empty() || blocks_.back().key != key) blocks_.push_back({key, k, 0});
      blocks_.back().places |= static_cast<std::uint8_t>(1u << (cells[k].key & 7));
    }
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * blocks_.size(), 16));
    shift_ = 64 - std::countr_zero(size);
    table_.assign(size, CellTable::none);
    for (std::uint32_t k = 0; k < blocks_.size(); ++k) {
      std::size_t s = slot(blocks_[k].key);
      while (table_[s] != CellTable::none) s = (s + 1) & (size - 1);
      table_[s] = k;
    }
  }
  /// The block with this key; null if no cell of it holds grains.
  const Block* find(std::uint64_t key) const {
    for (std::size_t s = slot(key); table_[s] != CellTable::none; s = (s + 1) & (table_.size() - 1)) {
      if (blocks_[table_[s]].key == key) return &blocks_[table_[s]];
    }
    return nullptr;
  }
  std::size_t memory_bytes() const {
    return blocks_.capacity() * sizeof(Block) + table_.capacity() * sizeof(std::uint32_t);
  }

 private:
  std::size_t slot(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> shift_);
  }
  int shift_ = 60;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> table_;
};

}  // namespace dem::broadphase
