#pragma once

#include <dem/mbd/machine_phases.hpp>

#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A machine: an Assembly that moves, with the integrator of the grains. With grains, the world calls the phases of a
/// step (MachinePhases); without, `step` and `run` are all it takes.
///
///     Machine<integrator::PredictorCorrector> m;
///     const BodyId rod = m.add_body(box_body("rod", {1, 0.1, 0.1}, 100).at({0.5, 0, 0}));
///     m.add_joint(revolute("hinge", m.ground(), rod, {0, 0, 0}, {0, 1, 0}));
///     if (const MachineReport report = m.run(10.0, 1e-4); !report) fmt::print("{}\n", report.text);
template <integrator::Integrator I>
class Machine : public MachinePhases<I> {
  using Base = MachinePhases<I>;
  using Base::bad_, Base::contacts_, Base::design_dt_, Base::earlier_contacts_, Base::memory_, Base::parts_,
      Base::sampling_, Base::time_;

 public:
  using Base::add_forces, Base::advance, Base::before_forces, Base::clear_forces, Base::design_for, Base::gravity,
      Base::initialise, Base::prescribe, Base::report, Base::stage_time, Base::substeps;

  // ------------------------------------------------------------------------------------------- without any world

  /// One step of dt (s), in `substeps` parts. Throws Error, before anything moves, if it is above the stable time step
  /// or a prescribed motion would have to jump. What is derived from the step is derived anew when dt changes: a
  /// smaller one makes joints stiffer at once, a jolt where they are strained. design_for with one dt for all keeps
  /// them as they are.
  [[nodiscard]] MachineReport step(double dt) {
    prepare(dt);
    whole_step(dt);
    return report();
  }

  /// Steps of dt (s) for a duration (s; the number of steps is rounded). Stops at the first body that blows up. Throws
  /// Error as step does, between two steps, and for more steps than 9e15.
  [[nodiscard]] MachineReport run(double duration, double dt) {
    return run(duration, dt, [] {});
  }
  /// The same, calling `after_step()` after each step, e.g. to record. If it returns a bool, false ends the run there:
  /// return !io::interrupted() ends it at Ctrl-C.
  template <class F>
  [[nodiscard]] MachineReport run(double duration, double dt, F&& after_step) {
    require_non_negative(duration, "time to run", "s");
    prepare(dt);
    const double whole = std::round(duration / dt);
    if (!(whole <= 0x1.0p53)) {  // beyond it time stands still: t + dt = t
      fail("time to run is {:g} s, {:g} steps of {:g} s, but must be at most 9e15 steps", duration, whole, dt);
    }
    const auto steps = static_cast<long long>(whole);
    for (long long s = 0; s < steps && !bad_.valid(); ++s) {
      if (s > 0) prepare(dt);  // after_step may have changed something
      whole_step(dt);
      if constexpr (std::is_same_v<std::invoke_result_t<F&>, bool>) {
        if (!after_step()) break;
      } else {
        after_step();
      }
    }
    return report();
  }

  // ------------------------------------------------------------------------------- several steps within the world's

  /// Remembers the grains' forces that the bodies carry now, at the world's state of this stage.
  void hold_contacts(int stage) {
    if (stage == 0) std::swap(contacts_, earlier_contacts_);
    std::vector<Wrench>& now = stage == 0 ? contacts_ : corrected_contacts_;
    now.resize(parts_.bodies.size());
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = {parts_.bodies[i].force, parts_.bodies[i].torque};
  }

  /// Takes `substeps` machine steps in place of add_forces, advance and prescribe, for machines that are stiffer than
  /// the grains. With an integrator of one stage the grains' forces (hold_contacts) are held over the step, and half of
  /// what they changed by since the last one is made up for by an impulse (catch_up): a free body then moves exactly as
  /// without sub-steps, so that energy is kept at any stable step. With two stages they run linearly in time: in the
  /// first on from their values at the start of the last step and of this one, in the second between the start and the
  /// predicted end of the step. In a world's step:
  ///
  ///     clear_forces(); (grains) hold_contacts(stage); advance_substeps(stage, dt, gravity);
  ///
  /// and where the integrator predicts, before the grains' forces: advance_substeps(...); clear_forces(); (grains)
  /// hold_contacts(stage). before_forces, add_forces, advance and prescribe are then not called.
  void advance_substeps(int stage, double dt, const Vec3& g) {
    gravity = g;
    const int n = this->checked_substeps();
    const double h = dt / n;
    const bool trial = stage < I::stages - 1;  // done again in the next stage, from the same start
    if constexpr (I::stages > 1) stage == 0 ? save() : restore();
    struct Sampling {  // goes on after the sub-steps, also if a function of the user throws in one
      bool& flag;
      ~Sampling() { flag = true; }
    } sampling{Base::sampling_};
    sampling.flag = !trial;
    const std::vector<Wrench>& from = stage == 0 ? earlier_contacts_ : contacts_;
    const std::vector<Wrench>& to = stage == 0 ? contacts_ : corrected_contacts_;
    const double phase = stage == 0 ? 1.0 : 0.0;
    if constexpr (I::stages == 1) catch_up(dt, h);
    for (int s = 0; s < n; ++s) {
      const double start = time_;
      for (int k = 0; k < I::stages; ++k) {
        before_forces(k, h);
        const double x = phase + (stage_time(s * h, h, k)) / dt;
        for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
          const Wrench w = I::stages == 1 ? contacts_[i] : (1.0 - x) * from[i] + x * to[i];
          parts_.bodies[i].force = w.force;
          parts_.bodies[i].torque = w.torque;
        }
        add_forces(stage_time(start, h, k), h, k, k == I::stages - 1);
        advance(k, h, g);
        prescribe(start + h, h);
      }
    }
  }

 private:
  /// Gives the bodies half of the impulse by which the grains' forces changed since the last step, dt ago: what the
  /// kick at the end of a step is to velocity Verlet. The machine's own step h is in it because its first half kick was
  /// with the earlier force (Verlet), or its kicks come before its drifts (symplectic Euler).
  void catch_up(double dt, double h) {
    const double time = 0.5 * (I::predicts_before_forces ? dt + h : dt - h);
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
      if (!parts_.bodies[i].fixed) this->push(i, time * contacts_[i] + -time * earlier_contacts_[i]);
    }
  }

  /// Before each step: what was added or changed since the last one counts, and is refused before anything moves.
  void prepare(double dt) {
    require_positive(dt, "time step", "s");
    const bool same = this->is_initialised();
    if (!this->is_designed_ && (dt != design_dt_ || !same)) this->derive(dt);
    if (!same) {
      if (this->is_designed_) design_for(design_dt_);
      clear_forces();
      initialise(time_, gravity);
    }
    if (!same) accepted_dt_ = 0.0;
    if (dt != accepted_dt_) {
      check_time_step(dt);
      this->note_stable_step();  // what is derived is another one
    }
    accepted_dt_ = dt;
    this->check_motions();
  }

  void check_time_step(double dt) const {
    const StableTimeStep limit = this->stable_time_step();
    if (dt <= limit.dt || this->allow_unstable_time_step) return;
    fail(
        "time step {:g} s of a machine is above the largest stable one, {:.4g} s ({}); lower the time step or the "
        "stiffness there, raise substeps (now {}), or set allow_unstable_time_step",
        dt, limit.dt, limit.limited_by, substeps);
  }

  void whole_step(double dt) {
    for (int s = 0; s < substeps; ++s) raw_step(dt / substeps);
  }

  void raw_step(double dt) {
    const double start = time_;
    for (int stage = 0; stage < I::stages; ++stage) {
      before_forces(stage, dt);
      clear_forces();
      add_forces(stage_time(start, dt, stage), dt, stage, stage == I::stages - 1);
      advance(stage, dt, gravity);
      prescribe(start + dt, dt);
    }
  }

  /// Keeps the state at the start of a step / goes back to it.
  void save() {
    saved_.time = time_;
    saved_.memory = memory_;
    saved_.motions.resize(parts_.bodies.size());
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) saved_.motions[i] = parts_.bodies[i].motion;
    saved_.turns.resize(parts_.joints.size());
    for (std::size_t i = 0; i < parts_.joints.size(); ++i) saved_.turns[i] = parts_.joints[i].angle_estimate;
    saved_.rubbing = parts_.rubbing;
    saved_.drives.resize(parts_.motions.size());
    for (std::size_t i = 0; i < parts_.motions.size(); ++i) saved_.drives[i] = parts_.motions[i].drive;
  }
  void restore() {
    time_ = saved_.time;
    memory_ = saved_.memory;
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) parts_.bodies[i].motion = saved_.motions[i];
    for (std::size_t i = 0; i < parts_.joints.size(); ++i) parts_.joints[i].angle_estimate = saved_.turns[i];
    parts_.rubbing = saved_.rubbing;
    for (std::size_t i = 0; i < parts_.motions.size(); ++i) parts_.motions[i].drive = saved_.drives[i];
  }

  struct Saved {
    double time = 0.0;
    std::vector<typename Base::Memory> memory;
    std::vector<integrator::Motion<double>> motions;
    std::vector<double> turns;
    std::vector<JointRubbing> rubbing;
    std::vector<PrescribedMotion::Drive> drives;
  };

  std::vector<Wrench> corrected_contacts_;
  double accepted_dt_ = 0.0;  ///< s, that was compared with the stable time step
  Saved saved_;
};

}  // namespace dem::mbd
