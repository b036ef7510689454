#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/joined_bodies.hpp>
#include <dem/mbd/solver/part_kind.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// How far a joint stood open, and how far it may.
struct JointOpening {
  JointId joint = {};
  Violation violation;        ///< m and rad
  double share = 0.0;         ///< of what is allowed, the larger of the two
  double displacement = 0.0;  ///< m, allowed
  double rotation = 0.0;      ///< rad, allowed
  double time = 0.0;          ///< s

  template <class V>
  void fields(V& v) {
    v("joint", joint), v("displacement", violation.displacement, "m"), v("rotation", violation.rotation, "rad");
    v("share", share), v("allowed_displacement", displacement, "m"), v("allowed_rotation", rotation, "rad");
    v("time", time, "s");
  }
};

/// Watches, as a machine runs, how far its joints give way. Only what is derived is watched: who gives a stiffness says
/// by it how far the joint gives way.
///
/// A joint's force is that of its springs and dampers, so where it is below k times half the tolerance nothing has to
/// be looked at: a few operations for each joint and step. At the largest opening the damper's force is 0.
class JointWatch {
 public:
  static constexpr double part_of_size = 1e-4;  ///< of a machine's size: the tolerance where none is given

  struct Watched {
    std::uint32_t joint;
    double displacement, rotation;  ///< m and rad, allowed; 1e300 where it is not watched
    double mass;                    ///< kg, of the machine that it belongs to
    template <class V>
    void fields(V& v) {
      v("joint", joint), v("displacement", displacement, "m"), v("rotation", rotation, "rad"), v("mass", mass, "kg");
    }
  };

  JointWatch() = default;
  /// `tolerance` in m, for displacements, and with the size of its machine for rotations; 0: part_of_size of its size.
  JointWatch(const Parts& m, double tolerance);

  /// To be called at the end of each of the machine's own steps.
  void follow(const Parts& m, double time);

  /// The joint that stood open farthest since the last call; no valid id if none came to half of what is allowed.
  JointOpening take_recent() { return std::exchange(recent_, {}); }

  bool has_recent() const { return recent_.share > 0.0; }

  /// The joint that stood open farthest since the start; no valid id if none came to half of what is allowed.
  const JointOpening& worst() const { return worst_; }
  bool is_exceeded() const { return worst_.share > 1.0; }
  /// The first joint that folded (see below); no valid id if none did.
  const JointOpening& folded() const { return folded_; }
  const std::vector<Watched>& watched() const { return watched_; }

  template <class V>
  void fields(V& v) {
    v("watched", watched_), v("recent", recent_), v("worst", worst_), v("folded", folded_),
        v("steps_left", steps_left_);
  }

 private:
  static constexpr double unwatched = 1e300;

  void look(const Parts& m, const Watched& w, double time);

  /// A joint folds where what it holds turns by so much that its springs no longer pull it back: 45 deg of axes that
  /// should be parallel, or shafts of a universal or constant-velocity joint that come to stand square to each other.
  void look_for_folded(const Parts& m, double time);

  std::vector<Watched> watched_;
  JointOpening recent_, worst_, folded_;
  int steps_left_ = 0;
};

/// "revolute joint 'x' stood open by 0.067 m and 0.01 rad at t = 0.1 s, allowed are ...".
std::string in_words(const Parts& m, const JointOpening& o);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JointWatch::JointWatch(const Parts& m, double tolerance) {
  if (!(tolerance >= 0.0)) fail("joint_tolerance is {:g} m, but must not be negative; 0 chooses one", tolerance);
  const JoinedBodies joined = joined_bodies(m);
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const Joint& j = m.joints[i];
    const JointSpec& s = m.joint_specs[i];
    const JointTraits& traits = traits_of(j.kind);
    const std::uint32_t k = joined.machine_of_joint(j);
    if (traits.stiffness != Stiffness::derived || k == JoinedBodies::none) continue;
    const JoinedBodies::Machine& whole = joined.machines[k];
    const double allowed = tolerance > 0.0 ? tolerance : part_of_size * whole.size;
    const bool holds = traits.hold != Hold::nothing && !s.stiffness;
    const bool aligns = traits.align != Align::nothing && !s.rotational_stiffness;
    watched_.push_back({static_cast<std::uint32_t>(i), holds ? allowed : unwatched,
                        aligns ? allowed / whole.size : unwatched, whole.mass});
  }
}

DEM_INLINE void JointWatch::follow(const Parts& m, double time) {
  for (const Watched& w : watched_) {
    const Joint& j = m.joints[w.joint];
    const double f = 0.5 * w.displacement * j.k, t = 0.5 * w.rotation * j.kr;
    if (dot(j.force, j.force) > f * f || dot(j.torque, j.torque) > t * t) [[unlikely]]
      look(m, w, time);
  }
  if (--steps_left_ > 0) return;
  steps_left_ = 64;
  look_for_folded(m, time);
}

DEM_INLINE void JointWatch::look(const Parts& m, const Watched& w, double time) {
  const Joint& j = m.joints[w.joint];
  const Violation v = violation_of(j, m.bodies[j.a], m.bodies[j.b]);
  const double share = std::max(v.displacement / w.displacement, v.rotation / w.rotation);
  if (!(share >= 0.5 && share > recent_.share)) return;
  recent_ = {JointId(w.joint), v, share, w.displacement, w.rotation, time};
  if (share > worst_.share) worst_ = recent_;
}

DEM_INLINE void JointWatch::look_for_folded(const Parts& m, double time) {
  if (folded_.joint.valid()) return;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const Joint& j = m.joints[i];
    const JointTraits& traits = traits_of(j.kind);
    if (!j.on || traits.stiffness != Stiffness::derived || traits.align == Align::nothing) continue;
    const Matrix3<double>&A = m.bodies[j.a].motion.rotation, &B = m.bodies[j.b].motion.rotation;
    const double shafts = dot(A * j.axes_a.z, B * j.axes_b.z);
    const double around = traits.align == Align::locked ? dot(A * j.axes_a.x, B * j.axes_b.x) : 1.0;
    if (!(std::min(shafts, around) < (traits.two_axes ? 0.05 : 0.7))) continue;
    const double angle = std::acos(std::clamp(std::min(shafts, around), -1.0, 1.0));
    folded_ = {JointId(i), {0.0, angle}, 0.0, 0.0, 0.0, time};
    return;
  }
}

DEM_INLINE std::string in_words(const Parts& m, const JointOpening& o) {
  const bool by_turn = o.violation.rotation / o.rotation > o.violation.displacement / o.displacement;
  return dem::text("{} {} by {:.3g} {} at t = {:.6g} s, allowed is {:.3g}", detail::joint_in_words(m, o.joint.index()),
                   by_turn ? "was out of line" : "stood open",
                   by_turn ? o.violation.rotation : o.violation.displacement, by_turn ? "rad" : "m", o.time,
                   by_turn ? o.rotation : o.displacement);
}

}  // namespace dem::mbd

#endif
