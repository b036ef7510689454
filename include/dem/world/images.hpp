#pragma once

// Images of grains in a world whose cell repeats itself (domain::Periodic). In others all of this is nothing.

#include <dem/world/state.hpp>

#include <algorithm>
#include <cstddef>

namespace dem {

/// Puts the grains of a periodic cell back into it, and takes the images away that were beyond its borders.
template <class Model>
void wrap_grains(WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    auto& p = w.grains;
    p.resize(p.count);
    w.images = {};
    for (std::size_t i = 0; i < p.count; ++i) {
      const Vector3<double> inside = w.domain.wrapped(p.position[i]);
      double slip = 0.0;  // m/s, of a sheared cell
      if constexpr (domain::IsSheared<typename Model::Domain>) {
        slip = w.domain.level_of(p.position[i]) * w.domain.slip();
        p.velocity.x[i] -= slip;
      }
      // An integrator that goes back to the start of the step goes back to where that is now. A sheared cell's
      // neighbours were one step's way back then.
      using Memory = typename Model::Integrator::template Memory<double>;
      if constexpr (requires(Memory memory) { memory.start.position; }) {
        if (const Vector3<double> by = inside - p.position[i]; dot(by, by) > 0.0) {
          Memory memory = p.memory_at(i);
          memory.start.position += by + Vector3<double>{slip * w.time_step, 0, 0};
          memory.start.velocity.x -= slip;
          p.set_memory(i, memory);
        }
      }
      const auto& kind = w.species[p.species[i]];
      if (w.ledger.on && w.ledger.knows(p.id[i]) && !kind.is_held()) {
        w.ledger.came -= kind.mass * dot(from_eigen(w.options.gravity), inside - p.position[i]);
      }
      p.position.set(i, inside);
    }
  }
}

/// Makes the images of the grains near a periodic cell's borders, after the grains are sorted.
template <class Model>
void make_images(WorldState<Model>& w, double reach) {
  if constexpr (Model::Domain::has_images) {
    grain::find_images(w.images, w.grains, w.domain, reach);
    grain::make_rows(w.grains, w.images);
  }
}

/// Images go where their grains are.
template <class Model>
void place_images(WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    const std::size_t count = w.images.grain.size();
    w.executor.for_each((count + chunk_size - 1) / chunk_size, [&](std::size_t block) {
      const std::size_t end = std::min((block + 1) * chunk_size, count);
      for (std::size_t k = block * chunk_size; k < end; ++k) grain::follow_grain(w.grains, w.images, w.domain, k);
    });
  }
}

/// Images do what their grains do, where grains may sleep.
template <class Model>
void tell_images(WorldState<Model>& w) {
  if constexpr (Model::Domain::has_images) {
    if (!w.options.sleep) return;
    auto& doing = w.sleepers.doing;
    doing.resize(w.grains.view.size());
    for (std::size_t k = 0; k < w.images.grain.size(); ++k) doing[w.images.first + k] = doing[w.images.grain[k]];
  }
}

}  // namespace dem
