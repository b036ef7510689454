#pragma once

#include <dem/core/compiled.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace dem {

/// What was known of grains (ids) is forgotten.
void forget_grains(WorldCommon& w, std::span<const std::uint32_t> ids);

/// The ids of grains whose rows are gone may be given to others from here on: what was known of the old ones is
/// forgotten. To be called when no contact of them is remembered: at the end of a step, or while neighbours are listed.
template <class Model>
void release_ids(WorldState<Model>& w) {
  if (w.grains.freed.empty()) [[likely]]
    return;
  forget_grains(w, w.grains.freed);
  w.grains.release_ids();
}

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE void forget_grains(WorldCommon& w, std::span<const std::uint32_t> ids) {
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
    ledger.velocity[id] = ledger.global_angular_velocity[id] = {0, 0, 0};
  }
}

}  // namespace dem

#endif
