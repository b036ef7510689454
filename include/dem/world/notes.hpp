#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/odd_parts.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dem {

// What is odd about a world though it runs, in words.

/// Of surfaces that are there twice, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_twins(const WorldState<Model>& w) {
  for (std::size_t b = 1; b < w.surfaces.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const auto &first = w.surfaces[a], &second = w.surfaces[b];
      if (!first.active || !second.active || !second.coincides_with(first)) continue;
      return dem::text("Surfaces {} and {} of body '{}' have one shape and one place: both push on what touches them.",
                       a, b, w.machine.bodies()[first.body.index()].name);
    }
  }
  return {};
}

/// Of bodies that nothing holds and that have nothing to lie on, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_loose_bodies(const WorldState<Model>& w) {
  if (w.options.gravity.isZero() || !w.held.empty()) return {};
  std::vector<std::uint32_t> loose = mbd::loose_bodies(w.machine.parts());
  std::erase_if(loose, [&](std::uint32_t body) {
    return std::any_of(w.surfaces.begin(), w.surfaces.end(), [&](const auto& s) { return s.body.index() == body; });
  });
  return mbd::note_of_loose(w.machine.parts(), loose);
}

/// Of densities that hardly any solid has, as those in g/cm^3 or t/mm^3, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_density(const WorldState<Model>& w) {
  for (std::size_t k = 0; k < w.species.size(); ++k) {
    if (const double density = w.species[k].density; density < 5.0 || density > 30e3) {
      return dem::text("Species {} has a density of {:g} kg/m^3; is it in another unit? Sand has 2650 kg/m^3.", k,
                       density);
    }
  }
  return {};
}

/// Of gravity along a direction in which a cell repeats itself and has nothing that could carry grains, in words; else
/// empty. What grains are held by is a surface or a held grain.
template <class Model>
DEM_SETUP std::string note_of_free_fall(const WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    if (!w.surfaces.empty() || !w.held.empty()) return {};
    for (const auto& kind : w.species) {
      if (kind.is_held()) return {};
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double g = w.options.gravity[static_cast<int>(k)];
      if (g == 0.0 || w.domain.period()[k] == 0.0 || w.grains.count == 0) continue;
      return dem::text(
          "Gravity is {:g} m/s^2 along {}, where the cell repeats itself and has no surface: all grains fall "
          "for ever. Set WorldOptions::gravity to zero, or add a floor.",
          g, "xyz"[k]);
    }
  }
  return {};
}

}  // namespace dem
