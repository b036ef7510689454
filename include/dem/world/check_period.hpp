#pragma once

#include <dem/world/check.hpp>

namespace dem {

/// Refuses a periodic cell that is so small that a grain would meet itself or another grain twice, and a surface that
/// neither fills the cell nor leaves room for grains between its images. Throws Error.
template <class Model>
void check_period(const WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    constexpr const char* axes[] = {"x", "y", "z"};
    const double reach = shape::widened(w.largest_radius, w.materials.range());
    const double skin = w.options.skin > 0.0 ? w.options.skin : grain::SkinChoice::ladder[0] * w.largest_radius;
    const double list_reach = 2.0 * w.largest_radius + w.materials.range() + skin;
    for (std::size_t k = 0; k < 3; ++k) {
      const double period = w.domain.period()[k];
      if (period == 0.0) continue;
      if (!(period > 2.0 * list_reach)) {
        fail(
            "the domain's period in {} is {:g} m, but must be above {:g} m, twice the reach of the neighbour list: "
            "enlarge the cell or take smaller grains",
            axes[k], period, 2.0 * list_reach);
      }
      for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
        auto surface = w.surfaces[s];
        surface.follow(w.machine.bodies()[surface.body.index()]);
        const double low = surface.low.data()[k], high = surface.high.data()[k], extent = high - low;
        if (w.domain.repeats(k, extent, reach)) continue;
        if (low <= w.domain.low(k) && high >= w.domain.low(k) + period) continue;
        fail(
            "{} is {:g} m long in {} (from {:g} to {:g}), where the domain repeats itself every {:g} m: a surface "
            "there "
            "must fill the cell ({:g} to {:g} m) or be shorter than {:g} m, so that grains fit between its images",
            surface_in_words(w, s), extent, axes[k], low, high, period, w.domain.low(k), w.domain.low(k) + period,
            period - 2.0 * reach);
      }
    }
  }
}

}  // namespace dem
