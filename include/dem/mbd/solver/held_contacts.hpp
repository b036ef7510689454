#pragma once

#include <dem/mbd/solver/bodies_in_motion.hpp>

#include <utility>
#include <vector>

namespace dem::mbd {

/// The forces of the grains over the sub-steps of a machine that is stiffer than they are. The grains are evaluated
/// once in each stage of the world's step.
///
/// With an integrator of one stage the forces are held over the step. They changed since the last step, and half of
/// this change is made up for by an impulse (catch_up). A free body then moves exactly as without sub-steps, so energy
/// is kept at any stable step. With two stages the forces are linear in time. In the first stage they are extrapolated
/// from their values at the start of the last step and of this one. In the second they are interpolated between the
/// start and the predicted end of the step.
template <integrator::Integrator I>
class HeldContacts {
 public:
  void start(const std::vector<Wrench>& loads) { now_ = earlier_ = loads; }

  /// Remembers the forces that the bodies carry now, those of the grains alone.
  void hold(const std::vector<Body>& bodies, int stage) {
    if (stage == 0) std::swap(now_, earlier_);
    std::vector<Wrench>& held = stage == 0 ? now_ : corrected_;
    held.resize(bodies.size());
    for (std::size_t i = 0; i < held.size(); ++i) held[i] = {bodies[i].force, bodies[i].torque};
  }

  /// Sets the bodies' forces to those of the grains at a time `share` (s/s) of the world's step after its start.
  void put_on(std::vector<Body>& bodies, int stage, double share) const {
    const std::vector<Wrench>& from = stage == 0 ? earlier_ : now_;
    const std::vector<Wrench>& to = stage == 0 ? now_ : corrected_;
    const double x = (stage == 0 ? 1.0 : 0.0) + share;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Wrench w = I::stages == 1 ? now_[i] : (1.0 - x) * from[i] + x * to[i];
      bodies[i].force = w.force;
      bodies[i].torque = w.torque;
    }
  }

  /// Sets the bodies' forces to those of the grains that the sub-steps of the last step were taken with.
  void put_earlier_on(std::vector<Body>& bodies) const {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i].force = earlier_[i].force;
      bodies[i].torque = earlier_[i].torque;
    }
  }

  /// Gives the bodies half of the impulse by which the grains' forces changed since the last step, dt (s) ago: what the
  /// kick at the end of a step is to velocity Verlet. The machine's own step h (s) is in it because its first half kick
  /// was with the earlier force (Verlet), or its kicks come before its drifts (symplectic Euler).
  void catch_up(std::vector<Body>& bodies, const BodiesInMotion<I>& motion, double dt, double h) const {
    const double time = 0.5 * (I::predicts_before_forces ? dt + h : dt - h);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (!bodies[i].fixed) motion.push(bodies, i, time * now_[i] + -time * earlier_[i]);
    }
  }

  template <class V>
  void fields(V& v) {
    v("now", now_), v("earlier", earlier_), v("corrected", corrected_);
  }

 private:
  std::vector<Wrench> now_, earlier_, corrected_;  ///< at the start of this step and of the last, and at its end
};

/// What a trial stage of a step changes, to go back to: the next stage starts from the same state.
template <integrator::Integrator I>
class SavedState {
 public:
  void save(const Parts& parts, std::vector<typename BodiesInMotion<I>::Memory>& memory, double time) {
    time_ = time;
    memory_ = memory;
    motions_.resize(parts.bodies.size());
    for (std::size_t i = 0; i < parts.bodies.size(); ++i) motions_[i] = parts.bodies[i].motion;
    turns_.resize(parts.joints.size());
    for (std::size_t i = 0; i < parts.joints.size(); ++i) turns_[i] = parts.joints[i].angle_estimate;
    friction_ = parts.friction;
    clutches_.resize(parts.clutches.size());
    for (std::size_t i = 0; i < parts.clutches.size(); ++i) clutches_[i] = parts.clutches[i].history;
    drives_.resize(parts.motions.size());
    for (std::size_t i = 0; i < parts.motions.size(); ++i) drives_[i] = parts.motions[i].drive;
  }
  /// Returns the time (s).
  double restore(Parts& parts, std::vector<typename BodiesInMotion<I>::Memory>& memory) const {
    memory = memory_;
    for (std::size_t i = 0; i < parts.bodies.size(); ++i) parts.bodies[i].motion = motions_[i];
    for (std::size_t i = 0; i < parts.joints.size(); ++i) parts.joints[i].angle_estimate = turns_[i];
    parts.friction = friction_;
    for (std::size_t i = 0; i < parts.clutches.size(); ++i) parts.clutches[i].history = clutches_[i];
    for (std::size_t i = 0; i < parts.motions.size(); ++i) parts.motions[i].drive = drives_[i];
    return time_;
  }

 private:
  double time_ = 0.0;
  std::vector<typename BodiesInMotion<I>::Memory> memory_;
  std::vector<integrator::Motion<double>> motions_;
  std::vector<double> turns_;
  std::vector<JointFrictionState> friction_;
  std::vector<Clutch::History> clutches_;
  std::vector<PrescribedMotion::Drive> drives_;
};

}  // namespace dem::mbd
