#pragma once

#include <dem/grain/chunk.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::grain {

/// When the grains of a chunk may be moved within the sweep that finds contacts: when those of the chunk are found, and
/// those of all chunks that reach it. Nobody reads where its grains were after that, and all forces on them are there.
/// What is moved then is still in the cache. Which thread moves a chunk, and when, changes nothing.
class Turns {
 public:
  /// Before contacts are found: those of the chunks `working` will be, here. Others hold nobody up, and are not moved.
  template <class Model>
  void begin(const std::vector<std::uint32_t>& working, const std::vector<Chunk<Model>>& chunks) {
    waits_.assign(chunks.size(), 1);
    expect(working, chunks);
  }
  /// What these chunks reach waits for them.
  template <class Model>
  void expect(const std::vector<std::uint32_t>& some, const std::vector<Chunk<Model>>& chunks) {
    for (const std::uint32_t c : some) {
      for (const std::uint32_t other : chunks[c].reached) ++waits_[other];
    }
  }
  /// The contacts of chunk c are found. Calls move(k) for each chunk whose turn that makes it.
  template <class Model, class Move>
  void found(std::size_t c, const std::vector<Chunk<Model>>& chunks, Move&& move) {
    count(c, move);
    found_elsewhere(c, chunks, move);
  }
  /// The same of a chunk that another rank works on.
  template <class Model, class Move>
  void found_elsewhere(std::size_t c, const std::vector<Chunk<Model>>& chunks, Move&& move) {
    for (const std::uint32_t other : chunks[c].reached) count(other, move);
  }
  std::size_t bytes() const { return waits_.capacity() * sizeof(waits_[0]); }

 private:
  template <class Move>
  void count(std::size_t c, Move& move) {
    if (std::atomic_ref(waits_[c]).fetch_sub(1, std::memory_order_acq_rel) == 1) move(c);
  }

  std::vector<std::uint32_t> waits_;  // by chunk: how many chunks are to be found yet, itself included
};

}  // namespace dem::grain
