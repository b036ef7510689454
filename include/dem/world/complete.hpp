#pragma once

// The contacts of all chunks on every rank (domain::Ranks), for who looks at contacts or saves a state.

#include <dem/grain/incoming.hpp>
#include <dem/world/border.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/sleep.hpp>

#include <cstddef>
#include <vector>

namespace dem {

namespace detail {

/// Calls f(items, count) for each list of contact histories.
template <class Histories, class F>
void for_each_list(Histories& histories, F&& f) {
  const auto n = static_cast<std::size_t>(histories.count);
  f(histories.key.data(), n);
  for (auto& column : histories.history) f(column.data(), n);
}

/// What a chunk knows and no other rank does, as bytes.
template <class Model>
void write_chunk(std::vector<std::byte>& message, Chunk<Model>& chunk) {
  const auto put = [&](const auto* items, std::size_t n) { append(message, items, n); };
  const std::uint64_t sizes[] = {chunk.candidate.size(), static_cast<std::uint64_t>(chunk.pair_contacts.last.count),
                                 static_cast<std::uint64_t>(chunk.surface_contacts.last.count),
                                 chunk.partner_load_first.back(), chunk.surface_loads.size()};
  put(sizes, std::size(sizes));
  put(chunk.candidate_first.data(), chunk.candidate_first.size());
  put(chunk.candidate.data(), chunk.candidate.size());
  put(chunk.partner_load_first.data(), chunk.partner_load_first.size());
  put(chunk.partner_loads.data(), sizes[3]);
  put(chunk.surface_loads.data(), chunk.surface_loads.size());
  if constexpr (shape::WarmStartedShape<typename Model::Shape>) {
    put(chunk.searches.start.data(), chunk.searches.start.size());
  }
  for_each_list(chunk.pair_contacts.last, put);
  for_each_list(chunk.surface_contacts.last, put);
}
template <class Model>
void read_chunk(const std::vector<std::byte>& message, std::size_t& at, Chunk<Model>& chunk) {
  const auto get = [&](auto* items, std::size_t n) { read(message, at, items, n); };
  std::uint64_t sizes[5];
  get(sizes, std::size(sizes));
  get(chunk.candidate_first.data(), chunk.candidate_first.size());
  chunk.candidate.resize(sizes[0]);
  get(chunk.candidate.data(), sizes[0]);
  grain::list_owners(chunk);
  get(chunk.partner_load_first.data(), chunk.partner_load_first.size());
  chunk.partner_loads.resize(sizes[3]);
  get(chunk.partner_loads.data(), sizes[3]);
  chunk.surface_loads.resize(sizes[4]);
  get(chunk.surface_loads.data(), sizes[4]);
  if constexpr (shape::WarmStartedShape<typename Model::Shape>) get(chunk.searches.start.data(), sizes[0]);
  const auto of = [&](auto& histories, std::uint64_t n) {
    histories.reserve(n + static_cast<std::size_t>(pack_width));
    histories.count = static_cast<int>(n);
    for_each_list(histories, get);
  };
  of(chunk.pair_contacts.last, sizes[1]);
  of(chunk.surface_contacts.last, sizes[2]);
}

}  // namespace detail

/// Gives every rank the contacts of all chunks. To be called by all ranks at once, for a copy of a world that is looked
/// at and not run on.
template <class Model>
void complete_chunks(WorldState<Model>& w) {
  auto& d = w.domain;
  gather_rows(w);
  if (d.is_complete || !d.is_shared()) return;
  std::vector<std::byte> message;
  const auto [begin, end] = d.own();
  for (std::size_t c = begin; c < end; ++c) detail::write_chunk(message, w.chunks[c]);
  message = d.gathered(message, false);
  std::size_t at = 0;
  for (auto& chunk : w.chunks) detail::read_chunk(message, at, chunk);
  for (std::size_t c = 0; c < std::min(w.chunks.size(), w.grains.chunks()); ++c) {
    if (!d.owns(c)) grain::refresh_chunk<Model>(c, w.chunks[c], w.grains, w.species);
  }
  w.sleepers.working = d.gathered(w.sleepers.working, false);
  if (w.options.sleep) {
    auto& s = w.sleepers;
    const std::size_t width = s.borne.empty() ? 0 : chunk_size;
    const auto gather = [&](auto& column) { d.gather_chunks(column.data(), width); };
    gather(s.borne);
    for (Columns3* columns : {&s.kept_force, &s.kept_torque, &s.surface_force, &s.surface_torque}) {
      columns->for_each_column(gather);
    }
    const auto first = s.doing.begin() + static_cast<std::ptrdiff_t>(begin * width),
               last = s.doing.begin() + static_cast<std::ptrdiff_t>(end * width);
    s.doing = d.gathered(std::vector<std::uint8_t>(first, last), false);
  }
  if (w.list_valid) place_images(w), tell_images(w);  // else the rows of images may be gone
  if (!w.chunks.empty()) {
    grain::list_incoming<Model>(w.executor, std::span(w.chunks), w.grains.count, w.images, w.incoming_first,
                                w.incoming);
    if (w.options.sleep) grain::list_chunks_around<Model>(w.chunks);
  }
  d.is_complete = true;
}

/// The opposite, after a state was loaded on every rank: each keeps the contacts of its own chunks.
template <class Model>
void share_chunks(WorldState<Model>& w) {
  auto& d = w.domain;
  d.is_whole = d.has_names = true;
  cut_chunks(w);
  make_borders(w);
  if (!d.is_shared()) return;
  if (w.options.sleep) gather_around(w);
  std::erase_if(w.sleepers.working, [&](std::uint32_t c) { return !d.owns(c); });
}

}  // namespace dem
