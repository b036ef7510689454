#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/penalty.hpp>

namespace dem::mbd {

inline constexpr JointTraits plunging_constant_velocity_joint =
    joint_that_holds<Hold::line, Align::constant_velocity>({.name = "plunging constant-velocity joint",
                                                            .dofs = {Dof::slide, Dof::bend},
                                                            .own = Dof::slide,
                                                            .bearing = Bearing::guide,
                                                            .two_axes = true});
inline constexpr JointKind JointKind::plunging_constant_velocity{plunging_constant_velocity_joint};

/// A tripod or a plunging ball joint: as constant_velocity(...), but the point of shaft b slides along axis_a, as it
/// does in the housing of a half shaft. Its own coordinate is this slide (m); limits and friction go with it. A half
/// shaft has this joint at the gearbox and a constant_velocity(...) at the wheel, and gets longer and shorter as the
/// wheel travels. Both ends turn alike, however the joint is bent and wherever it slides.
JointSpec plunging_constant_velocity(std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis_a,
                                     const Vec3& axis_b);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JointSpec plunging_constant_velocity(std::string name, BodyId a, BodyId b, const Vec3& at,
                                                const Vec3& axis_a, const Vec3& axis_b) {
  JointSpec s = joint(JointKind::plunging_constant_velocity, std::move(name), a, b, at, axis_a);
  s.axis_b = axis_b;
  return s;
}

}  // namespace dem::mbd

#endif
