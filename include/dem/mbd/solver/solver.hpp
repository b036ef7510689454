#pragma once

#include <dem/mbd/joint/locked_shafts.hpp>
#include <dem/mbd/solver/accepted_time_step.hpp>
#include <dem/mbd/solver/assembly.hpp>
#include <dem/mbd/solver/blow_up.hpp>
#include <dem/mbd/solver/body_watch.hpp>
#include <dem/mbd/solver/close_joints.hpp>
#include <dem/mbd/solver/forces.hpp>
#include <dem/mbd/solver/held_contacts.hpp>
#include <dem/mbd/solver/joint_policy.hpp>
#include <dem/mbd/solver/machine_report.hpp>
#include <dem/mbd/solver/mechanism.hpp>
#include <dem/mbd/solver/raised_substeps.hpp>
#include <dem/mbd/solver/softening.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace dem::mbd {

/// What moves a mechanism: a world calls it with the grains' forces, Machine without any. It belongs to one mechanism,
/// which is handed to each call.
///
///     solver.design_for(mechanism, dt);
///     solver.initialise(mechanism, time, gravity, forces_of_grains);
///     for (int stage = 0; stage < I::stages; ++stage) solver.stage(mechanism, stage, dt, gravity, forces_of_grains);
template <integrator::Integrator I, JointPolicy Joints = Penalty>
class Solver {
 public:
  double time() const { return time_; }              ///< s
  double design_step() const { return design_dt_; }  ///< s, for which was derived what was left open; 0: not yet

  /// Derives what was left open (stiffness, damping) for a step of dt (s), all sub-steps together, in the present pose.
  DEM_COLD void design_for(Mechanism& m, double dt) {
    derive_stiffness(m.parts(), dt / checked_substeps(m));
    held_joints_.take_springs_off(m.parts());
    softening_ = Softening(m.parts(), dt / m.substeps);
    ramp_ = {};
    design_dt_ = dt;
  }

  /// After design_for: raises the machine's sub-steps, and derives for them, until the weight of all bodies that a
  /// joint is joined with opens none beyond joint_tolerance.
  DEM_COLD void carry_weight(Mechanism& m, const Vec3& gravity) {
    const JointWatch watch(m.parts(), m.joint_tolerance);
    const double share = opening_under_weight(m.parts(), watch, gravity);
    const int n = substeps_for(m.substeps, share, 1.0, std::max(m.substeps, m.most_substeps));
    if (n == m.substeps) return;
    raised_.raise(m.substeps, n);
    m.substeps = n;
    design_for(m, design_dt_);
  }

  /// To be called after a step: raises the sub-steps where joints open too far (close_joints.hpp). Bodies that touch
  /// nothing may be moved to close them. Returns what stays open beyond joint_tolerance with most_substeps.
  JointOpening close_joints(Mechanism& m, bool bodies_may_touch = true) {
    ramp_.step(m.parts());
    if (!joints_.has_recent()) return {};
    const JointOpening recent = joints_.take_recent();
    const double share = recent.share / ramp_.left();
    if (share <= 0.5 || body_watch_.seen()) return {};
    if (m.substeps < m.most_substeps) {
      raise_substeps(m, substeps_for(m.substeps, share, 0.25, m.most_substeps), bodies_may_touch);
      return {};
    }
    if (share > 1.0) raised_.stands_open(recent);
    return share > 1.0 ? recent : JointOpening{};
  }
  /// After close_joints: all is well, or which joint has opened beyond joint_tolerance though the sub-steps are as many
  /// as they may be. Each joint is told once.
  MachineReport newly_opened(const Mechanism& m) { return report_of(m, raised_.take_newly_opened()); }

  /// The largest stable time step of the world, all sub-steps of the machine together, and the part that limits it.
  DEM_COLD StableTimeStep stable_time_step(const Mechanism& m) const {
    StableTimeStep limit = stable_time_step_of<I>(m.parts());
    limit.dt *= checked_substeps(m);
    return limit;
  }
  /// The same with the stiffness and damping alone that were given: what a step may be chosen by before anything is
  /// derived for it. 1e300 if none limits it.
  DEM_COLD StableTimeStep stable_time_step_of_given(const Mechanism& m) const {
    StableTimeStep limit = stable_time_step_of<I>(without_derived(m.parts()));
    if (limit.dt > 1e-3 * endless_step) return {};
    limit.dt *= checked_substeps(m);
    return limit;
  }

  /// The largest time step (s) up to dt at which the machine is stable with what would be derived for that step.
  DEM_COLD StableTimeStep accepted_time_step(const Mechanism& m, double dt) const {
    return accepted_time_step_of<I>(m.parts(), dt, checked_substeps(m));
  }

  /// False before initialise, and after a body, a joint or a coupling was added or `substeps` was changed since:
  /// design_for and initialise are due.
  bool is_initialised(const Mechanism& m) const {
    return initialised_ && m.parts().revision == revision_ && m.substeps == substeps_;
  }
  /// Whether what is derived belongs to steps of dt (s), and nothing was added since.
  bool is_designed_for(const Mechanism& m, double dt) const { return is_initialised(m) && dt == design_dt_; }

  /// Throws Error if couplings that were added or changed lock a shaft, or such a motion would have to jump to take
  /// hold of its coordinate. To be called before a step begins, so that one that has begun is never refused.
  void check_motions(Mechanism& m) const {
    detail::check_changed_couplings(m.parts());
    if (m.parts().check_holds) m.parts().check_holds(m.parts(), time_);
  }

  /// Starts at `time` (s): the integrator's memory is filled from the forces at this state. `put_forces()` adds those
  /// from outside (the grains) to the bodies. Throws Error if a stiffness has to be derived and no time step is known,
  /// or a prescribed motion would have to jump.
  template <class PutForces>
  DEM_COLD void initialise(Mechanism& m, double time, const Vec3& gravity, PutForces&& put_forces) {
    Parts& parts = m.parts();
    if (design_dt_ <= 0.0) require_derived(parts);
    clear_forces(parts);
    put_forces();
    time_ = time;
    motion_.read(parts.bodies);
    parts.spin.assign(parts.bodies.size(), {0, 0, 0});
    parts.outside.assign(parts.bodies.size(), {});
    check_motions(m);
    const double step = design_dt_ / checked_substeps(m);  // 0 if none is known
    if (parts.apply_motions) parts.apply_motions(parts, time, step, false);
    held_joints_.start(parts);
    if (!is_assembled_) assemble(m);
    for (PrescribedMotion& p : parts.motions) p.drive.impulse = 0.0;  // the speeds that it starts with
    add_forces(parts, time, step, false);
    held_.start(parts.outside);
    motion_.initialise(parts.bodies, from_eigen(gravity));
    joints_ = JointWatch(parts, m.joint_tolerance);
    note_stable_step(m);
    start(m);
  }

  /// Bodies that hang together are made to move together; at the first start this is done anyway.
  DEM_COLD void assemble(Mechanism& m) {
    if (m.given_velocities != GivenVelocities::keep) assembly_ = joined_velocities(m.parts(), m.given_velocities);
    is_assembled_ = true;
  }

  /// One of the integrator's stages of a step of dt (s): where the integrator predicts, the bodies move first; then
  /// `put_forces()` adds the forces from outside (the grains) to the bodies, whose sums are cleared; joints, loads and
  /// drives add theirs; the bodies move, and prescribed motions are set. A machine with sub-steps takes them all.
  template <class PutForces>
  void stage(Mechanism& m, int stage, double dt, const Vec3& gravity, PutForces&& put_forces) {
    if (m.substeps == 1) return single_stage(m, stage, dt, gravity, put_forces);
    if constexpr (I::predicts_before_forces) take_substeps(m, stage, dt, gravity);
    clear_forces(m.parts());
    put_forces();
    held_.hold(m.parts().bodies, stage);
    if constexpr (!I::predicts_before_forces) take_substeps(m, stage, dt, gravity);
  }

  /// A step of dt (s), in sub-steps, without forces from outside.
  void step(Mechanism& m, double dt, const Vec3& gravity) {
    for (int s = 0; s < m.substeps; ++s) {
      for (int k = 0; k < I::stages; ++k) single_stage(m, k, dt / m.substeps, gravity, [] {});
    }
  }

  // ---- of a mechanism that is a bare ground: the same without what moves bodies and closes joints (lazy_solver.hpp)

  void design_bare(double dt) { design_dt_ = dt; }
  template <class PutForces>
  void initialise_bare(Mechanism& m, double time, PutForces&& put_forces) {
    if (m.parts().bodies.size() > 1) fail("a machine was put together that World::machine() did not hand out");
    clear_forces(m.parts());
    put_forces();
    time_ = time;
    motion_.read(m.parts().bodies);
    m.parts().spin.assign(m.parts().bodies.size(), {0, 0, 0});
    m.parts().outside.assign(m.parts().bodies.size(), {});
    held_.start(m.parts().outside);
    is_assembled_ = true;
    start(m);
  }
  template <class PutForces>
  void stage_bare(Mechanism& m, int stage, double dt, PutForces&& put_forces) {
    clear_forces(m.parts());
    put_forces();
    if (stage < I::stages - 1) return;
    step_dt_ = dt;
    time_ += dt;
    ++steps_;
  }

  /// All is well, or which body blew up, when, and what to change.
  MachineReport report(const Mechanism& m) const {
    if (!body_watch_.seen()) return {true, time_, {}, {}, {}, {}};
    const std::string text = dem::text(
        "body '{}' blew up at t = {:g} s: its motion is not finite or its speed above largest_speed = {:g}. {}",
        m.parts().bodies[body_watch_.body().index()].name, body_watch_.time(), m.largest_speed,
        cause_of_blow_up<I>(m.parts(), limit_at_start_, watch_, joints_, step_dt_, m.substeps));
    return {false, body_watch_.time(), body_watch_.body(), {}, text, {}};
  }
  /// All is well, or which joint stood open beyond joint_tolerance, and what keeps it closed.
  MachineReport report_of(const Mechanism& m, const JointOpening& worst) const {
    if (!(worst.share > 1.0)) return {true, time_, {}, {}, {}, {}};
    return report_of_opening(m.parts(), worst, m.joint_tolerance, step_dt_, m.substeps, time_);
  }
  /// What was changed of what the user gave: sub-steps, velocities at the start. Empty if nothing.
  DEM_COLD std::string note(const Mechanism& m) const {
    return note_of(m.parts(), assembly_, joints_, raised_.given(m.substeps), m.substeps);
  }
  /// What became of the velocities that were given, at the start.
  const AssemblyReport& assembly() const { return assembly_; }
  const JointWatch& joints() const { return joints_; }
  bool has_blown_up() const { return body_watch_.seen(); }

  /// Remembers the largest stable step of this pose, for the report of a blow-up.
  DEM_COLD void note_stable_step(const Mechanism& m) {
    limit_at_start_ = stable_time_step(m);
    watch_ = StepWatch<I>(m.parts());
  }

  template <class V>
  void fields(V& v) {
    v("bodies", motion_), v("held_contacts", held_), v("softening", softening_), v("watch", watch_);
    v("stable_step_at_start", limit_at_start_.dt, "s"), v("limited_at_start_by", limit_at_start_.limited_by);
    v("time", time_, "s"), v("design_step", design_dt_, "s"), v("newest_step", step_dt_, "s"), v("steps", steps_);
    v("substeps", substeps_), v("revision", revision_), v("initialised", initialised_);
    v("ramp", ramp_), v("joints", joints_), v("assembled", is_assembled_);
    body_watch_.fields(v), raised_.fields(v), held_joints_.fields(v);
  }

 private:
  /// Notes what it is initialised for.
  void start(const Mechanism& m) {
    substeps_ = m.substeps;
    revision_ = m.parts().revision;
    initialised_ = true;
  }

  static int checked_substeps(const Mechanism& m) {
    if (m.substeps < 1) fail("the machine's substeps are {}, but must be at least 1", m.substeps);
    return m.substeps;
  }

  /// While running, between two steps of the world or of a machine alone.
  DEM_COLD void raise_substeps(Mechanism& m, int n, bool in_ramp) {
    Parts& parts = m.parts();
    if (m.substeps == 1) held_.start(parts.outside);  // the contacts' forces, which are held from here on
    raised_.raise(m.substeps, n);
    const std::vector<double> before = StiffnessRamp::stiffness_of(parts);
    const double part = static_cast<double>(m.substeps) / n;
    m.substeps = substeps_ = n;
    design_for(m, design_dt_);
    if (in_ramp) ramp_ = StiffnessRamp(parts, before);
    else close_openings(parts, part * part);  // so that joints bear the same forces
    note_stable_step(m);
  }

  /// The time of the state at which a stage's forces are evaluated, in a step of dt from `time`.
  static double stage_time(double time, double dt, int stage) {
    return I::predicts_before_forces || stage > 0 ? time + dt : time;
  }

  template <class PutForces>
  void single_stage(Mechanism& m, int stage, double dt, const Vec3& gravity, PutForces&& put_forces) {
    const double start = time_;
    predict(m, stage, dt);
    clear_forces(m.parts());
    put_forces();
    complete(m, stage, start, dt, gravity);
  }

  void predict(Mechanism& m, int stage, double dt) {
    if (stage == 0) held_joints_.begin(m.parts());
    if constexpr (I::predicts_before_forces) {
      motion_.before_forces(m.parts().bodies, stage, dt);
      // Forces see driven bodies where they are at the end of the step.
      if constexpr (Joints::projects) held_joints_.move(m.parts(), time_ + dt, dt, true);
      else if (m.parts().apply_motions) m.parts().apply_motions(m.parts(), time_ + dt, dt, false);
    }
  }

  /// The machine's own forces, and what they do to the bodies.
  void complete(Mechanism& m, int stage, double start, double dt, const Vec3& gravity) {
    Parts& parts = m.parts();
    const bool last = stage == I::stages - 1;
    add_forces(parts, stage_time(start, dt, stage), dt, last, !sampling_);
    const auto sample = [&] {
      if (last && sampling_ && parts.sample_sensors) parts.sample_sensors(parts, dt);
    };
    if constexpr (!Joints::projects) sample();
    else if constexpr (I::stages == 1) held_joints_.add_gyroscopic(parts, integrator::gyroscopic_lead<I>(dt));
    motion_.after_forces(parts.bodies, stage, dt, from_eigen(gravity));
    step_dt_ = dt * m.substeps;
    if constexpr (Joints::projects) {
      if constexpr (!I::predicts_before_forces) held_joints_.move(parts, start + dt, dt, last);
    }
    if (last) end_step(m, dt);
    if constexpr (Joints::projects) {
      if (last) held_joints_.finish(parts, start + dt, dt);
      sample();
    } else {
      prescribe(m, start + dt, dt);
    }
  }

  /// Takes the machine's steps within one of the world's, with the grains' forces as HeldContacts has them.
  void take_substeps(Mechanism& m, int stage, double dt, const Vec3& gravity) {
    Parts& parts = m.parts();
    const int n = checked_substeps(m);
    const double h = dt / n;
    const bool trial = stage < I::stages - 1;  // done again in the next stage, from the same start
    if constexpr (I::stages > 1) {
      if (stage == 0) saved_.save(parts, motion_.memory(), time_);
      else time_ = saved_.restore(parts, motion_.memory());
      held_joints_.forget();
    }
    struct Sampling {  // goes on after the sub-steps, also if a function of the user throws in one
      bool& flag;
      ~Sampling() { flag = true; }
    } sampling{sampling_};
    sampling.flag = !trial;
    if constexpr (I::stages == 1) held_.catch_up(parts.bodies, motion_, dt, h);
    for (int s = 0; s < n; ++s) {
      const double start = time_;
      for (int k = 0; k < I::stages; ++k) {
        predict(m, k, h);
        held_.put_on(parts.bodies, stage, stage_time(s * h, h, k) / dt);
        complete(m, k, start, h, gravity);
      }
    }
  }

  /// Sets prescribed motions (eq. 19) for the end of the step.
  void prescribe(Mechanism& m, double time_at_end_of_step, double dt) {
    Parts& parts = m.parts();
    if (!parts.apply_motions) return;
    parts.apply_motions(parts, time_at_end_of_step, dt, true);
    for (const PrescribedMotion& p : parts.motions) {
      if (p.spec.on) watch_body(m, p.spec.body);  // also a fixed one, which nothing else moves
    }
  }

  /// Looks after what drifts or changes slowly: rotations and turns, the stiffness of joints, the stable time step.
  void end_step(Mechanism& m, double dt) {
    Parts& parts = m.parts();
    const bool tidy = ++steps_ % 256 == 0;
    for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
      Body& b = parts.bodies[i];
      if (tidy && !b.fixed) b.motion.rotation = orthonormalised(b.motion.rotation);
      watch_body(m, BodyId(i));
    }
    if (tidy) settle_turns(parts);
    time_ += dt;
    softening_.follow(parts);
    if (sampling_ && !body_watch_.seen()) joints_.follow(parts, time_);
    if (!body_watch_.seen()) watch_.follow(parts, dt, time_);
  }

  void watch_body(const Mechanism& m, BodyId id) {
    body_watch_.look(id, m.parts().bodies[id.index()], m.largest_speed, time_);
  }

  BodiesInMotion<I> motion_;
  typename Joints::State held_joints_;
  HeldContacts<I> held_;
  SavedState<I> saved_;
  Softening softening_;
  StiffnessRamp ramp_;
  StepWatch<I> watch_;
  JointWatch joints_;
  BodyWatch body_watch_;
  RaisedSubsteps raised_;
  AssemblyReport assembly_;
  bool is_assembled_ = false;
  StableTimeStep limit_at_start_;
  double time_ = 0.0, design_dt_ = 0.0, step_dt_ = 0.0;  // s; the last two with all sub-steps
  long steps_ = 0;
  int substeps_ = 0;  // of the newest initialise, as is the revision
  std::uint64_t revision_ = 0;
  bool initialised_ = false;
  bool sampling_ = true;  // whether forces are felt by the sensors: not those of a trial
};

}  // namespace dem::mbd
