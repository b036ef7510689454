#pragma once

#include <dem/coupling/surface_contacts.hpp>
#include <dem/grain/pair_contacts.hpp>
#include <dem/world/sleep.hpp>

#include <algorithm>
#include <span>

namespace dem {

/// Whether the contacts of a chunk's grains with surfaces must be found. Those of sleepers are as they were, unless a
/// surface moves, or grains are watched, or all contacts are counted.
template <class Model>
bool surfaces_act_anew(const WorldState<Model>& w, const Chunk<Model>& chunk) {
  return !chunk.asleep || chunk.watched || chunk.meets_moving || w.record_contacts;
}

/// Adds the forces of surfaces to the sums of a chunk's grains.
template <class Model>
void add_surface_contacts(WorldState<Model>& w, std::size_t c, coupling::SurfaceScratch& scratch,
                          grain::ForceSums& sums) {
  const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, w.grains.count);
  Chunk<Model>& chunk = w.chunks[c];
  const double start = w.stopwatch.clock();
  const auto find = [&](grain::ForceSums& to) {
    coupling::find_surface_contacts<Model>(
        {begin, end, chunk, w.grains, w.species, w.materials, w.surfaces, w.largest_radius, w.domain, scratch},
        w.find_hits, w.time_step, to);
  };
  if (!chunk.asleep) {
    find(sums);
  } else {
    if (surfaces_act_anew(w, chunk)) {
      grain::ForceSums of_surfaces;
      find(of_surfaces);
      grain::keep_of_surfaces(begin, end, of_surfaces, w.sleepers);
    }
    sums.add_columns(w.sleepers.surface_force, w.sleepers.surface_torque, begin);
  }
  chunk.surface_seconds += w.stopwatch.clock() - start;
}

/// Contacts of one chunk's grains with each other and with surfaces. Their forces stay with the chunk, for
/// gather_forces. Within a step their histories are committed: the next stage starts from them.
template <class Model>
void find_chunk_contacts(WorldState<Model>& w, std::size_t c, ContactScratch<Model>& scratch) {
  const std::size_t begin = c * chunk_size, end = std::min(begin + chunk_size, w.grains.count);
  Chunk<Model>& chunk = w.chunks[c];
  const std::size_t chosen =
      grain::choose_candidates(begin, end, chunk, doing(w), w.sleepers.awake_beside, scratch.pairs);
  const bool with_surfaces = surfaces_act_anew(w, chunk);
  chunk.evaluated = chosen > 0 || with_surfaces;
  if (!chunk.evaluated) return;
  scratch.lend(chunk);
  const DeepestContact deepest = chunk.deepest;
  grain::ForceSums sums;
  const grain::ChunkPairs<Model, decltype(w.grains)> pairs{chunk, w.grains, w.species, w.materials, begin};
  grain::find_pair_contacts(pairs, w.time_step, doing(w), sums, scratch.pairs);
  add_surface_contacts(w, c, scratch.surfaces, sums);
  if (!with_surfaces && deepest.with_surface && deepest.overlap > chunk.deepest.overlap) chunk.deepest = deepest;
  sums.write(c, w.grains);
  if (w.options.sleep) grain::keep(begin, end, scratch.pairs.asleep, w.sleepers);
  if (w.sleepers.measuring) {
    const std::span<double> borne(&w.sleepers.borne[begin], chunk_size);
    std::fill(borne.begin(), borne.end(), 0.0);
    grain::add_borne(begin, scratch.pairs.hits, scratch.pairs.forces, true, borne);
    if (with_surfaces) grain::add_borne(begin, scratch.surfaces.hits, scratch.surfaces.forces, false, borne);
  }
  if (w.record_contacts) [[unlikely]]
    w.record_contacts(w, c, scratch);
  if (w.move.keeps_histories) {
    chunk.commit_pairs(scratch.pairs.renews, scratch.pairs.merged);
    if (with_surfaces) chunk.surface_contacts.commit_copy();
  }
  scratch.lend(chunk);
}

}  // namespace dem
