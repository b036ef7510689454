#pragma once

#include <dem/core/macros.hpp>
#include <dem/friction/asperity_spring.hpp>
#include <dem/mbd/coordinate.hpp>

namespace dem::mbd {

/// Stops and friction of a joint, ready to run.
struct JointExtras {
  std::uint32_t joint = 0;
  bool limited = false;
  double lower = 0, upper = 0;  ///< rad or m
  double stop_stiffness = 0, stop_damping = 0;
  double stop_force = 0;  ///< N or N m, what the stop pushes with

  bool rubs = false;
  friction::AsperitySpring::Parameters<double> law = {};
  double radius = 1, preload = 0, lever = 0;  ///< m, N, m
  friction::AsperitySpring::History<double> committed = {{0, 0, 0}};
  Vector3<double> friction_force = {0, 0, 0};   ///< N, on b, global; sliding joints
  Vector3<double> friction_torque = {0, 0, 0};  ///< N m, on b, global; joints that turn
};

/// A stop pushes back with a spring and, on the way in, a damper; it never pulls.
DEM_FLATTEN inline void apply_stop(JointExtras& e, const Joint& j, Body& a, Body& b) {
  const Coordinate q = coordinate_of(j, a, b);
  e.stop_force = 0.0;
  if (q.value < e.lower) {
    e.stop_force = max(0.0, e.stop_stiffness * (e.lower - q.value) + e.stop_damping * max(0.0, -q.speed));
  } else if (q.value > e.upper) {
    e.stop_force = -max(0.0, e.stop_stiffness * (q.value - e.upper) + e.stop_damping * max(0.0, q.speed));
  } else {
    return;
  }
  q.apply(e.stop_force, a, b);
}

/// Asperity friction on the joint's free motion. The spring is stretched from the committed history by the velocity
/// times `slip_time` (0 in a stage at the start of the step); the history is committed only where `commit` says so.
DEM_FLATTEN inline void apply_friction(JointExtras& e, const Joint& j, Body& a, Body& b, double slip_time,
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
    case prismatic: state.velocity = {0, 0, dot(za, v)}; break;
    case cylindrical: state.velocity = {e.radius * dot(za, w), 0, dot(za, v)}; break;
    case planar: state.velocity = {dot(xa, v), dot(ya, v), 0}; break;
    default: state.velocity = {e.radius * dot(xa, w), e.radius * dot(ya, w), e.radius * dot(za, w)}; break;
  }
  auto history = e.committed;
  const V f = friction::AsperitySpring::force(e.law, state, history);
  if (commit) e.committed = history;

  V force = {0, 0, 0}, torque = {0, 0, 0};
  switch (j.kind) {
    case revolute: torque = (e.radius * f.z) * za; break;
    case prismatic: force = f.z * za; break;
    case cylindrical:
      force = f.z * za;
      torque = (e.radius * f.x) * za;
      break;
    case planar: force = f.x * xa + f.y * ya; break;
    default: torque = e.radius * (f.x * xa + f.y * ya + f.z * za); break;
  }
  detail::act(a, b, ra, rb, force, torque);
  e.friction_force = force;
  e.friction_torque = torque;
}

}  // namespace dem::mbd
