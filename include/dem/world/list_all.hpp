#pragma once

#include <dem/grain/carry_histories.hpp>
#include <dem/grain/neighbours.hpp>
#include <dem/world/choose_skin.hpp>
#include <dem/world/gather.hpp>
#include <dem/world/images.hpp>
#include <dem/world/row_order.hpp>

namespace dem {

namespace detail {

/// Lets the broad phase take note of the first `rows` rows, images among them.
template <class Model>
void build_broad_phase(WorldState<Model>& w, std::size_t rows, double skin) {
  const auto& p = w.grains;
  const broadphase::Positions at = {p.position.x.data(), p.position.y.data(), p.position.z.data(), rows};
  if constexpr (broadphase::KnowsSizes<typename Model::BroadPhase>) {
    std::vector<double> radii;
    for (const auto& kind : w.species) radii.push_back(kind.shape.bounding_radius());
    const broadphase::Sizes sizes{radii, p.species.data(), w.materials.range() + skin};
    broadphase::build(w.broad_phase, at, sizes, w.executor);
  } else {
    broadphase::build(w.broad_phase, at, list_reach(w, skin), w.executor);
  }
}

/// Puts rows in the order of space, those of sleeping grains last. The broad phase knows them then.
template <class Model>
void sort_all_rows(WorldState<Model>& w, double skin, [[maybe_unused]] std::vector<std::uint16_t>& holders) {
  auto& p = w.grains;
  build_broad_phase(w, p.count, skin);
  const auto by_space = w.broad_phase.order();
  std::vector<std::uint32_t> sorted(by_space.begin(), by_space.end());
  if (by_space.empty() && w.options.sleep) {
    for (std::uint32_t row = 0; row < p.count; ++row) sorted.push_back(row);
  }
  const bool sleepers_last = put_sleepers_last(w, sorted);
  if (by_space.empty() && !sleepers_last) return;
  if constexpr (Model::Domain::has_ranks) permute_rows(w, sorted, holders);
  else p.permute(sorted, w.executor);
  if (sleepers_last || !broadphase::reordered(w.broad_phase, w.executor)) build_broad_phase(w, p.count, skin);
}

}  // namespace detail

/// Sorts all grains and lists the neighbours of those of this process's chunks, with the skin that is returned (m).
template <class Model, class Change>
double list_all(WorldState<Model>& w, grain::HistoryCarrier<Model>& histories, Change&& change) {
  auto& p = w.grains;
  [[maybe_unused]] std::vector<std::uint16_t> holders;
  if constexpr (Model::Domain::has_ranks) {
    count_work(w);
    holders = gather_positions(w);
  }
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
    return w.list_skin;
  }
  give_up_list(w);
  const double skin = choose_skin(w, count_species(w, 0, p.count));
  wrap_grains(w);
  detail::sort_all_rows(w, skin, holders);
  p.note_listed(w.executor);
  p.pad();
  if constexpr (Model::Domain::has_images) {
    make_images(w, list_reach(w, skin));
    detail::build_broad_phase(w, p.position.x.size(), skin);
  }

  w.chunks.resize(p.chunks());
  if constexpr (Model::Domain::has_ranks) cut_chunks(w), move_rows(w, holders);
  const auto [begin, end] = w.own_chunks();
  w.executor.for_each(end - begin, [&, first = begin](std::size_t k) {
    const std::size_t c = first + k;
    grain::list_candidates<Model>(c * chunk_size, w.chunks[c], p, w.broad_phase, w.images, w.species, w.largest_radius,
                                  w.materials.range() + skin);
    grain::refresh_chunk<Model>(c, w.chunks[c], p, w.species);
  });
  if constexpr (Model::Domain::has_ranks) make_borders(w);
  return skin;
}

}  // namespace dem
