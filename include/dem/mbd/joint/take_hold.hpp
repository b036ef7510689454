#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/align.hpp>

namespace dem::mbd::detail {

/// Moves the frame that a joint has on b to where the joint holds nothing strained in the present pose: a joint that is
/// switched on takes the bodies as they are. What it leaves free counts on as before.
void take_hold(Joint& j, const Body& a, const Body& b);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void take_hold(Joint& j, const Body& a, const Body& b) {
  using V = Vector3<double>;
  const JointTraits& traits = traits_of(j.kind);
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const FrameOfA at{j, A};
  const V gap = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  if (traits.hold == Hold::length) {
    j.length = norm(gap);
  } else if (traits.hold != Hold::nothing) {
    j.point_b -= transpose_times(B, held_part(traits.hold, at.z(), gap));
  }
  j.axes_b = axes_that_align(j, traits.align, at, B);
}

}  // namespace dem::mbd::detail

#endif
