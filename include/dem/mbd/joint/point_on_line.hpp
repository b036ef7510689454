#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits point_on_line_joint = joint_that_holds<Hold::line, Align::nothing>(
    {.name = "point-on-line joint", .dofs = {Dof::slide, Dof::bend}, .own = Dof::slide, .bearing = Bearing::guide});
inline constexpr JointKind JointKind::point_on_line{point_on_line_joint};

/// A point of b stays on a line that is fixed to a.
DEM_SETUP inline JointSpec point_on_line(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return joint(JointKind::point_on_line, std::move(name), a, b, at, axis);
}

}  // namespace dem::mbd
