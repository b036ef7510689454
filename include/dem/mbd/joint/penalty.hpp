#pragma once

// The penalty force of a joint. All kinds are one choice of held displacements (Hold) and one of held rotations
// (Align): the thesis's revolute joint, two spherical joints on a line at +-h, each of half the stiffness k, is exactly
// Hold::point with k and Align::parallel with k h^2, evaluated in closed form.

#include <dem/mbd/joint/align.hpp>

namespace dem::mbd {

namespace detail {

/// Flattened, because the vector operators in it have to be inlined however large the program is.
template <Hold hold, Align align>
DEM_FLATTEN void penalty(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb, double dt) {
  using V = Vector3<double>;
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const V rb = B * j.point_b;
  const V ra = b.motion.position - a.motion.position + rb;
  const V w = wb - wa;
  const FrameOfA at{j, A};
  V f = {0, 0, 0};
  if constexpr (hold != Hold::nothing) {
    const V v = b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra);
    f = holding_force<hold>(j, at, ra - A * j.point_a, v);
  }
  const V t = aligning_torque<align>(j, at, B, w);
  if constexpr (align == Align::parallel) j.angle_estimate += dt * dot(at.z(), w);
  act(a, b, ra, rb, f, t);
  j.force = f;
  j.torque = t;
}

}  // namespace detail

/// The traits of a kind of joint that holds these displacements and rotations.
template <Hold hold, Align align>
constexpr JointTraits joint_that_holds(JointTraits traits) {
  traits.hold = hold;
  traits.align = align;
  traits.force = &detail::penalty<hold, align>;
  return traits;
}

}  // namespace dem::mbd
