#pragma once

// Adds what the user wrote to the parts of a machine: checked, with a name of its own, in body coordinates.

#include <dem/mbd/solver/assemble.hpp>

namespace dem::mbd::detail {

inline constexpr auto name_in_spec = [](const auto& part) -> const std::string& { return part.spec.name; };

/// Keeps a part; structural ones make what was derived and initialised before out of date.
template <class Id, class Part>
Id keep(Parts& parts, std::vector<Part>& list, Part&& part, bool structural = true) {
  list.push_back(std::move(part));
  if (structural) ++parts.revision;
  return Id(list.size() - 1);
}

inline BodyId add_body(Parts& parts, BuiltBody built) {
  settle_name(built.body.name, parts.bodies, "body", "bodies", [](const Body& b) { return b.name; });
  parts.bodies.push_back(built.body);
  return keep<BodyId>(parts, parts.built, std::move(built));
}

inline ConnectionId add_connection(Parts& parts, std::string name, BodyId body, const Vec3& at) {
  const std::string who = fmt::format("connection point '{}'", name);
  const Body& b = known_body(parts, body, who);
  settle_name(name, parts.connections, "connection point", "connection points",
              [](const Connection& c) { return c.name; });
  Connection c{std::move(name), body, to_eigen(to_body(b, finite_point(at, who)))};
  return keep<ConnectionId>(parts, parts.connections, std::move(c), false);
}

inline JointId add_joint(Parts& parts, JointSpec spec) {
  settle_name(spec.name, parts.joint_specs, "joint", "joints", [](const JointSpec& s) { return s.name; });
  const Joint j = make_joint(parts, spec);
  const auto number = static_cast<std::uint32_t>(parts.joints.size());
  const std::size_t limits = parts.limits.size();
  try {
    add_limits(parts, spec, j, number);
    if (spec.friction) {
      const std::string who = fmt::format("{} '{}'", name_of(spec.kind), spec.name);
      parts.friction.push_back(make_friction(spec, number, who));
    }
  } catch (...) {  // a refused joint leaves nothing behind
    parts.limits.resize(limits);
    throw;
  }
  parts.joints.push_back(j);
  return keep<JointId>(parts, parts.joint_specs, std::move(spec));
}

/// A rotational actuator between three points acts on a free joint about the normal of their plane.
inline JointId joint_on_three_points(Parts& parts, const ActuatorSpec& spec, const std::string& who) {
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

inline ActuatorId add_actuator(Parts& parts, ActuatorSpec spec) {
  settle_name(spec.name, parts.actuators, "actuator", "actuators", name_in_spec);
  const std::string who = fmt::format("actuator '{}'", spec.name);
  check_actuator(spec, who);
  Actuator u;
  if (spec.three_points) spec.joint = joint_on_three_points(parts, spec, who);
  if (spec.joint.valid()) {
    const Joint& j = known_joint(parts, spec.joint, who);
    spec.dof = require_free_dof(j.kind, spec.dof, who);
    u.a = j.a;
    u.b = j.b;
  } else {
    attach_points(parts, u, spec, who, true);
    u.a = spec.a.value;
    u.b = spec.b.value;
  }
  u.spec = std::move(spec);
  if (!u.spec.set_point) {
    u.spec.set_point = coordinate_of(u, parts.joints, parts.bodies[u.a], parts.bodies[u.b]).value;
  }
  return keep<ActuatorId>(parts, parts.actuators, std::move(u));
}

inline SpringId add_spring(Parts& parts, SpringSpec spec) {
  settle_name(spec.name, parts.springs, "spring", "springs", name_in_spec);
  Spring s;
  attach_points(parts, s, spec, fmt::format("spring '{}'", spec.name), true);
  s.spec = std::move(spec);
  return keep<SpringId>(parts, parts.springs, std::move(s));
}

inline CouplingId add_coupling(Parts& parts, CouplingSpec spec) {
  settle_name(spec.name, parts.couplings, "coupling", "couplings", name_in_spec);
  return keep<CouplingId>(parts, parts.couplings, make_coupling(parts, std::move(spec)));
}

inline LoadId add_load(Parts& parts, LoadSpec spec) {
  settle_name(spec.name, parts.loads, "load", "loads", name_in_spec);
  const std::string who = fmt::format("load '{}'", spec.name);
  const Body& b = known_body(parts, spec.body, who);
  const Vector3<double> n = unit(spec.direction, who);
  Load load;
  load.point = to_body(b, finite_point(spec.at, "the point of " + who));
  load.direction = spec.follows_body ? transpose_times(b.motion.rotation, n) : n;
  load.spec = std::move(spec);
  return keep<LoadId>(parts, parts.loads, std::move(load), false);
}

inline MotionId add_motion(Parts& parts, MotionSpec spec) {
  settle_name(spec.name, parts.motions, "prescribed motion", "prescribed motions", name_in_spec);
  return keep<MotionId>(parts, parts.motions, make_motion(parts, std::move(spec)), false);
}

inline SensorId add_sensor(Parts& parts, SensorSpec spec) {
  settle_name(spec.name, parts.sensors, "sensor", "sensors", name_in_spec);
  check_sensor(parts, spec);
  WindowAverage average(spec.window);
  return keep<SensorId>(parts, parts.sensors, Sensor{std::move(spec), average}, false);
}

}  // namespace dem::mbd::detail
