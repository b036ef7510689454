#pragma once

// Joint friction (thesis section 2.2.2): what rubs in each kind of bearing, and the force.

#include <dem/core/macros.hpp>
#include <dem/law/friction/asperity_spring.hpp>
#include <dem/mbd/joint/joint.hpp>

namespace dem::mbd {

/// The friction of a joint, ready to run.
struct JointFrictionState {
  std::uint32_t joint = 0;
  friction::AsperitySpring::Parameters<double> law = {};
  double radius = 0, preload = 0, lever = 0;  ///< m, N, m
  friction::AsperitySpring::History<double> committed = {{0, 0, 0}};
  Vector3<double> force = {0, 0, 0};   ///< N, on b, global; sliding joints
  Vector3<double> torque = {0, 0, 0};  ///< N m, on b, global; joints that turn or bend
  template <class V>
  void fields(V& v) {
    v.given("joint", joint), v.reals("law", law), v("radius", radius, "m"), v("preload", preload, "N");
    v("lever", lever, "m"), v.reals("slip", committed, "m"), v("force", force, "N"), v("torque", torque, "N m");
  }
};

namespace detail {

/// The degrees of freedom that rub in a bearing; a bend stands for rotations about any axis.
constexpr Dofs friction_dofs(Bearing bearing) {
  switch (bearing) {
    case Bearing::journal: return {Dof::turn};
    case Bearing::guide: return {Dof::slide};
    case Bearing::sleeve: return {Dof::turn, Dof::slide};
    case Bearing::plate: return {Dof::turn, Dof::slide_x, Dof::slide_y};
    case Bearing::point: return {Dof::slide_x, Dof::slide_y};
    case Bearing::socket: return {Dof::bend};
    case Bearing::none: break;
  }
  return {};
}

}  // namespace detail

/// Asperity friction on the joint's free motion. The spring is stretched by the velocity times `slip_time` (s), the
/// share of a step that one of the integrator's stages stands for; 0 outside of a step, where nothing is remembered.
void apply_friction(JointFrictionState& e, const Joint& j, Body& a, Body& b, double slip_time);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void apply_friction(JointFrictionState& e, const Joint& j, Body& a, Body& b, double slip_time) {
  using V = Vector3<double>;
  e.force = e.torque = {0, 0, 0};
  if (!j.on) {
    e.committed = {};
    return;
  }
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const V wa = A * a.motion.angular_velocity, wb = B * b.motion.angular_velocity;
  const V w = wb - wa;
  const V rb = B * j.point_b, ra = b.motion.position - a.motion.position + rb;
  const V v = b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra);
  const V x = A * j.axes_a.x, y = A * j.axes_a.y, z = A * j.axes_a.z;
  const Bearing bearing = traits_of(j.kind).bearing;

  contact::TangentialState<double> state{};
  state.normal_force = norm(j.force) + e.preload + (e.lever > 0.0 ? norm(j.torque) / e.lever : 0.0);
  state.time_step = slip_time;
  // Sliding velocity at the bearing surface in a's joint frame, so that the stretch turns with the joint.
  using enum Bearing;
  switch (bearing) {
    case journal: state.velocity = {0, 0, e.radius * dot(z, w)}; break;
    case guide: state.velocity = {0, 0, dot(z, v)}; break;
    case sleeve: state.velocity = {e.radius * dot(z, w), 0, dot(z, v)}; break;
    case plate: state.velocity = {dot(x, v), dot(y, v), e.radius * dot(z, w)}; break;
    case point: state.velocity = {dot(x, v), dot(y, v), 0}; break;
    case socket: state.velocity = {e.radius * dot(x, w), e.radius * dot(y, w), e.radius * dot(z, w)}; break;
    case none: break;
  }
  auto history = e.committed;
  const V f = friction::AsperitySpring::force(e.law, state, history);
  if (slip_time > 0.0) e.committed = history;

  V force = {0, 0, 0}, torque = {0, 0, 0};
  switch (bearing) {
    case journal: torque = (e.radius * f.z) * z; break;
    case guide: force = f.z * z; break;
    case sleeve:
      force = f.z * z;
      torque = (e.radius * f.x) * z;
      break;
    case plate:
      force = f.x * x + f.y * y;
      torque = (e.radius * f.z) * z;
      break;
    case point: force = f.x * x + f.y * y; break;
    case socket: torque = e.radius * (f.x * x + f.y * y + f.z * z); break;
    case none: break;
  }
  detail::act(a, b, ra, rb, force, torque);
  e.force = force;
  e.torque = torque;
}

}  // namespace dem::mbd

#endif
