#pragma once

#include <dem/grain/sleep.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/images.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace dem {

/// What all grains do, for a step; empty where none may sleep.
template <class Model>
grain::Wakefulness doing(const WorldState<Model>& w) {
  return w.options.sleep ? grain::Wakefulness(w.sleepers.doing) : grain::Wakefulness{};
}

/// Wakes the grain of a row. Those beside it are watched in the next evaluation.
template <class Model>
void wake_row(WorldState<Model>& w, std::size_t i) {
  auto& s = w.sleepers;
  if (const std::uint32_t id = w.particles.id[i]; id < s.grains.size()) s.grains[id] = {};
  // One that came since neighbours were listed is in no chunk, and awake.
  if (i / chunk_size >= w.chunks.size() || i >= s.doing.size() || (s.doing[i] & grain::awake)) return;
  s.doing[i] |= grain::awake | grain::changed;
  w.chunks[i / chunk_size].asleep = false;
  w.chunks[i / chunk_size].changed = true;
}
template <class Model>
void wake_chunk(WorldState<Model>& w, std::size_t c) {
  const std::size_t end = std::min((c + 1) * chunk_size, w.particles.count);
  for (std::size_t i = c * chunk_size; i < end; ++i) wake_row(w, i);
}
template <class Model>
void wake_all(WorldState<Model>& w) {
  for (auto& rest : w.sleepers.grains) rest = {};
  for (std::size_t i = 0; i < std::min(w.particles.count, w.sleepers.doing.size()); ++i) {
    w.sleepers.doing[i] = grain::awake;
  }
  for (auto& chunk : w.chunks) chunk.asleep = chunk.changed = false;
}
/// Wakes what may feel that a grain is moved or taken away: its chunk and those around it.
template <class Model>
void wake_around(WorldState<Model>& w, std::size_t row) {
  const std::size_t c = row / chunk_size;
  if (!w.options.sleep || c >= w.chunks.size()) return;
  for (const std::uint32_t other : w.chunks[c].around) wake_chunk(w, other);
  wake_chunk(w, c);
}

/// New neighbour lists: rows hold other grains than before. All contacts are evaluated once.
template <class Model>
void find_sleepers(WorldState<Model>& w) {
  auto& s = w.sleepers;
  const auto& p = w.particles;
  s.all_work = true;
  if (!w.options.sleep) return;
  const std::size_t rows = w.chunks.size() * chunk_size;
  s.grains.resize(p.row_of.size());
  s.borne.assign(rows, 0.0);
  s.acted_on.assign(rows, 0);
  s.doing.assign(p.view.size(), 0);
  const auto clear = [&](AlignedVector<double>& column) { column.assign(rows, 0.0); };
  s.kept_force.for_each_column(clear), s.kept_torque.for_each_column(clear);
  grain::list_chunks_around<Model>(w.chunks);
  if constexpr (Model::Domain::has_ranks) gather_around(w);
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    const std::size_t end = std::min((c + 1) * chunk_size, p.count);
    Chunk<Model>& chunk = w.chunks[c];
    chunk.asleep = true;
    chunk.changed = false;
    for (std::size_t i = c * chunk_size; i < end; ++i) {
      s.doing[i] = s.grains[p.id[i]].asleep ? 0 : grain::awake;
      chunk.asleep &= s.doing[i] == 0;
    }
  }
}

/// Calls f(row) for the grains with which the grain of a row has candidates, as far as this process knows them.
template <class Model, class F>
void for_each_beside(const WorldState<Model>& w, std::size_t row, F&& f) {
  const Chunk<Model>& chunk = w.chunks[row / chunk_size];
  const std::size_t local = row % chunk_size;
  for (std::uint32_t k = chunk.candidate_first[local]; k < chunk.candidate_first[local + 1]; ++k) {
    f(static_cast<std::size_t>(w.images.grain_of(chunk.candidate[k])));
  }
  for (std::uint32_t m = w.incoming_first[row]; m < w.incoming_first[row + 1]; ++m) {
    const auto [other, candidate] = w.incoming[m];
    f(other * chunk_size + w.chunks[other].owner[candidate]);
  }
  for (std::uint32_t k = 0; k < chunk.candidate_first[local]; ++k) {  // of lower rows of its own chunk
    if (w.images.grain_of(chunk.candidate[k]) == row) f(row - local + chunk.owner[k]);
  }
}

/// Watches the grains that fell asleep or woke, and those beside them, for a step: the sums over contacts between
/// sleepers are made anew.
template <class Model>
void watch_changed(WorldState<Model>& w) {
  auto& s = w.sleepers;
  const auto watch = [&](std::size_t i) {
    if (s.doing[i] & grain::awake) return;
    s.doing[i] |= grain::watched;
    w.chunks[i / chunk_size].watched = true;
  };
  std::vector<std::uint32_t> rows;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) {
    if (!std::exchange(w.chunks[c].changed, false)) continue;
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, w.particles.count); ++i) {
      if ((s.doing[i] & grain::changed) == 0) continue;
      s.doing[i] &= static_cast<std::uint8_t>(~grain::changed);
      rows.push_back(static_cast<std::uint32_t>(i));
    }
  }
  if constexpr (Model::Domain::has_ranks) rows = w.domain.gathered(rows);
  for (const std::uint32_t row : rows) {
    watch(row);
    for_each_beside(w, row, watch);
  }
}

/// Whether chunks have grains that are awake or watched: each rank knows it of its own, and tells all others.
template <class Model>
std::vector<std::uint8_t> active_chunks(WorldState<Model>& w) {
  std::vector<std::uint8_t> active;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) active.push_back(!w.chunks[c].asleep || w.chunks[c].watched);
  if constexpr (Model::Domain::has_ranks) active = w.domain.gathered(active);
  return active;
}

/// Chooses the chunks that may have contacts to evaluate: those with grains that are awake or watched, those beside
/// them, and those that a surface that moves may touch. After neighbours were listed it is all of them.
template <class Model>
void choose_working_chunks(WorldState<Model>& w) {
  auto& s = w.sleepers;
  const auto [begin, end] = w.own_chunks();
  s.working.clear();
  if (!w.options.sleep) {
    for (std::size_t c = begin; c < end; ++c) s.working.push_back(static_cast<std::uint32_t>(c));
    s.all_work = false;
    return;
  }
  watch_changed(w);
  if (s.all_work) {
    for (auto& state : s.doing) state |= grain::watched;
    for (auto& chunk : w.chunks) chunk.watched = true;
  }
  const auto touched_by_moving_surface = [&](const Chunk<Model>& chunk) {
    const double reach = shape::widened(w.largest_radius, w.materials.range());
    const Vec3 low = chunk.low - filled(reach), high = chunk.high + filled(reach);
    for (const auto& surface : w.surfaces) {
      if (surface.moved && surface.active && coupling::may_meet(w.domain, low, high, surface, reach)) return true;
    }
    return false;
  };
  const std::vector<std::uint8_t> active = active_chunks(w);
  for (std::size_t c = begin; c < end; ++c) {
    const Chunk<Model>& chunk = w.chunks[c];
    const bool works =
        active[c] || touched_by_moving_surface(chunk) ||
        std::any_of(chunk.around.begin(), chunk.around.end(), [&](std::uint32_t k) { return active[k]; });
    if (!works) continue;
    s.working.push_back(static_cast<std::uint32_t>(c));
    if (!w.record_contacts) continue;
    for (std::size_t i = c * chunk_size; i < (c + 1) * chunk_size; ++i) s.doing[i] |= grain::recorded;
  }
  tell_images(w);
  s.all_work = false;
}

/// At the end of a step: wakes what is disturbed, and puts to sleep what rests.
template <class Model>
void wake_and_put_to_sleep(WorldState<Model>& w) {
  if (!w.options.sleep) return;
  auto& s = w.sleepers;
  auto& p = w.particles;
  const SleepOptions& o = *w.options.sleep;
  const double g = w.options.gravity.norm();
  w.executor.for_each(s.working.size(), [&](std::size_t k) {
    const std::size_t c = s.working[k];
    Chunk<Model>& chunk = w.chunks[c];
    chunk.watched = false;
    chunk.asleep = true;
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, p.count); ++i) {
      const std::uint8_t did = s.doing[i];
      s.doing[i] &= grain::awake | grain::changed;  // a part that holds grains may just have woken it
      if ((did & grain::awake) == 0) {
        if (s.acted_on[i]) s.doing[i] |= grain::touched;
        // Else nothing acts on it but what is kept, and that is as it was.
        if (((did | s.doing[i]) & (grain::watched | grain::touched)) == 0) continue;
        const auto& kind = w.species[p.species[i]];
        if (grain::is_disturbed(i, p, kind, g, s.grains[p.id[i]], o)) wake_row(w, i);
      } else if (s.measuring) {
        const auto& kind = w.species[p.species[i]];
        grain::Rest& rest = s.grains[p.id[i]];
        const double borne = grain::borne_by<Model>(i, w.chunks, w.incoming_first, w.incoming, s);
        if (grain::end_window(i, p, kind, w.options.gravity, borne, rest, o)) {
          rest.asleep = true;
          p.velocity.set(i, {0, 0, 0});
          p.spin.set(i, {0, 0, 0});
          grain::refresh_views(i, i + 1, p, std::span<const Species<typename Model::Shape>>(w.species));
          s.doing[i] = grain::changed;
          chunk.changed = true;
        }
      }
      if (s.doing[i] & grain::awake) chunk.asleep = false;
    }
  });
}

}  // namespace dem
