#pragma once

#include <dem/vehicle/assembly.hpp>
#include <dem/vehicle/axle.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// What drives the drive shaft.
struct EngineSpec {
  enum class Kind {
    actuator,  ///< one rotational actuator that holds a speed (thesis, Table 6.2)
    motor      ///< a torque curve, gears and a transfer case
  };
  Kind kind = Kind::motor;
  double speed_gain = 2000.0;      ///< N m s/rad, of the actuator
  double largest_torque = 2643.0;  ///< N m at the drive shaft, of the actuator
  mbd::Curve torque = {};          ///< N m over rad/s of the motor's shaft, at full throttle
  std::vector<double> gears = {};  ///< turns of the motor for one turn of the transfer case, from low to high
  double transfer = 1.0;           ///< turns of the transfer case for one turn of the drive shaft
  double shift_up = 350.0, shift_down = 150.0;  ///< rad/s of the motor
  double governor_lag = 2e-3;                   ///< s, of the governor's valve; see Controls
};

struct DrivelineSpec {
  AxleSpec front, rear;
  PartMass shaft;
  Vec3 shaft_middle = Vec3::Zero();  ///< m; the shaft runs forward
  EngineSpec engine;
};

/// Engine, drive shaft and two axles. The drive shaft turns in the chassis and drives both pinions through slip
/// splines, prismatic joints along the shaft.
struct Driveline {
  BodyId shaft;
  JointId shaft_turn, front_spline, rear_spline;
  Axle front, rear;
  ActuatorId engine;
  EngineSpec spec;
  std::size_t gear = 0;   ///< from 0
  double governed = 1.0;  ///< share of the throttle that the governor's valve leaves now

  template <class V>
  void fields(V& v) {
    v("gear", gear), v("governed", governed);
  }
};

namespace detail {

/// N m over rad/s at the drive shaft, in a gear.
DEM_COLD inline mbd::Curve curve_at_shaft(const EngineSpec& e, std::size_t gear) {
  const double ratio = e.gears[gear] * e.transfer;
  std::vector<std::pair<double, double>> points;
  for (const auto& [speed, torque] : e.torque.points()) points.emplace_back(speed / ratio, torque * ratio);
  return mbd::Curve(std::move(points)).held_outside();
}

/// Throws Error for an engine without gears, gears that do not fall, or a shift that would come back at once.
DEM_COLD inline void check_engine(const EngineSpec& e) {
  if (e.kind == EngineSpec::Kind::actuator) {
    require_positive(e.speed_gain, "speed gain of the engine", "N m s/rad");
    require_positive(e.largest_torque, "largest torque of the engine", "N m");
    return;
  }
  if (e.gears.empty()) fail("the engine has no gears, but needs at least 1; give EngineSpec::gears a ratio");
  if (e.torque.empty()) fail("the engine has no torque curve; give EngineSpec::torque points (rad/s, N m)");
  require_positive(e.transfer, "ratio of the transfer case", "(no unit)");
  require_positive(e.governor_lag, "lag of the engine's governor", "s");
  double widest = 1.0;
  for (std::size_t k = 0; k < e.gears.size(); ++k) {
    require_positive(e.gears[k], "ratio of a gear", "(no unit)");
    if (k == 0) continue;
    if (!(e.gears[k] < e.gears[k - 1])) {
      fail("gear {} has the ratio {:g} after {:g}, but ratios must fall from gear to gear; sort them", k + 1,
           e.gears[k], e.gears[k - 1]);
    }
    widest = std::max(widest, e.gears[k - 1] / e.gears[k]);
  }
  if (!(e.shift_up > widest * e.shift_down)) {
    fail(
        "the engine shifts up at {:g} rad/s and down at {:g} rad/s, so it would shift back at once: gears lie up to "
        "{:g} apart; raise shift_up or lower shift_down",
        e.shift_up, e.shift_down, widest);
  }
}

}  // namespace detail

/// `wheels`: front left, front right, rear left, rear right. The shafts turn with wheels of `spin` (rad/s) at the
/// start.
DEM_COLD inline Driveline add_driveline(const Assembly& in, BodyId chassis, const BodyId (&wheels)[4],
                                        const DrivelineSpec& s, double spin = 0.0) {
  using namespace mbd;
  detail::check_engine(s.engine);
  Driveline d;
  d.spec = s.engine;
  d.front = add_axle(in, "front", chassis, wheels[0], wheels[1], s.front, spin);
  d.rear = add_axle(in, "rear", chassis, wheels[2], wheels[3], s.rear, spin);
  if (std::abs(s.front.ratio - s.rear.ratio) > 1e-9 * s.front.ratio) {
    fail("the axles have the ratios {:g} and {:g}, but one drive shaft turns both; give them the same", s.front.ratio,
         s.rear.ratio);
  }
  const Vec3 forward = Vec3::UnitX();
  d.shaft = in.body("drive shaft", s.shaft, s.shaft_middle, s.front.ratio * spin * forward);
  d.shaft_turn = in.joint(JointKind::revolute, "drive shaft", chassis, d.shaft, s.shaft_middle, forward);
  const auto spline = [&](const char* part, BodyId pinion, const AxleSpec& axle) {
    return in.joint(JointKind::prismatic, part, d.shaft, pinion, axle.middle + axle.pinion_ahead * forward, forward);
  };
  d.front_spline = spline("front spline", d.front.pinion, s.front);
  d.rear_spline = spline("rear spline", d.rear.pinion, s.rear);
  const EngineSpec& e = s.engine;
  d.engine = in.mechanism().add_actuator(
      e.kind == EngineSpec::Kind::actuator
          ? joint_actuator(in.name("engine"), d.shaft_turn, 0.0, e.speed_gain, Signal::held(0.0, 0.0))
                .with_max_force(e.largest_torque)
                .switched_off()
          : motor(in.name("engine"), d.shaft_turn, detail::curve_at_shaft(e, 0), 0.0));
  return d;
}

/// rad/s, of the engine's shaft.
inline double engine_speed(const mbd::Mechanism& m, const Driveline& d) {
  const double shaft = m.speed(d.shaft_turn);
  return d.spec.kind == EngineSpec::Kind::motor ? shaft * d.spec.gears[d.gear] * d.spec.transfer : shaft;
}

/// Sets the throttle of a motor, 0 to 1, and shifts gears where they are due. The gears shift without a pause.
inline void set_throttle(mbd::Mechanism& m, Driveline& d, double throttle) {
  if (d.spec.kind != EngineSpec::Kind::motor) fail("this engine is an actuator that holds a speed; use hold_speed");
  const double speed = std::abs(engine_speed(m, d));
  const std::size_t before = d.gear;
  if (speed > d.spec.shift_up && d.gear + 1 < d.spec.gears.size()) ++d.gear;
  if (speed < d.spec.shift_down && d.gear > 0) --d.gear;
  mbd::ActuatorSpec& spec = m.parts().actuators[d.engine.index()].spec;
  if (d.gear != before) spec.torque_curve = detail::curve_at_shaft(d.spec, d.gear);
  spec.throttle = std::clamp(throttle, 0.0, 1.0);
}

/// Lets an engine that is an actuator hold a speed of the drive shaft (rad/s) with at most `share` (0 to 1) of its
/// torque.
inline void hold_speed(mbd::Mechanism& m, Driveline& d, double shaft_speed, double share = 1.0) {
  if (d.spec.kind != EngineSpec::Kind::actuator) fail("this engine is a motor with a torque curve; use set_throttle");
  mbd::ActuatorSpec& spec = m.parts().actuators[d.engine.index()].spec;
  spec.on = share > 0.0;
  spec.set_point = mbd::Signal::held(0.0, shaft_speed);
  spec.max_force = std::max(1e-12, std::min(1.0, share) * d.spec.largest_torque);
}

}  // namespace dem::vehicle
