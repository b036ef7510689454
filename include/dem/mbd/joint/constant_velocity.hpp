#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits constant_velocity_joint = joint_that_holds<Hold::point, Align::constant_velocity>(
    {.name = "constant-velocity joint", .dofs = {Dof::bend}, .bearing = Bearing::socket, .two_axes = true});
inline constexpr JointKind JointKind::constant_velocity{constant_velocity_joint};

/// Shaft a runs along axis_a and shaft b along axis_b, both pointing the way the torque goes. Both turn alike, however
/// the joint is bent.
JointSpec constant_velocity(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis_a,
                            const Vec3& axis_b);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JointSpec constant_velocity(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis_a,
                                       const Vec3& axis_b) {
  JointSpec s = joint(JointKind::constant_velocity, std::move(name), a, b, at, axis_a);
  s.axis_b = axis_b;
  return s;
}

}  // namespace dem::mbd

#endif
