#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/assembly.hpp>
#include <dem/mbd/blow_up.hpp>
#include <dem/mbd/check_holds.hpp>
#include <dem/mbd/softening.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// What became of a step or a run.
struct MachineReport {
  bool ok = true;
  double time = 0.0;  ///< s, reached
  BodyId body = {};   ///< the body that went wrong
  std::string text;   ///< what happened and which setting to change; empty if all is well
  explicit operator bool() const { return ok; }
};

/// The phases of a machine's step, one after the other as a world calls them. Machine adds what needs no world.
template <integrator::Integrator I>
class MachinePhases : public Assembly {
 public:
  Vec3 gravity = {0.0, 0.0, -9.81};  ///< m/s^2; the world hands its own to initialise and advance
  double largest_speed = 1e5;        ///< m/s or rad/s; a body that is faster is reported as blown up
  /// Machine steps within one step dt of the world (see advance_substeps) or of a machine alone.
  int substeps = 1;
  bool allow_unstable_time_step = false;  ///< a machine alone accepts a time step above the stable one

  double time() const { return time_; }  ///< s

  /// Derives what was left open (stiffness, damping) for a step of dt (s). Call it before initialise. Without it, step
  /// and run derive for the dt that they are given; after it, they keep what was derived, also for a smaller dt.
  void design_for(double dt) {
    derive(dt);
    is_designed_ = true;
  }

  /// The largest stable time step of the world, all substeps of the machine together, and the part that limits it.
  StableTimeStep stable_time_step() const {
    StableTimeStep limit = stable_time_step_of<I>(parts_);
    limit.dt *= checked_substeps();
    return limit;
  }

  /// The same with the stiffness and damping alone that were given: what a step may be chosen by before anything is
  /// derived for it. 1e300 if none limits it.
  StableTimeStep stable_time_step_of_given() const {
    StableTimeStep limit = stable_time_step_of<I>(without_derived(parts_));
    if (limit.dt > 1e-3 * endless_step) return {};
    limit.dt *= checked_substeps();
    return limit;
  }

  /// Throws Error if a prescribed motion that was added, switched on or given another signal would have to jump to take
  /// hold of its coordinate. Machine::step, run and a world's prepare call it, so that a step that has begun is never
  /// refused.
  void check_motions() { check_holds(parts_, time_); }

  /// False before initialise, and after a body, a joint or a coupling was added or `substeps` was changed since:
  /// design_for and initialise are due.
  bool is_initialised() const { return initialised_ && !changed_ && substeps == initialised_substeps_; }
  /// Whether what is derived belongs to steps of dt (s), and nothing was added since.
  bool is_designed_for(double dt) const { return is_initialised() && dt == design_dt_; }

  /// Starts at `time`: the integrator's memory is filled from the forces at this state, with what the caller has
  /// already put on the bodies (the grains). Throws Error if a stiffness has to be derived and no time step is known,
  /// or a prescribed motion would have to jump.
  void initialise(double time, const Vec3& g) {
    if (design_dt_ <= 0.0) {
      const std::string open = first_underived(parts_);
      if (!open.empty()) {
        fail(
            "the stiffness of {} is to be derived, but the machine does not know its time step: call "
            "machine.design_for(dt) before the first step, or give stiffness and damping",
            open);
      }
    }
    time_ = time;
    gravity = g;
    const std::size_t n = parts_.bodies.size();
    memory_.assign(n, {});
    inverse_.resize(n);
    parts_.spin.assign(n, {0, 0, 0});
    parts_.outside.assign(n, {});
    for (std::size_t i = 0; i < n; ++i) {
      const Body& b = parts_.bodies[i];
      check_body(b);
      if (b.fixed) {
        inverse_[i] = {0.0, {1, 1, 1}, {0, 0, 0}};
      } else {
        inverse_[i] = {1.0 / b.mass, from_eigen(b.inertia), from_eigen(Vec3(b.inertia.cwiseInverse()))};
      }
    }
    check_holds(parts_, time);
    const double step = design_dt_ / checked_substeps();  // 0 if none is known
    apply_motions(parts_, time, step, false);
    for (PrescribedMotion& p : parts_.motions) p.drive.impulse = 0.0;  // the speeds that it starts with
    mbd::add_forces(parts_, time, step, false);
    contacts_ = earlier_contacts_ = parts_.outside;
    for (std::size_t i = 0; i < n; ++i) I::template initialise<double>(memory_[i], acceleration(i, from_eigen(g)));
    note_stable_step();
    initialised_substeps_ = substeps;
    initialised_ = true;
    changed_ = false;
  }

  // --------------------------------------------------------------------------------- the phases of a world's step

  /// Moves the bodies first, if the integrator predicts.
  void before_forces(int stage, double dt) {
    if constexpr (I::predicts_before_forces) {
      for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
        if (!parts_.bodies[i].fixed) predict(i, stage, dt);
      }
      apply_motions(parts_, time_ + dt, dt, false);  // forces see driven bodies where they are at the end of the step
    }
  }

  void clear_forces() { mbd::clear_forces(parts_); }

  /// Adds the machine's own forces; `time` is that of the state they act at (see stage_time).
  void add_forces(double time, double dt, int, bool is_last_stage) {
    mbd::add_forces(parts_, time, dt, is_last_stage);
    if (is_last_stage && sampling_) sample_sensors(parts_, dt);
  }

  /// Lets the forces move the bodies.
  void advance(int stage, double dt, const Vec3& g) {
    move(stage, dt, from_eigen(g));
    gravity = g;
    step_dt_ = dt * substeps;
    if (stage == I::stages - 1) end_step(dt);
  }

  /// Sets prescribed motions (eq. 19) for the end of the step.
  void prescribe(double time_at_end_of_step, double dt) {
    if (parts_.motions.empty()) return;
    apply_motions(parts_, time_at_end_of_step, dt, true);
    for (const PrescribedMotion& p : parts_.motions) {
      if (p.spec.on) watch(p.spec.body.index());  // also of a fixed body, which nothing else moves
    }
  }

  /// The time of the state at which a stage's forces are evaluated, in a step of dt from `time`.
  static double stage_time(double time, double dt, int stage) {
    return I::predicts_before_forces || stage > 0 ? time + dt : time;
  }

  /// All is well, or which body blew up, when, and what to change.
  MachineReport report() const {
    if (!bad_.valid()) return {true, time_, {}, {}};
    const std::string text = fmt::format(
        "body '{}' blew up at t = {:g} s: its motion is not finite or its speed above largest_speed = {:g}. {}",
        parts_.bodies[bad_.index()].name, bad_time_, largest_speed,
        cause_of_blow_up<I>(parts_, assembled_limit_, watch_, step_dt_, substeps));
    return {false, bad_time_, bad_, text};
  }

 protected:
  using Memory = typename I::template Memory<double>;

  int checked_substeps() const {
    if (substeps < 1) fail("the machine's substeps are {}, but must be at least 1", substeps);
    return substeps;
  }

  /// Derives what is open for a step of dt (s) in the present pose.
  void derive(double dt) {
    derive_stiffness(parts_, dt / checked_substeps());
    softening_ = Softening(parts_, dt / substeps);
    design_dt_ = dt;
  }

  /// Remembers the largest stable step of this pose, for the report of a blow-up.
  void note_stable_step() {
    assembled_limit_ = stable_time_step();
    watch_ = StepWatch<I>(parts_);
  }

  /// Adds an impulse (N s, and N m s about the centre of mass) to a free body's velocities.
  void push(std::size_t i, const Wrench& impulse) {
    integrator::Motion<double>& m = parts_.bodies[i].motion;
    const Inverse& inv = inverse_[i];
    const Vector3<double> turn = transpose_times(m.rotation, impulse.torque);
    m.velocity += inv.mass * impulse.force;
    m.angular_velocity +=
        {inv.inverse_inertia.x * turn.x, inv.inverse_inertia.y * turn.y, inv.inverse_inertia.z * turn.z};
  }

  std::vector<Memory> memory_;
  double time_ = 0.0, design_dt_ = 0.0, step_dt_ = 0.0;  ///< s; the last two with all substeps
  int initialised_substeps_ = 0;
  bool initialised_ = false, is_designed_ = false;
  bool sampling_ = true;  ///< whether forces are felt by the sensors: not those of a trial
  BodyId bad_;
  StableTimeStep assembled_limit_;
  std::vector<Wrench> contacts_, earlier_contacts_;  ///< the grains' forces at the start of this step and of the last

 private:
  struct Inverse {
    double mass;
    Vector3<double> inertia, inverse_inertia;
  };

  integrator::Acceleration<double> acceleration(std::size_t i, const Vector3<double>& g, double lead = 0.0) const {
    const Body& b = parts_.bodies[i];
    const Inverse& inv = inverse_[i];
    return {g + inv.mass * b.force,
            integrator::angular_acceleration(transpose_times(b.motion.rotation, b.torque), b.motion.angular_velocity,
                                             inv.inertia, inv.inverse_inertia, lead)};
  }

  // Flattened, because the vector operators in them have to be inlined however large the program is.
  DEM_FLATTEN void predict(std::size_t i, int stage, double dt) {
    I::template before_forces<double>(stage, dt, parts_.bodies[i].motion, memory_[i]);
  }
  DEM_FLATTEN void move(int stage, double dt, const Vector3<double>& g) {
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
      if (parts_.bodies[i].fixed) continue;
      I::template after_forces<double>(stage, dt, parts_.bodies[i].motion, memory_[i],
                                       acceleration(i, g, integrator::gyroscopic_lead<I>(dt)));
    }
  }

  /// Looks after what drifts or changes slowly: rotations and turns, the stiffness of joints, the stable time step.
  void end_step(double dt) {
    const bool tidy = ++steps_ % 256 == 0;
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
      Body& b = parts_.bodies[i];
      if (tidy && !b.fixed) b.motion.rotation = orthonormalised(b.motion.rotation);
      watch(i);
    }
    if (tidy) settle_turns();
    time_ += dt;
    softening_.follow(parts_);
    if (!bad_.valid()) watch_.follow(parts_, dt, time_);
  }

  /// Notes the first body that is too fast, or has anything in its motion that is not a number. Each sum of squares is
  /// compared by itself: a maximum of several would drop a NaN in one of them.
  void watch(std::size_t i) {
    const auto& m = parts_.bodies[i].motion;
    const double limit = largest_speed * largest_speed, anywhere = 1e300;
    const Matrix3<double>& r = m.rotation;
    const double turned = dot(r.row0, r.row0) + dot(r.row1, r.row1) + dot(r.row2, r.row2);
    const bool is_well = dot(m.velocity, m.velocity) < limit && dot(m.angular_velocity, m.angular_velocity) < limit &&
                         dot(m.position, m.position) < anywhere && turned < anywhere;
    if (!is_well && !bad_.valid()) [[unlikely]] {
      bad_ = BodyId(i);
      bad_time_ = time_;
    }
  }

  /// Turn counts are sums of speed times dt; now and then they are set to the exact angles.
  void settle_turns() {
    for (Joint& j : parts_.joints) {
      if (j.turns) {
        j.angle_estimate = rotation_of(j, parts_.bodies[j.a], parts_.bodies[j.b]).value - j.angle_offset;
      }
    }
  }

  std::vector<Inverse> inverse_;
  Softening softening_;
  StepWatch<I> watch_;
  double bad_time_ = 0.0;
  long steps_ = 0;
};

}  // namespace dem::mbd
