#pragma once

#include <dem/core/macros.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/joint/hold.hpp>

#include <cmath>

namespace dem::mbd::detail {

/// The axes of b's joint frame, turned by an angle about their z.
inline Axes twisted(const Axes& axes, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * axes.x + s * axes.y, c * axes.y - s * axes.x, axes.z};
}

/// Moves the frame that a joint has on b to where the joint holds nothing strained in the present pose: a joint that is
/// switched on takes the bodies as they are. What it leaves free counts on as before.
DEM_COLD inline void take_hold(Joint& j, const Body& a, const Body& b) {
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
  const V xa = at.x(), ya = at.y(), za = at.z();
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (traits.align) {
    case Align::parallel: {
      const Matrix3<double> turn = from_eigen(rotation_between(to_eigen(zb), to_eigen(za)));
      j.axes_b = {transpose_times(B, turn * xb), transpose_times(B, turn * yb), transpose_times(B, turn * zb)};
      break;
    }
    case Align::locked:
    case Align::bushing: j.axes_b = {transpose_times(B, xa), transpose_times(B, ya), transpose_times(B, za)}; break;
    case Align::cross: j.axes_b = twisted(j.axes_b, std::atan(dot(xa, yb) / dot(xa, xb))); break;
    case Align::constant_velocity:
      j.axes_b = twisted(j.axes_b, std::atan2(dot(xa, yb) - dot(ya, xb), dot(xa, xb) + dot(ya, yb)));
      break;
    case Align::nothing: break;
  }
}

}  // namespace dem::mbd::detail
