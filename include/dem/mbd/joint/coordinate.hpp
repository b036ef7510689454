#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/align.hpp>

#include <cmath>
#include <numbers>

namespace dem::mbd {

/// One coordinate of a joint: how far b has moved along, or turned about, z of a's joint frame.
struct Coordinate {
  bool rotation = false;                   ///< rad and N m, else m and N
  double value = 0.0;                      ///< rad (over whole turns) or m
  double speed = 0.0;                      ///< rad/s or m/s
  Vector3<double> axis = {};               ///< global; a unit vector, but of the turn of a bent free joint longer
  Vector3<double> arm_a = {}, arm_b = {};  ///< m, from the centres of mass to the joint's point on b

  /// Adds a generalised force (N or N m) that drives the coordinate up to b, and the opposite to a.
  void apply(double q, Body& a, Body& b) const;
};

/// Rotation of b about z of a's joint frame, counted over whole turns; of a free joint that is bent, what is left when
/// the shortest rotation has undone the bend. Exact to rounding: the arc tangent gives the angle and the estimate only
/// says which turn it belongs to.
Coordinate rotation_of(const Joint& j, const Body& a, const Body& b);

/// The distance of two points (in body frames), with the line between them as its axis.
Coordinate distance_of(const Vector3<double>& point_a, const Vector3<double>& point_b, const Body& a, const Body& b);

/// Displacement of b's point along an axis (x, y or z) of a's joint frame.
Coordinate displacement_along(const Vector3<double>& axis_in_a, const Joint& j, const Body& a, const Body& b);
Coordinate displacement_of(const Joint& j, const Body& a, const Body& b);

/// A rotation about a global axis by an angle.
Coordinate rotation_about(const Vector3<double>& axis, double angle, const Body& a, const Body& b);

/// The angle between the z axes, about the axis that turns za into zb. Where they are parallel any axis across will do.
Coordinate bend_of(const Joint& j, const Body& a, const Body& b);
/// The two angles of a universal joint: of its cross about xa, and of body b about yb. As xa and yb are square to each
/// other, the relative angular velocity is bend_x' xa + bend_y' yb.
Coordinate bend_x_of(const Joint& j, const Body& a, const Body& b);
Coordinate bend_y_of(const Joint& j, const Body& a, const Body& b);

/// A coordinate of a joint, which has to be one of dofs_of(its kind). By default the joint's own: the rotation of
/// joints that turn, else the displacement along z.
Coordinate coordinate_of(const Joint& j, const Body& a, const Body& b, Dof dof = Dof::own);

/// How far a joint is from holding what it should: m, and rad for small angles.
struct Violation {
  double displacement = 0.0;
  double rotation = 0.0;
};

/// The same of what a joint would hold if it were on.
Violation gap_of(const Joint& j, const Body& a, const Body& b);
inline Violation violation_of(const Joint& j, const Body& a, const Body& b) {
  return j.on ? gap_of(j, a, b) : Violation{};
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void Coordinate::apply(double q, Body& a, Body& b) const {
  if (rotation) {
    b.torque += q * axis;
    a.torque -= q * axis;
  } else {
    detail::act(a, b, arm_a, arm_b, q * axis, {0, 0, 0});
  }
}

DEM_INLINE Coordinate rotation_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> xa = A * j.axes_a.x, ya = A * j.axes_a.y, xb = B * j.axes_b.x, yb = B * j.axes_b.y;
  Coordinate q;
  q.rotation = true;
  q.axis = detail::turn_gradient(A * j.axes_a.z, B * j.axes_b.z);
  q.speed = dot(q.axis, B * b.motion.angular_velocity - A * a.motion.angular_velocity);
  const double angle = std::atan2(dot(ya, xb) - dot(xa, yb), dot(xa, xb) + dot(ya, yb));
  constexpr double turn = 2.0 * std::numbers::pi;
  q.value = angle + turn * std::round((j.angle_estimate - angle) / turn) + j.angle_offset;
  return q;
}

DEM_INLINE Coordinate distance_of(const Vector3<double>& point_a, const Vector3<double>& point_b, const Body& a,
                                  const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  Coordinate q;
  q.arm_b = B * point_b;
  q.arm_a = A * point_a;
  const Vector3<double> d = b.motion.position + q.arm_b - a.motion.position - q.arm_a;
  q.value = norm(d);
  q.axis = (1.0 / max(q.value, 1e-300)) * d;
  q.speed = dot(q.axis, b.motion.velocity + cross(B * b.motion.angular_velocity, q.arm_b) - a.motion.velocity -
                            cross(A * a.motion.angular_velocity, q.arm_a));
  return q;
}

DEM_INLINE Coordinate displacement_along(const Vector3<double>& axis_in_a, const Joint& j, const Body& a,
                                         const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  Coordinate q;
  q.axis = A * axis_in_a;
  q.arm_b = B * j.point_b;
  q.arm_a = b.motion.position - a.motion.position + q.arm_b;
  q.value = dot(q.axis, q.arm_a - A * j.point_a);
  q.speed = dot(q.axis, b.motion.velocity - a.motion.velocity + cross(B * b.motion.angular_velocity, q.arm_b) -
                            cross(A * a.motion.angular_velocity, q.arm_a));
  return q;
}

DEM_INLINE Coordinate displacement_of(const Joint& j, const Body& a, const Body& b) {
  Coordinate q = displacement_along(j.axes_a.z, j, a, b);
  q.value += j.slide_offset;
  return q;
}

DEM_INLINE Coordinate rotation_about(const Vector3<double>& axis, double angle, const Body& a, const Body& b) {
  Coordinate q;
  q.rotation = true;
  q.axis = axis;
  q.value = angle;
  q.speed = dot(axis, b.motion.rotation * b.motion.angular_velocity - a.motion.rotation * a.motion.angular_velocity);
  return q;
}

DEM_INLINE Coordinate bend_of(const Joint& j, const Body& a, const Body& b) {
  const Vector3<double> za = a.motion.rotation * j.axes_a.z, zb = b.motion.rotation * j.axes_b.z;
  const Vector3<double> n = cross(za, zb);
  const double sine = norm(n);
  return rotation_about(sine > 1e-12 ? (1.0 / sine) * n : a.motion.rotation * j.axes_a.x, std::atan2(sine, dot(za, zb)),
                        a, b);
}

DEM_INLINE Coordinate bend_x_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> yb = B * j.axes_b.y;
  return rotation_about(A * j.axes_a.x, std::atan2(dot(A * j.axes_a.z, yb), dot(A * j.axes_a.y, yb)), a, b);
}

DEM_INLINE Coordinate bend_y_of(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> xa = A * j.axes_a.x;
  return rotation_about(B * j.axes_b.y, std::atan2(dot(xa, B * j.axes_b.z), dot(xa, B * j.axes_b.x)), a, b);
}

DEM_INLINE Coordinate coordinate_of(const Joint& j, const Body& a, const Body& b, Dof dof) {
  switch (dof) {
    case Dof::turn: return rotation_of(j, a, b);
    case Dof::slide: return displacement_of(j, a, b);
    case Dof::slide_x: return displacement_along(j.axes_a.x, j, a, b);
    case Dof::slide_y: return displacement_along(j.axes_a.y, j, a, b);
    case Dof::length: return distance_of(j.point_a, j.point_b, a, b);
    case Dof::bend: return bend_of(j, a, b);
    case Dof::bend_x: return bend_x_of(j, a, b);
    case Dof::bend_y: return bend_y_of(j, a, b);
    case Dof::own: break;
  }
  const Dof own = resolved(j.kind, dof);
  return own == Dof::own ? displacement_of(j, a, b) : coordinate_of(j, a, b, own);
}

DEM_INLINE Violation gap_of(const Joint& j, const Body& a, const Body& b) {
  const JointTraits& traits = traits_of(j.kind);
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  const detail::FrameOfA at{j, A};
  return {detail::opening(j, traits.hold, at, d), detail::misalignment(j, traits.align, at, B)};
}

}  // namespace dem::mbd

#endif
