#pragma once

#include <dem/mbd/joint/locked_shafts.hpp>
#include <dem/mbd/solver/accepted_time_step.hpp>
#include <dem/mbd/solver/assembly.hpp>
#include <dem/mbd/solver/close_joints.hpp>
#include <dem/mbd/solver/derive.hpp>
#include <dem/mbd/solver/machine_report.hpp>
#include <dem/mbd/solver/odd_parts.hpp>
#include <dem/mbd/solver/raised_substeps.hpp>
#include <dem/mbd/solver/stages.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// What a machine would be with what is derived for a step.
struct MachineDesign {
  StableTimeStep limit = {};
  /// The largest step, up to that one, at which it is stable with what is derived for it.
  StableTimeStep accepted = {};
  int substeps = 1;
};

/// What moves a mechanism: a world calls it with the grains' forces, Machine without any. It belongs to one mechanism,
/// which is handed to each call.
///
///     solver.design_for(mechanism, dt);
///     solver.initialise(mechanism, time, dt, gravity, forces_of_grains);
///     for (int stage = 0; stage < I::stages; ++stage) solver.stage(mechanism, stage, dt, gravity, forces_of_grains);
template <integrator::Integrator I, JointPolicy Joints = Penalty>
class Solver {
 public:
  double time() const { return stages_.time(); }     ///< s
  double design_step() const { return design_dt_; }  ///< s, for which was derived what was left open; 0: not yet

  /// Derives what was left open (stiffness, damping) for a step of dt (s), all sub-steps together, in the present pose.
  DEM_SETUP void design_for(Mechanism& m, double dt) {
    derive_stiffness(m.parts(), dt / checked_substeps(m));
    stages_.take_design(m.parts(), dt / m.substeps);
    ramp_ = {};
    design_dt_ = dt;
  }

  /// After design_for: raises the machine's sub-steps, and derives for them, until the weight of all bodies that a
  /// joint is joined with opens none beyond joint_tolerance.
  DEM_SETUP void carry_weight(Mechanism& m, const Vec3& gravity) {
    const JointWatch watch(m.parts(), m.joint_tolerance);
    const double share = most_loaded(m.parts(), watch).share * norm(from_eigen(gravity));
    const int n = substeps_for(m.substeps, share, 1.0, std::max(m.substeps, m.most_substeps));
    if (n == m.substeps) return;
    raised_.raise(m.substeps, n);
    m.substeps = n;
    design_for(m, design_dt_);
  }

  /// Both, for steps of dt (s) of a world. Strained joints that became stiffer at once would throw what they hold. So
  /// where the world has run, what was derived for a larger step stays as soft, and what gets stiffer because
  /// sub-steps are raised grows as StiffnessRamp says.
  DEM_SETUP void design(Mechanism& m, double dt, const Vec3& gravity, bool has_run) {
    const std::vector<double> before = StiffnessRamp::stiffness_of(m.parts());
    design_for(m, has_run && has_derived(m.parts()) ? std::max(dt, design_dt_) : dt);
    carry_weight(m, gravity);
    if (has_run) ramp_ = StiffnessRamp(m.parts(), before);
  }
  /// What that comes to, of copies.
  DEM_SETUP MachineDesign tried(const Mechanism& m, double dt, const Vec3& gravity, bool has_run) const {
    Mechanism machine = m;
    Solver solver = *this;
    solver.design(machine, dt, gravity, has_run);
    const StableTimeStep limit = solver.stable_time_step(machine);
    return {limit, limit.dt < dt ? accepted_time_step(m, dt) : limit, machine.substeps};
  }

  /// To be called after a step: raises the sub-steps where joints open too far (close_joints.hpp). Bodies that touch
  /// nothing may be moved to close them. Returns what stays open beyond joint_tolerance with most_substeps.
  JointOpening close_joints(Mechanism& m, bool bodies_may_touch = true) {
    ramp_.step(m.parts());
    JointWatch& joints = stages_.watches.joints();
    if (!joints.has_recent()) return {};
    const JointOpening recent = joints.take_recent();
    const double share = recent.share / ramp_.left();
    if (share <= 0.5 || has_blown_up()) return {};
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
  DEM_SETUP StableTimeStep stable_time_step(const Mechanism& m) const {
    StableTimeStep limit = stable_time_step_of<I>(m.parts());
    limit.dt *= checked_substeps(m);
    return limit;
  }
  /// The same with the stiffness and damping alone that were given: what a step may be chosen by before anything is
  /// derived for it. 1e300 if none limits it.
  DEM_SETUP StableTimeStep stable_time_step_of_given(const Mechanism& m) const {
    StableTimeStep limit = stable_time_step_of<I>(without_derived(m.parts()));
    if (limit.dt > 1e-3 * endless_step) return {};
    limit.dt *= checked_substeps(m);
    return limit;
  }

  /// The largest time step (s) up to dt at which the machine is stable with what would be derived for that step.
  DEM_SETUP StableTimeStep accepted_time_step(const Mechanism& m, double dt) const {
    return accepted_time_step_of<I>(m.parts(), dt, checked_substeps(m));
  }

  /// False before initialise, and after a body, a joint or a coupling was added, a mass or an inertia or `substeps` was
  /// changed since: design_for and initialise are due.
  bool is_initialised(const Mechanism& m) const {
    return initialised_ && m.parts().revision == revision_ && m.substeps == substeps_ &&
           stages_.has_read(m.parts().bodies);
  }
  /// Whether what is derived belongs to steps of dt (s), and nothing was added since.
  bool is_designed_for(const Mechanism& m, double dt) const { return is_initialised(m) && dt == design_dt_; }

  /// Throws Error if couplings that were added or changed lock a shaft, or such a motion would have to jump to take
  /// hold of its coordinate. To be called before a step begins, so that one that has begun is never refused.
  void check_motions(Mechanism& m) const {
    detail::check_changed_couplings(m.parts());
    if (m.parts().check_holds) m.parts().check_holds(m.parts(), time());
  }

  /// Starts at `time` (s), for steps of dt (s; 0: not known): the integrator's memory is filled from the forces at this
  /// state. `put_forces()` adds those from outside (the grains) to the bodies. Throws Error if a stiffness has to be
  /// derived and no time step is known, or a prescribed motion would have to jump.
  template <class PutForces>
  DEM_SETUP void initialise(Mechanism& m, double time, double dt, const Vec3& gravity, PutForces&& put_forces) {
    Parts& parts = m.parts();
    const bool goes_on = is_initialised(m) && m.substeps > 1;
    if (design_dt_ <= 0.0) require_derived(parts);
    clear_forces(parts);
    put_forces();
    stages_.begin(parts, time);
    check_motions(m);
    const double step = dt / checked_substeps(m);
    if (parts.apply_motions) parts.apply_motions(parts, time, step, false);
    stages_.hold_joints(parts);
    if (!is_assembled_) assemble(m);
    stages_.start(parts, step, gravity, goes_on);
    stages_.watches.watch_joints(m);
    note_stable_step(m);
    odd_ = odd_parts(parts);
    start(m);
  }

  /// Bodies that hang together are made to move together; at the first start this is done anyway.
  DEM_SETUP void assemble(Mechanism& m) {
    if (m.given_velocities != GivenVelocities::keep) assembly_ = joined_velocities(m.parts(), m.given_velocities);
    is_assembled_ = true;
  }

  /// One of the integrator's stages of a step of dt (s). Where the integrator predicts, the bodies move first. Their
  /// sums of forces are cleared, and `put_forces()` adds those from outside (the grains). Joints, loads and drives add
  /// theirs. Then the bodies move, and prescribed motions are set. A machine with sub-steps takes them all.
  template <class PutForces>
  void stage(Mechanism& m, int stage, double dt, const Vec3& gravity, PutForces&& put_forces) {
    checked_substeps(m);
    stages_.stage(m, stage, dt, gravity, put_forces);
  }

  /// A step of dt (s), in sub-steps, without forces from outside.
  void step(Mechanism& m, double dt, const Vec3& gravity) { stages_.step(m, dt, gravity); }

  // ---- of a mechanism that is a bare ground: the same without what moves bodies and closes joints (lazy_solver.hpp)

  void design_bare(double dt) { design_dt_ = dt; }
  template <class PutForces>
  DEM_SETUP void initialise_bare(Mechanism& m, double time, PutForces&& put_forces) {
    if (m.parts().bodies.size() > 1) fail("a machine was put together that World::machine() did not hand out");
    clear_forces(m.parts());
    put_forces();
    stages_.begin(m.parts(), time);
    stages_.hold_contacts(m.parts());
    is_assembled_ = true;
    start(m);
  }
  template <class PutForces>
  void stage_bare(Mechanism& m, int stage, double dt, PutForces&& put_forces) {
    clear_forces(m.parts());
    put_forces();
    if (stage == I::stages - 1) stages_.pass(dt);
  }

  /// All is well, or which body blew up, when, and what to change.
  MachineReport report(const Mechanism& m) const { return stages_.watches.report(m, time(), stages_.newest_step()); }
  /// All is well, or which joint stood open beyond joint_tolerance, and what keeps it closed.
  MachineReport report_of(const Mechanism& m, const JointOpening& worst) const {
    if (!(worst.share > 1.0)) return {true, time(), {}, {}, {}, {}};
    return report_of_opening(m.parts(), worst, m.joint_tolerance, {stages_.newest_step(), design_dt_}, m.substeps,
                             time());
  }
  /// What was changed of what the user gave (sub-steps, velocities at the start), and what of it is odd. Empty if
  /// nothing.
  DEM_SETUP std::string note(const Mechanism& m) const {
    const std::string changed = note_of(m.parts(), assembly_, joints(), raised_.given(m.substeps), m.substeps);
    return odd_ + (odd_.empty() || changed.empty() ? "" : " ") + changed;
  }
  /// What became of the velocities that were given, at the start.
  const AssemblyReport& assembly() const { return assembly_; }
  const JointWatch& joints() const { return stages_.watches.joints(); }
  bool has_blown_up() const { return stages_.watches.has_blown_up(); }

  /// Remembers the largest stable step of this pose, for the report of a blow-up.
  DEM_SETUP void note_stable_step(const Mechanism& m) {
    stages_.watches.note_stable_step(m.parts(), stable_time_step(m));
  }

  template <class V>
  void fields(V& v) {
    stages_.fields(v), raised_.fields(v);
    v("design_step", design_dt_, "s"), v("substeps", substeps_), v("revision", revision_);
    v("initialised", initialised_), v("ramp", ramp_), v("assembled", is_assembled_);
  }

 private:
  /// Notes what it is initialised for.
  void start(const Mechanism& m) {
    substeps_ = m.substeps;
    revision_ = m.parts().revision;
    initialised_ = true;
  }

  /// Whether some stiffness was derived.
  static bool has_derived(Parts& m) {
    Parts given = without_derived(m);
    const std::vector<double> now = StiffnessRamp::stiffness_of(m), of_given = StiffnessRamp::stiffness_of(given);
    return !std::equal(now.begin(), now.end(), of_given.begin(), [](double a, double b) { return a <= 2.0 * b; });
  }

  static int checked_substeps(const Mechanism& m) {
    if (m.substeps < 1) fail("the machine's substeps are {}, but must be at least 1", m.substeps);
    return m.substeps;
  }

  /// While running, between two steps of the world or of a machine alone.
  DEM_SETUP void raise_substeps(Mechanism& m, int n, bool in_ramp) {
    Parts& parts = m.parts();
    if (m.substeps == 1) stages_.hold_contacts(parts);  // the contacts' forces, which are held from here on
    raised_.raise(m.substeps, n);
    const std::vector<double> before = StiffnessRamp::stiffness_of(parts);
    const double part = static_cast<double>(m.substeps) / n;
    m.substeps = substeps_ = n;
    design_for(m, design_dt_);
    if (in_ramp) ramp_ = StiffnessRamp(parts, before);
    else close_openings(parts, part * part);  // so that joints bear the same forces
    note_stable_step(m);
  }

  Stages<I, Joints> stages_;
  StiffnessRamp ramp_;
  RaisedSubsteps raised_;
  AssemblyReport assembly_;
  std::string odd_;  // parts that are hardly meant as they were given
  bool is_assembled_ = false;
  double design_dt_ = 0.0;  // s, with all sub-steps
  int substeps_ = 0;        // of the newest initialise, as is the revision
  std::uint64_t revision_ = 0;
  bool initialised_ = false;
};

}  // namespace dem::mbd
