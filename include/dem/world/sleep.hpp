#pragma once

#include <dem/grain/sleep.hpp>
#include <dem/world/state.hpp>

namespace dem {

/// Whether a grain is asleep decides for its chunk: a chunk sleeps if all of its grains do.
template <class Model>
void wake_chunk(WorldState<Model>& w, std::size_t c) {
  w.chunks[c].asleep = false;
  const std::size_t end = std::min((c + 1) * chunk_size, w.particles.count);
  for (std::size_t i = c * chunk_size; i < end; ++i) {
    const std::uint32_t id = w.particles.id[i];
    if (id < w.sleepers.grains.size()) w.sleepers.grains[id] = {};
  }
}
template <class Model>
void wake_all(WorldState<Model>& w) {
  for (auto& rest : w.sleepers.grains) rest = {};
  for (auto& chunk : w.chunks) chunk.asleep = false;
}
/// Wakes what may feel that a grain is moved or taken away: its chunk and those around it.
template <class Model>
void wake_around(WorldState<Model>& w, std::size_t row) {
  const std::size_t c = row / chunk_size;
  if (!w.options.sleep || c >= w.chunks.size()) return;
  if constexpr (Model::Domain::has_ranks) {  // only the owners of chunks know what is around them
    const auto [begin, end] = w.own_chunks();
    for (std::size_t own = begin; own < end; ++own) {
      const auto& around = w.chunks[own].around;
      if (std::find(around.begin(), around.end(), c) != around.end()) wake_chunk(w, own);
    }
  } else {
    for (const std::uint32_t other : w.chunks[c].around) wake_chunk(w, other);
  }
  wake_chunk(w, c);
}

/// New neighbour lists: chunks hold other grains than before. One sleeps if each of its grains slept, or was at rest
/// for as long as grains are that fall asleep. Grains beside which there is one that does not rest go on being at rest:
/// else one that moves would, list by list, wake the chunks after it along the curve.
template <class Model>
void find_sleeping_chunks(WorldState<Model>& w) {
  auto& s = w.sleepers;
  auto& p = w.particles;
  s.all_work = true;
  if (!w.options.sleep) return;
  s.grains.resize(p.row_of.size());
  s.borne.assign(w.chunks.size() * chunk_size, 0.0);
  grain::list_chunks_around<Model>(w.chunks);
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, p.count);
    bool asleep = true;
    for (std::size_t i = begin; i < end; ++i) {
      const grain::Rest& rest = s.grains[p.id[i]];
      asleep &= rest.asleep || rest.quiet_windows == grain::Sleepers::windows_to_sleep;
    }
    w.chunks[c].asleep = asleep;
    if (asleep) grain::put_to_sleep<typename Model::Shape>(begin, end, p, w.species, s);
    else
      for (std::size_t i = begin; i < end; ++i) s.grains[p.id[i]].asleep = false;
  }
}

/// Tells all ranks which chunks sleep. Each knows it of its own.
template <class Model>
void share_sleep(WorldState<Model>& w) {
  std::vector<std::uint8_t> asleep;
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) asleep.push_back(w.chunks[c].asleep);
  asleep = w.domain.gathered(asleep);
  for (std::size_t c = 0; c < asleep.size(); ++c) w.chunks[c].asleep = asleep[c] != 0;
}

/// Chooses the chunks whose contacts are evaluated: those that are awake, and those of the others that somebody awake
/// or a surface that moves may touch. After neighbours were listed it is all of them, as forces are kept by chunk.
template <class Model>
void choose_working_chunks(WorldState<Model>& w) {
  auto& s = w.sleepers;
  s.working.clear();
  const auto touched_by_moving_surface = [&](const Chunk<Model>& chunk) {
    const double reach = shape::widened(w.largest_radius, w.materials.range());
    const Vec3 low = chunk.low - filled(reach), high = chunk.high + filled(reach);
    for (const auto& surface : w.surfaces) {
      if (surface.moved && surface.active && coupling::may_meet(w.domain, low, high, surface, reach)) return true;
    }
    return false;
  };
  if constexpr (Model::Domain::has_ranks) {
    if (w.options.sleep) share_sleep(w);
  }
  const auto [begin, end] = w.own_chunks();
  for (std::size_t c = begin; c < end; ++c) {
    const Chunk<Model>& chunk = w.chunks[c];
    const bool works = s.all_work || !chunk.asleep ||
                       std::any_of(chunk.around.begin(), chunk.around.end(),
                                   [&](std::uint32_t other) { return !w.chunks[other].asleep; }) ||
                       touched_by_moving_surface(chunk);
    if (works) s.working.push_back(static_cast<std::uint32_t>(c));
  }
  s.all_work = false;
}

/// At the end of a step: wakes what is disturbed, and puts to sleep what rests.
template <class Model>
void wake_and_put_to_sleep(WorldState<Model>& w) {
  if (!w.options.sleep) return;
  auto& s = w.sleepers;
  const std::span<const Chunk<Model>> chunks = w.chunks;
  w.executor.for_each(s.working.size(), [&](std::size_t k) {
    const std::size_t c = s.working[k], begin = c * chunk_size, end = std::min(begin + chunk_size, w.particles.count);
    Chunk<Model>& chunk = w.chunks[c];
    if (chunk.asleep) {
      if (grain::is_disturbed<Model>(begin, end, w.particles, w.species, w.options.gravity, s, *w.options.sleep)) {
        wake_chunk(w, c);
      }
    } else if (s.measuring) {
      chunk.asleep = grain::end_window<Model>(begin, end, chunks, w.particles, w.species, w.options.gravity,
                                              w.incoming_first, w.incoming, s, *w.options.sleep);
    }
  });
}

}  // namespace dem
