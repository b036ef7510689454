#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits planar_joint =
    joint_that_holds<Hold::plane, Align::parallel>({.name = "planar joint",
                                                    .dofs = {Dof::turn, Dof::slide_x, Dof::slide_y},
                                                    .own = Dof::turn,
                                                    .bearing = Bearing::plate});
inline constexpr JointKind JointKind::planar{planar_joint};

/// A plate on a table: leaves both slides along a plane and the rotation about its normal.
DEM_SETUP inline JointSpec planar(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& normal) {
  return joint(JointKind::planar, std::move(name), a, b, at, normal);
}

}  // namespace dem::mbd
