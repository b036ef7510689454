#pragma once

// Who tells whom what in each step, where ranks share the grains (domain::Ranks). It is agreed on with each neighbour
// list. In worlds that are not shared all of this is nothing.

#include <dem/core/sorted.hpp>
#include <dem/world/images.hpp>

#include <cstddef>
#include <cstring>
#include <vector>

namespace dem {

namespace detail {

/// A chunk of another rank has no candidates but those that reach this rank: most have none.
template <class Model>
void forget_contacts(Chunk<Model>& chunk) {
  const bool has_lists = !chunk.candidate.empty() || !chunk.sleeps.empty() || !chunk.surface_loads.empty();
  if (!has_lists && chunk.pair_contacts.last.count == 0 && chunk.surface_contacts.last.count == 0 &&
      chunk.partner_load_first.size() == 1) {
    return chunk.around.clear();
  }
  chunk.candidate.clear();
  chunk.candidate_first.fill(0);
  chunk.pair_contacts.last.count = chunk.surface_contacts.last.count = 0;
  chunk.partner_loads.clear();
  chunk.sleeps.clear();
  chunk.surface_loads.clear();
  chunk.around.clear();
  grain::list_owners(chunk);
}

/// Marks, beside their number, loads of contacts between sleepers.
inline constexpr std::uint32_t sleeping_load = 0x8000;

/// Appends the bytes of n items to a message.
template <class T>
void append(std::vector<std::byte>& message, const T* items, std::size_t n) {
  const std::size_t at = message.size();
  message.resize(at + n * sizeof(T));
  if (n > 0) std::memcpy(message.data() + at, items, n * sizeof(T));
}
/// Reads the next n items of a message.
template <class T>
void read(const std::vector<std::byte>& message, std::size_t& at, T* items, std::size_t n) {
  if (n > 0) std::memcpy(static_cast<void*>(items), message.data() + at, n * sizeof(T));
  at += n * sizeof(T);
}

}  // namespace detail

/// Agrees with the other ranks on what goes over the borders in each step. To be called when this rank's chunks have
/// their candidates. The chunks of other ranks get those candidates that are grains of this rank, in their order: sums
/// of forces are made from them as if the chunks were here.
template <class Model>
void make_borders(WorldState<Model>& w) {
  auto& d = w.domain;
  const auto ranks = static_cast<std::size_t>(d.ranks());
  d.borders.assign(ranks, {});
  d.is_at_border.assign(w.chunks.size(), 0);
  d.is_complete = !d.is_shared();
  if (!d.is_shared()) return;
  const auto [begin, end] = d.own();
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    if (c < begin || c >= end) detail::forget_contacts(w.chunks[c]);
  }
  std::vector<std::vector<std::uint32_t>> wanted(ranks), lists(ranks);
  for (std::size_t c = begin; c < end; ++c) {
    const Chunk<Model>& chunk = w.chunks[c];
    for (std::uint32_t k = 0; k < chunk.candidate.size(); ++k) {
      const std::uint32_t j = chunk.candidate[k], grain = w.images.grain_of(j);
      const int owner = d.owner(grain / chunk_size);
      if (owner == d.rank()) continue;
      const auto r = static_cast<std::size_t>(owner);
      auto& border = d.borders[r];
      if (border.chunks_out.empty() || border.chunks_out.back() != c) {
        border.chunks_out.push_back(static_cast<std::uint32_t>(c));
        border.first_out.push_back(static_cast<std::uint32_t>(border.candidates_out.size()));
      }
      border.candidates_out.push_back(k);
      wanted[r].push_back(grain);
      lists[r].insert(lists[r].end(), {static_cast<std::uint32_t>(c), chunk.owner[k], j});
      d.is_at_border[c] = 1;
    }
  }
  for (std::size_t r = 0; r < ranks; ++r) {
    d.borders[r].first_out.push_back(static_cast<std::uint32_t>(d.borders[r].candidates_out.size()));
    sort_and_drop_doubles(wanted[r]);
    d.borders[r].rows_in = wanted[r];
  }
  const auto [asked, asked_first] = d.exchanged(wanted);
  const auto [came, came_first] = d.exchanged(lists);
  for (std::size_t r = 0; r < ranks; ++r) {
    auto& border = d.borders[r];
    border.rows_out.assign(asked.begin() + asked_first[r], asked.begin() + asked_first[r + 1]);
    for (int at = came_first[r]; at < came_first[r + 1]; at += 3) {
      const std::uint32_t c = came[static_cast<std::size_t>(at)], i = came[static_cast<std::size_t>(at) + 1];
      Chunk<Model>& chunk = w.chunks[c];
      if (border.chunks_in.empty() || border.chunks_in.back() != c) border.chunks_in.push_back(c);
      chunk.candidate.push_back(came[static_cast<std::size_t>(at) + 2]);
      ++chunk.candidate_first[i + 1];
    }
    for (const std::uint32_t c : border.chunks_in) {
      Chunk<Model>& chunk = w.chunks[c];
      for (std::size_t k = 0; k < chunk_size; ++k) chunk.candidate_first[k + 1] += chunk.candidate_first[k];
      grain::list_owners(chunk);
    }
  }
}

/// How many numbers tell the motion of a grain: position, velocity, angular velocity, what its pose is made from, and
/// what it does where grains may sleep.
template <class Model>
inline constexpr std::size_t motion_width = Model::Shape::pose_size > 0 ? 19 : 10;

}  // namespace dem
