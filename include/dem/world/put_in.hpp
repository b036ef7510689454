#pragma once

#include <dem/world/free_room.hpp>
#include <dem/world/relist.hpp>
#include <dem/world/sleep.hpp>

#include <algorithm>
#include <cstddef>

namespace dem {

/// Tells of a grain that is not in the world yet whether it would touch a surface: by what the step itself asks.
template <class Model>
class SurfaceTrial {
 public:
  explicit SurfaceTrial(const WorldState<Model>& w) : w_(w) { grain_.resize(1); }

  /// Whether it would touch a surface, or lie so deep in one that nothing of it is felt.
  bool touches(SpeciesId kind, const Vec3& x, const Mat3& rotation) {
    if (w_.surfaces.empty()) return false;
    const auto& shape = w_.species[kind.index()].shape;
    grain_.species[0] = kind.value;
    grain_.position.set(0, from_eigen(x));
    grain_.set_rotation(0, from_eigen(rotation));
    if constexpr (Model::Shape::pose_size > 0) shape.orient(grain_.rotation(0), grain_.pose_of(0));
    chunk_.low = chunk_.high = x;
    const coupling::ChunkAtSurfaces<Model> at = {
        0, 1, chunk_, grain_, w_.species, w_.materials, w_.surfaces, w_.largest_radius, w_.domain, scratch_};
    const double reach = at.reach();
    const Vec3 low = x - filled(reach), high = x + filled(reach);
    scratch_.hits.clear(), scratch_.contact_points.clear(), scratch_.total_share.clear(), scratch_.views.clear();
    scratch_.law_of.resize(w_.species.size());
    for (std::size_t s = 0; s < w_.surfaces.size() && scratch_.hits.empty(); ++s) {
      const auto& surface = w_.surfaces[s];
      if (!surface.active || !coupling::may_meet(w_.domain, low, high, surface, reach)) continue;
      if (coupling::is_buried_in<Model>(w_.is_buried[s], surface, w_.domain, from_eigen(x), shape.bounding_radius()))
        return true;
      w_.find_hits[s](at, s);
    }
    return !scratch_.hits.empty();
  }

 private:
  const WorldState<Model>& w_;
  GrainColumns<typename Model::Shape, typename Model::Integrator> grain_;  // one
  Chunk<Model> chunk_;
  coupling::SurfaceScratch scratch_;
};

/// Puts in what an inlet wants, as far as there is room. Rows from `listed` on came since the last neighbour list.
/// Surfaces are where the last forces were found.
template <class Model>
void fill_from(WorldState<Model>& w, Inlet& inlet, std::size_t listed) {
  constexpr int tries = 40;  // places for each grain: random places that fill a box to a third of its volume
  const auto mass_of = [&](SpeciesId s) { return w.species[s.index()].mass; };
  auto& p = w.grains;
  const double gap = w.materials.range();
  FreeRoom room(inlet.region().bounds(), w.largest_radius + 0.5 * gap);
  const auto add_ball = [&](const Vec3& x, double radius) {
    if constexpr (Model::Domain::has_images) {
      w.domain.for_each_image(x, [&](const Vec3& image) { room.add(image, radius); });
    } else {
      room.add(x, radius);
    }
  };
  const auto add = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      add_ball(to_eigen(p.position[i]), w.species[p.species[i]].shape.bounding_radius());
    }
  };
  for (std::size_t c = 0; c < w.chunks.size(); ++c) {
    if (!Model::Domain::has_images && !boxes_overlap(w.chunks[c].low, w.chunks[c].high, room.low(), room.high()))
      continue;
    add(c * chunk_size, std::min((c + 1) * chunk_size, listed));
  }
  add(listed, p.count);  // by other inlets
  SurfaceTrial<Model> trial(w);
  const InletOptions& o = inlet.options();
  while (inlet.want(w.time, mass_of)) {
    const SpeciesId kind = inlet.next();
    const double radius = w.species[kind.index()].shape.bounding_radius();
    Vec3 x = Vec3::Zero();
    Mat3 rotation = Mat3::Identity();
    bool fits = false;
    for (int k = 0; k < tries && !fits; ++k) {
      x = inlet.region().point(inlet.random());
      if (Model::Shape::has_orientation && o.random_orientation) rotation = inlet.random().rotation();
      fits = room.has_room(x, radius, gap) && !trial.touches(kind, x, rotation);
    }
    if (!fits) return inlet.block();
    add_ball(x, radius);
    const Vec3 v = o.velocity + inlet.random().in_ball(o.velocity_spread);
    const std::size_t row = p.append(kind.value, from_eigen(x), from_eigen(v), from_eigen(rotation), {0, 0, 0});
    begin_to_fall(w, row);
    inlet.put(mass_of(kind));
  }
}

/// Before a step: inlets put in what is due. Grains come in batches, as each asks for new neighbour lists: when lists
/// are to be made anyway, or after some steps. Serial, so that the number of threads changes nothing.
template <class Model>
void put_in(WorldState<Model>& w) {
  constexpr std::uint64_t most_steps = 64;  // a list costs as much as a few steps
  const auto mass_of = [&](SpeciesId s) { return w.species[s.index()].mass; };
  bool is_wanted = false;
  for (Inlet& inlet : w.inlets) is_wanted |= inlet.want(w.time, mass_of);
  if (!is_wanted || (w.step < w.put_in_at && !neighbours_outdated(w))) return;
  if constexpr (Model::Domain::has_ranks) gather_rows(w);  // every rank puts the same grains in
  w.put_in_at = w.step + most_steps;
  const std::size_t before = w.grains.count;
  for (Inlet& inlet : w.inlets) {
    if (inlet.want(w.time, mass_of)) fill_from(w, inlet, before);
  }
  if (w.grains.count == before) return;
  list_between_steps(w, [&] { rebuild_neighbours(w); });
}

}  // namespace dem
