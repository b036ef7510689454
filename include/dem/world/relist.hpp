#pragma once

#include <dem/world/neighbours.hpp>
#include <dem/world/sleep.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace dem {

/// Lists neighbours anew between two steps, with grains that `change(histories)` puts in, while all others and the
/// machine go on as they were: nothing is initialised again.
template <class Model, class Change>
void relist(WorldState<Model>& w, Change&& change) {
  w.stopwatch.start();
  rebuild_neighbours(w, change);
  find_sleeping_chunks(w);
  choose_working_chunks(w);
  w.sleepers.all_work = true;
  w.stopwatch.stop(Phase::neighbours);
}

/// Ids of grains that left, before they are given to others: what was known of the old ones is forgotten. To be called
/// when no contact of them is remembered.
template <class Model>
void forget_ids(WorldState<Model>& w, std::span<const std::uint32_t> ids) {
  if (ids.empty()) return;
  std::vector<std::uint32_t> sorted(ids.begin(), ids.end());
  std::sort(sorted.begin(), sorted.end());
  const auto is_one = [&](std::uint32_t id) { return std::binary_search(sorted.begin(), sorted.end(), id); };
  std::erase_if(w.known_lost, is_one);
  for (grain::HeldGrains& held : w.held) std::erase_if(held.grains, [&](const auto& g) { return is_one(g.id); });
  grain::EnergyLedger& ledger = w.ledger;
  std::erase_if(ledger.last,
                [&](const grain::ContactWork& c) { return is_one(c.i) || (!c.on_surface && is_one(c.partner)); });
  for (const std::uint32_t id : sorted) {
    if (id < w.sleepers.grains.size()) w.sleepers.grains[id] = {};
    if (id >= ledger.energy.size()) continue;
    if (ledger.energy[id] == ledger.energy[id]) ledger.came -= ledger.energy[id];
    ledger.energy[id] = std::numeric_limits<double>::quiet_NaN();
    ledger.velocity[id] = ledger.spin[id] = {0, 0, 0};
  }
}

/// The species of grains that are held and are otherwise like those of `s`; made when the world has none.
template <class World>
SpeciesId held_twin(World& world, SpeciesId s) {
  const auto kind = world.species(s);  // a copy: the list may grow
  if (kind.is_held()) return s;
  const auto& all = world.state().species;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto& o = all[k];
    if (o.is_held() && o.material == kind.material && o.mass == kind.mass && o.inertia == kind.inertia &&
        o.shape.bounding_radius() == kind.shape.bounding_radius()) {
      return SpeciesId(k);
    }
  }
  return world.add_species(
      kind.shape, {.material = world.state().materials.name(kind.material), .density = kind.density, .held = true});
}

/// A grain stands still from now on, or moves by itself again, as the species says that it is of now; its contacts go
/// on. Its neighbours have to be listed anew after it.
template <class Model>
void change_species(WorldState<Model>& w, std::size_t row, SpeciesId to) {
  auto& p = w.particles;
  p.species[row] = to.value;
  if (!w.species[to.index()].is_held()) return;
  p.velocity.set(row, {0, 0, 0});
  p.spin.set(row, {0, 0, 0});
  p.set_memory(row, {});
}

}  // namespace dem
