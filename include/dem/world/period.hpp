#pragma once

#include <dem/world/in_words.hpp>

namespace dem {

/// The cell of a periodic world is its domain, which ends nowhere in the directions that repeat. Throws Error where the
/// options and the model's Domain do not go together.
template <class Model>
void set_period(WorldState<Model>& w) {
  const std::array<bool, 3> repeats = {w.options.periodic.x, w.options.periodic.y, w.options.periodic.z};
  const bool any = repeats[0] || repeats[1] || repeats[2];
  w.borders = w.options.domain;
  if constexpr (Model::Domain::has_images) {
    if (!any || !w.options.domain) {
      fail(
          "the world's model has a periodic Domain, but its options name no {}: set WorldOptions::domain to the cell "
          "and WorldOptions::periodic to the directions in which it repeats",
          !w.options.domain ? "domain" : "periodic direction");
    }
    surface::Aabb& d = *w.borders;
    for (std::size_t k = 0; k < 3; ++k) {
      if (repeats[k]) require_positive(d.high.data()[k] - d.low.data()[k], "period of the domain", "m");
    }
    w.domain = {d, repeats};
    if constexpr (domain::IsSheared<typename Model::Domain>) {
      require_within(w.options.shear_rate, -1e9, 1e9, "shear rate (1/s)");
      if (!repeats[0] || !repeats[2]) {
        fail("a sheared cell repeats itself along x and z at least: set WorldOptions::periodic to .x and .z");
      }
      w.domain.set_shear_rate(w.options.shear_rate, 0.0);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (repeats[k]) d.low.data()[k] = -HUGE_VAL, d.high.data()[k] = HUGE_VAL;
    }
  } else if (Model::Domain::has_ranks && any) {
    fail(
        "WorldOptions::periodic is set, but the world's model has an open Domain that ranks share: say `using Domain = "
        "dem::domain::PeriodicRanks;` in the model");
  } else if (any) {
    fail(
        "WorldOptions::periodic is set, but the world's model has an open Domain: say `using Domain = "
        "dem::domain::Periodic;` in the model");
  }
  if (!domain::IsSheared<typename Model::Domain> && w.options.shear_rate != 0.0) {
    fail(
        "WorldOptions::shear_rate is {:g} 1/s, but the world's model is not sheared: say `using Domain = "
        "dem::domain::{};` in the model",
        w.options.shear_rate, Model::Domain::has_ranks ? "ShearedRanks" : "Sheared");
  }
}

/// Throws Error unless the region of an inlet is in the cell of a periodic world.
template <class Model>
void check_region(const WorldState<Model>& w, const surface::Aabb& region, const std::string& inlet) {
  if constexpr (Model::Domain::has_images) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double period = w.domain.period()[k], low = w.domain.low(k), slack = 1e-9 * period;
      const double from = region.low.data()[k], to = region.high.data()[k];
      if (period == 0.0 || (from >= low - slack && to <= low + period + slack)) continue;
      fail("inlet '{}' reaches from {:g} to {:g} m in {}, but must be in the domain's cell, from {:g} to {:g} m", inlet,
           from, to, "xyz"[k], low, low + period);
    }
  }
}

/// Refuses a surface that neither fills a periodic cell nor leaves room for grains between its images. Throws Error.
template <class Model>
void check_surface_in_period(const WorldState<Model>& w, std::size_t number) {
  if constexpr (Model::Domain::has_images) {
    auto surface = w.surfaces[number];
    surface.follow(w.machine.bodies()[surface.body.index()]);
    if (const std::string why = misfit_in_period(w, number, surface); !why.empty()) fail("{}", why);
  }
}

/// Refuses a periodic cell that is so small that a grain would meet itself or another grain twice, and surfaces that do
/// not fit it. Throws Error.
template <class Model>
void check_period(const WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    constexpr const char* axes[] = {"x", "y", "z"};
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
    }
    if constexpr (domain::IsSheared<typename Model::Domain>) {
      if (!w.surfaces.empty() || w.options.sleep) {
        fail("the world's cell is sheared, but has {}, which such a cell cannot have; {}",
             w.surfaces.empty() ? "grains that may sleep" : surface_in_words(w, 0),
             w.surfaces.empty() ? "leave WorldOptions::sleep empty" : "take domain::Periodic");
      }
    }
    for (std::size_t s = 0; s < w.surfaces.size(); ++s) check_surface_in_period(w, s);
  }
}

}  // namespace dem
