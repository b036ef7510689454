#pragma once

#include <dem/vehicle/assembly.hpp>
#include <dem/vehicle/double_wishbone.hpp>
#include <dem/vehicle/driveline.hpp>
#include <dem/vehicle/driver.hpp>
#include <dem/vehicle/rack_steering.hpp>
#include <dem/vehicle/wheel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace dem::vehicle {

/// Corners of a vehicle, in this order everywhere.
inline constexpr std::array<const char*, 4> corner_names = {"front left", "front right", "rear left", "rear right"};

inline constexpr double telemetry_window = 0.01;  ///< s, over which a vehicle's sensors take means

/// A vehicle with two axles: double wishbones all round, front wheels that steer, all wheels driven. What each point
/// is, and how to build what this does not describe: README.md beside this file.
struct VehicleSpec {
  PartMass chassis;
  Vec3 chassis_centre = Vec3::Zero();  ///< m
  DoubleWishboneSpec front, rear;      ///< of the left side
  WheelSpec wheel;
  TyreSpec tyre;
  RackSteeringSpec steering;
  DrivelineSpec driveline;

  double wheelbase() const { return front.points.wheel.x() - rear.points.wheel.x(); }
  double track() const { return 2.0 * front.points.wheel.y(); }
  /// m, by which the outer ends of the tie rods are ahead of the lines through both ball joints, seen from above.
  double steering_arm() const {
    const WishbonePoints& p = front.points;
    const Vec3 kingpin = p.upper_ball - p.lower_ball;
    const double share = (steering.rod_outer.z() - p.lower_ball.z()) / kingpin.z();
    return steering.rod_outer.x() - p.lower_ball.x() - share * kingpin.x();
  }
};

/// The parts of a vehicle and what steers them.
struct Vehicle {
  BodyId chassis;
  std::array<DoubleWishbone, 4> suspension;
  std::array<Wheel, 4> wheels;
  std::array<JointId, 2> toe_links;  ///< of the rear wheels
  RackSteering steering;
  Driveline driveline;
  /// As it was built. To change it later changes no part; drive() and the telemetry read the tyre's radius, the front
  /// axle's ratio, the chassis' centre and the middles of the wheels. The engine works by driveline.engine.spec.
  VehicleSpec spec;
  double pinion_per_steer = 1.0;  ///< rad of the pinion for a rad of the mean of both wheels, about straight ahead
  std::array<std::array<SensorId, 4>, 4> joint_forces;  ///< by corner, in the order of knuckle_joints()

  /// What holds a knuckle: upper and lower ball joint, bearing of the wheel, end of the tie rod or toe link.
  std::array<JointId, 4> knuckle_joints(std::size_t corner) const {
    const JointId rods[4] = {steering.left_outer, steering.right_outer, toe_links[0], toe_links[1]};
    return {suspension[corner].upper_ball, suspension[corner].lower_ball, wheels[corner].turn, rods[corner]};
  }

  /// What the controls have come to, besides the state of the mechanism. See take_controls().
  template <class V>
  void fields(V& v) {
    v("wheels", wheels), v("driveline", driveline);
  }
};

namespace detail {

/// Throws Error for a vehicle whose left wheels are not on the left, or whose front wheels are not in front.
DEM_SETUP inline void check_drawing(const VehicleSpec& s) {
  const Vec3 &front = s.front.points.wheel, &rear = s.rear.points.wheel;
  if (!(front.y() > 0.0 && rear.y() > 0.0)) {
    fail(
        "the middles of the wheels are drawn at y = {:g} m (front) and {:g} m (rear), but must be at positive y: draw "
        "the left side, y points to the left",
        front.y(), rear.y());
  }
  if (!(s.wheelbase() > 0.0)) {
    fail(
        "the middle of the front wheel is drawn at x = {:g} m and that of the rear one at {:g} m, but the front one "
        "must be ahead: x points forward",
        front.x(), rear.x());
  }
}

}  // namespace detail

/// Adds a vehicle to a mechanism. With a road it has tyres on hard ground; without, its wheels need surfaces that touch
/// what there is. It starts with the assembly's speed, wheels rolling. Throws Error for a left side that is drawn on
/// the right, and for axles that are swapped.
///
/// Its light parts (shafts, splines, the rack) give way under their loads: by default the machine raises its sub-steps
/// for them, and is many times slower. So give it a large joint_tolerance (0.5 m, say) before its first step. Nothing
/// watches the suspension then: halve the step once, compare, and look at violation() of its joints. See README.md
/// beside this file.
DEM_SETUP inline Vehicle add_vehicle(const Assembly& in, const VehicleSpec& s, const std::optional<Road>& road = {}) {
  detail::check_drawing(s);
  Vehicle v;
  v.spec = s;
  v.chassis = in.body("chassis", s.chassis, s.chassis_centre);
  const double spin = in.speed() / s.tyre.radius;
  BodyId wheels[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const DoubleWishboneSpec& left = k < 2 ? s.front : s.rear;
    const DoubleWishboneSpec corner = k % 2 == 0 ? left : left.mirrored();
    v.suspension[k] = add_double_wishbone(in, corner_names[k], v.chassis, corner);
    v.wheels[k] = add_wheel(in, corner_names[k], v.suspension[k].knuckle, corner.points.wheel, s.wheel, spin);
    wheels[k] = v.wheels[k].body;
    if (k >= 2) {
      v.toe_links[k - 2] = add_toe_link(in, corner_names[k], v.chassis, v.suspension[k].knuckle, corner.points);
    }
  }
  const double arm = s.steering_arm();
  v.steering = add_rack_steering(in, v.chassis, v.suspension[0].knuckle, v.suspension[1].knuckle, s.steering, arm);
  v.pinion_per_steer = std::abs(arm) / s.steering.pinion_radius;
  v.driveline = add_driveline(in, v.chassis, wheels, s.driveline, spin);
  if (road) {
    for (std::size_t k = 0; k < 4; ++k) add_tyre(in, corner_names[k], v.wheels[k], s.tyre, *road);
  }
  constexpr const char* forces[4] = {" upper ball joint", " lower ball joint", " bearing", " rod"};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto joints = v.knuckle_joints(k);
    for (std::size_t j = 0; j < 4; ++j) {
      const std::string name = in.name(std::string(corner_names[k]) + forces[j]);
      v.joint_forces[k][j] = in.mechanism().add_sensor(mbd::joint_sensor(name, joints[j], telemetry_window));
    }
  }
  return v;
}

/// Derives what the user left open for a time step (s) of a machine by itself. An engine's own damping comes on top of
/// what is derived: that is made softer until the step bears both, where ten times 5 % will do. Where they do not, the
/// first step says what is too stiff.
template <class Machine>
void design_for(Machine& machine, double time_step) {
  double design = time_step;
  machine.design_for(design);
  for (int k = 0; k < 10 && machine.stable_time_step().dt < time_step; ++k) machine.design_for(design *= 1.05);
}

// ------------------------------------------------------------------------------------------------------- looking

inline Vec3 forward_of(const mbd::Mechanism& m, const Vehicle& v) {
  return m.reference_rotation(v.chassis) * Vec3::UnitX();
}
/// m/s, of the chassis along its own axis.
inline double speed_of(const mbd::Mechanism& m, const Vehicle& v) {
  return m.body(v.chassis).velocity().dot(forward_of(m, v));
}
/// m/s, of the rims, as the drive shaft turns: the mean of the four.
inline double rim_speed_of(const mbd::Mechanism& m, const Vehicle& v) {
  return m.speed(v.driveline.shaft_turn) / v.spec.driveline.front.ratio * v.spec.tyre.radius;
}
/// Global position (m) of a point that is given in the axes and from the origin of the vehicle.
inline Vec3 point_of(const mbd::Mechanism& m, const Vehicle& v, const Vec3& p) {
  return m.reference_point(v.chassis, p - v.spec.chassis_centre);
}
/// rad, of a wheel against straight ahead, seen from above the chassis; positive to the left.
inline double steer_of(const mbd::Mechanism& m, const Vehicle& v, std::size_t corner) {
  const Vec3 a =
      m.reference_rotation(v.chassis).transpose() * m.reference_rotation(v.suspension[corner].knuckle) * Vec3::UnitY();
  return std::atan2(-a.x(), a.y());
}
/// rad, of a wheel whose top leans outward.
inline double camber_of(const mbd::Mechanism& m, const Vehicle& v, std::size_t corner) {
  const Vec3 a =
      m.reference_rotation(v.chassis).transpose() * m.reference_rotation(v.suspension[corner].knuckle) * Vec3::UnitY();
  return (corner % 2 == 0 ? -1.0 : 1.0) * std::asin(std::clamp(a.z(), -1.0, 1.0));
}
/// m, of the middle of a wheel above where it is drawn, in the axes of the chassis.
inline double travel_of(const mbd::Mechanism& m, const Vehicle& v, std::size_t corner) {
  const WishbonePoints& p = corner < 2 ? v.spec.front.points : v.spec.rear.points;
  const Vec3 from_chassis = m.body(v.wheels[corner].body).position() - m.reference_position(v.chassis);
  return (m.reference_rotation(v.chassis).transpose() * from_chassis + v.spec.chassis_centre).z() - p.wheel.z();
}

// ------------------------------------------------------------------------------------------------------ steering

/// For a vehicle that was built anew and whose fields were restored: brakes and an engine that is an actuator are set
/// as the controls had set them. load() of a world restores this with its machine.
inline void take_controls(mbd::Mechanism& m, const Vehicle& v) {
  for (const Wheel& w : v.wheels) {
    if (w.brake_torque > 0.0) m.parts().actuators[w.brake.index()].spec.max_force = w.brake_torque;
  }
  const Engine& e = v.driveline.engine;
  if (!e.has_throttle()) m.parts().actuators[e.drive.index()].spec.max_force = e.limit();
}

/// Passes a driver's controls on, to be called before every step: `dt` is the time (s) to the next call. The steering
/// turns no faster than `steer_rate` (rad/s of the wheels). An engine that is an actuator holds the speed in the middle
/// of the governor's limits with the throttle's share of its torque; without limits it gives that torque at any speed.
/// Sums what engine and brakes do. Throws Error for controls out of range and for times and rates that are not
/// positive.
inline void drive(mbd::Mechanism& m, Vehicle& v, const Controls& c, double dt, double steer_rate = 0.5) {
  c.check();
  require_positive(dt, "time from one call of drive to the next", "s");
  require_positive(steer_rate, "rate at which the wheels are steered", "rad/s");
  Engine& e = v.driveline.engine;
  e.work += dt * m.actuator(e.drive).power();
  for (Wheel& w : v.wheels) {
    w.brake_work -= dt * m.actuator(w.brake).power();
    set_brake(m, w, c.brake);
  }
  if (e.has_throttle()) {
    e.governed += (c.governed(rim_speed_of(m, v)) - e.governed) * -std::expm1(-dt / e.spec.governor_lag);
    set_throttle(m, e, c.throttle * e.governed);
    work_gears(m, e, m.speed(v.driveline.shaft_turn), dt);
  } else {
    const double fastest = 1e3;  // m/s
    const double rims = c.ease_to < Controls::no_limit ? 0.5 * (c.ease_from + c.ease_to) : fastest;
    hold_speed(m, e, rims / v.spec.tyre.radius * v.spec.driveline.front.ratio, c.throttle);
  }
  mbd::PrescribedMotion& steer = m.parts().motions[v.steering.steer.index()];
  const double limit = v.steering.largest_angle, now = steer.drive.value;
  const double wanted = std::clamp(c.steer * v.pinion_per_steer, -limit, limit);
  const double most = steer_rate * v.pinion_per_steer * dt, by = std::clamp(wanted - now, -most, most);
  m.set_motion(v.steering.steer, now + by, by / dt);
}

}  // namespace dem::vehicle
