#pragma once

// Turns what the user wrote (specs, in global coordinates at assembly) into what a step runs on (body coordinates), and
// refuses what cannot work.

#include <dem/mbd/parts.hpp>

#include <algorithm>
#include <utility>

namespace dem::mbd::detail {

/// A global point in a body's frame.
inline Vec3 to_body(const Body& b, const Vec3& global) { return b.rotation().transpose() * (global - b.position()); }

/// Any direction across `axis`, the same one for the same axis.
inline Vec3 across(const Vec3& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3::Unit(least)).normalized();
}

inline Axes axes_in_body(const Body& b, const Vec3& x, const Vec3& z) {
  const Mat3 t = b.rotation().transpose();
  return {from_eigen(Vec3(t * x)), from_eigen(Vec3(t * z.cross(x))), from_eigen(Vec3(t * z))};
}

inline void use_connections(const Parts& parts, JointSpec& s, const std::string& who) {
  const auto resolve = [&](ConnectionId id, BodyId& body, Vec3& at) {
    if (!id.valid()) return;
    if (id.index() >= parts.connections.size()) {
      fail("{} names connection point {}, but the machine has {}; use the ConnectionId that add_connection returned",
           who, id.index(), parts.connections.size());
    }
    const Connection& c = parts.connections[id.index()];
    body = c.body;
    at = parts.bodies[c.body.index()].point(c.point);
  };
  resolve(s.connection_a, s.a, s.at_a);
  resolve(s.connection_b, s.b, s.at_b);
}

inline void check_penalty(const JointSpec& s, const std::string& who) {
  const auto check = [&](const std::optional<double>& value, const char* what, const char* unit_name) {
    if (value) require_non_negative(*value, fmt::format("{} of {}", what, who).c_str(), unit_name);
  };
  check(s.stiffness, "stiffness", "N/m");
  check(s.damping, "damping", "N s/m");
  check(s.rotational_stiffness, "rotational stiffness", "N m/rad");
  check(s.rotational_damping, "rotational damping", "N m s/rad");
  if (s.kind == JointKind::bushing) {
    for (const Vec3* v :
         {&s.bushing_stiffness, &s.bushing_damping, &s.bushing_rotational_stiffness, &s.bushing_rotational_damping}) {
      for (int k = 0; k < 3; ++k) require_non_negative((*v)[k], ("a constant of " + who).c_str(), "(SI units)");
    }
  }
  if (s.kind == JointKind::bushing && s.bushing_stiffness.norm() + s.bushing_rotational_stiffness.norm() <= 0.0) {
    fail("{} has no stiffness at all: give it bushing_stiffness (N/m) or bushing_rotational_stiffness (N m/rad)", who);
  }
}

inline Joint make_joint(const Parts& parts, JointSpec& s) {
  const std::string who = fmt::format("{} '{}'", name_of(s.kind), s.name);
  use_connections(parts, s, who);
  const Body &a = known_body(parts, s.a, who), &b = known_body(parts, s.b, who);
  if (s.a == s.b) {
    fail("{} joins body '{}' to itself: a joint needs two different bodies; use machine.ground() for a fixed one", who,
         a.name);
  }
  check_penalty(s, who);
  const Vec3 za = unit(s.axis_a, "the axis of " + who), zb = unit(s.axis_b, "the axis of " + who);
  const bool has_own_axes = s.kind == JointKind::universal || s.kind == JointKind::constant_velocity;
  const Vec3 gap = s.at_b - s.at_a;
  const bool may_be_apart = s.kind == JointKind::distance || s.kind == JointKind::free;
  // Only the directions that the joint holds have to meet.
  const double apart = hold_of(s.kind) == Hold::line    ? (gap - za.dot(gap) * za).norm()
                       : hold_of(s.kind) == Hold::plane ? std::abs(za.dot(gap))
                                                        : gap.norm();
  if (!may_be_apart && !(apart <= s.tolerance)) {
    fail(
        "the points of {} do not meet: ({:g}, {:g}, {:g}) on body '{}' and ({:g}, {:g}, {:g}) on body '{}' are {:g} m "
        "apart, allowed is {:g} m; move a body or a point, or raise the joint's tolerance",
        who, s.at_a.x(), s.at_a.y(), s.at_a.z(), a.name, s.at_b.x(), s.at_b.y(), s.at_b.z(), b.name, apart,
        s.tolerance);
  }
  if (!has_own_axes && align_of(s.kind) != Align::nothing && za.cross(zb).norm() + (za.dot(zb) < 0.0) > s.tolerance) {
    fail(
        "the axes of {} are {:g} rad apart, allowed is {:g}; give both bodies the same axis or raise the joint's "
        "tolerance",
        who, std::acos(std::clamp(za.dot(zb), -1.0, 1.0)), s.tolerance);
  }
  if (has_own_axes && za.dot(zb) < 0.05) {
    fail("the shafts of {} are bent by {:g} deg, allowed is 87 deg; point both axes the way the torque goes", who,
         std::acos(std::clamp(za.dot(zb), -1.0, 1.0)) * 180.0 / std::numbers::pi);
  }

  Joint j{};
  j.a = s.a.value;
  j.b = s.b.value;
  j.kind = s.kind;
  j.turns = turns(s.kind);
  j.point_a = from_eigen(to_body(a, s.at_a));
  j.point_b = from_eigen(to_body(b, s.at_b));
  const Vec3 xa = across(za);
  Vec3 xb = xa;
  if (s.kind == JointKind::universal) {
    const Vec3 yb = zb.cross(xa).normalized();  // the second arm of the cross, square to the first
    xb = yb.cross(zb);
  } else if (s.kind == JointKind::constant_velocity) {
    xb = Quaternion::FromTwoVectors(za, zb) * xa;
  }
  j.axes_a = axes_in_body(a, xa, za);
  j.axes_b = axes_in_body(b, xb, zb);
  (turns(s.kind) ? j.angle_offset : j.slide_offset) = s.start;
  j.length = s.length ? require_positive(*s.length, ("length of " + who).c_str(), "m") : gap.norm();
  if (s.kind == JointKind::distance && !(gap.norm() > 1e-9)) {
    fail("the points of {} are {:g} m apart, but need a distance; use a spherical joint for points that meet", who,
         gap.norm());
  }
  // What is given counts from the start; the rest waits for the time step.
  j.k = s.stiffness.value_or(0.0);
  j.c = s.damping.value_or(0.0);
  j.kr = s.rotational_stiffness.value_or(0.0);
  j.cr = s.rotational_damping.value_or(0.0);
  if (s.kind == JointKind::bushing) {
    j.k3 = from_eigen(s.bushing_stiffness);
    j.c3 = from_eigen(s.bushing_damping);
    j.kr3 = from_eigen(s.bushing_rotational_stiffness);
    j.cr3 = from_eigen(s.bushing_rotational_damping);
  }
  return j;
}

inline void add_stops(Parts& parts, const JointSpec& s, std::uint32_t joint) {
  const std::string who = fmt::format("{} '{}'", name_of(s.kind), s.name);
  for (const JointLimits& l : s.limits) {
    require_freedom(s.kind, l.freedom, "a stop of " + who);
    if (!(l.lower < l.upper)) {
      fail("the limits of {} are {:g} to {:g}: the lower one must be below the upper one", who, l.lower, l.upper);
    }
    if (l.stiffness) require_non_negative(*l.stiffness, ("stop stiffness of " + who).c_str(), "N/m or N m/rad");
    if (l.damping) require_non_negative(*l.damping, ("stop damping of " + who).c_str(), "N s/m or N m s/rad");
    for (const JointStops& e : parts.stops) {
      if (e.joint == joint && e.freedom == l.freedom) {
        fail("{} has two pairs of limits for its {}; give one", who, name_of(l.freedom));
      }
    }
    parts.stops.push_back(
        {joint, l.freedom, l.lower, l.upper, l.stiffness.value_or(0.0), l.damping.value_or(0.0), 0.0});
  }
}

inline void add_rubbing(Parts& parts, const JointSpec& s, std::uint32_t joint) {
  if (!s.friction) return;
  const std::string who = fmt::format("{} '{}'", name_of(s.kind), s.name);
  using enum JointKind;
  if (s.kind == fixed || s.kind == distance || s.kind == bushing || s.kind == free) {
    fail("{} has friction, but nothing in it slides; a bushing has dampers, and other kinds of joint have friction",
         who);
  }
  JointRubbing e;
  e.joint = joint;
  e.radius = require_positive(s.friction->radius, ("bearing radius of " + who).c_str(), "m");
  e.preload = require_non_negative(s.friction->preload, ("preload of " + who).c_str(), "N");
  e.lever = require_non_negative(s.friction->lever, ("lever of " + who).c_str(), "m");
  e.law = {s.friction->coefficient, s.friction->stiffness.value_or(0.0), s.friction->velocity_stiffness.value_or(0.0),
           s.friction->breaking_factor};
  friction::AsperitySpring::check(e.law);
  parts.rubbing.push_back(e);
}

/// Checks the two ends of an element between points and puts the points into body frames.
template <class Part, class Spec>
void attach_points(const Parts& parts, Part& part, const Spec& s, const std::string& who, bool need_distance) {
  const Body &a = known_body(parts, s.a, who), &b = known_body(parts, s.b, who);
  if (s.a == s.b) fail("{} joins body '{}' to itself; give it two different bodies", who, a.name);
  if (need_distance && !((s.at_b - s.at_a).norm() > 1e-9)) {
    fail(
        "the two points of {} are {:g} m apart, so its direction is not known; move one of them, or act on a joint's "
        "coordinate instead",
        who, (s.at_b - s.at_a).norm());
  }
  part.point_a = from_eigen(to_body(a, s.at_a));
  part.point_b = from_eigen(to_body(b, s.at_b));
}

inline Coupling make_coupling(const Parts& parts, CouplingSpec spec) {
  const std::string who = fmt::format("coupling '{}'", spec.name);
  if (spec.terms.size() < 2) fail("{} joins {} coordinates, but needs at least 2", who, spec.terms.size());
  for (std::size_t i = 0; i < spec.terms.size(); ++i) {
    const Joint& j = known_joint(parts, spec.terms[i].joint, who);
    require_freedom(j.kind, spec.terms[i].freedom, who);
    if (!std::isfinite(spec.terms[i].ratio) || spec.terms[i].ratio == 0.0) {
      fail("ratio {} of {} is {:g}, but must be finite and not zero", i + 1, who, spec.terms[i].ratio);
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (spec.terms[k].joint == spec.terms[i].joint && spec.terms[k].freedom == spec.terms[i].freedom) {
        fail("{} names the same coordinate twice; add up the ratios", who);
      }
    }
  }
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
    require_freedom(j.kind, Freedom::own, who);
    spec.body = BodyId(j.b);
  }
  const Body& b = known_body(parts, spec.body, who);
  if (spec.target == MotionSpec::Target::pose && !spec.pose) fail("{} has no function that gives the pose", who);
  p.axis = from_eigen(unit(spec.axis, who));
  p.start = dot(b.motion.position, p.axis);
  p.start_rotation = b.motion.rotation;
  p.spec = std::move(spec);
  return p;
}

}  // namespace dem::mbd::detail
