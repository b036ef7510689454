#pragma once

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

  template <class V>
  void fields(V& v) {
    v("is_needed", is_needed_), v("steps_left", steps_left_), v("examined", examined_), v("time", time_, "s");
    v("limit", limit_.dt, "s"), v("limited_by", limit_.limited_by);
  }

 private:
  static bool may_grow(const Parts& m) {
    return std::any_of(m.kinds.begin(), m.kinds.end(), [&](const auto* k) { return k->may_grow && k->may_grow(m); });
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
