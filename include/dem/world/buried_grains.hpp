#pragma once

#include <dem/core/macros.hpp>
#include <dem/world/in_words.hpp>

namespace dem {

/// Looks into the surfaces that were added or switched on since the last look, and of the other ones for grains that
/// were put somewhere since the last step. Throws Error for a grain so deep in a solid that nothing of it is felt: it
/// would pass through without a word. What is less deep overlaps, which the first step reports.
template <class Model>
DEM_SETUP void check_buried_grains(WorldState<Model>& w) {
  const auto& p = w.grains;
  const bool some_placed = w.placed.at == w.step;
  for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
    if (w.is_buried[s] == nullptr || !w.surfaces[s].active) continue;
    const bool is_new = w.new_surfaces.has(s);
    if (!is_new && !some_placed) continue;
    auto surface = w.surfaces[s];
    surface.follow(w.machine.bodies()[surface.body.index()]);
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < p.count; ++i) {
      const auto& kind = w.species[p.species[i]];
      if (!is_new && !w.placed.has_grain(p.id[i])) continue;
      if (kind.is_held() || p.row_of[p.id[i]] == p.gone) continue;
      if (!coupling::is_buried_in<Model>(w.is_buried[s], surface, w.domain, p.position[i],
                                         kind.shape.bounding_radius()))
        continue;
      if (count == 0 || p.number_at(i) < p.number_at(first)) first = i;
      ++count;
    }
    if (count == 0) continue;
    const Vec3 x = to_eigen(p.position[first]);
    fail(
        "grain {} at ({:.4g}, {:.4g}, {:.4g}) m lies within {}, so deep that it would not be felt{}; put it or the "
        "surface elsewhere, or remove it{}",
        p.number_at(first), x.x(), x.y(), x.z(), surface_in_words(w, s),
        count > 1 ? dem::text(" ({} grains do)", count) : std::string(),
        2 * count > p.count ? dem::text(". The surface is {:.3g} m long; is that in another unit? Lengths are in m",
                                        (surface.high - surface.low).norm())
                            : std::string());
  }
  w.new_surfaces = {};
}

}  // namespace dem
