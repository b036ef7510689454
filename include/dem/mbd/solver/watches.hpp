#pragma once

#include <dem/mbd/solver/blow_up.hpp>
#include <dem/mbd/solver/body_watch.hpp>
#include <dem/mbd/solver/machine_report.hpp>
#include <dem/mbd/solver/mechanism.hpp>

#include <string>
#include <utility>

namespace dem::mbd {

/// What is looked after while a machine runs, so that a report can tell what went wrong: bodies that blow up, joints
/// that open, a time step that is stable no longer.
template <class I>
class Watches {
 public:
  const JointWatch& joints() const { return joints_; }
  JointWatch& joints() { return joints_; }
  bool has_blown_up() const { return body_watch_.seen(); }

  /// At the start of a run: which joints are looked at.
  void watch_joints(const Mechanism& m) { joints_ = JointWatch(m.parts(), m.joint_tolerance); }
  /// Remembers the largest stable step of this pose, for the report of a blow-up.
  void note_stable_step(const Parts& m, StableTimeStep limit) {
    limit_at_start_ = std::move(limit);
    step_watch_ = StepWatch<I>(m);
  }

  /// Looks at a body that moved, at `time` (s).
  void look(const Mechanism& m, BodyId id, double time) {
    body_watch_.look(id, m.parts().bodies[id.index()], m.largest_speed, time);
  }
  /// At the end of a step of dt (s), now at `time`; of joints only where the step is not a trial.
  void follow(const Parts& m, double dt, double time, bool is_trial) {
    if (has_blown_up()) return;
    if (!is_trial) joints_.follow(m, time);
    step_watch_.follow(m, dt, time);
  }

  /// All is well at `time`, or which body blew up, when, and what to change. Steps are of `step` (s), all sub-steps
  /// together.
  MachineReport report(const Mechanism& m, double time, double step) const {
    if (!has_blown_up()) return {true, time, {}, {}, {}, {}};
    const std::string text = dem::text(
        "body '{}' blew up at t = {:g} s: its motion is not finite or its speed above largest_speed = {:g}. {}",
        m.parts().bodies[body_watch_.body().index()].name, body_watch_.time(), m.largest_speed,
        cause_of_blow_up<I>(m.parts(), limit_at_start_, step_watch_, joints_, step, m.substeps));
    return {false, body_watch_.time(), body_watch_.body(), {}, text, {}};
  }

  template <class V>
  void fields(V& v) {
    v("watch", step_watch_);
    v("stable_step_at_start", limit_at_start_.dt, "s"), v("limited_at_start_by", limit_at_start_.limited_by);
    v("joints", joints_);
    body_watch_.fields(v);
  }

 private:
  StepWatch<I> step_watch_;
  JointWatch joints_;
  BodyWatch body_watch_;
  StableTimeStep limit_at_start_;
};

}  // namespace dem::mbd
