#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits prismatic_joint = joint_that_holds<Hold::line, Align::locked>(
    {.name = "prismatic joint", .dofs = {Dof::slide}, .own = Dof::slide, .bearing = Bearing::guide});
inline constexpr JointKind JointKind::prismatic{prismatic_joint};

/// A slider on a rail (thesis section 2.3.2): leaves the slide along an axis.
DEM_SETUP inline JointSpec prismatic(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return joint(JointKind::prismatic, std::move(name), a, b, at, axis);
}

}  // namespace dem::mbd
