#pragma once

#include <dem/mbd/solver/solver.hpp>

#include <cmath>
#include <string>
#include <type_traits>

namespace dem::mbd {

/// A machine alone: a Mechanism with the solver that moves it. Among grains, the world has the solver, and its machine
/// is a Mechanism.
///
///     Machine<integrator::PredictorCorrector> m;
///     const BodyId rod = m.add_body(box_body("rod", {1, 0.1, 0.1}, 100).at({0.5, 0, 0}));
///     m.add_joint(revolute("hinge", m.ground(), rod, {0, 0, 0}, {0, 1, 0}));
///     if (const MachineReport report = m.run(10.0, 1e-4); !report) fmt::print("{}\n", report.text);
template <integrator::Integrator I, JointPolicy Joints = Penalty>
class Machine : public Mechanism {
 public:
  Vec3 gravity = {0.0, 0.0, -9.81};       ///< m/s^2
  bool allow_unstable_time_step = false;  ///< accepts a time step above the stable one

  double time() const { return solver_.time(); }  ///< s

  /// One step of dt (s), in `substeps` parts, which are raised where a joint opens too far (joint_tolerance). Throws
  /// Error, before anything moves, if it is above the stable time step or a prescribed motion would have to jump. What
  /// is derived from the step is derived anew when dt changes: a smaller one makes joints stiffer at once, a jolt where
  /// they are strained. design_for with one dt for all keeps them as they are.
  [[nodiscard]] MachineReport step(double dt) {
    prepare(dt);
    advance(dt);
    return report();
  }

  /// Steps of dt (s) for a duration (s; the number of steps is rounded). Stops at the first body that blows up, and at
  /// what goes wrong with a terrain, such as a wheel that leaves the soil: each such thing ends one run, and the next
  /// goes on after it. Throws Error as step does, between two steps, for more steps than 9e15, and for a time of less
  /// than half a step that was not taken before.
  [[nodiscard]] MachineReport run(double duration, double dt) {
    return run(duration, dt, [] {});
  }
  /// The same, calling `after_step()` after each step, e.g. to record. If it returns a bool, false ends the run there:
  /// return !io::interrupted() ends it at Ctrl-C.
  template <class F>
  [[nodiscard]] MachineReport run(double duration, double dt, F&& after_step) {
    require_non_negative(duration, "time to run", "s");
    require_positive(dt, "time step", "s");
    const double whole = std::round(duration / dt);
    if (!(whole <= 0x1.0p53)) {  // beyond it time stands still: t + dt = t
      fail("time to run is {:g} s, {:g} steps of {:g} s, but must be at most 9e15 steps", duration, whole, dt);
    }
    // Of a step that was taken before, it is what is left of a time.
    if (whole == 0.0 && duration > 0.0 && dt != accepted_dt_) {
      fail("time to run is {:g} s, less than half of a time step of {:g} s: run(duration, dt) would take no step",
           duration, dt);
    }
    prepare(dt);
    const auto steps = static_cast<long long>(whole);
    terrain_problem_.clear();
    for (long long s = 0; s < steps && !solver_.has_blown_up() && terrain_problem_.empty(); ++s) {
      if (s > 0) prepare(dt);  // after_step may have changed something
      advance(dt);
      if constexpr (std::is_same_v<std::invoke_result_t<F&>, bool>) {
        if (!after_step()) break;
      } else {
        after_step();
      }
    }
    return report();
  }

  /// Derives what was left open (stiffness, damping) for a step of dt (s). Without it, step and run derive for the dt
  /// that they are given; after it, they keep what was derived, also for a smaller dt.
  DEM_SETUP void design_for(double dt) {
    solver_.design_for(*this, dt);
    is_designed_ = true;
  }
  /// Evaluates the forces at the present state, at `time` (s), as the first step would. Throws Error if a stiffness has
  /// to be derived and design_for was not called, or a prescribed motion would have to jump.
  DEM_SETUP void initialise(double time, const Vec3& g) {
    gravity = g;
    const Stepping stepping(parts());
    solver_.initialise(*this, time, solver_.design_step(), g, [] {});
  }
  /// All is well; or which body blew up, when, and what to change; or what went wrong with a terrain in the newest
  /// step; or which joint stood open beyond joint_tolerance with most_substeps since the machine was last laid out, and
  /// the time step that keeps it closed. An open joint does not end a run.
  MachineReport report() const {
    MachineReport report = solver_.report(*this);
    if (report && !terrain_problem_.empty()) report = {false, time(), {}, {}, terrain_problem_, {}};
    if (report) report = solver_.report_of(*this, open_);
    report.note = solver_.note(*this);
    if (!falls_.empty()) report.note += (report.note.empty() ? "" : " ") + falls_;
    return report;
  }
  /// What was changed of the velocities that were given, at the start: see given_velocities.
  const AssemblyReport& assembly() const { return solver_.assembly(); }
  /// Does that now: velocities that joints do not allow are changed, as given_velocities says. What is prescribed moves
  /// as it does at the machine's time. Later changes of velocities need another call: the first step asks once.
  DEM_SETUP const AssemblyReport& assemble() {
    solver_.check_motions(*this);
    const Stepping stepping(parts());
    if (parts().apply_motions) parts().apply_motions(parts(), time(), 0.0, false);
    solver_.assemble(*this);
    return solver_.assembly();
  }
  /// False before the first step or initialise, and after something was added, a mass or `substeps` was changed.
  bool is_initialised() const { return solver_.is_initialised(*this); }

  /// The largest stable time step, all `substeps` together, and the part that limits it.
  StableTimeStep stable_time_step() const { return solver_.stable_time_step(*this); }
  /// The same with the stiffness and damping alone that were given; 1e300 if none limits it.
  StableTimeStep stable_time_step_of_given() const { return solver_.stable_time_step_of_given(*this); }

 private:
  /// Before each step: what was added or changed since the last one counts, and is refused before anything moves.
  void prepare(double dt) {
    require_positive(dt, "time step", "s");
    if (!is_initialised() || dt != accepted_dt_) accept(dt);
    solver_.check_motions(*this);
  }
  void advance(double dt) {
    {
      const Stepping stepping(parts());
      solver_.step(*this, dt, gravity);
    }
    const JointOpening open = solver_.close_joints(*this, false);
    if (open.share > open_.share) open_ = open;
    if (!parts().terrains.empty()) terrain_problem_ = take_terrain_problem(parts());
  }
  /// Lays the machine out for steps of dt (s), as far as that is due. Throws Error if they are too large.
  DEM_SETUP void accept(double dt) {
    const bool same = is_initialised();
    if (!is_designed_ && (dt != solver_.design_step() || !same)) solver_.design_for(*this, dt);
    if (!same) {
      if (is_designed_) design_for(solver_.design_step());
      initialise(time(), gravity);
      accepted_dt_ = 0.0;
      open_ = {};
      falls_ = gravity.isZero() ? "" : note_of_loose(parts(), loose_bodies(parts()));
    }
    if (dt != accepted_dt_) {
      check_time_step(dt);
      solver_.note_stable_step(*this);  // what is derived is another one
    }
    accepted_dt_ = dt;
  }

  DEM_SETUP void check_time_step(double dt) const {
    if (dt <= stable_time_step().dt || allow_unstable_time_step) return;
    // What is derived is derived anew for a smaller step: the one that is named is accepted when it is taken.
    const StableTimeStep limit = is_designed_ ? stable_time_step() : solver_.accepted_time_step(*this, dt);
    fail(
        "time step {:g} s of a machine is above the largest stable one, {:g} s ({}); lower the time step or the "
        "stiffness there, raise substeps (now {}), or set allow_unstable_time_step",
        dt, rounded_down(limit.dt), limit.limited_by, substeps);
  }

  Solver<I, Joints> solver_;
  JointOpening open_;            // farthest, of those that more sub-steps did not close
  std::string terrain_problem_;  // of the newest step, in words
  std::string falls_;            // that a body is held by nothing, in words
  bool is_designed_ = false;
  double accepted_dt_ = 0.0;  // s, that was compared with the stable time step
};

}  // namespace dem::mbd
