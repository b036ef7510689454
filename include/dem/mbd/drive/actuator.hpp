#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/signal.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coordinate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// What an actuator is made from. Gains as in eqs. 34 and 38: force = -position_gain (l - l_set) - speed_gain (l' -
/// l'_set), positive where it makes the coordinate l grow (pushes two points apart, drives b forward along or about a
/// joint). A gain of zero switches that part off: position_gain = 0 is a speed controller, which
/// follows the rate of its set point, not its value: see speed_actuator.
struct ActuatorSpec {
  std::string name;
  JointId joint = {};  ///< acts on this joint's coordinate; if not valid, between two points
  BodyId a = {}, b = {};
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();          ///< m, global at assembly
  Vec3 toward_a = Vec3::Zero(), toward_b = Vec3::Zero();  ///< m, global; arms of a rotational actuator on three points
  bool three_points = false;
  double position_gain = 0.0;            ///< K, N/m or N m/rad
  double speed_gain = 0.0;               ///< c, N s/m or N m s/rad
  std::optional<Signal> set_point = {};  ///< m or rad, with its rate; if none is given, the coordinate when it is added
  bool by_speed = false;                 ///< set_target gives speeds (m/s or rad/s), whose rates do not count
  double max_force = std::numeric_limits<double>::infinity();  ///< N or N m; the force is cut at +- this
  Curve torque_curve = {};  ///< a motor: N m over rad/s (or N over m/s) at full throttle
  double throttle = 0.0;    ///< -1 .. 1; below 0 the motor runs the other way, with the mirrored curve
  bool on = true;
  Dof dof = Dof::own;                                     ///< the joint's coordinate that it drives
  std::vector<std::pair<double, Curve>> engine_map = {};  ///< an engine: N m over rad/s for each throttle, 0 to 1
  double idle_speed = 0.0, idle_gain = 0.0;               ///< rad/s, 1/(rad/s); see idling_at
  bool has_throttle() const { return !torque_curve.empty() || !engine_map.empty(); }

  ActuatorSpec along(Dof f) const;
  ActuatorSpec with_max_force(double f) const;
  /// A governor opens the throttle by `gain` (1/(rad/s)) for each rad/s below the idling speed (rad/s), if the driver
  /// has not opened it further. Without load the engine turns a little slower: by the throttle that balances its drag,
  /// over the gain.
  ActuatorSpec idling_at(double speed, double gain = 0.05) const;
  ActuatorSpec switched_off() const;
};

/// Between two points (eqs. 34-37): the coordinate is their distance (m), which must not become zero.
ActuatorSpec linear_actuator(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b,
                             double position_gain, double speed_gain, std::optional<Signal> set_point = {});
/// On the coordinate of a joint: force on one that slides, torque on one that turns (eq. 38, over whole turns).
ActuatorSpec joint_actuator(std::string name, JointId joint, double position_gain, double speed_gain,
                            std::optional<Signal> set_point = {});
/// A speed controller on the coordinate of a joint: force (N) or torque (N m) = -gain (speed - wanted speed). The
/// wanted speed (m/s or rad/s) may change with time: Signal::smooth_step(0, 2, 0, 0.2) is a soft start. set_target
/// gives it another one.
ActuatorSpec speed_actuator(std::string name, JointId joint, double gain, const Signal& speed);
/// On three points (section 2.4.2): the angle at `corner` from `toward_a` on body a to `toward_b` on body b, counted
/// positive about a x b at assembly. It is the turn of a free joint about that normal: give the bodies a joint that
/// lets them turn about it, as a hinge does. Where they bend away from it, only the turn that is left is measured and
/// driven.
ActuatorSpec rotational_actuator(std::string name, BodyId a, const Vec3& corner, const Vec3& toward_a, BodyId b,
                                 const Vec3& toward_b, double position_gain, double speed_gain,
                                 std::optional<Signal> set_point = {});
/// A motor on a joint: torque (N m) over speed (rad/s), times a throttle between -1 and 1 that is set while running.
/// In reverse it is the same motor the other way round: torque = throttle curve(-speed).
ActuatorSpec motor(std::string name, JointId joint, Curve torque_over_speed, double throttle = 1.0);

/// An actuator, ready to run, and what it did in the newest force evaluation.
struct Actuator {
  ActuatorSpec spec;
  std::uint32_t a = 0, b = 0;
  Vector3<double> point_a = {}, point_b = {};  ///< m, body frames
  double coordinate = 0.0;                     ///< m or rad
  double speed = 0.0;                          ///< m/s or rad/s
  double force = 0.0;                          ///< N or N m, positive where it makes the coordinate grow
  Signal::Sample target = {};                  ///< the set point
  /// The largest force is state: brakes and engines set it while they run.
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.given("joint", spec.joint), v.given("a", a), v.given("b", b);
    v.given("dof", spec.dof), v.given("position_gain", spec.position_gain), v.given("speed_gain", spec.speed_gain);
    v("max_force", spec.max_force), v("torque_curve", spec.torque_curve), v.given("engine_map", spec.engine_map),
        v.given("idle_speed", spec.idle_speed), v("throttle", spec.throttle);
    v.given("idle_gain", spec.idle_gain), v.given("point_on_a", spec.at_a, "m"), v.given("point_on_b", spec.at_b, "m");
    v.given("toward_a", spec.toward_a, "m"), v.given("toward_b", spec.toward_b, "m");
    v.given("has_set_point", spec.set_point.has_value()), v.given("by_speed", spec.by_speed), v("on", spec.on);
    if (spec.set_point) v("set_point", *spec.set_point);
    v("point_a", point_a, "m"), v("point_b", point_b, "m"), v("coordinate", coordinate), v("speed", speed);
    v("force", force), v("target", target.value), v("target_rate", target.rate);
  }
  double power() const { return force * speed; }  ///< W, delivered to the bodies
};

/// The torque (N m) of an engine at a throttle and a speed (rad/s), governor included.
double torque_of_engine(const ActuatorSpec& s, double speed);
/// N m s/rad, at most: of the steepest table, and of the governor where the tables differ most from the first one.
double steepest_of_engine(const ActuatorSpec& s);

/// The coordinate that an actuator acts on.
Coordinate coordinate_of(const Actuator& u, const std::vector<Joint>& joints, const Body& a, const Body& b);

void apply_actuator(Actuator& u, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time, double dt);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE ActuatorSpec ActuatorSpec::along(Dof f) const {
  ActuatorSpec s = *this;
  s.dof = f;
  return s;
}

DEM_INLINE ActuatorSpec ActuatorSpec::with_max_force(double f) const {
  ActuatorSpec s = *this;
  s.max_force = f;
  return s;
}

DEM_INLINE ActuatorSpec ActuatorSpec::switched_off() const {
  ActuatorSpec s = *this;
  s.on = false;
  return s;
}

DEM_INLINE ActuatorSpec linear_actuator(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b,
                                        double position_gain, double speed_gain, std::optional<Signal> set_point) {
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = at_a,
          .at_b = at_b,
          .position_gain = position_gain,
          .speed_gain = speed_gain,
          .set_point = std::move(set_point)};
}

DEM_INLINE ActuatorSpec joint_actuator(std::string name, JointId joint, double position_gain, double speed_gain,
                                       std::optional<Signal> set_point) {
  return {.name = std::move(name),
          .joint = joint,
          .position_gain = position_gain,
          .speed_gain = speed_gain,
          .set_point = std::move(set_point)};
}

DEM_INLINE ActuatorSpec speed_actuator(std::string name, JointId joint, double gain, const Signal& speed) {
  ActuatorSpec s = joint_actuator(std::move(name), joint, 0.0, gain, speed.as_rate());
  s.by_speed = true;
  return s;
}

DEM_INLINE ActuatorSpec rotational_actuator(std::string name, BodyId a, const Vec3& corner, const Vec3& toward_a,
                                            BodyId b, const Vec3& toward_b, double position_gain, double speed_gain,
                                            std::optional<Signal> set_point) {
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = corner,
          .at_b = corner,
          .toward_a = toward_a,
          .toward_b = toward_b,
          .three_points = true,
          .position_gain = position_gain,
          .speed_gain = speed_gain,
          .set_point = std::move(set_point)};
}

DEM_INLINE ActuatorSpec motor(std::string name, JointId joint, Curve torque_over_speed, double throttle) {
  if (torque_over_speed.empty()) fail("motor '{}' has no torque curve; give it points (speed, torque)", name);
  require_within(throttle, -1.0, 1.0, ("throttle of motor '" + name + "'").c_str());
  return {.name = std::move(name), .joint = joint, .torque_curve = std::move(torque_over_speed), .throttle = throttle};
}

DEM_INLINE double torque_of_engine(const ActuatorSpec& s, double speed) {
  const auto& map = s.engine_map;
  const double wanted = std::max(s.throttle, std::clamp(s.idle_gain * (s.idle_speed - speed), 0.0, 1.0));
  std::size_t i = 1;
  while (i + 1 < map.size() && map[i].first < wanted) ++i;
  const double share = (wanted - map[i - 1].first) / (map[i].first - map[i - 1].first);
  return (1.0 - share) * map[i - 1].second(speed) + share * map[i].second(speed);
}

DEM_INLINE double steepest_of_engine(const ActuatorSpec& s) {
  double slope = 0.0, rise = 0.0;
  for (const auto& [throttle, curve] : s.engine_map) slope = std::max(slope, curve.steepest());
  for (std::size_t i = 1; i < s.engine_map.size(); ++i) {
    const auto &low = s.engine_map[i - 1], &high = s.engine_map[i];
    const double between = high.first - low.first;
    for (const auto& [speed, torque] : high.second.points()) {
      if (speed <= s.idle_speed) rise = std::max(rise, std::abs(torque - low.second(speed)) / between);
    }
    rise = std::max(rise, std::abs(high.second(s.idle_speed) - low.second(s.idle_speed)) / between);
  }
  return slope + s.idle_gain * rise;
}

DEM_INLINE Coordinate coordinate_of(const Actuator& u, const std::vector<Joint>& joints, const Body& a, const Body& b) {
  return u.spec.joint.valid() ? coordinate_of(joints[u.spec.joint.index()], a, b, u.spec.dof)
                              : distance_of(u.point_a, u.point_b, a, b);
}

DEM_INLINE void apply_actuator(Actuator& u, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time,
                               double dt) {
  Body &a = bodies[u.a], &b = bodies[u.b];
  const Coordinate q = coordinate_of(u, joints, a, b);
  u.coordinate = q.value;
  u.speed = q.speed;
  u.force = 0.0;
  if (!u.spec.on) return;
  if (!u.spec.engine_map.empty()) {
    u.force = torque_of_engine(u.spec, q.speed);
  } else if (u.spec.torque_curve.empty()) {
    u.target = (*u.spec.set_point)(time, dt);
    u.force = -u.spec.position_gain * (q.value - u.target.value) - u.spec.speed_gain * (q.speed - u.target.rate);
  } else {
    // Reverse is the mirror image of forward: the curve is read at the speed in the direction of the torque.
    u.force = u.spec.throttle * u.spec.torque_curve(u.spec.throttle < 0.0 ? -q.speed : q.speed);
  }
  // Compared such that a NaN stays one and reaches the report.
  if (u.force > u.spec.max_force) u.force = u.spec.max_force;
  if (u.force < -u.spec.max_force) u.force = -u.spec.max_force;
  q.apply(u.force, a, b);
}

}  // namespace dem::mbd

#endif
