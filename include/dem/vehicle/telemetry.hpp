#pragma once
// What is recorded of a vehicle while it drives, whatever it drives on: rows of numbers with units in their names.

#include <dem/vehicle/vehicle.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace dem::vehicle {

/// Corners in the names of columns, in the order of corner_names.
inline constexpr std::array<const char*, 4> corner_letters = {"fl", "fr", "rl", "rr"};

/// Longitudinal slip: (rim - way)/max(|rim|, |way|), of the speed of the rim, omega r, and that of the wheel's middle
/// (m/s). Of a car that goes forward positive drives and negative brakes, from -1 (locked) to 1 (spins on the spot);
/// beyond that, up to 2, where both go against each other. 0 below 1 mm/s.
inline double slip_of(double rim, double way) {
  const double fastest = std::max(std::abs(rim), std::abs(way));
  return fastest > 1e-3 ? (rim - way) / fastest : 0.0;
}
/// What columns of it are called in files: other slips are 1 - v/(omega r).
inline constexpr const char* slip_column = "slip_(omega*r-v)/max";

/// Roll, pitch and yaw of the chassis, rad: turned by yaw about z, then pitch about y, then roll about x. A positive
/// pitch lowers the nose.
inline Vec3 attitude_of(const mbd::Mechanism& m, const Vehicle& v) {
  const Mat3 r = m.reference_rotation(v.chassis);
  return {std::atan2(r(2, 1), r(2, 2)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)), std::atan2(r(1, 0), r(0, 0))};
}

/// N, of all bodies of a mechanism that are not fixed, under 9.81 m/s^2, whatever the gravity of its machine or world.
inline double weight_of(const mbd::Mechanism& m) {
  double mass = 0.0;
  for (const Body& b : m.bodies()) mass += b.fixed ? 0.0 : b.mass;
  return 9.81 * mass;
}

/// The vehicle as a whole at a time.
struct CarSample {
  double time = 0.0;                          ///< s
  Vec3 position = Vec3::Zero();               ///< m, of the vehicle's origin
  double yaw = 0.0, roll = 0.0, pitch = 0.0;  ///< rad
  double speed = 0.0;                         ///< m/s, of the chassis along its own axis
  double yaw_rate = 0.0;                      ///< rad/s
  Controls controls;
  double steer = 0.0;          ///< rad, mean of the front wheels
  double gear = 1.0;           ///< from 1
  double engine_torque = 0.0;  ///< N m, at the drive shaft; with gears, at the engine's own
  double engine_speed = 0.0;   ///< rad/s, of the engine's own shaft, a motor's too
  double engine_power = 0.0;   ///< W
  double engine_work = 0.0;    ///< J, since the vehicle was made
  double brake_work = 0.0;     ///< J, that all brakes took since then

  /// f(name with unit, value) for all columns.
  template <class F>
  void each(F&& f) const {
    f("time_s", time), f("x_m", position.x()), f("y_m", position.y()), f("z_m", position.z());
    f("yaw_rad", yaw), f("roll_rad", roll), f("pitch_rad", pitch);
    f("speed_m_per_s", speed), f("yaw_rate_rad_per_s", yaw_rate);
    f("throttle", controls.throttle), f("brake", controls.brake), f("steer_rad", steer), f("gear", gear);
    f("engine_torque_Nm", engine_torque), f("engine_speed_rad_per_s", engine_speed), f("engine_power_W", engine_power);
    f("engine_work_J", engine_work), f("brake_work_J", brake_work);
  }
  template <class V>
  void fields(V& v) {
    v("time", time, "s"), v("position", position, "m"), v("yaw", yaw, "rad"), v("roll", roll, "rad");
    v("pitch", pitch, "rad"), v("speed", speed, "m/s"), v("yaw_rate", yaw_rate, "rad/s");
    v.reals("controls", controls), v("steer", steer, "rad"), v("gear", gear);
    v("engine_torque", engine_torque, "N m"), v("engine_speed", engine_speed, "rad/s");
    v("engine_power", engine_power, "W"), v("engine_work", engine_work, "J"), v("brake_work", brake_work, "J");
  }
};

/// `controls`: what the driver does.
inline CarSample sample_of(const mbd::Mechanism& m, const Vehicle& v, const Controls& controls, double time) {
  const Vec3 turn = attitude_of(m, v);
  const auto& engine = m.actuator(v.driveline.engine.drive);
  double brake_work = 0.0;
  for (const Wheel& w : v.wheels) brake_work += w.brake_work;
  return {.time = time,
          .position = point_of(m, v, Vec3::Zero()),
          .yaw = turn.z(),
          .roll = turn.x(),
          .pitch = turn.y(),
          .speed = speed_of(m, v),
          .yaw_rate = m.body(v.chassis).angular_velocity().z(),
          .controls = controls,
          .steer = 0.5 * (steer_of(m, v, 0) + steer_of(m, v, 1)),
          .gear = 1.0 + static_cast<double>(v.driveline.engine.gear),
          .engine_torque = engine.force,
          .engine_speed = engine_speed(m, v.driveline),
          .engine_power = engine.power(),
          .engine_work = v.driveline.engine.work,
          .brake_work = brake_work};
}

/// One wheel over a sample's interval: forces of the ground are means over it, or those at its end.
struct WheelSample {
  double slip = 0.0;  ///< (omega r - v)/max(|omega r|, |v|), r: unloaded radius; v: of the wheel's middle, forward
  double slip_angle = 0.0;    ///< rad, of the middle's path to the left of the wheel's plane
  double load = 0.0;          ///< N, up across the lane
  double pull = 0.0;          ///< N, forward along the lane's surface in the wheel's plane
  double side = 0.0;          ///< N, to the left
  double torque = 0.0;        ///< N m, that drives the wheel against the ground
  double sinkage = 0.0;       ///< m, of the tyre's lowest point below the level of the ground
  double deflection = 0.0;    ///< m, of a pneumatic tyre: how much nearer that point is to the middle than unloaded
  double travel = 0.0;        ///< m, of the suspension, up
  double brake_torque = 0.0;  ///< N m
  double spin = 0.0;          ///< rad/s, of the wheel on its knuckle

  template <class F>
  void each(F&& f) const {
    f(slip_column, slip), f("slip_angle_rad", slip_angle), f("load_N", load), f("pull_N", pull), f("side_N", side);
    f("torque_Nm", torque), f("sinkage_m", sinkage), f("deflection_m", deflection), f("travel_m", travel),
        f("brake_torque_Nm", brake_torque);
    f("spin_rad_per_s", spin);
  }
};

/// Of a wheel (0 to 3) under the force (N) and torque (N m, about its middle) of soft ground at a level (m). `radius`
/// (m) is that of the unloaded wheel, `deflection` (m) that of a pneumatic tyre. Ground without a slope: across it is
/// z.
inline WheelSample wheel_sample_of(const mbd::Mechanism& m, const Vehicle& v, std::size_t corner, const Wrench& ground,
                                   double level, double radius, double deflection = 0.0) {
  const Wheel& wheel = v.wheels[corner];
  const Body& body = m.body(wheel.body);
  const Vec3 force = to_eigen(ground.force), torque = to_eigen(ground.torque), speed = body.velocity();
  const Vec3 axle = m.reference_rotation(v.suspension[corner].knuckle) * Vec3::UnitY();
  const Vec3 across = axle.cross(Vec3::UnitZ()), ahead = across.normalized(), left = Vec3::UnitZ().cross(ahead);
  WheelSample w;
  w.spin = m.speed(wheel.turn);
  w.slip = slip_of(body.angular_velocity().dot(axle) * radius, speed.dot(ahead));
  w.slip_angle = std::abs(speed.dot(ahead)) > 1e-3 ? std::atan2(speed.dot(left), std::abs(speed.dot(ahead))) : 0.0;
  w.load = force.z();
  w.pull = force.dot(ahead);
  w.side = force.dot(left);
  w.torque = -torque.dot(axle);
  w.sinkage = level - (body.position().z() - radius + deflection);
  w.deflection = deflection;
  w.travel = travel_of(m, v, corner);
  w.brake_torque = -m.actuator(wheel.brake).force;
  return w;
}

/// What the joints of one wheel's suspension carry: forces on the knuckle, N, in the axes of the chassis (forward,
/// left, up), means over the last telemetry_window.
struct SuspensionSample {
  Vec3 upper_ball = Vec3::Zero(), lower_ball = Vec3::Zero();  ///< of the arms
  Vec3 bearing = Vec3::Zero();                                ///< of the wheel
  Vec3 rod = Vec3::Zero();                                    ///< of the tie rod in front, the toe link behind
  double spring = 0.0, shock = 0.0;  ///< N, that push chassis and lower arm apart; at the end of the newest step

  template <class F>
  void each(F&& f) const {
    const auto axes = [&](const char* x, const char* y, const char* z, const Vec3& force) {
      f(x, force.x()), f(y, force.y()), f(z, force.z());
    };
    axes("upper_ball_x_N", "upper_ball_y_N", "upper_ball_z_N", upper_ball);
    axes("lower_ball_x_N", "lower_ball_y_N", "lower_ball_z_N", lower_ball);
    axes("bearing_x_N", "bearing_y_N", "bearing_z_N", bearing);
    axes("rod_x_N", "rod_y_N", "rod_z_N", rod);
    f("spring_N", spring), f("shock_N", shock);
  }
  template <class V>
  void fields(V& v) {
    v("upper_ball", upper_ball, "N"), v("lower_ball", lower_ball, "N"), v("bearing", bearing, "N");
    v("rod", rod, "N"), v("spring", spring, "N"), v("shock", shock, "N");
  }
};

/// Of a wheel (0 to 3).
inline SuspensionSample suspension_sample_of(const mbd::Mechanism& m, const Vehicle& v, std::size_t corner) {
  const DoubleWishbone& s = v.suspension[corner];
  const auto on_knuckle = [&](std::size_t k) -> Vec3 {
    const Vec3 force = to_eigen(m.sensor(v.joint_forces[corner][k]).mean().force);  // on the joint's body b
    const bool is_second = m.joint(v.knuckle_joints(corner)[k]).b == s.knuckle.index();
    return m.reference_rotation(v.chassis).transpose() * (is_second ? force : Vec3(-force));
  };
  return {.upper_ball = on_knuckle(0),
          .lower_ball = on_knuckle(1),
          .bearing = on_knuckle(2),
          .rod = on_knuckle(3),
          .spring = m.spring(s.spring).force,
          .shock = m.spring(s.shock).force};
}

/// Names of the columns of something with each(), after a prefix.
template <class Sample>
void add_columns(std::vector<std::string>& names, const Sample& sample, const std::string& prefix = "") {
  sample.each([&](const char* name, double) { names.push_back(prefix + name); });
}
template <class Sample>
void add_values(std::vector<double>& row, const Sample& sample) {
  sample.each([&](const char*, double value) { row.push_back(value); });
}

/// Mean of a value over the four wheels.
inline double mean_of(const std::array<WheelSample, 4>& wheels, double WheelSample::*value) {
  return 0.25 * (wheels[0].*value + wheels[1].*value + wheels[2].*value + wheels[3].*value);
}
/// The columns of all corners, one corner after the other: of its wheel, then of its suspension.
inline void add_corner_columns(std::vector<std::string>& names) {
  for (const char* corner : corner_letters) {
    add_columns(names, WheelSample{}, std::string(corner) + "_");
    add_columns(names, SuspensionSample{}, std::string(corner) + "_");
  }
}
inline void add_corner_values(std::vector<double>& row, const std::array<WheelSample, 4>& wheels,
                              const std::array<SuspensionSample, 4>& suspension) {
  for (std::size_t k = 0; k < 4; ++k) add_values(row, wheels[k]), add_values(row, suspension[k]);
}

}  // namespace dem::vehicle
