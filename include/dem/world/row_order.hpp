#pragma once

#include <dem/world/state.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace dem {

/// Grains sleep in such numbers, a quarter, that it pays to keep those apart that are awake.
inline bool sleepers_go_last(std::size_t asleep, std::size_t grains) { return 4 * asleep >= grains && asleep < grains; }

/// Of rows in the order of space, puts those of grains that sleep last, where there are enough. So chunks are awake or
/// asleep as a whole, and those that are awake hold the contacts with the others. Returns whether it did.
template <class Model>
bool put_sleepers_last(const WorldState<Model>& w, std::vector<std::uint32_t>& order) {
  if (!w.options.sleep) return false;
  std::vector<std::uint32_t> awake, asleep;
  for (const std::uint32_t row : order) (is_asleep(w, w.grains.id[row]) ? asleep : awake).push_back(row);
  if (!sleepers_go_last(asleep.size(), order.size())) return false;
  order = std::move(awake);
  order.insert(order.end(), asleep.begin(), asleep.end());
  return true;
}

/// At the end of a window: where many chunks have both grains that are awake and grains that sleep, neighbours are
/// listed anew, which sorts them. A list costs about as much as two evaluations of all contacts, and a chunk of both
/// kinds half of one that is awake.
template <class Model>
void look_at_order(WorldState<Model>& w) {
  if (!w.sleepers.measuring || !w.list_valid) return;
  const auto [begin, end] = w.own_chunks();
  std::vector<double> counts(3, 0.0);  // grains that are awake, chunks with some, chunks
  for (std::size_t c = begin; c < end; ++c) {
    ++counts[2];
    if (w.chunks[c].asleep) continue;
    ++counts[1];
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, w.grains.count); ++i) {
      counts[0] += w.sleepers.doing[i] & grain::awake;
    }
  }
  if constexpr (Model::Domain::has_ranks) w.domain.share_sums(counts);
  const double chunks_needed = counts[0] / chunk_size + 1.0;
  const double steps = w.options.sleep->window;  // until the next look
  if (!sleepers_go_last(w.grains.count - static_cast<std::size_t>(counts[0]), w.grains.count)) return;
  if (0.5 * steps * (counts[1] - chunks_needed) > 4.0 * counts[2]) give_up_list(w);
}

}  // namespace dem
