#pragma once

// Anti-roll bars: a torsion bar on the chassis whose arms are tied to the suspensions of an axle.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/coupling_part.hpp>
#include <dem/mbd/joint/joint_part.hpp>

namespace dem::mbd {

/// An anti-roll bar between the coordinates of two joints: forces stiffness (q_left - q_right) + damping (its rate),
/// which push the left coordinate down and the right one up. In N m/rad where they turn, N/m where they slide. Both
/// coordinates have to grow where their wheels rise. With `mirrored` the sum counts in place of the difference, for two
/// arms on axes that point the same way on both sides of the car.
CouplingSpec anti_roll_bar(std::string name, JointId left, JointId right, double stiffness, double damping = 0.0,
                           bool mirrored = false);

/// An anti-roll bar between two points of suspension parts, where its drop links are tied to them. The forces act along
/// `up` of the chassis. A bar of torsional stiffness kt (N m/rad) with arms of length L (m) has the stiffness kt/L^2.
struct AntiRollBarSpec {
  std::string name;
  BodyId chassis = {}, left = {}, right = {};
  Vec3 at_left = Vec3::Zero(), at_right = Vec3::Zero();  ///< m, global at assembly
  double stiffness = 0.0;                                ///< N on each point per m of difference in height
  double damping = 0.0;                                  ///< N s/m
  Vec3 up = Vec3::UnitZ();                               ///< global at assembly; turns with the chassis
};

namespace detail {

/// The heights of the points are measured by two free joints, named after the bar.
CouplingId add_anti_roll_bar(Parts& parts, const AntiRollBarSpec& s);

}  // namespace detail
}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE CouplingSpec anti_roll_bar(std::string name, JointId left, JointId right, double stiffness, double damping,
                                      bool mirrored) {
  return {.name = std::move(name),
          .terms = {{left, 1.0}, {right, mirrored ? 1.0 : -1.0}},
          .stiffness = require_positive(stiffness, "stiffness of an anti-roll bar", "N m/rad or N/m"),
          .damping = require_non_negative(damping, "damping of an anti-roll bar", "N m s/rad or N s/m")};
}

}  // namespace dem::mbd

namespace dem::mbd::detail {

DEM_INLINE CouplingId add_anti_roll_bar(Parts& parts, const AntiRollBarSpec& s) {
  const std::string who = "anti-roll bar '" + s.name + "'";
  const CouplingSpec bar = mbd::anti_roll_bar(s.name, {}, {}, s.stiffness, s.damping);
  known_body(parts, s.chassis, who);
  known_body(parts, s.left, who);
  known_body(parts, s.right, who);
  finite_point(s.at_left, "the left point of " + who);
  finite_point(s.at_right, "the right point of " + who);
  unit(s.up, who);
  for (const BodyId b : {s.left, s.right}) {
    if (b == s.chassis) fail("{} ties its chassis '{}' to itself", who, parts.bodies[b.index()].name);
  }
  for (const Coupling& g : parts.couplings) {
    if (g.spec.name == s.name) fail("two couplings are named '{}'; rename one, so that reports are clear", s.name);
  }
  CouplingSpec spec = bar;
  spec.terms[0] = {add_joint(parts, free_joint("left of " + who, s.chassis, s.left, s.at_left, s.up)), 1.0, Dof::slide};
  spec.terms[1] = {add_joint(parts, free_joint("right of " + who, s.chassis, s.right, s.at_right, s.up)), -1.0,
                   Dof::slide};
  return add_coupling(parts, std::move(spec));
}

}  // namespace dem::mbd::detail

#endif
