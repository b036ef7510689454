#pragma once

#include <dem/grain/incoming.hpp>
#include <dem/world/list_all.hpp>
#include <dem/world/list_part.hpp>

namespace dem {

/// True when some grain moved more than half the skin since the neighbour list was made.
template <class Model>
bool neighbours_outdated(const WorldState<Model>& w) {
  if (!w.list_valid) return w.grains.count > 0;
  if constexpr (domain::IsSheared<typename Model::Domain>) return 2.0 * w.moved() > w.list_skin;
  return 4.0 * w.moved2() > w.list_skin * w.list_skin;
}

/// Sorts the grains in space, lists their neighbours, and carries the contact histories over. `change(histories)` may
/// put grains in, with their histories, when those that left are out.
template <class Model, class Change>
void rebuild_neighbours(WorldState<Model>& w, Change&& change) {
  w.forget_moved2();
  grain::HistoryCarrier<Model> histories;
  histories.collect(w.executor, std::span<const Chunk<Model>>(w.chunks), w.grains, w.images);
  double skin = 0.0;
  if (has_parts(w)) {
    if constexpr (lists_parts<Model>) skin = list_part(w);
  } else {
    skin = list_all(w, histories, change);
  }
  const auto& p = w.grains;
  w.list_valid = true;
  if (p.count == 0) return;
  grain::list_incoming<Model>(w.executor, std::span(w.chunks), p.count, w.images, w.incoming_first, w.incoming);
  histories.hand_out(w.executor, std::span<Chunk<Model>>(w.chunks), p, w.images, [&](auto& entries) {
    if constexpr (Model::Domain::has_ranks) send_home(w, entries);
  });
  place_images(w);
  w.list_skin = skin;
  ++w.rebuilds;
  if (w.options.skin == 0.0) {
    double candidates = 0.0;
    const auto [begin, end] = w.own_chunks();
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
