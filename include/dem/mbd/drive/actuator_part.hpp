#pragma once

// Actuators: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_part.hpp>
#include <dem/mbd/solver/line_element.hpp>

namespace dem::mbd::detail {

/// N, with which an actuator between two points pulls them together while they stand. A set point that it was not asked
/// for yet (0, which is no length) is that at the start.
double pull_of(const Actuator& u, double length);

inline constexpr PartKind actuator_kind = {
    .rank = 6,
    .add_forces =
        [](Parts& m, const Evaluation& now) {
          for (Actuator& u : m.actuators) apply_actuator(u, m.joints, m.bodies, now.time, now.dt);
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.actuators.size(); ++i) {
            const Actuator& u = m.actuators[i];
            const Body &a = m.bodies[u.a], &b = m.bodies[u.b];
            const double c = !u.spec.engine_map.empty()    ? steepest_of_engine(u.spec)
                             : u.spec.torque_curve.empty() ? u.spec.speed_gain
                                                           : u.spec.torque_curve.steepest();
            if (u.spec.joint.valid()) {
              const auto w = inverse_mass_along(m.joints[u.spec.joint.index()], a, b, u.spec.dof);
              add_element(list, actuator_kind, i, u.a, u.b, w, u.spec.position_gain, c);
            } else {
              const Coordinate q = distance_of(u.point_a, u.point_b, a, b);
              add_line_element(list, m, actuator_kind, i, u.a, u.b, q, {u.spec.position_gain, c, pull_of(u, q.value)});
            }
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "actuator '" + m.actuators[i].spec.name + "'"; },
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.actuators.begin(), m.actuators.end(), [&](const Actuator& u) {
            return !u.spec.joint.valid() || traits_of(m.joints[u.spec.joint.index()].kind).changes_with_pose;
          });
        },
    .not_a_number = [](const Parts& m) -> std::string {
      for (const Actuator& u : m.actuators) {
        if (std::isnan(u.target.value + u.target.rate)) return "The set point of actuator '" + u.spec.name + "'";
      }
      return {};
    }};

void check_actuator(const ActuatorSpec& spec, const std::string& who);

/// A rotational actuator between three points acts on a free joint about the normal of their plane.
JointId joint_on_three_points(Parts& parts, const ActuatorSpec& spec, const std::string& who);

/// A number is no speed: without a position gain the rate of the set point counts alone.
void refuse_constant_speed(const ActuatorSpec& spec, const Signal& set_point, const std::string& who);

ActuatorId add_actuator(Parts& parts, ActuatorSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE double pull_of(const Actuator& u, double length) {
  if (u.spec.position_gain == 0.0 || u.spec.has_throttle()) return 0.0;
  const double target = u.target.value != 0.0 ? u.target.value : (*u.spec.set_point)(0.0).value;
  return std::min(u.spec.position_gain * (length - target), u.spec.max_force);
}

DEM_INLINE void check_actuator(const ActuatorSpec& spec, const std::string& who) {
  require_non_negative(spec.position_gain, ("position gain of " + who).c_str(), "N/m or N m/rad");
  require_non_negative(spec.speed_gain, ("speed gain of " + who).c_str(), "N s/m or N m s/rad");
  require_within(spec.throttle, -1.0, 1.0, ("throttle of " + who).c_str());
  if (!(spec.max_force > 0.0)) {
    fail("the largest force of {} is {:g} N or N m, but must be greater than zero; leave it out for no limit", who,
         spec.max_force);
  }
}

DEM_INLINE JointId joint_on_three_points(Parts& parts, const ActuatorSpec& spec, const std::string& who) {
  using V = Vector3<double>;
  const V to_a = unit(from_eigen(spec.toward_a) - from_eigen(spec.at_a), who);
  const V to_b = unit(from_eigen(spec.toward_b) - from_eigen(spec.at_b), who);
  const V normal = cross(to_a, to_b);
  if (norm(normal) < 1e-6) {
    fail("the three points of {} lie on a line, so its axis is not known; use joint_actuator on a revolute joint", who);
  }
  return add_joint(parts, free_joint("angle of " + who, spec.a, spec.b, spec.at_a, to_eigen(normal))
                              .starting_at(std::atan2(norm(normal), dot(to_a, to_b))));
}

DEM_INLINE void refuse_constant_speed(const ActuatorSpec& spec, const Signal& set_point, const std::string& who) {
  const bool follows_rate =
      spec.joint.valid() && spec.on && spec.position_gain == 0.0 && spec.speed_gain > 0.0 && !spec.by_speed;
  if (!follows_rate || !set_point.is_constant()) return;
  const double value = set_point(0.0).value;
  if (value == 0.0) return;
  fail(
      "{} has no position_gain, so it follows the rate of its set point alone, and that of the constant {:g} is 0: it "
      "would brake; to drive at this speed give it Signal::ramp(0, {:g}) or use speed_actuator; to brake, leave the "
      "set "
      "point out",
      who, value, value);
}

DEM_INLINE ActuatorId add_actuator(Parts& parts, ActuatorSpec spec) {
  settle_name(spec.name, parts.actuators, "actuator", "actuators", name_in_spec);
  const std::string who = dem::text("actuator '{}'", spec.name);
  check_actuator(spec, who);
  Actuator u;
  if (spec.three_points) spec.joint = joint_on_three_points(parts, spec, who);
  if (spec.joint.valid()) {
    const Joint& j = known_joint(parts, spec.joint, who);
    spec.dof = require_free_dof(j.kind, spec.dof, who);
    u.a = j.a;
    u.b = j.b;
  } else {
    if (!spec.a.valid() && !spec.b.valid()) {
      fail("{} was given no joint and no bodies; use the JointId that add_joint returned, or two BodyIds", who);
    }
    attach_points(parts, u, spec, who);
    u.a = spec.a.value;
    u.b = spec.b.value;
  }
  if (spec.set_point) refuse_constant_speed(spec, *spec.set_point, who);
  u.spec = std::move(spec);
  if (!u.spec.set_point) {
    u.spec.set_point = coordinate_of(u, parts.joints, parts.bodies[u.a], parts.bodies[u.b]).value;
  }
  use(parts, actuator_kind);
  return keep<ActuatorId>(parts, parts.actuators, std::move(u));
}

}  // namespace dem::mbd::detail

#endif
