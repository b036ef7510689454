#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits spherical_joint = joint_that_holds<Hold::point, Align::nothing>(
    {.name = "spherical joint", .dofs = {Dof::bend}, .bearing = Bearing::socket, .changes_with_pose = false});
inline constexpr JointKind JointKind::spherical{spherical_joint};

/// A ball in a socket: holds a point and leaves all rotations.
DEM_SETUP inline JointSpec spherical(std::string name, BodyId a, BodyId b, const Vec3& at) {
  return joint(JointKind::spherical, std::move(name), a, b, at);
}

}  // namespace dem::mbd
