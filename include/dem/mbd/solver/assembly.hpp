#pragma once

#include <dem/mbd/solver/assemble.hpp>
#include <dem/mbd/solver/mechanism.hpp>

namespace dem::mbd {

/// A mechanism as it is put together: bodies, joints and everything that acts between them. `Mechanism` tells what
/// they do, `Machine` adds the motion. Every add_... function checks what it is given, throws Error in words, and
/// returns an id.
class Assembly : public Mechanism {
 public:
  BodyId add_body(const BodySpec& spec) { return keep_body(build_body(spec)); }
  /// A body that is given in its own frame: centre of mass and principal axes.
  BodyId add_body(const Body& body) {
    check_body(body);
    return keep_body({body, Vec3::Zero(), Mat3::Identity()});
  }
  BodyId add_fixed_body(std::string name, const Vec3& position = Vec3::Zero()) {
    return add_body(fixed_body(std::move(name), position));
  }
  /// The fixed body "ground" at the origin; made when first asked for, which adds a body.
  BodyId ground() {
    if (!ground_.valid()) ground_ = add_fixed_body("ground");
    return ground_;
  }
  /// A connection point (section 2.3) at a global point.
  ConnectionId add_connection(std::string name, BodyId body, const Vec3& at) {
    const std::string who = fmt::format("connection point '{}'", name);
    const Body& b = known_body(parts_, body, who);
    settle_name(name, parts_.connections, "connection point", "connection points",
                [](const Connection& c) { return c.name; });
    parts_.connections.push_back({std::move(name), body, detail::to_body(b, finite_point(at, who))});
    return ConnectionId(parts_.connections.size() - 1);
  }
  /// A connection point at a point of the body's reference frame.
  ConnectionId add_connection_in_reference(std::string name, BodyId body, const Vec3& point) {
    known_body(parts_, body, fmt::format("connection point '{}'", name));
    return add_connection(std::move(name), body, reference_point(body, point));
  }
  JointId add_joint(JointSpec spec) {
    settle_name(spec.name, parts_.joint_specs, "joint", "joints", [](const JointSpec& s) { return s.name; });
    const Joint j = detail::make_joint(parts_, spec);
    const auto number = static_cast<std::uint32_t>(parts_.joints.size());
    const std::size_t limits = parts_.limits.size();
    try {
      detail::add_limits(parts_, spec, j, number);
      if (spec.friction) {
        const std::string who = fmt::format("{} '{}'", name_of(spec.kind), spec.name);
        parts_.friction.push_back(detail::make_friction(spec, number, who));
      }
    } catch (...) {  // a refused joint leaves nothing behind
      parts_.limits.resize(limits);
      throw;
    }
    parts_.joints.push_back(j);
    parts_.joint_specs.push_back(std::move(spec));
    changed_ = true;
    return JointId(parts_.joints.size() - 1);
  }
  ActuatorId add_actuator(ActuatorSpec spec) {
    settle_name(spec.name, parts_.actuators, "actuator", "actuators", name_in_spec);
    const std::string who = fmt::format("actuator '{}'", spec.name);
    detail::check_actuator(spec, who);
    Actuator u;
    if (spec.three_points) spec = on_three_points(std::move(spec), who);
    if (spec.joint.valid()) {
      const Joint& j = known_joint(parts_, spec.joint, who);
      spec.dof = require_free_dof(j.kind, spec.dof, who);
      u.a = j.a;
      u.b = j.b;
    } else {
      detail::attach_points(parts_, u, spec, who, true);
      u.a = spec.a.value;
      u.b = spec.b.value;
    }
    u.spec = std::move(spec);
    if (!u.spec.set_point) {
      u.spec.set_point = coordinate_of(u, parts_.joints, parts_.bodies[u.a], parts_.bodies[u.b]).value;
    }
    parts_.actuators.push_back(std::move(u));
    changed_ = true;
    return ActuatorId(parts_.actuators.size() - 1);
  }
  SpringId add_spring(SpringSpec spec) {
    settle_name(spec.name, parts_.springs, "spring", "springs", name_in_spec);
    Spring s;
    detail::attach_points(parts_, s, spec, fmt::format("spring '{}'", spec.name), true);
    s.spec = std::move(spec);
    parts_.springs.push_back(std::move(s));
    changed_ = true;
    return SpringId(parts_.springs.size() - 1);
  }
  CouplingId add_coupling(CouplingSpec spec) {
    settle_name(spec.name, parts_.couplings, "coupling", "couplings", name_in_spec);
    parts_.couplings.push_back(detail::make_coupling(parts_, std::move(spec)));
    changed_ = true;
    return CouplingId(parts_.couplings.size() - 1);
  }
  LoadId add_load(LoadSpec spec) {
    settle_name(spec.name, parts_.loads, "load", "loads", name_in_spec);
    const std::string who = fmt::format("load '{}'", spec.name);
    const Body& b = known_body(parts_, spec.body, who);
    const Vec3 n = unit(spec.direction, who);
    Load load;
    load.point = from_eigen(detail::to_body(b, finite_point(spec.at, "the point of " + who)));
    load.direction = from_eigen(spec.follows_body ? Vec3(b.rotation().transpose() * n) : n);
    load.spec = std::move(spec);
    parts_.loads.push_back(std::move(load));
    return LoadId(parts_.loads.size() - 1);
  }
  MotionId add_motion(MotionSpec spec) {
    settle_name(spec.name, parts_.motions, "prescribed motion", "prescribed motions", name_in_spec);
    parts_.motions.push_back(detail::make_motion(parts_, std::move(spec)));
    return MotionId(parts_.motions.size() - 1);
  }
  SensorId add_sensor(SensorSpec spec) {
    settle_name(spec.name, parts_.sensors, "sensor", "sensors", name_in_spec);
    detail::check_sensor(parts_, spec);
    WindowAverage average(spec.window);
    parts_.sensors.push_back({std::move(spec), average});
    return SensorId(parts_.sensors.size() - 1);
  }

 private:
  static constexpr auto name_in_spec = [](const auto& part) -> const std::string& { return part.spec.name; };

  BodyId keep_body(BuiltBody built) {
    settle_name(built.body.name, parts_.bodies, "body", "bodies", [](const Body& b) { return b.name; });
    parts_.bodies.push_back(built.body);
    parts_.built.push_back(std::move(built));
    changed_ = true;
    return BodyId(parts_.bodies.size() - 1);
  }
  /// A rotational actuator between three points acts on a free joint about the normal of their plane.
  ActuatorSpec on_three_points(ActuatorSpec spec, const std::string& who) {
    const Vec3 to_a = unit(spec.toward_a - spec.at_a, who), to_b = unit(spec.toward_b - spec.at_b, who);
    const Vec3 normal = to_a.cross(to_b);
    if (normal.norm() < 1e-6) {
      fail("the three points of {} lie on a line, so its axis is not known; use joint_actuator on a revolute joint",
           who);
    }
    spec.joint = add_joint(free_joint("angle of " + who, spec.a, spec.b, spec.at_a, normal)
                               .starting_at(std::atan2(normal.norm(), to_a.dot(to_b))));
    return spec;
  }

  BodyId ground_;
};

}  // namespace dem::mbd
