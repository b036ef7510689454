#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits point_on_plane_joint = joint_that_holds<Hold::plane, Align::nothing>(
    {.name = "point-on-plane joint", .dofs = {Dof::slide_x, Dof::slide_y, Dof::bend}, .bearing = Bearing::point});
inline constexpr JointKind JointKind::point_on_plane{point_on_plane_joint};

/// A point of b stays on a plane that is fixed to a.
DEM_SETUP inline JointSpec point_on_plane(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& normal) {
  return joint(JointKind::point_on_plane, std::move(name), a, b, at, normal);
}

}  // namespace dem::mbd
