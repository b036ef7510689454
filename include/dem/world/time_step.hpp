#pragma once

#include <dem/coupling/body_stability.hpp>
#include <dem/grain/stable_time_step.hpp>
#include <dem/world/state.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace dem {

namespace detail {

/// Of grains with each other and with surfaces, and of bodies with each other.
template <class Model>
StableTimeStep stable_time_step_of_contacts(const WorldState<Model>& w) {
  const mbd::CarriedBodies carried(w.machine.parts());
  std::vector<grain::SurfaceMatter> of_surfaces;
  for (const auto& s : w.surfaces) {
    const Body& body = w.machine.bodies()[s.body.index()];
    const bool gives_way = carried.gives_way(body, s.body);
    of_surfaces.push_back({s.material, coupling::inverse_effective_mass_of(s, body, gives_way, 0.0)});
  }
  auto limit = grain::stable_time_step<Model>(w.species, w.materials, of_surfaces, w.options.overlap_limit);
  const auto bodies = coupling::stable_time_step_of_bodies<Model>(w.body_contacts.pairs, std::span(w.surfaces),
                                                                  std::span(w.machine.bodies()), carried, w.materials,
                                                                  w.options.overlap_limit);
  if (bodies.dt < limit.dt) limit = bodies;
  return limit;
}
template <class Model>
StableTimeStep stable_time_step_of_machine(const WorldState<Model>& w) {
  return w.machine_solver.stable_time_step(w.machine);
}

/// What is derived depends on the pose. It changes with the machine or the time step, not with the grains, and where
/// another pose has made it too stiff. Forces are out of date then: `initialised` becomes false.
template <class Model>
void design_machine(WorldState<Model>& w, double dt, bool& initialised) {
  const bool is_designed = w.machine_solver.is_designed_for(w.machine, dt);
  if (is_designed && stable_time_step_of_machine(w).dt >= dt) return;
  w.machine_solver.design_for(w.machine, dt);
  w.machine_solver.carry_weight(w.machine, w.options.gravity);
  initialised = false;
}

}  // namespace detail

/// Largest stable time step of grains and machine, and what limits it.
template <class Model>
StableTimeStep stable_time_step(const WorldState<Model>& w) {
  const StableTimeStep contacts = detail::stable_time_step_of_contacts(w);
  const StableTimeStep machine = detail::stable_time_step_of_machine(w);
  return machine.dt < contacts.dt ? machine : contacts;
}

namespace detail {

template <class Model>
void choose_time_step_automatically(WorldState<Model>& w, bool& initialised) {
  // A machine's derived stiffness suits whatever step is chosen, so only given stiffness limits the step.
  const double of_given = w.machine_solver.stable_time_step_of_given(w.machine).dt;
  const double limit = std::min(stable_time_step_of_contacts(w).dt, of_given);
  if (limit >= 1e300) fail("nothing in the world limits the time step; set time_step");
  // A step that was chosen before is kept while it is as safe: a change of friction must not change it.
  const double safe = w.options.time_step_safety * limit;
  if (w.time_step == 0.0 || w.time_step > (1.0 + 1e-12) * safe) w.time_step = safe;
  design_machine(w, w.time_step, initialised);
  // Given and derived parts of the same bodies add up, which a safety factor near 1 leaves no room for.
  while (stable_time_step_of_machine(w).dt < w.time_step) design_machine(w, w.time_step *= 0.9, initialised);
}

template <class Model>
void check_time_step(WorldState<Model>& w, double dt, bool& initialised) {
  design_machine(w, dt, initialised);
  StableTimeStep limit = stable_time_step(w);
  if (dt > limit.dt && !w.options.allow_unstable_time_step) {
    // What is derived is derived anew for a smaller step: the one that is named is accepted when it is taken.
    const StableTimeStep machine = w.machine_solver.accepted_time_step(w.machine, dt);
    const bool by_machine = stable_time_step_of_machine(w).dt < dt && machine.dt <= stable_time_step_of_contacts(w).dt;
    if (by_machine) limit = machine;
    fail(
        "time step {:g} s is above the largest stable one, {:g} s ({}); lower time_step or the stiffness, {}or set "
        "allow_unstable_time_step",
        dt, rounded_down(limit.dt), limit.limited_by,
        by_machine ? dem::text("raise machine().substeps (now {}), ", w.machine.substeps) : "");
  }
  w.time_step = dt;
}

}  // namespace detail

/// Chooses or checks the time step. What the machine's user left open is derived for this step; where it is, forces are
/// out of date and `initialised` becomes false. Throws Error for a step above the stable one, and where nothing limits
/// it.
template <class Model>
void choose_time_step(WorldState<Model>& w, bool& initialised) {
  const double given = w.options.time_step;
  given == 0.0 ? detail::choose_time_step_automatically(w, initialised)
               : detail::check_time_step(w, given, initialised);
}

/// What makes a time step that was chosen less than a tenth of what the contacts allow, in words; else empty.
template <class Model>
std::string note_of_time_step(const WorldState<Model>& w) {
  if (w.options.time_step != 0.0) return {};
  const StableTimeStep of_given = w.machine_solver.stable_time_step_of_given(w.machine);
  const double of_contacts = detail::stable_time_step_of_contacts(w).dt;
  if (!(of_contacts < 1e300 && of_given.dt < 0.1 * of_contacts)) return {};
  return dem::text(
      "The time step is {:.3g} of what the contacts allow, because of {}: a smaller stiffness, gain or damping there "
      "makes the run as much faster.",
      of_given.dt / of_contacts, of_given.limited_by);
}

}  // namespace dem
