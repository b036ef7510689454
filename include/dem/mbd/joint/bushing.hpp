#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

namespace detail {

void check_bushing(const JointSpec& s, const std::string& who);
void take_constants(Joint& j, const JointSpec& s, const Vector3<double>&, const std::string&);

}  // namespace detail

inline constexpr JointTraits bushing_joint =
    joint_that_holds<Hold::bushing, Align::bushing>({.name = "bushing",
                                                     .dofs = {Dof::slide, Dof::slide_x, Dof::slide_y, Dof::bend},
                                                     .stiffness = Stiffness::own,
                                                     .check = detail::check_bushing,
                                                     .take = detail::take_constants});
inline constexpr JointKind JointKind::bushing{bushing_joint};

/// Springs (N/m, N m/rad) and dampers (N s/m, N m s/rad) along and about the x, y, z axes of a frame with z along axis.
JointSpec bushing(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis, const Vec3& stiffness,
                  const Vec3& damping, const Vec3& rotational_stiffness, const Vec3& rotational_damping);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void check_bushing(const JointSpec& s, const std::string& who) {
  if (s.has_stiffness_or_damping()) {
    fail(
        "{} was given a stiffness or damping with with_stiffness or with_damping, which it does not use: a bushing has "
        "its own constants for each direction; give them to bushing(...)",
        who);
  }
  for (const Vec3* v :
       {&s.bushing_stiffness, &s.bushing_damping, &s.bushing_rotational_stiffness, &s.bushing_rotational_damping}) {
    for (int k = 0; k < 3; ++k) require_non_negative((*v)[k], ("a constant of " + who).c_str(), "(SI units)");
  }
  if (norm(from_eigen(s.bushing_stiffness)) + norm(from_eigen(s.bushing_rotational_stiffness)) <= 0.0) {
    fail("{} has no stiffness at all: give it bushing_stiffness (N/m) or bushing_rotational_stiffness (N m/rad)", who);
  }
}

DEM_INLINE void take_constants(Joint& j, const JointSpec& s, const Vector3<double>&, const std::string&) {
  j.k3 = from_eigen(s.bushing_stiffness);
  j.c3 = from_eigen(s.bushing_damping);
  j.kr3 = from_eigen(s.bushing_rotational_stiffness);
  j.cr3 = from_eigen(s.bushing_rotational_damping);
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE JointSpec bushing(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis,
                             const Vec3& stiffness, const Vec3& damping, const Vec3& rotational_stiffness,
                             const Vec3& rotational_damping) {
  JointSpec s = joint(JointKind::bushing, std::move(name), a, b, at, axis);
  s.bushing_stiffness = stiffness;
  s.bushing_damping = damping;
  s.bushing_rotational_stiffness = rotational_stiffness;
  s.bushing_rotational_damping = rotational_damping;
  return s;
}

}  // namespace dem::mbd

#endif
