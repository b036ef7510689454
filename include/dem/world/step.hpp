#pragma once

#include <dem/core/macros.hpp>
#include <dem/grain/move.hpp>
#include <dem/world/border_step.hpp>
#include <dem/world/chunk_contacts.hpp>
#include <dem/world/flat_step.hpp>
#include <dem/world/grain_loads.hpp>
#include <dem/world/neighbours.hpp>
#include <dem/world/sleep.hpp>

namespace dem {

/// Completes the sums of forces on the grains of a chunk.
template <class Model>
void gather_forces(WorldState<Model>& w, std::size_t c) {
  if (w.options.sleep) {
    grain::gather_forces<Model>(c, w.chunks, w.grains, w.incoming_first, w.incoming, w.sleepers);
  } else {
    grain::gather_forces<Model>(c, w.chunks, w.grains, w.incoming_first, w.incoming);
  }
  if (w.grain_load) [[unlikely]]
    add_grain_loads(w, c);
}

/// What moves the grains in the present stage.
template <class Model>
grain::MovingStage<typename Model::Shape> moving_stage(const WorldState<Model>& w) {
  return {w.species, w.inertia, w.options.gravity, w.move.stage, w.time_step, w.move.cleans_rotations, doing(w)};
}

/// Sums the forces of the grains of a chunk and moves them.
template <class Model>
void move_chunk(WorldState<Model>& w, std::size_t c) {
  gather_forces(w, c);
  if (!w.chunks[c].asleep) grain::move_chunk<Model>(c, w.chunks[c], w.grains, moving_stage(w));
}

/// Whether grains are moved within the sweep that finds contacts, while they are in the cache. Of a few chunks most are
/// moved at its end, by the thread that happens to find the last contacts: each thread moves its own after it.
template <class Model>
bool moves_at_once(const WorldState<Model>& w) {
  constexpr std::size_t few = 12;  // chunks a thread; measured with two: 8 each are moved faster after it, 16 are not
  const auto threads = static_cast<std::size_t>(w.executor.threads());
  return threads == 1 || w.sleepers.working.size() > few * threads;
}

/// All contacts at the present state, and the loads that they put on bodies, whose sums of forces are clear. Chunks are
/// moved on the way if they may be (grain::Turns).
template <class Model>
void evaluate_contacts(WorldState<Model>& w) {
  w.stopwatch.start();
  if (w.carry_held) w.carry_held(w), w.forget_moved2();
  if (neighbours_outdated(w)) {
    rebuild_neighbours(w);
    find_sleepers(w);
  }
  w.forget_moved2();
  place_images(w);
  w.stopwatch.stop(Phase::neighbours);

  w.stopwatch.start();
  place_surfaces(w);
  w.scratch.resize(static_cast<std::size_t>(w.executor.threads()));
  choose_working_chunks(w);
  const auto move = [&](std::size_t c) { move_chunk(w, c); };
  w.move.at_once = w.move.at_once && moves_at_once(w);
  if (w.move.at_once) w.turns.begin(w.sleepers.working, w.chunks);
  const auto find_contacts = [&](std::span<const std::uint32_t> working) {
    w.executor.for_each(working.size(), [&](std::size_t k, int thread) {
      find_chunk_contacts(w, working[k], w.scratch[static_cast<std::size_t>(thread)]);
      if (w.move.at_once) w.turns.found(working[k], w.chunks, move);
    });
  };
  if constexpr (Model::Domain::has_ranks) {
    find_shared_contacts(w, find_contacts, move);
  } else {
    find_contacts(w.sleepers.working);
  }
  w.stopwatch.stop(Phase::grains);

  w.stopwatch.start();
  load_bodies(w);
  if (w.load_by_held) w.load_by_held(w);
  if (w.find_body_contacts) w.find_body_contacts(w);
  w.stopwatch.stop(Phase::machine);
}

/// One time step (thesis section 2.5): as many force evaluations as the integrator has stages (the thesis: a predictor
/// and a corrector).
template <class Model>
void advance(WorldState<Model>& w) {
  using Integrator = typename Model::Integrator;
  w.sleepers.measuring = w.options.sleep && (w.step + 1) % static_cast<std::uint64_t>(w.options.sleep->window) == 0;
  begin_step_of_surfaces(w);
  for (int stage = 0; stage < Integrator::stages; ++stage) {
    const bool last = stage + 1 == Integrator::stages;
    // What grains bear goes to the parts that hold some before they are moved.
    w.move = {.stage = stage,
              .keeps_histories = true,
              .cleans_rotations = last && w.step % grain::steps_between_orthonormalisations == 0,
              .at_once = !w.load_by_held};
    w.time_of_forces = w.time + (Integrator::predicts_before_forces || stage > 0 ? w.time_step : 0.0);
    if constexpr (domain::IsSheared<typename Model::Domain>) w.domain.move_to(w.time_of_forces);
    if constexpr (Integrator::predicts_before_forces) {
      w.forget_moved2();
      if constexpr (Model::Domain::has_ranks)
        w.domain.is_whole = !w.domain.is_shared();  // a list made now is of grains that each rank has moved alone
      const auto [begin, end] = w.own_chunks();
      w.executor.for_each(end - begin, [&, first = begin](std::size_t k) {
        const std::size_t c = first + k;
        if (!w.chunks[c].asleep) grain::predict_chunk<Model>(c, w.chunks[c], w.grains, moving_stage(w));
      });
    }
    // The machine's stage clears the bodies' sums, calls for the contacts, adds joints and drives, and moves the
    // bodies.
    w.stopwatch.start();
    w.machine_solver.stage(w.machine, stage, w.time_step, w.options.gravity, [&] {
      w.stopwatch.stop(Phase::machine);
      evaluate_contacts(w);
      w.stopwatch.start();
    });
    w.stopwatch.stop(Phase::machine);

    w.stopwatch.start();
    if (!w.move.at_once) {
      w.executor.for_each(w.sleepers.working.size(), [&](std::size_t k) { move_chunk(w, w.sleepers.working[k]); });
    }
    w.move = {};
    w.body_contacts.commit();
    if (last) sample_surface_sensors(w);
    w.stopwatch.stop(Phase::grains);
  }
  end_step_of_surfaces(w);
  if (w.carry_held) w.carry_held(w);
  if (w.count_energy) [[unlikely]]
    w.count_energy(w);
  if constexpr (domain::IsSheared<typename Model::Domain>) w.domain.move_to(w.time + w.time_step);
  place_images(w);
  wake_and_put_to_sleep(w);
  look_at_order(w);
  w.time += w.time_step;
  ++w.step;
  look_at_skin(w);
}

/// One time step where the grains are: here, or in the memory of the executor.
template <class Model>
void take_step(WorldState<Model>& w) {
  if constexpr (is_flat<Model>()) {
    flat::Step<Model>::advance(w);
  } else {
    advance(w);
  }
}

/// Before the first step, and after anything but grains that were added was changed by hand: forces at the present
/// state, from which integrators that remember an acceleration take their first one.
template <class Model>
DEM_SETUP void initialise(WorldState<Model>& w) {
  w.sleepers.all_work = true;
  w.move = {};
  w.time_of_forces = w.time;
  w.forget_moved2();
  const auto for_each_own_chunk = [&](auto&& f) {
    const auto [begin, end] = w.own_chunks();
    w.executor.for_each(end - begin, [&, first = begin](std::size_t k) { f(first + k); });
  };
  if (w.list_valid) {
    for_each_own_chunk([&](std::size_t c) { grain::refresh_chunk<Model>(c, w.chunks[c], w.grains, w.species); });
  }
  w.machine_solver.initialise(w.machine, w.time, w.time_step, w.options.gravity, [&] { evaluate_contacts(w); });
  for_each_own_chunk([&](std::size_t c) {
    gather_forces(w, c);
    grain::initialise_chunk<Model>(c, w.grains, w.inertia, w.options.gravity);
  });
  for (auto& s : w.surfaces) s.has_place = false, s.went = 0.0;  // by hand, not within a step
  if constexpr (Model::Domain::has_ranks) gather_rows(w);
}

}  // namespace dem
