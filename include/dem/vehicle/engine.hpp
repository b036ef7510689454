#pragma once

#include <dem/mbd/drive/engine.hpp>
#include <dem/vehicle/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// What drives the drive shaft.
struct EngineSpec {
  enum class Kind {
    actuator,  ///< one rotational actuator that holds a speed (thesis, Table 6.2)
    motor,     ///< a torque curve behind a fixed ratio, without inertia of its own
    geared     ///< a rotor with a torque curve, a clutch, gears that shift, and a transfer case
  };
  Kind kind = Kind::motor;
  double speed_gain = 2000.0;      ///< N m s/rad, of the actuator
  double largest_torque = 2643.0;  ///< N m at the drive shaft, of the actuator
  mbd::Curve torque = {};          ///< N m over rad/s of the engine's own shaft, at full throttle
  /// Turns of the engine for one of the transfer case, of the first gear first: they fall. A motor has one.
  std::vector<double> gears = {};
  double transfer = 1.0;       ///< turns of the transfer case for one turn of the drive shaft
  double governor_lag = 2e-3;  ///< s, of the governor's valve; see Controls

  // Geared only. The clutch lets go at the idling speed, of the rotor or of the gearbox's input, whichever is faster,
  // and holds clutch_torque from clutch_speed on. So a car rolls freely while both are slower.
  mbd::Curve drag = {};  ///< N m over rad/s, with closed throttle: below 0
  PartMass rotor = {};
  Vec3 rotor_at = Vec3(0.5, 0, 0.4);            ///< m, middle of the rotor from that of the drive shaft
  double idle = 84.0;                           ///< rad/s
  double clutch_speed = 140.0;                  ///< rad/s
  double clutch_torque = 1000.0;                ///< N m
  double shift_up = 350.0, shift_down = 150.0;  ///< rad/s of the gearbox's input
  double shift_wait = 1.0;                      ///< s, from one shift to the next

  /// Turns of the engine's shaft for one of the drive shaft.
  double ratio(std::size_t gear) const { return gears[gear] * transfer; }
};

namespace detail {

/// N m over rad/s at the drive shaft, of a motor.
DEM_SETUP inline mbd::Curve curve_at_shaft(const EngineSpec& e) {
  std::vector<std::pair<double, double>> points;
  for (const auto& [speed, torque] : e.torque.points()) points.emplace_back(speed / e.ratio(0), torque * e.ratio(0));
  return mbd::Curve(std::move(points)).held_outside();
}

DEM_SETUP inline void check_gears(const EngineSpec& e) {
  double widest = 1.0;
  for (std::size_t k = 1; k < e.gears.size(); ++k) {
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
  require_non_negative(e.shift_wait, "time between two shifts of the engine's gears", "s");
  require_positive(e.clutch_torque, "torque of the engine's clutch", "N m");
  require_positive(e.idle, "idling speed of the engine", "rad/s");
  if (!(e.clutch_speed > e.idle)) {
    fail("the engine idles at {:g} rad/s and its clutch holds from {:g} rad/s on, but the latter must be faster",
         e.idle, e.clutch_speed);
  }
  if (e.drag.empty()) fail("the engine has no curve of its drag; give EngineSpec::drag points (rad/s, N m below 0)");
}

/// Throws Error for an engine that cannot be: without gears or a curve, with gears that do not fall or would shift back
/// at once, without drag or an idling speed below that of its clutch; and for a motor with more than one ratio.
DEM_SETUP inline void check_engine(const EngineSpec& e) {
  if (e.kind == EngineSpec::Kind::actuator) {
    require_positive(e.speed_gain, "speed gain of the engine", "N m s/rad");
    require_positive(e.largest_torque, "largest torque of the engine", "N m");
    return;
  }
  if (e.gears.empty()) fail("the engine has no gears, but needs at least 1; give EngineSpec::gears a ratio");
  if (e.torque.empty()) fail("the engine has no torque curve; give EngineSpec::torque points (rad/s, N m)");
  require_positive(e.transfer, "ratio of the transfer case", "(no unit)");
  require_positive(e.governor_lag, "lag of the engine's governor", "s");
  for (const double ratio : e.gears) require_positive(ratio, "ratio of a gear", "(no unit)");
  if (e.kind == EngineSpec::Kind::geared) return check_gears(e);
  if (e.gears.size() > 1) {
    fail("a motor has {} gears, but a fixed ratio; give one, or EngineSpec::Kind::geared", e.gears.size());
  }
}

}  // namespace detail

/// An engine on its drive shaft.
struct Engine {
  EngineSpec spec;
  ActuatorId drive;
  BodyId rotor;  ///< geared only, as its crank in the chassis and its clutch
  JointId crank;
  ClutchId clutch;
  std::size_t gear = 0;      ///< from 0
  double governed = 1.0;     ///< share of the throttle that the governor's valve leaves now
  double share = 1.0;        ///< of its torque that an actuator may use now
  double since_shift = 0.0;  ///< s
  double work = 0.0;         ///< J, of the engine so far; summed by drive()

  bool has_throttle() const { return spec.kind != EngineSpec::Kind::actuator; }
  double limit() const { return std::max(1e-12, share * spec.largest_torque); }  ///< N m, of an actuator now
  template <class V>
  void fields(V& v) {
    v("gear", gear), v("governed", governed), v("share", share), v("since_shift", since_shift, "s"),
        v("work", work, "J");
  }
};

/// `shaft` turns about `forward` in the chassis with its middle at `at` (m), at `spin` (rad/s) at the start.
DEM_SETUP inline Engine add_engine(const Assembly& in, BodyId chassis, JointId shaft, const EngineSpec& s,
                                   const Vec3& at, const Vec3& forward, double spin) {
  using namespace mbd;
  detail::check_engine(s);
  Engine e;
  e.spec = s;
  Mechanism& m = in.mechanism();
  const std::string name = in.name("engine");
  if (s.kind == EngineSpec::Kind::actuator) {
    e.drive = m.add_actuator(joint_actuator(name, shaft, 0.0, s.speed_gain, Signal::held(0.0, 0.0))
                                 .with_max_force(s.largest_torque)
                                 .switched_off());
  } else if (s.kind == EngineSpec::Kind::motor) {
    e.drive = m.add_actuator(motor(name, shaft, detail::curve_at_shaft(s), 0.0));
  } else {
    while (e.gear + 1 < s.gears.size() && spin * s.ratio(e.gear) > s.shift_up) ++e.gear;
    const Vec3 middle = at + s.rotor_at;
    e.rotor = in.body("rotor", s.rotor, middle, std::max(s.idle, spin * s.ratio(e.gear)) * forward);
    e.crank = in.joint(JointKind::revolute, "crank", chassis, e.rotor, middle, forward);
    e.drive =
        m.add_actuator(engine(name, e.crank, s.torque.held_outside(), s.drag.held_outside()).idling_at(s.idle, 0.05));
    // Open until work_gears() sets the ratio of the gear. Its stiffness is derived for the first, whose
    // ratio is the largest and bears the least.
    ClutchSpec plates = clutch(in.name("clutch"), shaft, e.crank, 0.0);
    plates.terms[1].ratio = -s.ratio(0);
    e.clutch = m.add_clutch(std::move(plates));
    e.since_shift = s.shift_wait;
  }
  return e;
}

/// N m at the drive shaft, the most that the engine gives in its lowest gear.
inline double largest_torque(const EngineSpec& e) {
  if (e.kind == EngineSpec::Kind::actuator) return e.largest_torque;
  double most = 0.0;
  for (const auto& point : e.torque.points()) most = std::max(most, point.second);
  return most * e.ratio(0);
}

/// Shifts the gears and works the clutch, dt (s) after the last call. A gear shifts where its input has become too fast
/// or too slow; the clutch slips until the rotor turns with the new one.
inline void work_gears(mbd::Mechanism& m, Engine& e, double shaft_speed, double dt) {
  if (e.spec.kind != EngineSpec::Kind::geared) return;
  const EngineSpec& s = e.spec;
  const double input = shaft_speed * s.ratio(e.gear);
  const std::size_t before = e.gear;
  e.since_shift += dt;
  if (e.since_shift >= s.shift_wait) {
    if (input > s.shift_up && e.gear + 1 < s.gears.size()) ++e.gear;
    if (input < s.shift_down && e.gear > 0) --e.gear;
  }
  mbd::Clutch& plates = m.parts().clutches[e.clutch.index()];
  if (e.gear != before) {
    e.since_shift = 0.0;
    plates.history.slip_work += plates.elastic_energy();
    plates.history.is_closed = false, plates.history.stretch = 0.0;
  }
  const double ratio = s.ratio(e.gear);
  plates.spec.terms[1].ratio = -ratio;
  const double fastest = std::max(m.speed(e.crank), shaft_speed * ratio);
  const double closed = (fastest - s.idle) / (s.clutch_speed - s.idle);
  plates.spec.capacity = s.clutch_torque * std::clamp(closed, 0.0, 1.0);
}

/// Sets the throttle of a motor or of an engine with gears, 0 to 1.
inline void set_throttle(mbd::Mechanism& m, const Engine& e, double throttle) {
  if (!e.has_throttle()) fail("this engine is an actuator that holds a speed; use hold_speed");
  m.parts().actuators[e.drive.index()].spec.throttle = std::clamp(throttle, 0.0, 1.0);
}

/// Lets an engine that is an actuator hold a speed of the drive shaft (rad/s) with at most `share` (0 to 1) of its
/// torque.
inline void hold_speed(mbd::Mechanism& m, Engine& e, double shaft_speed, double share = 1.0) {
  if (e.has_throttle()) fail("this engine has a torque curve and a throttle; use set_throttle");
  e.share = std::clamp(share, 0.0, 1.0);
  mbd::ActuatorSpec& spec = m.parts().actuators[e.drive.index()].spec;
  spec.on = e.share > 0.0;
  spec.set_point = mbd::Signal::held(0.0, shaft_speed);
  spec.max_force = e.limit();
}

}  // namespace dem::vehicle
