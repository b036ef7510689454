#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/body/add_body.hpp>
#include <dem/mbd/drive/actuator_part.hpp>
#include <dem/mbd/drive/clutch_part.hpp>
#include <dem/mbd/drive/engine.hpp>
#include <dem/mbd/drive/motion_part.hpp>
#include <dem/mbd/joint/anti_roll_bar.hpp>
#include <dem/mbd/joint/coupling_part.hpp>
#include <dem/mbd/joint/friction_part.hpp>
#include <dem/mbd/joint/kinds.hpp>
#include <dem/mbd/joint/limits_part.hpp>
#include <dem/mbd/load/load_part.hpp>
#include <dem/mbd/load/spring_part.hpp>
#include <dem/mbd/sensor/sensor_part.hpp>
#include <dem/mbd/solver/assembly.hpp>
#include <dem/mbd/solver/steer.hpp>

namespace dem::mbd {

/// A machine without its motion: put together (add_...), looked at (poses, coordinates, reactions) and steered (set
/// points, brakes, switches). What moves it is a Solver: that of a Machine, or that of a world. Every add_... function
/// checks what it is given, throws Error in words, and returns an id.
class Mechanism {
 public:
  /// Machine steps within one step dt of the world, or of a machine alone. They are raised while it runs, so that
  /// joints stay within joint_tolerance (close_joints.hpp), up to most_substeps; most_substeps = 1 forbids it.
  int substeps = 1, most_substeps = 1000;
  /// m, how far a joint whose stiffness is derived may open, and be out of line: rad times the size of the machine that
  /// it belongs to. 0: 1e-4 of that size, which is the diagonal of the box about its joints and bodies. A joint that
  /// opens farther with most_substeps is reported; infinity: none is. Read when the machine is laid out: before the
  /// first step, and before the next one after something was added or `substeps` changed.
  double joint_tolerance = 0.0;
  /// What becomes of velocities that joints do not allow, at the start.
  GivenVelocities given_velocities = GivenVelocities::project;
  double largest_speed = 1e5;  ///< m/s or rad/s; a body that is faster is reported as blown up

  // -------------------------------------------------------------------------------------------------- put together

  DEM_SETUP BodyId add_body(const BodySpec& spec) { return detail::add_body(parts_, build_body(spec)); }
  /// A body that is given in its own frame: centre of mass and principal axes.
  BodyId add_body(const Body& body);
  DEM_SETUP BodyId add_fixed_body(std::string name, const Vec3& position = Vec3::Zero()) {
    return add_body(fixed_body(std::move(name), position));
  }
  /// The fixed body "ground" at the origin, made when first asked for. References to other bodies stay good.
  BodyId ground();
  /// A connection point (section 2.3) at a global point.
  DEM_SETUP ConnectionId add_connection(std::string name, BodyId body, const Vec3& at) {
    return detail::add_connection(parts_, std::move(name), body, at);
  }
  /// A connection point at a point of the body's reference frame.
  ConnectionId add_connection_in_reference(std::string name, BodyId body, const Vec3& point);
  DEM_SETUP JointId add_joint(JointSpec spec) { return detail::add_joint(parts_, std::move(spec)); }
  DEM_SETUP ActuatorId add_actuator(ActuatorSpec spec) { return detail::add_actuator(parts_, std::move(spec)); }
  DEM_SETUP SpringId add_spring(SpringSpec spec) { return detail::add_spring(parts_, std::move(spec)); }
  DEM_SETUP CouplingId add_coupling(CouplingSpec spec) { return detail::add_coupling(parts_, std::move(spec)); }
  DEM_SETUP CouplingId add_anti_roll_bar(const AntiRollBarSpec& spec) {
    return detail::add_anti_roll_bar(parts_, spec);
  }
  DEM_SETUP ClutchId add_clutch(ClutchSpec spec) { return detail::add_clutch(parts_, std::move(spec)); }
  DEM_SETUP BrakeId add_brake(ClutchSpec spec) { return detail::add_clutch(parts_, std::move(spec)); }
  DEM_SETUP LoadId add_load(LoadSpec spec) { return detail::add_load(parts_, std::move(spec)); }
  DEM_SETUP MotionId add_motion(MotionSpec spec) { return detail::add_motion(parts_, std::move(spec)); }
  DEM_SETUP SensorId add_sensor(SensorSpec spec) { return detail::add_sensor(parts_, std::move(spec)); }

  // ----------------------------------------------------------------------------------------------------- looked at

  /// All bodies, in the order of their ids. Mass and inertia that are changed count from the next step on;
  /// `fixed` is changed by set_fixed. References are good until the next body is added; the ground does not count.
  std::vector<Body>& bodies() { return parts_.bodies; }
  const std::vector<Body>& bodies() const { return parts_.bodies; }
  Body& body(BodyId id) { return known(parts_.bodies, id, "body"); }
  const Body& body(BodyId id) const { return known(parts_.bodies, id, "body"); }
  /// The body of that name. Throws Error if there is none.
  BodyId body_named(const std::string& name) const;
  /// Global position (m) of a point of the body's reference frame.
  Vec3 reference_point(BodyId id, const Vec3& point) const;
  /// Origin of the body's reference frame (m, global): with reference_rotation the pose at which a mesh of the body in
  /// the axes of its drawing is shown (io::BodyMesh).
  Vec3 reference_position(BodyId id) const { return reference_point(id, Vec3::Zero()); }
  /// Reference frame -> global.
  Mat3 reference_rotation(BodyId id) const {
    return to_eigen(body(id).motion.rotation * from_eigen(known(parts_.built, id, "body").reference_axes));
  }
  /// Global velocity (m/s) of a point (m) of the body's reference frame.
  Vec3 reference_point_velocity(BodyId id, const Vec3& point) const;
  /// Global velocity (m/s) of the origin of the body's reference frame.
  Vec3 reference_velocity(BodyId id) const { return reference_point_velocity(id, Vec3::Zero()); }
  Vec3 connection_velocity(ConnectionId id) const;
  Vec3 connection_position(ConnectionId id) const;

  /// A coordinate and its speed, one of dofs_of(the joint's kind), as Dof::slide of a cylindrical joint. Without a name
  /// the joint's own: the rotation (rad, over whole turns) of one that turns, the slide (m) of one that slides, the
  /// length (m) of a distance joint.
  double coordinate(JointId id, Dof dof = Dof::own) const { return coordinate_now(parts_, id, dof).value; }
  double speed(JointId id, Dof dof = Dof::own) const { return coordinate_now(parts_, id, dof).speed; }
  /// What a joint would be strained by (m, rad) if it were switched on without taking the bodies as they are.
  Violation gap(JointId id) const;
  /// How far (m, rad) a joint is from holding what it should; 0 while it is switched off.
  Violation violation(JointId id) const;
  /// Force (N) and torque (N m, about the joint's point) that the joint puts on its body b: its springs and dampers,
  /// limits and friction. Actuators, couplings and drives that act on its coordinates report their own.
  Wrench reaction(JointId id) const;
  const Joint& joint(JointId id) const { return known(parts_.joints, id, "joint"); }
  /// Limits of a joint's coordinate, or its friction; nullptr if it has none.
  const JointLimitState* limits(JointId id, Dof dof = Dof::own) const { return limits_of(parts_, id, dof); }
  const JointFrictionState* friction(JointId id) const { return friction_of(parts_, id); }

  const Actuator& actuator(ActuatorId id) const { return known(parts_.actuators, id, "actuator"); }
  const Clutch& clutch(ClutchId id) const { return known(parts_.clutches, id, "clutch or brake"); }
  const Clutch& brake(BrakeId id) const { return clutch(id); }
  /// Rate (rad/s, m/s) at which a clutch or brake slips, also while it is open.
  double slip_speed(ClutchId id) const { return slip_of(clutch(id), parts_.joints, parts_.bodies).rate; }
  const Load& load(LoadId id) const { return known(parts_.loads, id, "load"); }
  const Spring& spring(SpringId id) const { return known(parts_.springs, id, "spring"); }
  const Coupling& coupling(CouplingId id) const { return known(parts_.couplings, id, "coupling"); }
  const PrescribedMotion& motion(MotionId id) const { return known(parts_.motions, id, "prescribed motion"); }
  const WindowAverage& sensor(SensorId id) const { return known(parts_.sensors, id, "sensor").average; }
  /// The mean of an actuator_sensor or a drive_sensor: the force (N) on a coordinate that slides, the torque (N m) on
  /// one that turns. Throws Error for a sensor of anything else, which has no single one.
  double drive_effort(SensorId id) const { return detail::drive_effort(known(parts_.sensors, id, "sensor")); }
  const Parts& parts() const { return parts_; }
  Parts& parts() { return parts_; }

  // ------------------------------------------------------------------------------------------------------- steered

  /// Sets the torque (N m; N where it slides) that a brake or clutch can hold, a number or a function of time.
  void set_capacity(ClutchId id, Signal capacity) {
    known(parts_.clutches, id, "clutch or brake").spec.capacity = std::move(capacity);
  }
  void switch_on(ClutchId id, bool on = true) { known(parts_.clutches, id, "clutch or brake").spec.on = on; }
  /// Sets the preload (N) of a joint's friction while running: a tighter bearing. Throws Error if the joint has no
  /// friction.
  void set_friction_preload(JointId id, double newtons) { detail::set_friction_preload(parts_, id, newtons); }
  /// Sets the set point (m or rad; of a speed_actuator m/s or rad/s) from outside, until another is given. Throws Error
  /// unless finite, for a motor, which has a throttle instead, and for a number other than 0 where the actuator follows
  /// the rate alone.
  void set_target(ActuatorId id, double value) { set_target(id, Signal(value)); }
  /// The set point and its rate, for instance every step. The rate may pass through 0. Throws Error unless finite, and
  /// for a motor.
  void set_target(ActuatorId id, double value, double rate) {
    detail::set_target(known(parts_.actuators, id, "actuator").spec, Signal::held(value, rate), false);
  }
  void set_target(ActuatorId id, Signal signal) {
    detail::set_target(known(parts_.actuators, id, "actuator").spec, std::move(signal));
  }
  /// Throttle of a motor, -1 to 1, or of an engine, 0 to 1.
  void set_throttle(ActuatorId id, double throttle) {
    detail::set_throttle(known(parts_.actuators, id, "actuator").spec, throttle);
  }
  void switch_on(ActuatorId id, bool on = true) { known(parts_.actuators, id, "actuator").spec.on = on; }
  /// A fixed body stops when the motion that moves it is switched off.
  void switch_on(MotionId id, bool on = true) {
    detail::switch_on(parts_, known(parts_.motions, id, "prescribed motion"), on);
  }
  /// A coupling that is switched on takes hold of its coordinates where they are: gears that mesh at any angle. Shafts
  /// that differ in speed are brought to one by its damper within some steps, which is a jolt: open a clutch before.
  void switch_on(CouplingId id, bool on = true) {
    detail::switch_on(parts_, known(parts_.couplings, id, "coupling"), on);
  }
  /// Gives a coupling's term (0 is the first one) another ratio from the present pose on, without a jump of its
  /// multiplier: another gear. Of gear(...) and rack_and_pinion(...) term 0 has the ratio and the radius. Throws Error
  /// for 0: neutral is a coupling that is switched off.
  void set_ratio(CouplingId id, double ratio, std::size_t term = 0) {
    detail::set_ratio(parts_, known(parts_.couplings, id, "coupling"), term, ratio);
  }
  /// A joint that is switched off holds nothing, and neither do its limits and its friction; its coordinates can still
  /// be read, driven and coupled. One that is switched on takes the bodies as they are: what it holds is held in the
  /// present pose from there on, so that it starts unstrained. gap(id) tells how far they are from where it held them
  /// before.
  void switch_on(JointId id, bool on = true) { detail::switch_on(parts_, id, on); }
  void switch_on(SpringId id, bool on = true) { known(parts_.springs, id, "spring").spec.on = on; }
  void switch_on(LoadId id, bool on = true) { known(parts_.loads, id, "load").spec.on = on; }
  /// Stops and fixes a body where it is, or sets it free; what is derived from masses is derived again.
  void set_fixed(BodyId id, bool fixed = true) { detail::set_fixed(parts_, body(id), fixed); }
  void set_load(LoadId id, Signal size) { detail::set_load(known(parts_.loads, id, "load").spec, std::move(size)); }
  /// Another signal for a prescribed coordinate, or another function for a pose (set_pose).
  void set_motion(MotionId id, Signal motion) {
    detail::set_motion(known(parts_.motions, id, "prescribed motion"), std::move(motion));
  }
  /// For values that come from outside every step. Where the rate is not 0 the value is reached at the end of the next
  /// step, by all sub-steps. How far each is from the last is the caller's care, only the first
  /// one is compared with the coordinate. A motion prescribed by its speed takes that alone, set_motion(id, speed).
  void set_motion(MotionId id, double value, double rate) {
    detail::set_motion(known(parts_.motions, id, "prescribed motion"), value, rate);
  }
  void set_pose(MotionId id, PoseFunction pose) {
    detail::set_pose(known(parts_.motions, id, "prescribed motion"), std::move(pose));
  }

  template <class V>
  void fields(V& v) {
    v("substeps", substeps), v("largest_speed", largest_speed), v("parts", parts_);
  }

 private:
  Parts parts_;
  BodyId ground_;
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE BodyId Mechanism::add_body(const Body& body) {
  check_body(body);
  return detail::add_body(parts_, {body, Vec3::Zero(), Mat3::Identity()});
}

DEM_INLINE BodyId Mechanism::ground() {
  if (!ground_.valid()) ground_ = detail::add_body(parts_, build_body(fixed_body("ground", Vec3::Zero())), true);
  return ground_;
}

DEM_INLINE ConnectionId Mechanism::add_connection_in_reference(std::string name, BodyId body, const Vec3& point) {
  known_body(parts_, body, dem::text("connection point '{}'", name));
  return add_connection(std::move(name), body, reference_point(body, point));
}

DEM_INLINE BodyId Mechanism::body_named(const std::string& name) const {
  for (std::size_t i = 0; i < parts_.bodies.size(); ++i) {
    if (parts_.bodies[i].name == name) return BodyId(i);
  }
  std::string names;
  for (const Body& b : parts_.bodies) names += (names.empty() ? "'" : ", '") + b.name + "'";
  fail("no body is named '{}'; there {} {}", name, parts_.bodies.size() == 1 ? "is" : "are",
       names.empty() ? "none" : names);
}

DEM_INLINE Vec3 Mechanism::reference_point(BodyId id, const Vec3& point) const {
  const BuiltBody& built = known(parts_.built, id, "body");
  const Matrix3<double> axes = from_eigen(built.reference_axes);
  return body(id).point(to_eigen(from_eigen(built.reference_origin) + axes * from_eigen(point)));
}

DEM_INLINE Vec3 Mechanism::reference_point_velocity(BodyId id, const Vec3& point) const {
  const Body& b = body(id);
  return b.point_velocity(to_eigen(to_body(b, from_eigen(reference_point(id, point)))));
}

DEM_INLINE Vec3 Mechanism::connection_velocity(ConnectionId id) const {
  const Connection& c = known(parts_.connections, id, "connection point");
  return body(c.body).point_velocity(c.point);
}

DEM_INLINE Vec3 Mechanism::connection_position(ConnectionId id) const {
  const Connection& c = known(parts_.connections, id, "connection point");
  return body(c.body).point(c.point);
}

DEM_INLINE Violation Mechanism::gap(JointId id) const {
  const Joint& j = joint(id);
  return gap_of(j, parts_.bodies[j.a], parts_.bodies[j.b]);
}

DEM_INLINE Violation Mechanism::violation(JointId id) const {
  const Joint& j = joint(id);
  return violation_of(j, parts_.bodies[j.a], parts_.bodies[j.b]);
}

DEM_INLINE Wrench Mechanism::reaction(JointId id) const {
  joint(id);
  return reaction_of(parts_, id.index());
}

}  // namespace dem::mbd

#endif
