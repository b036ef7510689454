#pragma once

// Static equilibrium of the machine of a world, and velocities that its joints allow. Not among what <dem/dem.hpp>
// includes.

#include <dem/mbd/solver/rest.hpp>
#include <dem/world/world.hpp>

namespace dem {

/// Brings the machine of a world to rest: moves its bodies to where gravity, springs, loads, joints and contacts are in
/// balance, and stops them, as mbd::find_rest does for a machine alone. Grains are held where they are. They push on
/// what comes near, so a wheel that hangs over a settled bed is set down on it, and sinks in no farther than grains at
/// rest give way. Friction holds what it held before.
///
/// Each iteration evaluates all contacts 12 times for each free body: cheap before there are grains, or with some
/// thousands. Of a large bed, find the rest on a plane first, and let the bed take the load as it runs.
///
///     #include <dem/world/rest.hpp>
///     if (const auto rest = find_rest(world); !rest) fmt::print("{}\n", rest.text);
///
/// Throws Error for a prescribed motion of a body that is not fixed, and what World::run throws. Where ranks share the
/// grains, all ranks call it at once, and an exception of the search ends all of them.
template <class Model>
mbd::RestReport find_rest(World<Model>& world, const mbd::RestOptions& options = {}) {
  WorldState<Model>& w = world.state();
  require_grains_here(w, "the machine's rest");
  auto& parts = w.machine.parts();
  const auto bodies = parts.bodies;
  mbd::detail::stop_for_rest(parts);
  try {
    world.prepare();
  } catch (...) {
    for (std::size_t k = 0; k < bodies.size(); ++k) parts.bodies[k].motion = bodies[k].motion;
    throw;
  }
  const mbd::RestReport report = together(w, domain::Call::rest, "in find_rest", [&] {
    return mbd::detail::search_rest<typename Model::Joints>(parts, w.options.gravity, w.time,
                                                            w.time_step / w.machine.substeps, options, [&w] {
                                                              w.sleepers.all_work = true;
                                                              evaluate_contacts(w);
                                                            });
  });
  if constexpr (Model::Domain::has_ranks) gather_rows(w);
  world.evaluate_anew();
  return report;
}

/// Changes the velocities of a world's machine to what its joints allow, as given_velocities says. The first step does
/// that by itself; velocities that are given later, or after find_rest, need this. What is prescribed moves as it does
/// at the world's time. Where ranks share the grains, all ranks call it at once. Throws what World::run throws.
template <class Model>
const mbd::AssemblyReport& assemble(World<Model>& world) {
  WorldState<Model>& w = world.state();
  world.prepare();
  auto& parts = w.machine.parts();
  if (parts.apply_motions) parts.apply_motions(parts, w.time, 0.0, false);
  w.machine_solver.whole().assemble(w.machine);
  world.evaluate_anew();
  return w.machine_solver.whole().assembly();
}

}  // namespace dem
