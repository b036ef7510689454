#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits universal_joint =
    joint_that_holds<Hold::point, Align::cross>({.name = "universal joint",
                                                 .dofs = {Dof::bend_x, Dof::bend_y, Dof::bend},
                                                 .bearing = Bearing::socket,
                                                 .two_axes = true});
inline constexpr JointKind JointKind::universal{universal_joint};

/// Shaft a runs along axis_a and shaft b along axis_b, both pointing the way the torque goes. with_x gives the arm of
/// the cross on shaft a; two joints in a row cancel their ripple if the arms on the shaft between them are parallel.
JointSpec universal(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis_a, const Vec3& axis_b);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JointSpec universal(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis_a,
                               const Vec3& axis_b) {
  JointSpec s = joint(JointKind::universal, std::move(name), a, b, at, axis_a);
  s.axis_b = axis_b;
  return s;
}

}  // namespace dem::mbd

#endif
