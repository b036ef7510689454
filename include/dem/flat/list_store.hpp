#pragma once

#include <dem/flat/motion_kernels.hpp>
#include <dem/flat/pair_kernels.hpp>
#include <dem/world/state.hpp>

#include <array>
#include <vector>

namespace dem::flat {

/// The neighbour list in the executor's memory: the chunks' candidates one after the other, and the other way round.
template <class Model>
class ListStore {
 public:
  /// Throws Error for more candidates than 32 bits count.
  void bring_up(WorldState<Model>& w) {
    number_chunks(w);
    std::vector<std::uint32_t> owner(candidates()), partner(candidates()), first(w.grains.count + 1);
    first.back() = static_cast<std::uint32_t>(candidates());
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      const Chunk<Model>& chunk = w.chunks[c];
      const std::size_t begin = c * chunk_size, from = chunk_first_[c];
      for (std::size_t k = 0; k < chunk.candidate.size(); ++k) {
        owner[from + k] = static_cast<std::uint32_t>(begin + chunk.owner[k]);
        partner[from + k] = chunk.candidate[k];
      }
      for (std::size_t i = begin; i < std::min(begin + chunk_size, w.grains.count); ++i) {
        first[i] = static_cast<std::uint32_t>(from + chunk.candidate_first[i - begin]);
      }
    });
    owner_.upload(owner.data(), owner.size());
    partner_.upload(partner.data(), partner.size());
    first_.upload(first.data(), first.size());
    bring_up_incoming(w);
  }

  std::size_t candidates() const { return chunk_first_.empty() ? 0 : chunk_first_.back(); }
  /// The first candidate of each chunk, and one more.
  const std::vector<std::uint32_t>& chunk_first() const { return chunk_first_; }
  CandidatesView view() { return {owner_.data(), partner_.data()}; }
  const std::uint32_t* first_candidate() { return first_.data(); }
  IncomingView incoming() { return {incoming_first_.data(), incoming_.data()}; }
  std::size_t bytes() const {
    return owner_.bytes() + partner_.bytes() + first_.bytes() + incoming_first_.bytes() + incoming_.bytes();
  }

 private:
  template <class T>
  using Array = typename Model::Executor::template Array<T>;

  void number_chunks(const WorldState<Model>& w) {
    chunk_first_.assign(1, 0);
    std::size_t total = 0;
    for (const auto& chunk : w.chunks) {
      total += chunk.candidate.size();
      if (total > 0xfffffff0u) {
        fail("the neighbour list has more than 4.29e9 pairs, which a device does not number; take fewer grains");
      }
      chunk_first_.push_back(static_cast<std::uint32_t>(total));
    }
  }
  /// For each grain the candidates whose partner it is. The world lists those of other chunks, which all have lower
  /// numbers; those of its own chunk come behind them.
  void bring_up_incoming(WorldState<Model>& w) {
    const std::size_t count = w.grains.count;
    std::vector<std::uint32_t> first(count + 1), incoming(candidates());
    // Of each candidate one grain is the partner: the places of a chunk's grains follow from how many there are before.
    std::vector<std::uint32_t> of_chunk(w.chunks.size() + 1, 0);
    w.executor.for_each(w.chunks.size(),
                        [&](std::size_t c) { of_chunk[c + 1] = list_incoming(w, c, nullptr, nullptr); });
    for (std::size_t c = 0; c < w.chunks.size(); ++c) of_chunk[c + 1] += of_chunk[c];
    first.back() = of_chunk.back();
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      const std::size_t begin = c * chunk_size;
      std::array<std::uint32_t, chunk_size> starts = {};
      list_incoming(w, c, starts.data(), incoming.data() + of_chunk[c]);
      for (std::size_t i = begin; i < std::min(begin + chunk_size, count); ++i)
        first[i] = of_chunk[c] + starts[i - begin];
    });
    incoming_first_.upload(first.data(), first.size());
    incoming_.upload(incoming.data(), incoming.size());
  }
  /// Writes where the candidates of each grain of a chunk begin, and the candidates; returns how many there are.
  std::uint32_t list_incoming(const WorldState<Model>& w, std::size_t c, std::uint32_t* starts,
                              std::uint32_t* to) const {
    const Chunk<Model>& chunk = w.chunks[c];
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, w.grains.count);
    std::array<std::uint32_t, chunk_size> own = {};
    for (const std::uint32_t j : chunk.candidate) {
      if (j / chunk_size == c) ++own[j - begin];
    }
    std::array<std::uint32_t, chunk_size> next = {};
    std::uint32_t total = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (starts != nullptr) starts[i - begin] = total;
      for (std::uint32_t m = w.incoming_first[i]; m < w.incoming_first[i + 1]; ++m, ++total) {
        if (to != nullptr) to[total] = chunk_first_[w.incoming[m].chunk] + w.incoming[m].candidate;
      }
      next[i - begin] = total;
      total += own[i - begin];
    }
    if (to == nullptr) return total;
    for (std::size_t k = 0; k < chunk.candidate.size(); ++k) {
      const std::uint32_t j = chunk.candidate[k];
      if (j / chunk_size == c) to[next[j - begin]++] = static_cast<std::uint32_t>(chunk_first_[c] + k);
    }
    return total;
  }

  std::vector<std::uint32_t> chunk_first_;
  Array<std::uint32_t> owner_, partner_, first_, incoming_first_, incoming_;
};

}  // namespace dem::flat
