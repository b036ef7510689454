#pragma once

#include <dem/coupling/surface_contacts.hpp>
#include <dem/grain/move.hpp>
#include <dem/grain/pair_contacts.hpp>
#include <dem/world/state.hpp>

namespace dem {

/// Contacts of the grains with each other and with surfaces at the present state, and the loads that surfaces hand to
/// their bodies, whose sums of forces are clear. Each contact's forces stay with its chunk, for gather_forces.
template <class Model>
void find_contacts(WorldState<Model>& w) {
  w.stopwatch.start();
  if (neighbours_outdated(w)) rebuild_neighbours(w);
  w.stopwatch.stop(Phase::neighbours);

  w.stopwatch.start();
  follow_bodies(w);
  w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
    thread_local grain::PairScratch<Model> pair_scratch;
    thread_local coupling::SurfaceScratch surface_scratch;
    grain::ForceSums sums;
    grain::find_pair_contacts<Model>(c, w.chunks[c], w.particles, w.species, w.materials, w.time_step, sums,
                                     pair_scratch);
    const double start = w.stopwatch.clock();
    coupling::find_surface_contacts<Model>(
        {c * chunk_size, std::min((c + 1) * chunk_size, w.particles.count), w.chunks[c], w.particles, w.species,
         w.materials, w.surfaces, w.largest_radius, surface_scratch},
        w.find_hits, w.time_step, sums);
    w.chunks[c].surface_seconds += w.stopwatch.clock() - start;
    sums.write(c, w.particles);
  });
  w.stopwatch.stop(Phase::contacts);
  w.stopwatch.start();
  load_bodies(w);
  if (w.find_body_contacts) w.find_body_contacts(w);
  w.stopwatch.stop(Phase::machine);
}

/// One time step (thesis section 2.5): as many force evaluations as the integrator has stages (the thesis: a predictor
/// and a corrector). What contacts remember is committed in the last stage.
template <class Model>
void advance(WorldState<Model>& w) {
  using Integrator = typename Model::Integrator;
  const Vec3& gravity = w.options.gravity;
  const bool clean_rotations = w.step % grain::steps_between_orthonormalisations == 0;

  for (int stage = 0; stage < Integrator::stages; ++stage) {
    const bool last = stage + 1 == Integrator::stages;
    if constexpr (Integrator::predicts_before_forces) {
      w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
        grain::predict_chunk<Model>(c, w.chunks[c], w.particles, w.species, stage, w.time_step);
      });
    }
    w.stopwatch.start();
    w.machine_solver.stage(w.machine, stage, w.time_step, gravity, [&] {
      w.stopwatch.stop(Phase::machine);
      find_contacts(w);
      w.stopwatch.start();
    });
    w.stopwatch.stop(Phase::machine);

    w.stopwatch.start();
    w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
      grain::gather_forces<Model>(c, w.chunks, w.particles, w.incoming_first, w.incoming);
      grain::move_chunk<Model>(c, w.chunks[c], w.particles, w.species, w.inertia, gravity, stage, w.time_step,
                               clean_rotations && last);
      if (last) w.chunks[c].commit();
    });
    if (last) w.body_contacts.commit();
    if (last) sample_surface_sensors(w);
    w.stopwatch.stop(Phase::motion);
  }
  w.time += w.time_step;
  ++w.step;
}

/// Before the first step, and after anything was changed by hand: forces at the present state, from which integrators
/// that remember an acceleration take their first one.
template <class Model>
void initialise(WorldState<Model>& w) {
  if (w.list_valid) {
    w.executor.for_each(w.chunks.size(),
                        [&](std::size_t c) { grain::refresh_chunk<Model>(c, w.chunks[c], w.particles, w.species); });
  }
  w.machine_solver.initialise(w.machine, w.time, w.options.gravity, [&] { find_contacts(w); });
  w.executor.for_each(w.chunks.size(), [&](std::size_t c) {
    grain::gather_forces<Model>(c, w.chunks, w.particles, w.incoming_first, w.incoming);
    grain::initialise_chunk<Model>(c, w.particles, w.inertia, w.options.gravity);
  });
}

}  // namespace dem
