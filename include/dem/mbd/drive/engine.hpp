#pragma once

// Engines: torque over speed and throttle, with the drag of a closed throttle and a governor for idling.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/actuator.hpp>

namespace dem::mbd {

/// An engine on the joint of its crankshaft (body a: what it is mounted on). Torque (N m) over speed (rad/s) at full
/// throttle, and while it is motored with closed throttle: the braking torque, negative where the engine turns forward.
/// In between, torque goes with the throttle (0 to 1, see set_throttle). The tables go on with their last slopes,
/// unless they are held_outside(). What starts it is an actuator or a clutch; without idling_at it stalls below what
/// its tables hold.
///
///     const ActuatorId diesel = car.add_actuator(engine("diesel", crank, full, motoring).idling_at(75.0));
///     car.set_throttle(diesel, 0.6);
ActuatorSpec engine(std::string name, JointId crank, Curve full_throttle, Curve motoring, double throttle = 0.0);
/// The same from a map as it is measured: a table of torque over speed for each throttle, in rising throttle from 0 to
/// 1. Between two throttles the torque is on the line between their tables.
ActuatorSpec engine(std::string name, JointId crank, std::vector<std::pair<double, Curve>> map, double throttle = 0.0);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE ActuatorSpec engine(std::string name, JointId crank, Curve full_throttle, Curve motoring, double throttle) {
  if (full_throttle.empty() || motoring.empty()) {
    fail(
        "engine '{}' needs two tables, of torque at full throttle and while it is motored; give points (speed, torque)",
        name);
  }
  require_within(throttle, 0.0, 1.0, ("throttle of engine '" + name + "'").c_str());
  ActuatorSpec s{.name = std::move(name), .joint = crank, .throttle = throttle};
  s.engine_map = {{0.0, std::move(motoring)}, {1.0, std::move(full_throttle)}};
  return s;
}

DEM_INLINE ActuatorSpec engine(std::string name, JointId crank, std::vector<std::pair<double, Curve>> map,
                               double throttle) {
  if (map.size() < 2 || map.front().first != 0.0 || map.back().first != 1.0) {
    fail("the map of engine '{}' has {} throttles, but needs at least 2, the first one 0 and the last one 1", name,
         map.size());
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i].second.empty()) fail("table {} of engine '{}' has no points", i, name);
    if (i > 0 && !(map[i].first > map[i - 1].first)) {
      fail("throttle {} of the map of engine '{}' is {:g} after {:g}: it must rise from table to table", i, name,
           map[i].first, map[i - 1].first);
    }
  }
  require_within(throttle, 0.0, 1.0, ("throttle of engine '" + name + "'").c_str());
  ActuatorSpec s{.name = std::move(name), .joint = crank, .throttle = throttle};
  s.engine_map = std::move(map);
  return s;
}

DEM_INLINE ActuatorSpec ActuatorSpec::idling_at(double speed, double gain) const {
  if (engine_map.empty()) fail("actuator '{}' is no engine(...), so it cannot idle", name);
  ActuatorSpec s = *this;
  s.idle_speed = require_positive(speed, ("idling speed of engine '" + name + "'").c_str(), "rad/s");
  s.idle_gain = require_positive(gain, ("governor of engine '" + name + "'").c_str(), "1/(rad/s)");
  return s;
}

}  // namespace dem::mbd

#endif
