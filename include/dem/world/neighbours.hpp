#pragma once

#include <dem/grain/carry_histories.hpp>
#include <dem/grain/incoming.hpp>
#include <dem/grain/neighbours.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/images.hpp>
#include <dem/world/row_order.hpp>

namespace dem {

/// True when some grain moved more than half the skin since the neighbour list was made.
template <class Model>
bool neighbours_outdated(const WorldState<Model>& w) {
  if (!w.list_valid) return w.particles.count > 0;
  if constexpr (domain::IsSheared<typename Model::Domain>) return 2.0 * w.moved() > w.list_skin;
  return 4.0 * w.moved2() > w.list_skin * w.list_skin;
}

/// The mean bounding radius (m) of the grains that there are: that of all if they have one size.
template <class Model>
double mean_radius(const WorldState<Model>& w) {
  std::vector<std::size_t> grains(w.species.size(), 0);
  for (std::size_t i = 0; i < w.particles.count; ++i) ++grains[w.particles.species[i]];
  double sum = 0.0, smallest = HUGE_VAL, largest = 0.0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    if (grains[k] == 0) continue;
    const double radius = w.species[k].shape.bounding_radius();
    smallest = std::min(smallest, radius), largest = std::max(largest, radius);
    sum += static_cast<double>(grains[k]) * radius;
  }
  return smallest == largest ? largest : sum / static_cast<double>(w.particles.count);
}

/// The skin of the next list (m): the one that was given, or the one that suits the grains' motion. A periodic cell
/// bounds it, as no grain may be listed with two images of another.
template <class Model>
double choose_skin(WorldState<Model>& w) {
  if (w.options.skin > 0.0) return w.options.skin;
  w.skin_choice.radius = mean_radius(w);
  double skin = w.skin_choice.choose(w.step, Model::Integrator::stages);
  if constexpr (Model::Domain::has_images) {
    for (const double period : w.domain.period()) {
      if (period > 0.0) skin = std::min(skin, 0.499 * period - 2.0 * w.largest_radius - w.materials.range());
    }
    w.skin_choice.skin = skin;
  }
  return skin;
}

/// Sorts the grains in space, lists their neighbours, and carries the contact histories over. `change(histories)` may
/// put grains in, with their histories, when those that left are out.
template <class Model, class Change>
void rebuild_neighbours(WorldState<Model>& w, Change&& change) {
  auto& p = w.particles;
  [[maybe_unused]] std::vector<std::uint16_t> holders;
  if constexpr (Model::Domain::has_ranks) {
    count_work(w);
    holders = gather_positions(w);
  }
  grain::HistoryCarrier<Model> histories;
  histories.collect(w.executor, std::span<const Chunk<Model>>(w.chunks), p, w.images);
  if (!w.to_remove.empty()) {
    p.remove(w.to_remove, w.executor);
    w.to_remove.clear();
  }
  change(histories);

  if (p.count == 0) {
    w.images = {};
    w.chunks.clear();
    w.incoming.clear();
    if constexpr (Model::Domain::has_ranks) cut_chunks(w), make_borders(w);
    w.list_valid = true;
    return;
  }
  give_up_list(w);
  const double skin = choose_skin(w);
  const double reach = 2.0 * w.largest_radius + w.materials.range() + skin;
  const auto build = [&](std::size_t rows) {
    const broadphase::Positions at = {p.position.x.data(), p.position.y.data(), p.position.z.data(), rows};
    const auto with = [&](const auto& how_far) {
      if constexpr (requires { w.broad_phase.build(at, how_far, w.executor); }) {
        w.broad_phase.build(at, how_far, w.executor);
      } else {
        w.broad_phase.build(at, how_far);
      }
    };
    if constexpr (broadphase::KnowsSizes<typename Model::BroadPhase>) {
      std::vector<double> radii;
      for (const auto& kind : w.species) radii.push_back(kind.shape.bounding_radius());
      with(broadphase::Sizes{radii, p.species.data(), w.materials.range() + skin});
    } else {
      with(reach);
    }
  };
  wrap_grains(w);
  build(p.count);
  const auto by_space = w.broad_phase.order();
  std::vector<std::uint32_t> sorted(by_space.begin(), by_space.end());
  if (by_space.empty() && w.options.sleep) {
    for (std::uint32_t row = 0; row < p.count; ++row) sorted.push_back(row);
  }
  const bool sleepers_last = put_sleepers_last(w, sorted);
  if (!by_space.empty() || sleepers_last) {
    if constexpr (Model::Domain::has_ranks) permute_rows(w, sorted, holders);
    else p.permute(sorted, w.executor);
    if (sleepers_last) build(p.count);
    else if constexpr (requires { w.broad_phase.reordered(w.executor); }) w.broad_phase.reordered(w.executor);
    else if constexpr (requires { w.broad_phase.reordered(); }) w.broad_phase.reordered();
    else build(p.count);
  }
  p.note_listed(w.executor);
  p.pad();
  if constexpr (Model::Domain::has_images) {
    make_images(w, reach);
    build(p.position.x.size());
  }

  w.chunks.resize(p.chunks());
  if constexpr (Model::Domain::has_ranks) cut_chunks(w), move_rows(w, holders);
  const auto [begin, end] = w.own_chunks();
  w.executor.for_each(end - begin, [&, first = begin](std::size_t k) {
    const std::size_t c = first + k;
    grain::list_candidates<Model>(c, w.chunks[c], p, w.broad_phase, w.images, w.species, w.largest_radius,
                                  w.materials.range() + skin);
    grain::refresh_chunk<Model>(c, w.chunks[c], p, w.species);
  });
  if constexpr (Model::Domain::has_ranks) make_borders(w);
  grain::list_incoming<Model>(w.executor, std::span(w.chunks), p.count, w.images, w.incoming_first, w.incoming);
  histories.hand_out(w.executor, std::span<Chunk<Model>>(w.chunks), p, w.images, [&](auto& entries) {
    if constexpr (Model::Domain::has_ranks) send_home(w, entries);
  });
  place_images(w);
  w.list_valid = true;
  w.list_skin = skin;
  ++w.rebuilds;
  if (w.options.skin == 0.0) {
    double candidates = 0.0;
    for (std::size_t c = begin; c < end; ++c) candidates += static_cast<double>(w.chunks[c].candidate.size());
    if constexpr (Model::Domain::has_ranks) candidates = w.domain.total(candidates);
    const auto count = static_cast<double>(p.count);
    w.skin_choice.made_list(w.materials.range(), candidates / count, w.step, Model::Integrator::stages);
  }
}

/// The same grains as before.
template <class Model>
void rebuild_neighbours(WorldState<Model>& w) {
  rebuild_neighbours(w, [](grain::HistoryCarrier<Model>&) {});
}

/// After a step: a list that has lasted, and holds more than the motion asks for, is made anew.
template <class Model>
void look_at_skin(WorldState<Model>& w) {
  if (w.step < w.skin_choice.look_at) [[likely]]
    return;
  if (w.skin_choice.is_too_wide(w.moved(), w.step, Model::Integrator::stages)) give_up_list(w);
}

}  // namespace dem
