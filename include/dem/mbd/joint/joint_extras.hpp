#pragma once

#include <dem/core/macros.hpp>
#include <dem/law/friction/asperity_spring.hpp>
#include <dem/mbd/joint/coordinate.hpp>

namespace dem::mbd {

/// The limits of one coordinate of a joint, ready to run.
struct JointLimitState {
  std::uint32_t joint = 0;
  Dof dof = Dof::own;
  double lower = 0, upper = 0;        ///< rad or m
  double stiffness = 0, damping = 0;  ///< N/m or N m/rad, N s/m or N m s/rad
  double force = 0;                   ///< N or N m, what the limit pushes with
  Vector3<double> axis = {0, 0, 0};   ///< global: force times this is the force (N) or torque (N m) on b
};

/// The friction of a joint, ready to run.
struct JointFrictionState {
  std::uint32_t joint = 0;
  friction::AsperitySpring::Parameters<double> law = {};
  double radius = 0, preload = 0, lever = 0;  ///< m, N, m
  friction::AsperitySpring::History<double> committed = {{0, 0, 0}};
  Vector3<double> force = {0, 0, 0};   ///< N, on b, global; sliding joints
  Vector3<double> torque = {0, 0, 0};  ///< N m, on b, global; joints that turn or bend
};

/// A limit pushes back with a spring and, on the way in, a damper; it never pulls.
DEM_FLATTEN inline void apply_limits(JointLimitState& e, const Joint& j, Body& a, Body& b) {
  const Coordinate q = coordinate_of(j, a, b, e.dof);
  e.force = 0.0;
  if (q.value >= e.lower && q.value <= e.upper) return;
  // Compared such that a NaN stays one and reaches the report.
  const double side = q.value < e.lower ? 1.0 : -1.0;
  const double depth = side * ((side > 0.0 ? e.lower : e.upper) - q.value), inward = -side * q.speed;
  e.force = side * (e.stiffness * depth + (inward < 0.0 ? 0.0 : e.damping * inward));
  e.axis = q.axis;
  q.apply(e.force, a, b);
}

/// Asperity friction on the joint's free motion. The spring is stretched from the committed history by the velocity
/// times `slip_time` (0 in a stage at the start of the step); the history is committed only where `commit` says so.
DEM_FLATTEN inline void apply_friction(JointFrictionState& e, const Joint& j, Body& a, Body& b, double slip_time,
                                       bool commit) {
  using V = Vector3<double>;
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const V wa = A * a.motion.angular_velocity, wb = B * b.motion.angular_velocity;
  const V w = wb - wa;
  const V rb = B * j.point_b, ra = b.motion.position - a.motion.position + rb;
  const V v = b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra);
  const V xa = A * j.axes_a.x, ya = A * j.axes_a.y, za = A * j.axes_a.z;

  contact::TangentialState<double> state{};
  state.normal_force = norm(j.force) + e.preload + (e.lever > 0.0 ? norm(j.torque) / e.lever : 0.0);
  state.time_step = slip_time;
  // Sliding velocity at the bearing surface in a's joint frame, so that the stretch turns with the joint.
  using enum JointKind;
  switch (j.kind) {
    case revolute: state.velocity = {0, 0, e.radius * dot(za, w)}; break;
    case prismatic:
    case point_on_line: state.velocity = {0, 0, dot(za, v)}; break;
    case cylindrical: state.velocity = {e.radius * dot(za, w), 0, dot(za, v)}; break;
    case planar: state.velocity = {dot(xa, v), dot(ya, v), e.radius * dot(za, w)}; break;
    case point_on_plane: state.velocity = {dot(xa, v), dot(ya, v), 0}; break;
    default: state.velocity = {e.radius * dot(xa, w), e.radius * dot(ya, w), e.radius * dot(za, w)}; break;
  }
  auto history = e.committed;
  const V f = friction::AsperitySpring::force(e.law, state, history);
  if (commit) e.committed = history;

  V force = {0, 0, 0}, torque = {0, 0, 0};
  switch (j.kind) {
    case revolute: torque = (e.radius * f.z) * za; break;
    case prismatic:
    case point_on_line: force = f.z * za; break;
    case cylindrical:
      force = f.z * za;
      torque = (e.radius * f.x) * za;
      break;
    case planar:
      force = f.x * xa + f.y * ya;
      torque = (e.radius * f.z) * za;
      break;
    case point_on_plane: force = f.x * xa + f.y * ya; break;
    default: torque = e.radius * (f.x * xa + f.y * ya + f.z * za); break;
  }
  detail::act(a, b, ra, rb, force, torque);
  e.force = force;
  e.torque = torque;
}

}  // namespace dem::mbd
