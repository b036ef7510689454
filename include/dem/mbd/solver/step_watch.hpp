#pragma once

#include <dem/mbd/solver/softening.hpp>
#include <dem/mbd/solver/stable_time_step.hpp>

#include <algorithm>
#include <vector>

namespace dem::mbd {

/// Looks now and then whether a machine is still stable in its present pose, so that a report can say when it was not:
/// stiffness that users gave is not lowered where a lever grows. Looks at nothing where no such stiffness can grow.
template <class I>
class StepWatch {
 public:
  StepWatch() = default;
  explicit StepWatch(const Parts& m) : is_needed_(may_grow(m)) {}

  /// To be called at the end of each step of dt (s).
  void follow(const Parts& m, double dt, double time) {
    if (!is_needed_ || seen() || --steps_left_ > 0) return;
    const double share = share_of_limit(m, dt);
    steps_left_ = share < 0.6 ? 256 : 32;
    if (share < 0.97 || share < 1.01 * examined_) return;
    examined_ = share;
    const StableTimeStep now = stable_time_step_of<I>(m);
    if (now.dt >= dt) return;
    limit_ = now;
    time_ = time;
  }
  bool seen() const { return !limit_.limited_by.empty(); }
  double time() const { return time_; }                   ///< s, when the machine was first seen to be unstable
  const StableTimeStep& limit() const { return limit_; }  ///< of the pose at that time

 private:
  static bool may_grow(const Parts& m) {
    if (!m.springs.empty()) return true;
    for (const JointSpec& s : m.joint_specs) {
      if (traits_of(s.kind).changes_with_pose && has_given(s)) return true;
    }
    for (const Actuator& u : m.actuators) {
      if (!u.spec.joint.valid() || traits_of(m.joints[u.spec.joint.index()].kind).changes_with_pose) return true;
    }
    for (const Coupling& c : m.couplings) {
      if (c.spec.stiffness || c.spec.damping) return true;
    }
    return false;
  }
  static bool has_given(const JointSpec& s) {
    const bool limits =
        std::any_of(s.limits.begin(), s.limits.end(), [](const JointLimits& l) { return l.stiffness || l.damping; });
    const bool friction = s.friction && (s.friction->stiffness || s.friction->velocity_stiffness);
    return limits || friction || traits_of(s.kind).stiffness == Stiffness::own || s.has_stiffness_or_damping();
  }
  /// omega^2 dt^2 + 2 c dt of the worst part, by the better bound, over 4: below 1 each of the integrators is stable.
  static double share_of_limit(const Parts& m, double dt) {
    double worst[2] = {0, 0};
    for (const detail::ElementBounds& b : detail::bounds_of(m, detail::elements_of(m))) {
      for (int i = 0; i < 2; ++i) worst[i] = std::max(worst[i], b.k[i] * dt * dt + 2.0 * b.c[i] * dt);
    }
    return 0.25 * std::min(worst[0], worst[1]);
  }

  bool is_needed_ = false;
  int steps_left_ = 0;
  double examined_ = 0.0;  ///< the share at which the limit was last computed
  StableTimeStep limit_;
  double time_ = 0.0;
};

}  // namespace dem::mbd
