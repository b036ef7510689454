#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits revolute_joint =
    joint_that_holds<Hold::point, Align::parallel>({.name = "revolute joint",
                                                    .dofs = {Dof::turn},
                                                    .own = Dof::turn,
                                                    .bearing = Bearing::journal,
                                                    .changes_with_pose = false});
inline constexpr JointKind JointKind::revolute{revolute_joint};

/// A hinge (thesis section 2.3.1): leaves the rotation about an axis.
DEM_SETUP inline JointSpec revolute(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return joint(JointKind::revolute, std::move(name), a, b, at, axis);
}

}  // namespace dem::mbd
