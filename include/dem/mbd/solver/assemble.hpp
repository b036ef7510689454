#pragma once

// Turns what the user wrote (specs, in global coordinates at assembly) into what a step runs on (body coordinates), and
// refuses what cannot work; joints are in make_joint.hpp.

#include <dem/mbd/joint/make_joint.hpp>

#include <algorithm>
#include <utility>

namespace dem::mbd::detail {

/// Checks the two ends of an element between points and puts the points into body frames.
template <class Part, class Spec>
void attach_points(const Parts& parts, Part& part, const Spec& s, const std::string& who, bool need_distance) {
  const Body &a = known_body(parts, s.a, who), &b = known_body(parts, s.b, who);
  if (s.a == s.b) fail("{} joins body '{}' to itself; give it two different bodies", who, a.name);
  const auto point_a = finite_point(s.at_a, "the first point of " + who);
  const auto point_b = finite_point(s.at_b, "the second point of " + who);
  if (const double apart = norm(point_b - point_a); need_distance && !(apart > 1e-9)) {
    fail(
        "the two points of {} are {:g} m apart, so its direction is not known; move one of them, or act on a joint's "
        "coordinate instead",
        who, apart);
  }
  part.point_a = to_body(a, point_a);
  part.point_b = to_body(b, point_b);
}

inline void check_actuator(const ActuatorSpec& spec, const std::string& who) {
  require_non_negative(spec.position_gain, ("position gain of " + who).c_str(), "N/m or N m/rad");
  require_non_negative(spec.speed_gain, ("speed gain of " + who).c_str(), "N s/m or N m s/rad");
  require_within(spec.throttle, -1.0, 1.0, ("throttle of " + who).c_str());
  if (!(spec.max_force > 0.0)) {
    fail("the largest force of {} is {:g} N or N m, but must be greater than zero; leave it out for no limit", who,
         spec.max_force);
  }
}

/// The degree of freedom that a term of a coupling names, or the one of the kind that the term needs.
inline Dof dof_of(const CouplingSpec::Term& term, const Parts& parts, std::size_t number, const std::string& who) {
  using enum CouplingSpec::Moves;
  const Joint& j = known_joint(parts, term.joint, who);
  Dof dof = resolved(j.kind, term.dof);
  if (term.needs != any) {
    const Dofs& all = dofs_of(j.kind);
    const bool turns = term.needs == rotation;
    if (term.dof == Dof::own && all.has(turns ? Dof::turn : Dof::slide)) {
      dof = turns ? Dof::turn : Dof::slide;
    }
    if (dof == Dof::own || !all.has(dof) || is_rotation(dof) != turns) {
      fail(
          "{} needs as joint {} one that {}, but '{}' is a {}{}; exchange the joints, or name a degree of freedom that "
          "{} in the "
          "coupling's terms",
          who, number, turns ? "turns" : "slides", parts.joint_specs[term.joint.index()].name, name_of(j.kind),
          term.dof == Dof::own ? "" : fmt::format(" and its {} does not", name_of(dof)), turns ? "turns" : "slides");
    }
  }
  return require_free_dof(j.kind, dof, who);
}

inline Coupling make_coupling(const Parts& parts, CouplingSpec spec) {
  const std::string who = fmt::format("coupling '{}'", spec.name);
  if (spec.terms.size() < 2) fail("{} joins {} coordinates, but needs at least 2", who, spec.terms.size());
  for (std::size_t i = 0; i < spec.terms.size(); ++i) {
    spec.terms[i].dof = dof_of(spec.terms[i], parts, i + 1, who);
    if (!std::isfinite(spec.terms[i].ratio) || spec.terms[i].ratio == 0.0) {
      fail("ratio {} of {} is {:g}, but must be finite and not zero", i + 1, who, spec.terms[i].ratio);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (spec.terms[k].joint == spec.terms[i].joint && spec.terms[k].dof == spec.terms[i].dof) {
        fail("{} names the same coordinate twice; add up the ratios", who);
      }
    }
  }
  if (spec.stiffness) require_non_negative(*spec.stiffness, ("stiffness of " + who).c_str(), "per unit of the sum");
  if (spec.damping) require_non_negative(*spec.damping, ("damping of " + who).c_str(), "per unit of the sum's rate");
  Coupling g;
  g.offset = coupling_sum(spec, parts.joints, parts.bodies);
  g.k = spec.stiffness.value_or(0.0);
  g.c = spec.damping.value_or(0.0);
  g.spec = std::move(spec);
  return g;
}

inline PrescribedMotion make_motion(const Parts& parts, MotionSpec spec) {
  const std::string who = fmt::format("prescribed motion '{}'", spec.name);
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
  return p;
}

/// Checks that what a sensor measures is there.
inline void check_sensor(const Parts& parts, const SensorSpec& spec) {
  const std::size_t count = spec.target == SensorTarget::joint      ? parts.joints.size()
                            : spec.target == SensorTarget::actuator ? parts.actuators.size()
                            : spec.target == SensorTarget::drive    ? parts.motions.size()
                                                                    : parts.bodies.size();
  const char* what = spec.target == SensorTarget::joint      ? "joint"
                     : spec.target == SensorTarget::actuator ? "actuator"
                     : spec.target == SensorTarget::drive    ? "prescribed motion"
                                                             : "body";
  if (spec.index >= count) {
    fail("sensor '{}' measures {} {}, but the machine has {} of them; use the id that add_... returned", spec.name,
         what, spec.index == BodyId().index() ? "(never added)" : std::to_string(spec.index), count);
  }
  if (spec.target == SensorTarget::drive && parts.motions[spec.index].spec.target == MotionSpec::Target::pose) {
    fail(
        "sensor '{}' measures the drive of '{}', which prescribes a whole pose and so has no single force; use a "
        "total_force_sensor on its body",
        spec.name, parts.motions[spec.index].spec.name);
  }
}

}  // namespace dem::mbd::detail
