#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits cylindrical_joint = joint_that_holds<Hold::line, Align::parallel>(
    {.name = "cylindrical joint", .dofs = {Dof::turn, Dof::slide}, .own = Dof::turn, .bearing = Bearing::sleeve});
inline constexpr JointKind JointKind::cylindrical{cylindrical_joint};

/// A sleeve on a shaft: leaves the rotation about an axis and the slide along it.
DEM_SETUP inline JointSpec cylindrical(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return joint(JointKind::cylindrical, std::move(name), a, b, at, axis);
}

}  // namespace dem::mbd
