#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

namespace detail {

void check_free(const JointSpec& s, const std::string& who);
/// Puts no force on the bodies; its turns are followed.
inline void follow_turns(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb, double dt) {
  j.angle_estimate += dt * dot(turn_gradient(a.motion.rotation * j.axes_a.z, b.motion.rotation * j.axes_b.z), wb - wa);
}

}  // namespace detail

inline constexpr JointTraits free_joint_traits = {
    .name = "free joint",
    .dofs = {Dof::turn, Dof::slide, Dof::slide_x, Dof::slide_y, Dof::bend},
    .own = Dof::turn,
    .stiffness = Stiffness::none,
    .points_apart = true,
    .check = detail::check_free,
    .force = detail::follow_turns};
inline constexpr JointKind JointKind::free{free_joint_traits};

/// Holds nothing; measures the rotation about and the displacement along an axis.
DEM_SETUP inline JointSpec free_joint(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return joint(JointKind::free, std::move(name), a, b, at, axis);
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void check_free(const JointSpec& s, const std::string& who) {
  if (s.has_stiffness_or_damping()) {
    fail(
        "{} was given a stiffness or damping with with_stiffness or with_damping, which it does not use: it holds "
        "nothing; use a bushing or another kind of joint",
        who);
  }
}

}  // namespace dem::mbd::detail

#endif
