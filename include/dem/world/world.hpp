#pragma once

#include <dem/core/macros.hpp>
#include <dem/world/buried_grains.hpp>
#include <dem/world/check.hpp>
#include <dem/world/notes.hpp>
#include <dem/world/period.hpp>
#include <dem/world/report.hpp>
#include <dem/world/run_shared.hpp>
#include <dem/world/step.hpp>
#include <dem/world/thin_sheets.hpp>
#include <dem/world/time_step.hpp>
#include <dem/world/world_grains.hpp>

#include <array>
#include <concepts>

namespace dem {

/// A simulation: grains, machine, and the laws between them, specialised at compile time for a Model. What is put into
/// it is in WorldSetup, what is asked and set of single grains in WorldGrains. Worlds are values: copies go on with the
/// same bits. One that was moved from has to be assigned before it is used again.
template <class M>
class World : public WorldGrains<M> {
  using Setup = WorldGrains<M>;
  using Setup::state_, Setup::checked_, Setup::initialised_;

 public:
  using Model = M;
  using Setup::Setup;

  // ---- running ---------------------------------------------------------------------------------------------------

  /// Checks the set-up, chooses or checks the time step, and lists grains that were added; called by step() and run().
  /// Throws Error if contact constants are missing, the time step is too large, points would pass a two-sided sheet, a
  /// grain lies unseen within a solid mesh, or a prescribed motion would have to jump.
  DEM_SETUP void prepare() {
    this->require_no_step("run");
    if (state_.is_broken_off) {
      fail(
          "the step after t = {:g} s was broken off by an exception, so this world stands between two steps: make a "
          "new one",
          time());
    }
    this->require_grains_here("a world's preparation");
    if constexpr (Model::Domain::has_ranks) {
      check_agreement(state_, domain::Call::prepare,
                      {.set_up = !is_set_up(), .grains = !initialised_ || state_.grains_added, .steered = true});
    }
    if (!is_set_up()) check_set_up();
    if (!state_.time_step_note) state_.time_step_note = note_of_time_step(state_);
    for (const std::size_t s : state_.new_surfaces.all) check_surface_in_period(state_, s);
    if (!state_.new_surfaces.all.empty() || state_.placed.at == state_.step) check_buried_grains(state_);
    // A step that has begun must not be refused: motions that were added or changed are looked at before it.
    state_.machine.parts().allowed_jump = 0.1 * state_.smallest_radius;
    state_.machine_solver.check_motions(state_.machine);
    if (!initialised_ || !machine_is_initialised()) {
      const mbd::Stepping stepping(state_.machine.parts());
      together(state_, domain::Call::first_forces, "as the first forces were found", [&] { initialise(state_); });
      initialised_ = true;
      state_.grains_added = false;
    } else if (state_.grains_added) {
      together(state_, domain::Call::first_forces, "as grains were added", [&] { list_added(); });
    }
  }
  /// Whether prepare() has nothing left to do: nothing was changed since the last step.
  bool is_prepared() const { return is_set_up() && initialised_ && !state_.grains_added; }
  /// Runs one step. Where ranks share the grains each call tells all ranks all grains, as each run() does: run(n) costs
  /// less than n calls.
  [[nodiscard]] StepReport step() { return run(1); }
  /// Runs n steps, or fewer if a problem shows. A lost grain, or a body that leaves soil columns, is reported once: a
  /// run may go on without it. An exception of a law, a shape or a function of your own arrives here, from whichever
  /// thread; the world may then be looked at, but not run on.
  [[nodiscard]] StepReport run(std::uint64_t n) { return run(n, always); }
  /// The same, asking `goes_on()` after each step: false ends the run there, with all well. What it changes of the
  /// set-up (bodies, joints, surfaces, contact constants, species) is prepared for before the next step, as between
  /// runs. What it changes of grains and gravity the next step takes as it is.
  template <std::predicate F>
  [[nodiscard]] StepReport run(std::uint64_t n, F&& goes_on) {
    if (n > std::uint64_t{1} << 53) fail("{} steps are to be run, but at most 9e15 can be; is the number negative?", n);
    return run_on(n, goes_on, [](std::uint64_t left, double) { return left; });
  }
  /// Runs for a time span (s) in whole steps; what a span leaves of a step counts in the next one. Throws Error for
  /// more steps than 9e15.
  [[nodiscard]] StepReport run_for(double seconds) { return run_for(seconds, always); }
  /// The same, asking `goes_on()` after each step: false ends the run there, with all well and nothing owed.
  ///
  ///     world.run_for(10.0, [] { return !io::interrupted(); });   // Ctrl-C ends it after the present step
  ///
  /// What was left of the span is forgotten. A run that is to be saved and go on with the same bits asks between short
  /// spans instead:
  ///
  ///     while (world.time() < 10.0 && !io::interrupted()) (void)world.run_for(1e-3);   // look at the report
  template <std::predicate F>
  [[nodiscard]] StepReport run_for(double seconds, F&& goes_on) {
    prepare();
    require_non_negative(seconds, "time to run", "s");
    return run_on(whole_steps(owed_ + seconds), goes_on, [this](std::uint64_t left, double step) {
      return whole_steps(owed_ + static_cast<double>(left) * step);
    });
  }

  /// s, since the world was made.
  double time() const { return state_.time; }
  std::uint64_t steps() const { return state_.step; }
  /// s; 0 until it is chosen, by prepare() or the first step, if WorldOptions::time_step is 0.
  double time_step() const { return state_.time_step; }
  /// s, from the next step on, as WorldOptions::time_step; 0: chosen anew, and 0 until then. Joints are as stiff as was
  /// derived for the largest step since there are any; a still larger one makes them softer at once, and bodies sag.
  /// Sleep windows count steps. Throws Error unless it is finite and not negative; prepare() refuses one that is too
  /// large.
  void set_time_step(double dt) {
    this->require_no_step("set_time_step");
    if (dt == state_.options.time_step && dt > 0.0) return;
    state_.options.time_step = require_non_negative(dt, "time step", "s (0 chooses one)");
    if (dt == 0.0) state_.time_step = 0.0;
    checked_ = false;
  }
  /// Largest stable time step of grains and machine, and what limits it.
  StableTimeStep stable_time_step() const { return dem::stable_time_step(state_); }
  /// Throws Error unless n >= 1. Results do not depend on it.
  void set_threads(int n) { state_.executor.set_threads(n); }
  int threads() const { return state_.executor.threads(); }
  /// m/s^2, from the next step on. Another gravity wakes all grains. Throws Error unless it is finite.
  void set_gravity(const Vec3& g) {
    detail::require_finite(g, "gravity");
    if (g == state_.options.gravity) return;
    state_.options.gravity = g;
    evaluate_anew();
  }
  /// Forces are evaluated anew before the next step, what integrators remember of them is forgotten, and all grains
  /// wake: for what changed velocities or poses between two steps. Where ranks share the grains, all of them call it.
  void evaluate_anew() {
    wake_all(state_);
    initialised_ = false;
  }

  /// Puts a load of your own on each grain from now on, such as the drag of a fluid; none ends it:
  ///
  ///     world.set_grain_load([&](const GrainNow& g) { return GrainLoad{.force = -drag * (g.velocity - wind)}; });
  ///
  /// See GrainLoadLaw for what the law may do. Attached grains have none. The stable time step does not know it: a drag
  /// c (N s/m) asks for steps well below m/c. count_energy does not count its work. A saved state asks for a law where
  /// it had one. Throws Error where grains may sleep.
  void set_grain_load(GrainLoadLaw law) {
    this->require_no_step("set_grain_load");
    if (law && state_.options.sleep) fail("grains that may sleep can have no load law; leave WorldOptions::sleep out");
    state_.grain_load = std::move(law);
    initialised_ = false;
  }

  /// 1/s, dv_x/dz of a sheared cell from now on (domain::Sheared). Grains keep their velocities.
  void set_shear_rate(double rate) requires domain::IsSheared<typename Model::Domain> {
    require_within(rate, -1e9, 1e9, "shear rate (1/s)");
    state_.domain.set_shear_rate(rate, time());
    initialised_ = false;
  }

  /// Lets grains at rest sleep from now on, or wakes all for good. Another setting wakes all at first. Throws Error if
  /// a setting makes no sense.
  void set_sleep(const std::optional<SleepOptions>& sleep) {
    if (sleep == state_.options.sleep) return;
    if (sleep) check_sleep(*sleep);
    if (sleep && state_.grain_load) fail("grains that have a load law (set_grain_load) cannot sleep");
    if (domain::IsSheared<typename Model::Domain> && sleep) fail("grains of a sheared cell cannot sleep");
    wake_all(state_);
    state_.sleepers = {};  // what is known is of the rows that were listed last
    state_.options.sleep = sleep;
    state_.list_valid = false;
    initialised_ = false;
  }

  // ---- looking -----------------------------------------------------------------------------------------------------

  /// What an outlet took so far, and its mass flow.
  const Outlet& outlet(OutletId o) const { return known(state_.outlets, o, "outlet"); }
  /// The same of the grains that left a domain which removes them (BeyondDomain::remove), over the last 0.1 s.
  const Outlet& beyond_domain() const { return state_.beyond_domain; }
  /// What an inlet put in so far, and what it owes.
  const Inlet& inlet(InletId i) const { return known(state_.inlets, i, "inlet"); }

  /// Force (N) that the grains exert on a surface, from the last force evaluation; body_contact_force tells what
  /// another body's surface does.
  Vec3 surface_force(SurfaceId s) const { return to_eigen(known(state_.surfaces, s, "surface").force); }
  /// Torque (N m) of the grains on a surface about its body's centre of mass.
  Vec3 surface_torque(SurfaceId s) const { return to_eigen(known(state_.surfaces, s, "surface").torque); }
  /// Force (N) and torque (N m, about its body's centre of mass) of the grains and of other bodies' surfaces on a
  /// sensor's surface, now and averaged.
  const mbd::WindowAverage& surface_sensor(SurfaceSensorId s) const {
    return known(state_.surface_sensors, s, "surface sensor").average;
  }

  const WorldState<Model>& state() const { return state_; }
  WorldState<Model>& state() { return state_; }

  /// The state, for <dem/io/checkpoint.hpp>. Throws Error within a step, and for a world whose last one was broken off.
  template <class V>
  void fields(V& v) {
    this->require_no_step("save, load or a restore");
    if (state_.is_broken_off)
      fail("a world whose last step was broken off by an exception has no state to be saved or restored");
    this->require_grains_here("a state");
    v("", state_), v("owed", owed_, "s");
    bool checked = is_checked();
    v("checked", checked), v("initialised", initialised_);
    if (checked != checked_) checked_ = checked;
    if (checked) releases_ = state_.machine.parts().releases;
  }

 private:
  /// What goes on to the end.
  struct Always {
    constexpr bool operator()() const { return true; }
  };
  static constexpr Always always = {};

  /// The steps of a time span (s); what is left of it is owed to the next one.
  std::uint64_t whole_steps(double seconds) {
    const double steps = seconds / time_step();
    if (!(steps <= 0x1.0p53)) {  // beyond it time stands still: t + dt = t
      fail("time to run is {:g} s, {:g} steps of {:g} s, but must be at most 9e15 steps", seconds, steps, time_step());
    }
    const double whole = std::max(0.0, std::round(steps));
    owed_ = (steps - whole) * time_step();
    return static_cast<std::uint64_t>(whole);
  }

  /// Runs n steps. Where goes_on() changes the set-up, the world is prepared anew; where the time step is another one
  /// then, recount(steps left, time step before) tells how many are left.
  template <class F, class Recount>
  StepReport run_on(std::uint64_t n, F& goes_on, Recount&& recount) {
    prepare();
    state_.placed_note.clear();
    double step = time_step();
    for (std::uint64_t left = n;;) {
      const auto steps = [&] { return run_steps(left, goes_on); };
      StepReport report = [&] {
        if constexpr (Model::Domain::has_ranks) return run_shared(state_, left, steps);
        else if constexpr (is_flat<Model>()) return flat::Step<Model>::run(state_, left, steps);
        else return steps();
      }();
      if (left == 0 || !report) return report;
      prepare();
      if (time_step() != step) left = recount(left, std::exchange(step, time_step()));
    }
  }

  /// Until none is left, a problem shows, or goes_on() has changed what has to be prepared for.
  template <class F>
  StepReport run_steps(std::uint64_t& left, F& goes_on) {
    const double step = time_step();
    while (left > 0) {
      --left;
      within_step([&] {
        list_added();  // goes_on() may have added some
        if (state_.put_in) state_.put_in(state_);
        take_step(state_);
        release_ids(state_);
        take_out(state_);
      });
      state_.machine_solver.close_joints(state_.machine);
      if (StepReport report = find_problem(state_); !report) return report;
      if constexpr (!Model::Domain::has_ranks) {
        if (state_.step == state_.placed.at + 1) [[unlikely]]
          note_deep(state_);
      }
      if constexpr (!std::is_same_v<F, const Always>) {
        bool goes = goes_on(), stays = is_set_up() && time_step() == step;
        if constexpr (Model::Domain::has_ranks) {  // prepare() tells where the set-ups of ranks differ
          const auto [ends, changed] =
              state_.domain.largest(std::array<double, 2>{goes ? 0.0 : 1.0, stays ? 0.0 : 1.0});
          goes = ends == 0.0, stays = changed == 0.0;
        }
        if (!goes) left = 0, owed_ = 0.0;
        if (!goes || !stays) break;
        state_.machine_solver.check_motions(state_.machine);
      } else if (!is_checked()) [[unlikely]] {
        break;  // a law or signal has let a body go within the step
      }
    }
    return ok();
  }
  /// Calls f(), within which nothing may be added. What it throws leaves the world between two steps.
  template <class F>
  void within_step(F&& f) {
    const mbd::Stepping stepping(state_.machine.parts());
    state_.is_broken_off = true;
    f();
    state_.is_broken_off = false;
  }
  /// Lists grains that were added by hand since the last step.
  void list_added() {
    if (!state_.grains_added) [[likely]]
      return;
    list_between_runs(state_, [&] { rebuild_neighbours(state_); });  // inlets look at the bounds of all chunks
  }
  DEM_SETUP std::vector<MaterialId> used_materials() const {
    std::vector<MaterialId> used;
    for (const auto& s : state_.species) used.push_back(s.material);
    for (const auto& s : state_.surfaces) used.push_back(s.material);
    return used;
  }
  /// Whether nothing was changed since the last step but grains, their velocities, and gravity, which the next step
  /// takes as they are.
  bool is_set_up() const { return is_checked() && machine_is_initialised(); }
  /// A body that was let go is met with its mass from there on, which the time step must fit.
  bool is_checked() const { return checked_ && releases_ == state_.machine.parts().releases; }
  bool machine_is_initialised() const { return state_.machine_solver.is_initialised(state_.machine); }
  StepReport ok() const {
    StepReport r{
        StepReport::Problem::none, state_.time, state_.step, {}, {}, state_.machine_solver.note(state_.machine)};
    r.add_note(state_.time_step_note.value_or(""));
    r.add_note(state_.placed_note);
    r.add_note(note_of_density(state_));
    r.add_note(note_of_free_fall(state_));
    r.add_note(state_.odd_note);
    for (const Inlet& inlet : state_.inlets) {
      if (inlet.is_short()) r.add_note(inlet.note());
    }
    return r;
  }

  /// What was set up fits together; finds what follows from it. Throws Error.
  DEM_SETUP void check_set_up() {
    auto& materials = state_.materials;
    materials.check_complete();
    materials.check_names(used_materials());
    check_thin_sheets(state_);
    const double range = materials.range();
    materials.find_range(state_.largest_radius);
    if (materials.range() > range) state_.list_valid = false;
    check_period(state_);
    find_points_deep_enough(state_);
    for (const auto& pair : state_.body_contacts.pairs) {
      materials.check_pair(state_.surfaces[pair.a.index()].material, state_.surfaces[pair.b.index()].material);
    }
    coupling::list_pairs(state_.body_contacts, std::span(std::as_const(state_.surfaces)), materials);
    choose_time_step(state_, initialised_);
    checked_ = true;
    releases_ = state_.machine.parts().releases;
    state_.odd_note = note_of_twins(state_);
    if (state_.odd_note.empty()) state_.odd_note = note_of_loose_bodies(state_);
    state_.time_step_note.reset();
  }

  double owed_ = 0.0;           // s, by run_for: what a span leaves of a step
  std::uint64_t releases_ = 0;  // of the machine's bodies, when it was checked
};

}  // namespace dem
