#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

namespace detail {

void take_length(Joint& j, const JointSpec& s, const Vector3<double>& gap, const std::string& who);

}  // namespace detail

inline constexpr JointTraits distance_joint =
    joint_that_holds<Hold::length, Align::nothing>({.name = "distance joint",
                                                    .dofs = {Dof::length},
                                                    .own = Dof::length,
                                                    .points_apart = true,
                                                    .take = detail::take_length});
inline constexpr JointKind JointKind::distance{distance_joint};

/// A massless rod between a point of a and a point of b.
JointSpec distance(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void take_length(Joint& j, const JointSpec& s, const Vector3<double>& gap, const std::string& who) {
  const double apart = norm(gap);
  j.length = s.length ? require_positive(*s.length, ("length of " + who).c_str(), "m") : apart;
  if (!(std::abs(j.length - apart) <= s.tolerance)) {
    fail(
        "{} is {:g} m long, but its points are {:g} m apart, allowed is a difference of {:g} m; move a point, leave "
        "the length out, or raise the joint's tolerance for a rod that starts under load",
        who, j.length, apart, s.tolerance);
  }
  if (!(apart > 1e-9)) {
    fail("the points of {} are {:g} m apart, but need a distance; use a spherical joint for points that meet", who,
         apart);
  }
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE JointSpec distance(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b) {
  JointSpec s = joint(JointKind::distance, std::move(name), a, b, at_a);
  s.at_b = at_b;
  return s;
}

}  // namespace dem::mbd

#endif
