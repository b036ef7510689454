#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits fixed_joint =
    joint_that_holds<Hold::point, Align::locked>({.name = "fixed joint", .changes_with_pose = false});
inline constexpr JointKind JointKind::fixed{fixed_joint};

/// Holds everything: two bodies become one.
DEM_SETUP inline JointSpec fixed(std::string name, BodyId a, BodyId b, const Vec3& at) {
  return joint(JointKind::fixed, std::move(name), a, b, at);
}

}  // namespace dem::mbd
