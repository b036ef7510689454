#pragma once

#include <dem/world/state.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dem {

/// How many grains of each species the rows first to last - 1 hold.
template <class Model>
std::vector<double> count_species(const WorldState<Model>& w, std::size_t first, std::size_t last) {
  std::vector<double> grains(w.species.size(), 0.0);
  for (std::size_t i = first; i < last; ++i) grains[w.grains.species[i]] += 1.0;
  return grains;
}

/// The mean bounding radius (m) of so many grains of each species: that of all if they have one size.
template <class Model>
double mean_radius(const WorldState<Model>& w, const std::vector<double>& grains) {
  double sum = 0.0, all = 0.0, smallest = HUGE_VAL, largest = 0.0;
  for (std::size_t k = 0; k < grains.size(); ++k) {
    if (grains[k] == 0.0) continue;
    const double radius = w.species[k].shape.bounding_radius();
    smallest = std::min(smallest, radius), largest = std::max(largest, radius);
    sum += grains[k] * radius, all += grains[k];
  }
  return smallest == largest ? largest : sum / all;
}

/// The skin of the next list (m), of so many grains of each species: the one that was given, or the one that suits the
/// grains' motion. A periodic cell bounds it, as no grain may be listed with two images of another.
template <class Model>
double choose_skin(WorldState<Model>& w, const std::vector<double>& grains) {
  if (w.options.skin > 0.0) return w.options.skin;
  w.skin_choice.radius = mean_radius(w, grains);
  if constexpr (requires { Model::Executor::list_weight; }) w.skin_choice.list_weight = Model::Executor::list_weight;
  double skin = w.skin_choice.choose(w.step, Model::Integrator::stages);
  if constexpr (Model::Domain::has_images) {
    for (const double period : w.domain.period()) {
      if (period > 0.0) skin = std::min(skin, 0.499 * period - 2.0 * w.largest_radius - w.materials.range());
    }
    w.skin_choice.skin = skin;
  }
  return skin;
}

/// How far apart (m) the centres of two grains may be that are listed with this skin: the cells' size.
template <class Model>
double list_reach(const WorldState<Model>& w, double skin) {
  return 2.0 * w.largest_radius + w.materials.range() + skin;
}

}  // namespace dem
