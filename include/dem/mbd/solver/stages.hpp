#pragma once

#include <dem/mbd/solver/forces.hpp>
#include <dem/mbd/solver/held_contacts.hpp>
#include <dem/mbd/solver/joint_policy.hpp>
#include <dem/mbd/solver/softening.hpp>
#include <dem/mbd/solver/watches.hpp>

namespace dem::mbd {

/// Takes a mechanism through the stages of a step, with sub-steps or without: bodies, forces, prescribed motions.
/// Solver derives stiffness and chooses the sub-steps.
template <integrator::Integrator I, JointPolicy Joints>
class Stages {
 public:
  Watches<I> watches;

  double time() const { return time_; }         ///< s
  double newest_step() const { return step_; }  ///< s, all sub-steps together

  // ---- the start

  /// After stiffness was derived for sub-steps of h (s).
  void take_design(Parts& m, double h) {
    held_joints_.take_springs_off(m);
    softening_ = Softening(m, h);
  }
  /// Whether masses and inertias are those that begin() found.
  bool has_read(const std::vector<Body>& bodies) const { return motion_.has_read(bodies); }
  /// Bodies are where they are, at `time` (s), which may be earlier than before: ways of motions that were made are
  /// over.
  void begin(Parts& m, double time) {
    time_ = time;
    for (PrescribedMotion& p : m.motions) p.drive.way.end_if_begun();
    motion_.read(m.bodies);
    m.global_angular_velocity.assign(m.bodies.size(), {0, 0, 0});
    m.outside.assign(m.bodies.size(), {});
  }
  void hold_joints(Parts& m) { held_joints_.start(m); }
  /// Contacts' forces are held from here on over the sub-steps.
  void hold_contacts(Parts& m) { held_.start(m.outside); }
  /// The integrator's memory is filled from the forces at this state; those from outside are in the bodies already.
  /// Where a machine `goes_on` in its sub-steps as it was, with an integrator of one stage, those are of the last step:
  /// it has still to catch up with how they changed.
  void start(Parts& m, double h, const Vec3& gravity, bool goes_on) {
    for (PrescribedMotion& p : m.motions) p.drive.impulse = 0.0;  // the speeds that it starts with
    const bool catches_up = goes_on && I::stages == 1;
    if (catches_up) held_.put_earlier_on(m.bodies);
    add_forces(m, time_, h);
    if (!catches_up) hold_contacts(m);
    motion_.initialise(m.bodies, from_eigen(gravity));
  }

  // ---- a step

  /// One of the integrator's stages of a step of dt (s), in the machine's sub-steps: Solver::stage.
  template <class PutForces>
  void stage(Mechanism& m, int stage, double dt, const Vec3& gravity, PutForces&& put_forces) {
    const int n = m.substeps;
    if (stage == 0) begin_ways(m.parts(), dt);
    if (n == 1) return single_stage(m, stage, dt, gravity, put_forces);
    if constexpr (I::predicts_before_forces) take_substeps(m, n, stage, dt, gravity);
    clear_forces(m.parts());
    put_forces();
    held_.hold(m.parts().bodies, stage);
    if constexpr (!I::predicts_before_forces) take_substeps(m, n, stage, dt, gravity);
  }

  /// A step of dt (s), in the machine's sub-steps, without forces from outside.
  void step(Mechanism& m, double dt, const Vec3& gravity) {
    const int n = m.substeps;
    begin_ways(m.parts(), dt);
    for (int s = 0; s < n; ++s) {
      for (int k = 0; k < I::stages; ++k) single_stage(m, k, dt / n, gravity, [] {});
    }
  }

  /// A step of dt (s) of a machine in which nothing moves.
  void pass(double dt) {
    step_ = dt;
    time_ += dt;
    ++steps_;
  }

  template <class V>
  void fields(V& v) {
    v("bodies", motion_), v("held_contacts", held_), v("softening", softening_);
    v("time", time_, "s"), v("newest_step", step_, "s"), v("steps", steps_);
    watches.fields(v), held_joints_.fields(v);
  }

 private:
  /// Values of motions that were set since the last step are reached at the end of this one, of dt (s).
  void begin_ways(Parts& m, double dt) {
    for (PrescribedMotion& p : m.motions) p.drive.way.begin_step(time_, time_ + dt);
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
    add_forces(parts, stage_time(start, dt, stage), dt, dt / I::stages, last, !sampling_);
    const auto sample = [&] {
      if (last && sampling_ && parts.sample_sensors) parts.sample_sensors(parts, dt);
    };
    if constexpr (!Joints::projects) sample();
    else if constexpr (I::stages == 1) held_joints_.add_gyroscopic(parts, integrator::gyroscopic_lead<I>(dt));
    motion_.after_forces(parts.bodies, stage, dt, from_eigen(gravity));
    step_ = dt * m.substeps;
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
    if (last && sampling_) sample_drives(parts, dt);
  }

  /// Takes the machine's steps within one of the world's, with the grains' forces as HeldContacts has them.
  void take_substeps(Mechanism& m, int n, int stage, double dt, const Vec3& gravity) {
    Parts& parts = m.parts();
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
      if (p.spec.on) watches.look(m, p.spec.body, time_);  // also a fixed one, which nothing else moves
    }
  }

  /// The forces of drives, which are the mean ones of the step that is over.
  static void sample_drives(Parts& parts, double dt) {
    for (Sensor& s : parts.sensors) {
      if (s.spec.target != SensorTarget::drive) continue;
      s.average.add({{parts.motions[s.spec.index].drive.force, 0, 0}, {0, 0, 0}}, dt);
    }
  }

  /// Looks after what drifts or changes slowly: rotations and turns, the stiffness of joints, the stable time step.
  void end_step(Mechanism& m, double dt) {
    Parts& parts = m.parts();
    const bool tidy = ++steps_ % 256 == 0;
    for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
      Body& b = parts.bodies[i];
      if (tidy && !b.fixed) b.motion.rotation = orthonormalised(b.motion.rotation);
      watches.look(m, BodyId(i), time_);
    }
    if (tidy) settle_turns(parts);
    time_ += dt;
    softening_.follow(parts);
    watches.follow(parts, dt, time_, !sampling_);
  }

  BodiesInMotion<I> motion_;
  typename Joints::State held_joints_;
  HeldContacts<I> held_;
  SavedState<I> saved_;
  Softening softening_;
  double time_ = 0.0, step_ = 0.0;  // s; a step with all sub-steps
  long steps_ = 0;
  bool sampling_ = true;  // whether forces are felt by the sensors: not those of a trial
};

}  // namespace dem::mbd
