#pragma once

// Prescribed motions: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/check_holds.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

inline constexpr PartKind motion_kind = {.rank = 7, .not_a_number = [](const Parts& m) -> std::string {
                                           for (const PrescribedMotion& p : m.motions) {
                                             if (std::isnan((p.spec.by_speed ? 0.0 : p.drive.value) + p.drive.rate))
                                               return "The value of motion '" + p.spec.name + "'";
                                           }
                                           return {};
                                         }};

PrescribedMotion make_motion(const Parts& parts, MotionSpec spec);

MotionId add_motion(Parts& parts, MotionSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE PrescribedMotion make_motion(const Parts& parts, MotionSpec spec) {
  const std::string who = dem::text("prescribed motion '{}'", spec.name);
  PrescribedMotion p;
  if (spec.target == MotionSpec::Target::joint) {
    const Joint& j = known_joint(parts, spec.joint, who);
    spec.dof = known_dof(j.kind, spec.dof, who);
    if (spec.dof == Dof::bend) {
      fail(
          "{} drives the bend of a {}, which has no direction where the joint is straight; drive bend_x and bend_y "
          "of a universal joint, or use an actuator",
          who, name_of(j.kind));
    }
    if (spec.dof == Dof::length) {
      fail(
          "{} drives the length of a distance joint, which the joint holds; leave the joint out and use a "
          "linear_actuator, or put a cylinder of two bodies between the points and drive the slide of its prismatic "
          "joint",
          who);
    }
    if (parts.bodies[j.a].fixed && parts.bodies[j.b].fixed) {
      fail("{} drives a joint of '{}' and '{}', which are both fixed; free one, or prescribe its position or pose", who,
           parts.bodies[j.a].name, parts.bodies[j.b].name);
    }
    spec.body = BodyId(j.b);
  }
  const Body& b = known_body(parts, spec.body, who);
  if (spec.target == MotionSpec::Target::pose && !spec.pose) fail("{} has no function that gives the pose", who);
  p.axis = unit(spec.axis, who);
  p.start = dot(b.motion.position, p.axis);
  p.start_rotation = b.motion.rotation;
  if (spec.frame == BodyFrame::reference) {
    const BuiltBody& built = parts.built[spec.body.index()];
    p.axes = transposed(from_eigen(built.reference_axes));
    p.centre = -(p.axes * from_eigen(built.reference_origin));
  }
  p.spec = std::move(spec);
  if (p.spec.by_speed) p.drive.reached = coordinate_of_drive(parts, p);
  return p;
}

DEM_INLINE MotionId add_motion(Parts& parts, MotionSpec spec) {
  settle_name(spec.name, parts.motions, "prescribed motion", "prescribed motions", name_in_spec);
  use(parts, motion_kind);
  parts.apply_motions = &mbd::apply_motions;
  parts.check_holds = &mbd::check_holds;
  return keep<MotionId>(parts, parts.motions, make_motion(parts, std::move(spec)), false);
}

}  // namespace dem::mbd::detail

#endif
