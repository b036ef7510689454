#pragma once

#include <dem/core/macros.hpp>
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
  template <class V>
  void fields(V& v) {
    v.given("joint", joint), v.given("dof", dof), v.given("lower", lower), v.given("upper", upper);
    v("stiffness", stiffness), v("damping", damping), v("force", force), v("axis", axis);
  }
};

/// A limit pushes back with a spring and, on the way in, a damper; it never pulls.
void apply_limits(JointLimitState& e, const Joint& j, Body& a, Body& b);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void apply_limits(JointLimitState& e, const Joint& j, Body& a, Body& b) {
  e.force = 0.0;
  if (!j.on) return;
  const Coordinate q = coordinate_of(j, a, b, e.dof);
  if (q.value >= e.lower && q.value <= e.upper) return;
  // Compared such that a NaN stays one and reaches the report.
  const double side = q.value < e.lower ? 1.0 : -1.0;
  const double depth = side * ((side > 0.0 ? e.lower : e.upper) - q.value), inward = -side * q.speed;
  e.force = side * (e.stiffness * depth + (inward < 0.0 ? 0.0 : e.damping * inward));
  e.axis = q.axis;
  q.apply(e.force, a, b);
}

}  // namespace dem::mbd

#endif
