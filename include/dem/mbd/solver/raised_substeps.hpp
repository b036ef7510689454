#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/joint_watch.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace dem::mbd {

/// What became of the sub-steps of a machine that were chosen for it: from how many they were raised, and which joints
/// stood open all the same.
class RaisedSubsteps {
 public:
  /// They are raised from n to m.
  void raise(int n, int m);
  /// How many were given, if `now` is what they were raised to; else 0.
  int given(int now) const { return to_ == now && to_ > from_ ? from_ : 0; }

  /// A joint stands open with as many as there may be. Each joint is told once.
  void stands_open(const JointOpening& joint);
  JointOpening take_newly_opened() { return std::exchange(newly_opened_, {}); }

  template <class V>
  void fields(V& v) {
    v("newly_opened", newly_opened_), v("known_open", known_), v("raised_from", from_), v("raised_to", to_);
  }

 private:
  JointOpening newly_opened_;
  std::vector<JointId> known_;
  int from_ = 0, to_ = 0;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void RaisedSubsteps::raise(int n, int m) {
  if (to_ != n) from_ = n;
  to_ = m;
}

DEM_INLINE void RaisedSubsteps::stands_open(const JointOpening& joint) {
  if (std::find(known_.begin(), known_.end(), joint.joint) != known_.end()) return;
  known_.push_back(joint.joint);
  newly_opened_ = joint;
}

}  // namespace dem::mbd

#endif
