#pragma once

#include <dem/core/macros.hpp>
#include <dem/core/prefetch.hpp>
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
  bool is_known = true;  // which grain it is; else who owns it knows
  if constexpr (Model::Domain::has_ranks) is_known = w.domain.has_names || w.domain.owns(i / chunk_size);
  if (const std::uint32_t id = w.grains.id[i]; is_known && id < s.grains.size()) s.grains[id] = {};
  // One that came since neighbours were listed is in no chunk, and awake.
  if (i / chunk_size >= w.chunks.size() || i >= s.doing.size() || (s.doing[i] & grain::awake)) return;
  s.doing[i] |= grain::awake | grain::changed;
  w.chunks[i / chunk_size].asleep = false;
  w.chunks[i / chunk_size].changed = true;
}
template <class Model>
void wake_chunk(WorldState<Model>& w, std::size_t c) {
  const std::size_t end = std::min((c + 1) * chunk_size, w.grains.count);
  for (std::size_t i = c * chunk_size; i < end; ++i) wake_row(w, i);
}
template <class Model>
DEM_SETUP void wake_all(WorldState<Model>& w) {
  for (auto& rest : w.sleepers.grains) rest = {};
  for (std::size_t i = 0; i < std::min(w.grains.count, w.sleepers.doing.size()); ++i) {
    w.sleepers.doing[i] = grain::awake;
  }
  for (auto& chunk : w.chunks) chunk.asleep = chunk.changed = false;
  w.sleepers.all_work = true;
}
/// Wakes what may feel that a grain is moved or taken away: its chunk and those around it.
template <class Model>
void wake_around(WorldState<Model>& w, std::size_t row) {
  const std::size_t c = row / chunk_size;
  if (!w.options.sleep || c >= w.chunks.size()) return;
  for (const std::uint32_t other : w.chunks[c].around) wake_chunk(w, other);
  wake_chunk(w, c);
}

/// By row, whether the grain sleeps: of all grains, also of those that other ranks own.
template <class Model>
std::vector<std::uint8_t> who_sleeps(const WorldState<Model>& w) {
  const auto& p = w.grains;
  const auto [begin, end] = w.own_chunks();
  std::vector<std::uint8_t> asleep;
  for (std::size_t i = begin * chunk_size; i < std::min(end * chunk_size, p.count); ++i) {
    asleep.push_back(w.sleepers.grains[p.id[i]].asleep ? 1 : 0);
  }
  if constexpr (Model::Domain::has_ranks) return w.domain.gathered(asleep, false);
  return asleep;
}

/// New neighbour lists: rows hold other grains than before. All contacts are evaluated once.
template <class Model>
void find_sleepers(WorldState<Model>& w) {
  auto& s = w.sleepers;
  const auto& p = w.grains;
  s.all_work = true;
  if (!w.options.sleep) return;
  s.grains.resize(p.row_of.size());
  s.doing.assign(p.view.size(), 0);
  const auto clear = [&, own = w.own_chunks()](auto& column) {
    column.resize(w.chunks.size() * chunk_size);
    std::fill_n(column.begin() + static_cast<std::ptrdiff_t>(own.first * chunk_size),
                (own.second - own.first) * chunk_size, 0);
  };
  clear(s.borne), clear(s.acted_on);
  for (Columns3* columns : {&s.kept_force, &s.kept_torque, &s.surface_force, &s.surface_torque}) {
    columns->for_each_column(clear);
  }
  grain::list_chunks_around<Model>(w.chunks);
  if constexpr (Model::Domain::has_ranks) gather_around(w);
  const std::vector<std::uint8_t> asleep = who_sleeps(w);
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    const std::size_t end = std::min((c + 1) * chunk_size, p.count);
    Chunk<Model>& chunk = w.chunks[c];
    chunk.asleep = chunk.evaluated = true;
    chunk.changed = chunk.watched = chunk.asked = chunk.touched = false;
    for (std::size_t i = c * chunk_size; i < end; ++i) {
      s.doing[i] = asleep[i] ? 0 : grain::awake;
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
    if (other != row / chunk_size) f(other * chunk_size + w.chunks[other].owner[candidate]);
  }
  for (std::uint32_t k = 0; k < chunk.candidate_first[local]; ++k) {  // of lower rows of its own chunk
    if (w.images.grain_of(chunk.candidate[k]) == row) f(row - local + chunk.owner[k]);
  }
}

/// Counts for each grain of this process's chunks how many are awake beside it.
template <class Model>
void count_awake_beside(WorldState<Model>& w) {
  auto& s = w.sleepers;
  for (auto& does : s.doing) {
    does = static_cast<std::uint8_t>((does & ~grain::counted) | (does & grain::awake ? grain::counted : 0));
  }
  s.awake_beside.assign(w.chunks.size() * chunk_size, 0);
  const auto [begin, end] = w.own_chunks();
  w.executor.for_each(end - begin, [&, first = begin](std::size_t k) {
    const std::size_t c = first + k, row = c * chunk_size;
    Chunk<Model>& chunk = w.chunks[c];
    chunk.awake_beside = 0;
    const auto count = [&](std::size_t i, std::size_t j) {
      const auto one = static_cast<std::uint16_t>(s.doing[j] & grain::awake);
      s.awake_beside[i] = static_cast<std::uint16_t>(s.awake_beside[i] + one);
      chunk.awake_beside += one;
    };
    for (std::size_t m = 0; m < chunk.candidate.size(); ++m) {
      const std::size_t i = row + chunk.owner[m], j = w.images.grain_of(chunk.candidate[m]);
      count(i, j);
      if (j / chunk_size == c) count(j, i);
    }
    for (std::size_t i = row; i < std::min(row + chunk_size, w.grains.count); ++i) {
      for (std::uint32_t m = w.incoming_first[i]; m < w.incoming_first[i + 1]; ++m) {
        const auto [other, candidate] = w.incoming[m];
        if (other != c) count(i, other * chunk_size + w.chunks[other].owner[candidate]);
      }
    }
  });
}

/// What all ranks have of a list of which each has a part.
template <class Model>
std::vector<std::uint32_t> gathered_rows(WorldState<Model>& w, std::vector<std::uint32_t> rows) {
  if constexpr (Model::Domain::has_ranks) return w.domain.gathered(rows);
  return rows;
}

/// The grains of this process that fell asleep or woke since contacts were evaluated: twice the row, and one if it is
/// awake.
template <class Model>
std::vector<std::uint32_t> take_changed(WorldState<Model>& w) {
  auto& s = w.sleepers;
  std::vector<std::uint32_t> changed;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) {
    if (!std::exchange(w.chunks[c].changed, false)) continue;
    for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, w.grains.count); ++i) {
      if ((s.doing[i] & grain::changed) == 0) continue;
      s.doing[i] &= static_cast<std::uint8_t>(~grain::changed);
      changed.push_back(static_cast<std::uint32_t>(2 * i) | (s.doing[i] & grain::awake));
    }
  }
  return changed;
}

/// Watches the grains that fell asleep or woke, and those beside them, for a step: the sums over contacts between
/// sleepers are made anew.
template <class Model>
void watch_changed(WorldState<Model>& w) {
  auto& s = w.sleepers;
  std::vector<std::uint32_t> watched_here;
  const auto watch = [&](std::size_t i) {
    if ((s.doing[i] & (grain::awake | grain::watched)) != 0) return;
    s.doing[i] |= grain::watched;
    w.chunks[i / chunk_size].watched = true;
    watched_here.push_back(static_cast<std::uint32_t>(i));
  };
  for (const std::uint32_t told : gathered_rows(w, take_changed(w))) {
    const std::size_t row = told / 2;
    std::uint8_t& does = s.doing[row];
    const auto is_awake = static_cast<std::uint8_t>(told & 1);
    does = static_cast<std::uint8_t>((does & ~grain::awake) | is_awake);  // another rank's grain, too
    const bool is_news = ((does & grain::counted) != 0) != (is_awake != 0);
    if (is_news) does ^= grain::counted;
    watch(row);
    for_each_beside(w, row, [&](std::size_t j) {
      watch(j);
      if (!is_news) return;
      const int more = is_awake ? 1 : -1;
      s.awake_beside[j] = static_cast<std::uint16_t>(s.awake_beside[j] + more);
      w.chunks[j / chunk_size].awake_beside += static_cast<std::uint32_t>(more);
    });
  }
  for (const std::uint32_t row : gathered_rows(w, std::move(watched_here))) {
    for_each_beside(w, row, [&](std::size_t j) {
      s.doing[j] |= grain::asked;
      w.chunks[j / chunk_size].asked = true;
    });
  }
}

/// Chooses the chunks on whose grains new forces may act: those with grains that are awake or watched, or beside such
/// ones, and those that a surface that moves may touch. After neighbours were listed it is all of them.
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
    count_awake_beside(w);
    for (auto& state : s.doing) state |= grain::watched;
    for (auto& chunk : w.chunks) chunk.watched = true;
  }
  const auto touched_by_moving_surface = [&](const Chunk<Model>& chunk) {
    const double reach = shape::widened(w.largest_radius, w.materials.range());
    const Vec3 low = chunk.low - filled(reach), high = chunk.high + filled(reach);
    for (const auto& surface : w.surfaces) {
      if (surface.moved && surface.active && coupling::may_meet(w.domain, low, high, surface.swept, reach)) return true;
    }
    return false;
  };
  for (std::size_t c = begin; c < end; ++c) {
    Chunk<Model>& chunk = w.chunks[c];
    chunk.evaluated = false;
    chunk.meets_moving = touched_by_moving_surface(chunk);
    // One in which grains were touched has a last look at them.
    const bool works =
        !chunk.asleep || chunk.watched || chunk.asked || chunk.touched || chunk.awake_beside > 0 || chunk.meets_moving;
    if (!works) continue;
    s.working.push_back(static_cast<std::uint32_t>(c));
    if (!w.record_contacts) continue;
    for (std::size_t i = c * chunk_size; i < (c + 1) * chunk_size; ++i) s.doing[i] |= grain::recorded;
  }
  tell_images(w);
  s.all_work = false;
}

/// Counts the motion of grains that fell asleep in this step. Ranks tell each other of theirs.
template <class Model>
void count_stopped(WorldState<Model>& w) {
  std::vector<double> stopped;  // J, of the chunks
  for (const std::uint32_t c : w.sleepers.working) stopped.push_back(w.chunks[c].stopped);
  if constexpr (Model::Domain::has_ranks) {
    struct Sleeper {
      double energy;  // J, of the grain afterwards
      std::uint32_t id, padding;
    };
    std::vector<Sleeper> sleepers;
    for (const std::uint32_t c : w.sleepers.working) {
      const std::size_t end = std::min((c + 1) * chunk_size, w.grains.count);
      for (std::size_t i = c * chunk_size; w.chunks[c].changed && i < end; ++i) {
        const std::uint32_t id = w.grains.id[i];
        const bool fell_asleep = (w.sleepers.doing[i] & (grain::awake | grain::changed)) == grain::changed;
        if (fell_asleep) sleepers.push_back({w.ledger.energy[id], id, 0});
      }
    }
    stopped = w.domain.gathered(stopped);
    for (const Sleeper& s : w.domain.gathered(sleepers)) {
      w.ledger.stop(s.id, 0.0);
      w.ledger.energy[s.id] = s.energy;
    }
  }
  for (const double motion : stopped) w.ledger.stopped += motion;
}

/// At the end of a step: wakes what is disturbed, and puts to sleep what rests.
template <class Model>
void wake_and_put_to_sleep(WorldState<Model>& w) {
  if (!w.options.sleep) return;
  auto& s = w.sleepers;
  auto& p = w.grains;
  const SleepOptions& o = *w.options.sleep;
  const double g = w.options.gravity.norm();
  const grain::WindowEnd window = {o, w.options.gravity, o.window * w.time_step};
  // Whether what is known of a grain's rest is read; by id, so anywhere in memory.
  const auto looks_at = [&](std::size_t i) {
    if (s.doing[i] & grain::awake) return s.measuring;
    return s.acted_on[i] != 0 || (s.doing[i] & (grain::watched | grain::touched)) != 0;
  };
  w.executor.for_each(s.working.size(), [&](std::size_t k) {
    const std::size_t c = s.working[k];
    Chunk<Model>& chunk = w.chunks[c];
    chunk.watched = chunk.asked = chunk.touched = false;
    chunk.asleep = true;
    chunk.stopped = 0.0;
    const std::size_t end = std::min((c + 1) * chunk_size, p.count);
    for (std::size_t i = c * chunk_size; i < end; ++i) {
      constexpr std::size_t ahead = 8;  // rows
      if (const std::size_t later = i + ahead; later < end && looks_at(later)) {
        prefetch(&s.grains[p.id[later]], sizeof(grain::Rest));
      }
      const std::uint8_t did = s.doing[i];
      s.doing[i] &= grain::awake | grain::changed | grain::counted;  // a part that holds grains may just have woken it
      if ((did & grain::awake) == 0) {
        if (s.acted_on[i]) s.doing[i] |= grain::touched, chunk.touched = true;
        // Else nothing acts on it but what is kept, and that is as it was.
        if (((did | s.doing[i]) & (grain::watched | grain::touched)) == 0) continue;
        const auto& kind = w.species[p.species[i]];
        const bool is_final = (s.doing[i] & grain::touched) == 0;
        if (grain::is_disturbed(i, p, kind, g, is_final, o, s.grains[p.id[i]])) wake_row(w, i);
      } else if (s.measuring) {
        const auto& kind = w.species[p.species[i]];
        grain::Rest& rest = s.grains[p.id[i]];
        const double borne = grain::borne_by<Model>(i, w.chunks, w.incoming_first, w.incoming, s);
        if (grain::end_window(i, p, kind, borne, rest, window)) {
          rest.asleep = true;
          if (w.ledger.on) [[unlikely]] {
            const double motion =
                kind.is_held() ? 0.0 : kinetic_energy(kind, p.velocity[i], p.local_angular_velocity[i]);
            chunk.stopped += motion;
            w.ledger.stop(p.id[i], motion);
          }
          p.velocity.set(i, {0, 0, 0});
          p.local_angular_velocity.set(i, {0, 0, 0});
          grain::refresh_views(i, i + 1, p, std::span<const Species<typename Model::Shape>>(w.species));
          s.doing[i] = static_cast<std::uint8_t>(grain::changed | (s.doing[i] & grain::counted));
          chunk.changed = true;
        }
      }
      if (s.doing[i] & grain::awake) chunk.asleep = false;
    }
  });
  if (w.ledger.on && s.measuring) [[unlikely]]
    count_stopped(w);
}

}  // namespace dem
