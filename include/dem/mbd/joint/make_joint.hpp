#pragma once

// Turns a joint as the user wrote it (in global coordinates at assembly) into what a step runs on (body coordinates),
// and refuses what cannot work.

#include <dem/core/macros.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <algorithm>
#include <numbers>
#include <utility>

namespace dem::mbd::detail {

/// x of a joint's frame; the choice is explained at JointSpec::with_x.
Vector3<double> x_of_frame(const JointSpec& s, const Vector3<double>& z, const std::string& who);

Axes axes_in_body(const Body& b, const Vector3<double>& x, const Vector3<double>& z);

void use_connections(const Parts& parts, JointSpec& s, const std::string& who);

void check_penalty(const JointSpec& s, const std::string& who);

/// What the coordinates are said to be at assembly. Throws Error for those that are what they are.
void set_starts(Joint& j, const JointSpec& s, const std::string& who);

Joint make_joint(const Parts& parts, JointSpec& s);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Vector3<double> x_of_frame(const JointSpec& s, const Vector3<double>& z, const std::string& who) {
  using V = Vector3<double>;
  const V given = s.x_axis ? unit(*s.x_axis, "the x axis of " + who) : std::abs(z.x) > 0.9 ? V{0, 1, 0} : V{1, 0, 0};
  const V x = given - dot(z, given) * z;
  if (!(norm(x) > 1e-6)) {
    fail("the x axis of {} runs along its z axis, ({:g}, {:g}, {:g}); give with_x a direction across it", who, z.x, z.y,
         z.z);
  }
  return normalised(x);
}

DEM_INLINE Axes axes_in_body(const Body& b, const Vector3<double>& x, const Vector3<double>& z) {
  const auto in_body = [&](const Vector3<double>& v) { return transpose_times(b.motion.rotation, v); };
  return {in_body(x), in_body(cross(z, x)), in_body(z)};
}

DEM_INLINE void use_connections(const Parts& parts, JointSpec& s, const std::string& who) {
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

DEM_INLINE void check_penalty(const JointSpec& s, const std::string& who) {
  const auto check = [&](const std::optional<double>& value, const char* what, const char* unit_name) {
    if (value) require_non_negative(*value, dem::text("{} of {}", what, who).c_str(), unit_name);
  };
  check(s.stiffness, "stiffness", "N/m");
  check(s.damping, "damping", "N s/m");
  check(s.rotational_stiffness, "rotational stiffness", "N m/rad");
  check(s.rotational_damping, "rotational damping", "N m s/rad");
  if (const auto check_kind = traits_of(s.kind).check) check_kind(s, who);
}

DEM_INLINE void set_starts(Joint& j, const JointSpec& s, const std::string& who) {
  for (const JointStart& start : s.starts) {
    const Dof dof = known_dof(s.kind, start.dof, "starting_at of " + who);
    if (dof != Dof::turn && dof != Dof::slide) {
      fail(
          "starting_at of {} gives its {} a value, but only a turn about z and a slide along z can count from any "
          "value at assembly; move a body instead",
          who, name_of(dof));
    }
    if (!std::isfinite(start.value)) {
      fail("the {} of {} starts at {:g}, but must be finite at assembly", name_of(dof), who, start.value);
    }
    (dof == Dof::turn ? j.angle_offset : j.slide_offset) = start.value;
  }
}

DEM_INLINE Joint make_joint(const Parts& parts, JointSpec& s) {
  if (!s.kind.valid()) fail("joint '{}' has no kind; make it with revolute(...) or another of its functions", s.name);
  if (!s.limits.empty() && !s.add_limits) fail("joint '{}' has limits of its own; give them with with_limits", s.name);
  if (s.friction && !s.add_friction) fail("joint '{}' has friction of its own; give it with with_friction", s.name);
  const std::string who = name_of(s.kind) + (" '" + s.name + "'");
  use_connections(parts, s, who);
  const Body &a = known_body(parts, s.a, who), &b = known_body(parts, s.b, who);
  if (s.a == s.b) {
    fail("{} joins body '{}' to itself: a joint needs two different bodies; use machine.ground() for a fixed one", who,
         a.name);
  }
  const JointTraits& traits = traits_of(s.kind);
  if (a.fixed && b.fixed && traits.stiffness != Stiffness::none) {
    fail(
        "{} joins '{}' and '{}', which are both fixed, so it would hold nothing; leave it out, or measure with a "
        "free_joint",
        who, a.name, b.name);
  }
  check_penalty(s, who);
  using V = Vector3<double>;
  const V at_a = finite_point(s.at_a, "the point on body a of " + who);
  const V at_b = finite_point(s.at_b, "the point on body b of " + who);
  V za = unit(s.axis_a, "the axis of " + who), zb = unit(s.axis_b, "the axis of " + who);
  // Points and axes that nearly meet are put in the middle: the joint starts at rest, not stretched by the gap.
  const bool has_one_axis = !traits.two_axes && traits.align != Align::nothing;
  const auto differ = [](const V& p, const V& q) { return p.x != q.x || p.y != q.y || p.z != q.z; };
  const double crooked = norm(cross(za, zb)) + (dot(za, zb) < 0.0);
  const double angle = std::acos(std::clamp(dot(za, zb), -1.0, 1.0));
  if (has_one_axis && crooked <= s.tolerance && differ(za, zb)) za = zb = normalised(za + zb);
  const V gap = at_b - at_a;
  const V held_gap = held_part(traits.hold, za, gap);
  const double apart = norm(held_gap);
  if (!traits.points_apart && !(apart <= s.tolerance)) {
    fail(
        "the points of {} do not meet: ({:g}, {:g}, {:g}) on body '{}' and ({:g}, {:g}, {:g}) on body '{}' are {:g} m "
        "apart, allowed is {:g} m; move a body or a point, or raise the joint's tolerance",
        who, s.at_a.x(), s.at_a.y(), s.at_a.z(), a.name, s.at_b.x(), s.at_b.y(), s.at_b.z(), b.name, apart,
        s.tolerance);
  }
  if (has_one_axis && !(crooked <= s.tolerance)) {
    fail(
        "the axes of {} are {:g} rad apart, allowed is {:g}; give both bodies the same axis or raise the joint's "
        "tolerance",
        who, angle, s.tolerance);
  }
  if (traits.two_axes && dot(za, zb) < 0.05) {
    fail("the shafts of {} are bent by {:g} deg, allowed is 87 deg; point both axes the way the torque goes", who,
         angle * 180.0 / std::numbers::pi);
  }

  Joint j{};
  j.a = s.a.value;
  j.b = s.b.value;
  j.kind = s.kind;
  j.turns = traits.turns();
  const V to_middle = traits.points_apart ? V{0, 0, 0} : 0.5 * held_gap;
  j.point_a = to_body(a, at_a + to_middle);
  j.point_b = to_body(b, at_b - to_middle);
  const V xa = x_of_frame(s, za, who);
  V xb = xa;
  if (traits.align == Align::cross) {
    const V yb = normalised(cross(zb, xa));  // the second arm of the cross, square to the first
    xb = cross(yb, zb);
  } else if (differ(za, zb)) {
    xb = from_eigen(rotation_between(to_eigen(za), to_eigen(zb))) * xa;
  }
  j.axes_a = axes_in_body(a, xa, za);
  j.axes_b = axes_in_body(b, xb, zb);
  set_starts(j, s, who);
  // What is given counts from the start; the rest waits for the time step.
  j.k = s.stiffness.value_or(0.0);
  j.c = s.damping.value_or(0.0);
  j.kr = s.rotational_stiffness.value_or(0.0);
  j.cr = s.rotational_damping.value_or(0.0);
  if (traits.take) traits.take(j, s, gap, who);
  return j;
}

}  // namespace dem::mbd::detail

#endif
