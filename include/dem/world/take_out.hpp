#pragma once

#include <dem/world/release_ids.hpp>
#include <dem/world/sleep.hpp>

#include <algorithm>

namespace dem {

/// The grain `id` of this row is out of the world from here on, and who leaned on it wakes. The row goes when the next
/// neighbour list is made.
template <class Model>
void take_out_row(WorldState<Model>& w, std::size_t row, std::uint32_t id) {
  // A new list costs as much as a few steps, so grains that leave one after the other wait for each other.
  constexpr std::uint64_t most_steps = 16;
  if (w.to_remove.empty()) w.remove_by = w.step + most_steps;
  wake_around(w, row);
  w.grains.row_of[id] = w.grains.gone;
  w.to_remove.push_back(id);
}

/// Takes the grains out that are in an outlet, or beyond a domain that removes them. Costs a look at the bounds of each
/// chunk; nothing where there is neither. In the order of rows, so that the number of threads changes nothing.
template <class Model>
void take_out(WorldState<Model>& w) {
  const bool ends = w.borders && w.options.beyond_domain == BeyondDomain::remove;
  if (w.outlets.empty() && !ends) [[likely]]
    return;
  const auto& p = w.grains;
  struct Leaver {
    std::uint32_t row, id, species;
  };
  std::vector<Leaver> leavers;
  const auto take = [&](Outlet& outlet, auto&& reaches, auto&& holds) {
    leavers.clear();
    const auto [begin, end] = w.own_chunks();
    for (std::size_t c = begin; c < end; ++c) {
      if (!reaches(w.chunks[c])) continue;
      for (std::size_t i = c * chunk_size; i < std::min((c + 1) * chunk_size, p.count); ++i) {
        if (p.row_of[p.id[i]] == p.gone || !holds(to_eigen(p.position[i]))) continue;
        if (w.species[p.species[i]].is_held()) continue;  // a part of the apparatus
        leavers.push_back({static_cast<std::uint32_t>(i), p.id[i], p.species[i]});
      }
    }
    if constexpr (Model::Domain::has_ranks) leavers = w.domain.gathered(leavers);
    for (const Leaver& l : leavers) {
      outlet.take(w.species[l.species].mass);
      take_out_row(w, l.row, l.id);
    }
    outlet.end_step(w.time_step);
  };
  for (Outlet& outlet : w.outlets) {
    const surface::Aabb region = outlet.region();
    take(
        outlet, [&](const auto& chunk) { return boxes_overlap(chunk.low, chunk.high, region.low, region.high); },
        [&](const Vec3& x) { return none_below(x, region.low) && none_below(region.high, x); });
  }
  if (ends) {
    const surface::Aabb& d = *w.borders;
    // Written such that a NaN is no grain that left: it is reported.
    const auto is_out = [&](const Vec3& low, const Vec3& high) {
      return low.x() < d.low.x() || low.y() < d.low.y() || low.z() < d.low.z() || high.x() > d.high.x() ||
             high.y() > d.high.y() || high.z() > d.high.z();
    };
    take(
        w.beyond_domain, [&](const auto& chunk) { return is_out(chunk.low, chunk.high); },
        [&](const Vec3& x) { return is_out(x, x); });
  }
  if (!w.to_remove.empty() && w.step >= w.remove_by) give_up_list(w);
}

}  // namespace dem
