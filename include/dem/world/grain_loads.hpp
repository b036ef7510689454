#pragma once

#include <dem/world/state.hpp>

#include <algorithm>

namespace dem {

/// Adds the loads of World::set_grain_load to the sums of forces of a chunk's grains. Held grains have none, nor those
/// that were removed.
template <class Model>
void add_grain_loads(WorldState<Model>& w, std::size_t chunk) {
  auto& p = w.grains;
  const std::size_t begin = chunk * chunk_size, end = std::min(begin + chunk_size, p.count);
  for (std::size_t i = begin; i < end; ++i) {
    if (p.row_of[p.id[i]] != i || w.species[p.species[i]].is_held()) continue;
    const GrainLoad load = w.grain_load({p.name(p.id[i]), SpeciesId(p.species[i]), w.time_of_forces,
                                         to_eigen(Vector3<double>(p.position[i])),
                                         to_eigen(Vector3<double>(p.velocity[i])), to_eigen(p.angular_velocity(i))});
    p.force.set(i, Vector3<double>(p.force[i]) + from_eigen(load.force));
    p.torque.set(i, Vector3<double>(p.torque[i]) + from_eigen(load.torque));
  }
}

}  // namespace dem
