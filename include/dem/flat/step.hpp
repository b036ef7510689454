#pragma once

#include <dem/flat/store.hpp>
#include <dem/flat/surface_loads.hpp>
#include <dem/world/step.hpp>

namespace dem::flat {

/// The step of a world whose executor has memory of its own. The grains are there while a run lasts; the machine stays
/// here. Each evaluation sends the surfaces up and their loads down. For a new neighbour list the grains come back, the
/// world lists them, and they go again.
template <class Model>
struct Step {
  static_assert(check_flat_model<Model>());
  using Integrator = typename Model::Integrator;
  using World = WorldState<Model>;
  struct Kept : Store<Model> {
    SurfaceLoads<Model> loads;
  };

  /// Calls steps(), which takes n steps, with the grains in the executor's memory; the world is whole again after it.
  template <class F>
  static auto run(World& w, std::uint64_t n, F&& steps) {
    check_flat(w);
    if (n == 0) return steps();
    auto report = [&] {
      try {
        return steps();
      } catch (...) {
        try {
          come_home(w);
        } catch (...) {  // the first one tells more
          w.executor.set_holds_grains(false);
        }
        throw;
      }
    }();
    come_home(w);
    return report;
  }

  /// dem::advance() of such a world.
  static void advance(World& w) {
    check_flat(w);
    Kept& kept = kept_of(w);
    if (!w.executor.holds_grains()) leave(w);
    begin_step_of_surfaces(w);
    for (int stage = 0; stage < Integrator::stages; ++stage) {
      const bool last = stage + 1 == Integrator::stages;
      w.move = {.stage = stage,
                .keeps_histories = true,
                .cleans_rotations = last && w.step % grain::steps_between_orthonormalisations == 0,
                .at_once = true};
      kept.begin_stage();
      if constexpr (Integrator::predicts_before_forces) predict(w, kept);
      w.stopwatch.start();
      w.machine_solver.stage(w.machine, stage, w.time_step, w.options.gravity, [&] {
        w.stopwatch.stop(Phase::machine);
        evaluate_contacts(w, kept);
        w.stopwatch.start();
      });
      w.stopwatch.stop(Phase::machine);
      w.move = {};
      w.body_contacts.commit();
      if (last) sample_surface_sensors(w);
    }
    end_step_of_surfaces(w);
    w.time += w.time_step;
    ++w.step;
    look_at_skin(w);
    if (asks_for_a_look(w, kept.summary)) come_home(w);
  }

 private:
  static Kept& kept_of(World& w) { return w.executor.template kept<Kept>(); }

  static void leave(World& w) { kept_of(w).bring_up(w); }
  static void come_home(World& w) {
    if (w.executor.holds_grains()) kept_of(w).bring_down(w);
  }
  /// Whether find_problem() would find one, and needs the grains to say which.
  static bool asks_for_a_look(const World& w, const Summary& s) {
    const bool reports_lost = w.borders && w.options.beyond_domain == BeyondDomain::report;
    const bool may_pass = std::any_of(w.surfaces.begin(), w.surfaces.end(),
                                      [&](const auto& surface) { return may_have_passed(w, surface); });
    return s.not_finite > 0 || s.overlap > w.options.overlap_limit || (reports_lost && s.outside > 0) || may_pass;
  }

  static void predict(World& w, Kept& kept) {
    w.executor.reduce("predict grains", kept.grains.count(),
                      PredictGrains<Model>{kept.grains.view(), kept.grains.domain(w), w.move.stage, w.time_step},
                      kept.summary_place());
    w.executor.wait();
    kept.take_summary(w);
  }

  /// All contacts at the present state, the loads that they put on bodies, and the motion of the grains.
  static void evaluate_contacts(World& w, Kept& kept) {
    w.stopwatch.start();
    if (neighbours_outdated(w)) {
      come_home(w);
      rebuild_neighbours(w);
      leave(w);
    }
    w.stopwatch.stop(Phase::neighbours);

    w.stopwatch.start();
    dem::place_surfaces(w);
    const SurfacesView<Model> surfaces = kept.place_surfaces(w);
    find_contacts(w, kept, surfaces);
    evaluate_laws(w, kept, surfaces);
    move_grains(w, kept);
    kept.loads.sum(w, kept.at_surfaces.now().key, kept.at_surfaces.results(), kept.total(1));
    w.executor.wait();
    kept.take_summary(w);
    if (w.move.keeps_histories) kept.commit();
    w.stopwatch.stop(Phase::grains);

    w.stopwatch.start();
    kept.loads.hand_over(w);
    pass_on_loads(w);
    if (w.find_body_contacts) w.find_body_contacts(w);
    w.stopwatch.stop(Phase::machine);
  }

  static Gap<Model> gap(const World& w) {
    if constexpr (cohesion::reaches<typename Model::Cohesion>) return w.materials.range();
    else return {};
  }

  /// Finds the contacts of pairs and at surfaces, and numbers them.
  static void find_contacts(World& w, Kept& kept, const SurfacesView<Model>& surfaces) {
    auto& e = w.executor;
    const auto grains = kept.grains.view();
    const std::size_t count = kept.grains.count(), candidates = kept.list.candidates();
    const PairContactsView<Model> pairs = kept.pairs.now();
    e.launch("find contacts of pairs", candidates,
             FindContactBits<Model>{grains, kept.list.view(), gap(w), pairs.bits});
    e.scan("number contacts of pairs", candidates, CountContactBits<ContactBits<typename Model::Shape>>{pairs.bits},
           pairs.first, kept.totals_place());
    e.launch("find contacts at surfaces", count,
             CountSurfaceContacts<Model>{grains, surfaces, gap(w), kept.at_surfaces.count()});
    e.scan("number contacts at surfaces", count, CountedBefore{kept.at_surfaces.count()}, kept.at_surfaces.now().first,
           kept.totals_place() + 1);
    e.wait();
    kept.pairs.make_room(kept.total(0));
    kept.at_surfaces.make_room(kept.total(1));
  }

  static void evaluate_laws(World& w, Kept& kept, const SurfacesView<Model>& surfaces) {
    auto& e = w.executor;
    const auto grains = kept.grains.view();
    const PairContactsView<Model> pairs = kept.pairs.now();
    e.launch("list contacts of pairs", kept.list.candidates(),
             ListPairContacts<ContactBits<typename Model::Shape>>{pairs.bits, pairs.first, kept.pairs.places()});
    e.launch("laws of pairs", kept.total(0),
             EvaluatePairContacts<Model>{grains, kept.list.view(), kept.laws.of_pairs(w.time_step), kept.pairs.places(),
                                         pairs, kept.pairs.last(), kept.pairs.results()});
    if (kept.total(1) == 0) return;
    e.launch("list contacts at surfaces", kept.grains.count(),
             ListSurfaceContacts{kept.at_surfaces.now().first, kept.at_surfaces.grain_of()});
    e.launch("laws at surfaces", kept.total(1),
             EvaluateSurfaceContacts<Model>{grains, surfaces, kept.laws.at_surfaces(w.time_step), gap(w),
                                            kept.at_surfaces.grain_of(), kept.at_surfaces.now(),
                                            kept.at_surfaces.last(), kept.at_surfaces.results()});
  }

  static void move_grains(World& w, Kept& kept) {
    w.executor.reduce(
        "move grains", kept.grains.count(),
        MoveGrains<Model>{kept.grains.view(), kept.grains.domain(w), kept.list.first_candidate(), kept.list.incoming(),
                          kept.pairs.now().first, kept.pairs.results(), kept.at_surfaces.now().first,
                          kept.at_surfaces.results(), from_eigen(w.options.gravity), w.move.stage, w.time_step,
                          w.move.cleans_rotations},
        kept.summary_place());
  }
};

}  // namespace dem::flat
