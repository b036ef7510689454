#pragma once

#include <dem/mbd/drive/prescribe.hpp>
#include <dem/mbd/solver/assemble.hpp>
#include <dem/mbd/solver/forces.hpp>

namespace dem::mbd {

/// The parts of a mechanism, looked at (poses, coordinates, reactions) and steered (set points, brakes, switches).
/// `Assembly` puts them together.
class Mechanism {
 public:
  /// All bodies, in the order of their ids. Mass, inertia and `fixed` are read when a run starts (initialise); later,
  /// set_fixed changes the latter. References to bodies are good until the next one is added, as ground() may do.
  std::vector<Body>& bodies() { return parts_.bodies; }
  const std::vector<Body>& bodies() const { return parts_.bodies; }
  Body& body(BodyId id) { return known(parts_.bodies, id, "body"); }
  const Body& body(BodyId id) const { return known(parts_.bodies, id, "body"); }
  /// The body of that name. Throws Error if there is none.
  BodyId body_named(const std::string& name) const {
    for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
      if (parts_.bodies[i].name == name) return BodyId(i);
    }
    fail("no body is named '{}'", name);
  }
  /// Global position (m) of a point of the body's reference frame.
  Vec3 reference_point(BodyId id, const Vec3& point) const {
    const BuiltBody& built = known(parts_.built, id, "body");
    return body(id).point(built.reference_origin + built.reference_axes * point);
  }
  /// Origin of the body's reference frame (m, global): with reference_rotation the pose at which a mesh of the body in
  /// the axes of its drawing is shown (io::BodyMesh).
  Vec3 reference_position(BodyId id) const { return reference_point(id, Vec3::Zero()); }
  /// Reference frame -> global.
  Mat3 reference_rotation(BodyId id) const {
    return body(id).rotation() * known(parts_.built, id, "body").reference_axes;
  }
  Vec3 connection_position(ConnectionId id) const {
    const Connection& c = known(parts_.connections, id, "connection point");
    return body(c.body).point(c.point);
  }

  /// A coordinate and its speed, one of dofs_of(the joint's kind). Without a name the joint's own: the rotation
  /// (rad, over whole turns) of one that turns, the slide (m) of one that slides, the length (m) of a distance joint.
  double coordinate(JointId id, Dof dof = Dof::own) const { return coordinate_now(id, dof).value; }
  double speed(JointId id, Dof dof = Dof::own) const { return coordinate_now(id, dof).speed; }
  /// The slide along z (m, m/s), e.g. the second coordinate of a cylindrical joint.
  double slide(JointId id) const { return coordinate(id, Dof::slide); }
  double slide_speed(JointId id) const { return speed(id, Dof::slide); }
  Violation violation(JointId id) const {
    const Joint& j = joint(id);
    return violation_of(j, parts_.bodies[j.a], parts_.bodies[j.b]);
  }
  /// Force (N) and torque (N m, about the joint's point) that the joint puts on its body b: its springs and dampers,
  /// limits and friction. Actuators, couplings and drives that act on its coordinates report their own.
  Wrench reaction(JointId id) const {
    joint(id);
    return reaction_of(parts_, id.index());
  }
  const Joint& joint(JointId id) const { return known(parts_.joints, id, "joint"); }
  /// Limits of a joint's coordinate, or its friction; nullptr if it has none.
  const JointLimitState* limits(JointId id, Dof dof = Dof::own) const {
    dof = resolved(joint(id).kind, dof);
    for (const JointLimitState& e : parts_.limits) {
      if (e.joint == id.value && e.dof == dof) return &e;
    }
    return nullptr;
  }
  const JointFrictionState* friction(JointId id) const {
    for (const JointFrictionState& e : parts_.friction) {
      if (e.joint == id.value) return &e;
    }
    return nullptr;
  }
  /// Sets the preload (N) of a joint's friction while running: a brake. Throws Error if the joint has no friction.
  void set_friction_preload(JointId id, double newtons) {
    joint(id);
    for (JointFrictionState& e : parts_.friction) {
      if (e.joint == id.value) {
        e.preload = require_non_negative(newtons, "preload of a joint's friction", "N");
        return;
      }
    }
    fail("joint '{}' has no friction to preload; add it with with_friction", parts_.joint_specs[id.index()].name);
  }

  const Actuator& actuator(ActuatorId id) const { return known(parts_.actuators, id, "actuator"); }
  /// Sets the set point (m or rad) and its rate from outside, for instance every step. Throws Error unless finite, and
  /// for a motor, which has a throttle instead.
  void set_target(ActuatorId id, double value, double rate = 0.0) { set_target(id, Signal::held(value, rate)); }
  void set_target(ActuatorId id, Signal signal) {
    ActuatorSpec& s = known(parts_.actuators, id, "actuator").spec;
    if (!s.torque_curve.empty()) fail("actuator '{}' is a motor, which has no set point; use set_throttle", s.name);
    s.set_point = std::move(signal);
  }
  void set_throttle(ActuatorId id, double throttle) {
    ActuatorSpec& s = known(parts_.actuators, id, "actuator").spec;
    if (s.torque_curve.empty()) fail("actuator '{}' is no motor, so it has no throttle; use set_target", s.name);
    s.throttle = require_within(throttle, -1.0, 1.0, "throttle of a motor");
  }
  void switch_on(ActuatorId id, bool on = true) { known(parts_.actuators, id, "actuator").spec.on = on; }
  /// A fixed body stops when the motion that moves it is switched off.
  void switch_on(MotionId id, bool on = true) {
    PrescribedMotion& p = known(parts_.motions, id, "prescribed motion");
    Body& b = parts_.bodies[p.spec.body.index()];
    if (!on && p.spec.on && b.fixed && p.spec.target != MotionSpec::Target::joint) {
      b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
    }
    p.has_hold &= on && p.spec.on;
    p.spec.on = on;
  }
  void switch_on(LoadId id, bool on = true) { known(parts_.loads, id, "load").spec.on = on; }
  /// Stops and fixes a body where it is, or sets it free; what is derived from masses is derived again.
  void set_fixed(BodyId id, bool fixed = true) {
    Body& b = body(id);
    if (b.fixed == fixed) return;
    b.fixed = fixed;
    try {
      check_body(b);
    } catch (...) {
      b.fixed = true;
      throw;
    }
    if (fixed) b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
    changed_ = true;
  }
  void set_load(LoadId id, Signal size) {
    LoadSpec& s = known(parts_.loads, id, "load").spec;
    if (s.law)
      fail("load '{}' has a law of its own and no size; let the law give other forces, or switch it off", s.name);
    s.size = std::move(size);
  }
  /// Another signal for a prescribed coordinate, or another function for a pose (set_pose).
  void set_motion(MotionId id, Signal motion) {
    PrescribedMotion& p = known(parts_.motions, id, "prescribed motion");
    if (p.spec.target == MotionSpec::Target::pose) {
      fail("prescribed motion '{}' is a whole pose, which no signal gives; use set_pose", p.spec.name);
    }
    p.spec.motion = p.spec.by_speed ? motion.as_rate() : std::move(motion);
    p.has_hold = false;
  }
  /// For values that come from outside every step: how far each is from the last is the caller's care, only the first
  /// one is compared with the coordinate. A motion prescribed by its speed takes that alone, set_motion(id, speed).
  void set_motion(MotionId id, double value, double rate) {
    const PrescribedMotion& p = motion(id);
    if (p.spec.by_speed) {
      fail("prescribed motion '{}' is one of speed and takes no value with a rate; use set_motion(id, speed)",
           p.spec.name);
    }
    const bool has_hold = p.has_hold;
    set_motion(id, Signal::held(value, rate));
    parts_.motions[id.index()].has_hold = has_hold;
  }

  void set_pose(MotionId id, std::function<Pose(double)> pose) {
    PrescribedMotion& p = known(parts_.motions, id, "prescribed motion");
    if (p.spec.target != MotionSpec::Target::pose) {
      fail("prescribed motion '{}' is that of one coordinate, not of a pose; use set_motion", p.spec.name);
    }
    if (!pose) fail("prescribed motion '{}' was given no function that gives the pose", p.spec.name);
    p.spec.pose = std::move(pose);
    p.has_hold = false;
  }

  const Load& load(LoadId id) const { return known(parts_.loads, id, "load"); }
  const Spring& spring(SpringId id) const { return known(parts_.springs, id, "spring"); }
  const Coupling& coupling(CouplingId id) const { return known(parts_.couplings, id, "coupling"); }
  const PrescribedMotion& motion(MotionId id) const { return known(parts_.motions, id, "prescribed motion"); }
  const WindowAverage& sensor(SensorId id) const { return known(parts_.sensors, id, "sensor").average; }
  const Parts& parts() const { return parts_; }
  Parts& parts() { return parts_; }

 protected:
  Parts parts_;
  bool changed_ = false;  ///< a body, joint or coupling was added since the last initialise

 private:
  Coordinate coordinate_now(JointId id, Dof dof) const {
    const Joint& j = joint(id);
    const std::string& name = parts_.joint_specs[id.index()].name;
    return coordinate_of(j, parts_.bodies[j.a], parts_.bodies[j.b],
                         known_dof(j.kind, dof, "a coordinate of '" + name + "'"));
  }
};

}  // namespace dem::mbd
