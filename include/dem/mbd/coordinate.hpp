#pragma once

#include <dem/mbd/joint.hpp>

namespace dem::mbd {

/// One coordinate of a joint: how far b has moved along, or turned about, z of a's joint frame.
struct Coordinate {
  bool rotation = false;                   ///< rad and N m, else m and N
  double value = 0.0;                      ///< rad (over whole turns) or m
  double speed = 0.0;                      ///< rad/s or m/s
  Vector3<double> axis = {};               ///< global direction
  Vector3<double> arm_a = {}, arm_b = {};  ///< m, from the centres of mass to the joint's point on b

  /// Adds a generalised force (N or N m) that drives the coordinate up to b, and the opposite to a.
  void apply(double q, Body& a, Body& b) const {
    if (rotation) {
      b.torque += q * axis;
      a.torque -= q * axis;
    } else {
      detail::act(a, b, arm_a, arm_b, q * axis, {0, 0, 0});
    }
  }
};

/// Whether a kind's own coordinate is a rotation about z (else a displacement along z).
constexpr bool turns(JointKind kind) {
  using enum JointKind;
  return kind == revolute || kind == cylindrical || kind == planar || kind == free;
}
/// Whether a kind has a coordinate that slides along z.
constexpr bool slides(JointKind kind) {
  using enum JointKind;
  return kind == prismatic || kind == cylindrical || kind == point_on_line || kind == free;
}

/// Rotation of b about z of a's joint frame, counted over whole turns. Exact to rounding: the arc tangent gives the
/// angle and the estimate only says which turn it belongs to.
inline Coordinate rotation_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> xa = A * j.axes_a.x, ya = A * j.axes_a.y, xb = B * j.axes_b.x, yb = B * j.axes_b.y;
  Coordinate q;
  q.rotation = true;
  q.axis = A * j.axes_a.z;
  q.speed = dot(q.axis, B * b.motion.angular_velocity - A * a.motion.angular_velocity);
  const double angle = std::atan2(dot(ya, xb) - dot(xa, yb), dot(xa, xb) + dot(ya, yb));
  constexpr double turn = 2.0 * std::numbers::pi;
  q.value = angle + turn * std::round((j.angle_estimate - angle) / turn) + j.angle_offset;
  return q;
}

/// Displacement of b's point along z of a's joint frame.
inline Coordinate displacement_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  Coordinate q;
  q.axis = A * j.axes_a.z;
  q.arm_b = B * j.point_b;
  q.arm_a = b.motion.position - a.motion.position + q.arm_b;
  q.value = dot(q.axis, q.arm_a - A * j.point_a) + j.slide_offset;
  q.speed = dot(q.axis, b.motion.velocity - a.motion.velocity + cross(B * b.motion.angular_velocity, q.arm_b) -
                            cross(A * a.motion.angular_velocity, q.arm_a));
  return q;
}

/// The joint's own coordinate: the rotation of joints that turn, else the displacement along z.
inline Coordinate coordinate_of(const Joint& j, const Body& a, const Body& b) {
  return turns(j.kind) ? rotation_of(j, a, b) : displacement_of(j, a, b);
}

/// How far a joint is from holding what it should: m, and rad for small angles.
struct Violation {
  double displacement = 0.0;
  double rotation = 0.0;
};

inline Violation violation_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  const Vector3<double> xa = A * j.axes_a.x, ya = A * j.axes_a.y, za = A * j.axes_a.z;
  const Vector3<double> xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  Violation v;
  switch (hold_of(j.kind)) {
    case Hold::point: v.displacement = norm(d); break;
    case Hold::line: v.displacement = norm(d - dot(za, d) * za); break;
    case Hold::plane: v.displacement = std::abs(dot(za, d)); break;
    case Hold::length: v.displacement = std::abs(norm(d) - j.length); break;
    default: break;  // a bushing is meant to give way
  }
  if (j.kind == JointKind::bushing) return v;
  switch (align_of(j.kind)) {
    case Align::parallel: v.rotation = norm(cross(za, zb)); break;
    case Align::locked: v.rotation = 0.5 * norm(cross(xa, xb) + cross(ya, yb) + cross(za, zb)); break;
    case Align::cross: v.rotation = std::abs(dot(xa, yb)); break;
    case Align::constant_velocity: v.rotation = 0.5 * std::abs(dot(ya, xb) - dot(xa, yb)); break;
    default: break;
  }
  return v;
}

}  // namespace dem::mbd
