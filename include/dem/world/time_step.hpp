#pragma once

#include <dem/core/macros.hpp>
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
DEM_SETUP StableTimeStep stable_time_step_of_contacts(const WorldState<Model>& w) {
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
DEM_SETUP StableTimeStep stable_time_step_of_machine(const WorldState<Model>& w) {
  return w.machine_solver.stable_time_step(w.machine);
}

/// Whether what is derived serves steps of dt (s). It depends on the pose. It changes with the machine or a larger time
/// step, not with the grains, and where another pose has made it too stiff. A smaller step goes on with it once the
/// world has run.
template <class Model>
DEM_SETUP bool is_designed_for(const WorldState<Model>& w, double dt) {
  const double design = w.machine_solver.design_step();
  return (dt == design || (w.step > 0 && dt < design)) && w.machine_solver.is_designed_for(w.machine, design) &&
         stable_time_step_of_machine(w).dt >= dt;
}
/// Where something is derived, forces are out of date: `initialised` becomes false.
template <class Model>
DEM_SETUP void design_machine(WorldState<Model>& w, double dt, bool& initialised) {
  if (is_designed_for(w, dt)) return;
  w.machine_solver.design(w.machine, dt, w.options.gravity, w.step > 0);
  initialised = false;
}

}  // namespace detail

/// Largest stable time step of grains and machine, and what limits it.
template <class Model>
DEM_SETUP StableTimeStep stable_time_step(const WorldState<Model>& w) {
  const StableTimeStep contacts = detail::stable_time_step_of_contacts(w);
  const StableTimeStep machine = detail::stable_time_step_of_machine(w);
  return machine.dt < contacts.dt ? machine : contacts;
}

namespace detail {

template <class Model>
DEM_SETUP void choose_time_step_automatically(WorldState<Model>& w, bool& initialised) {
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

/// Throws Error for a step above the stable one. The machine stays as it is.
template <class Model>
DEM_SETUP void refuse_unstable(const WorldState<Model>& w, double dt) {
  mbd::MachineDesign design;
  if (!is_designed_for(w, dt)) design = w.machine_solver.tried(w.machine, dt, w.options.gravity, w.step > 0);
  StableTimeStep limit = stable_time_step_of_contacts(w);
  if (dt <= std::min(limit.dt, design.limit.dt)) return;
  const bool by_machine = design.limit.dt < dt && design.accepted.dt <= limit.dt;
  if (by_machine) limit = design.accepted;
  fail(
      "time step {:g} s is above the largest stable one, {:g} s ({}); lower time_step{} or the stiffness, {}or set "
      "allow_unstable_time_step",
      dt, rounded_down(limit.dt), limit.limited_by, w.step > 0 ? " (World::set_time_step)" : "",
      by_machine ? dem::text("raise machine().substeps above {}, ", design.substeps) : "");
}

template <class Model>
DEM_SETUP void check_time_step(WorldState<Model>& w, double dt, bool& initialised) {
  if (!w.options.allow_unstable_time_step) refuse_unstable(w, dt);
  design_machine(w, dt, initialised);
  w.time_step = dt;
}

}  // namespace detail

/// Chooses or checks the time step. What the machine's user left open is derived for this step; where it is, forces are
/// out of date and `initialised` becomes false. Throws Error for a step above the stable one, and where nothing limits
/// it.
template <class Model>
DEM_SETUP void choose_time_step(WorldState<Model>& w, bool& initialised) {
  const double given = w.options.time_step, before = w.time_step;
  given == 0.0 ? detail::choose_time_step_automatically(w, initialised)
               : detail::check_time_step(w, given, initialised);
  if (w.time_step != before) w.machine_solver.note_stable_step(w.machine);
}

/// What makes a time step that was chosen less than a tenth of what the contacts allow, in words; else empty.
template <class Model>
DEM_SETUP std::string note_of_time_step(const WorldState<Model>& w) {
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
