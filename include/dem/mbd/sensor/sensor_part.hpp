#pragma once

// Sensors: how they are added, and how they are sampled.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

/// What touches a body: grains and surfaces of other bodies, and terrains.
Wrench contacts_of(const Parts& m, std::size_t body);

/// Hands sensors what they measure, for the dt (s) that it held; but those of drives, whose forces are known when the
/// step is over (Stages).
void sample_sensors(Parts& m, double dt);

/// The mean force (N) or torque (N m) that an actuator or a drive puts on its coordinate.
double drive_effort(const Sensor& s);

/// Checks that what a sensor measures is there.
void check_sensor(const Parts& parts, const SensorSpec& spec);

SensorId add_sensor(Parts& parts, SensorSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Wrench contacts_of(const Parts& m, std::size_t body) {
  Wrench w = m.outside[body];
  if (m.terrains.empty()) return w;
  for (const Load& load : m.loads) {
    if (load.spec.by_terrain && load.spec.body.index() == body) w = w + load.wrench;
  }
  return w;
}

DEM_INLINE void sample_sensors(Parts& m, double dt) {
  for (Sensor& s : m.sensors) {
    const std::size_t i = s.spec.index;
    Wrench w;
    switch (s.spec.target) {
      case SensorTarget::contacts: w = contacts_of(m, i); break;
      case SensorTarget::total: w = {m.bodies[i].force, m.bodies[i].torque}; break;
      case SensorTarget::joint: w = reaction_of(m, i); break;
      case SensorTarget::actuator: w.force.x = m.actuators[i].force; break;
      case SensorTarget::drive: continue;
    }
    s.average.add(w, dt);
  }
}

DEM_INLINE double drive_effort(const Sensor& s) {
  if (s.spec.target == SensorTarget::actuator || s.spec.target == SensorTarget::drive) return s.average.mean().force.x;
  fail(
      "sensor '{}' measures no actuator and no drive, so it has a force and a torque in space; read "
      "sensor(id).mean().force and torque",
      s.spec.name);
}

DEM_INLINE void check_sensor(const Parts& parts, const SensorSpec& spec) {
  const std::size_t count = spec.target == SensorTarget::joint      ? parts.joints.size()
                            : spec.target == SensorTarget::actuator ? parts.actuators.size()
                            : spec.target == SensorTarget::drive    ? parts.motions.size()
                                                                    : parts.bodies.size();
  const char* what = spec.target == SensorTarget::joint      ? "joint"
                     : spec.target == SensorTarget::actuator ? "actuator"
                     : spec.target == SensorTarget::drive    ? "prescribed motion"
                                                             : "body";
  if (spec.index >= count) {
    fail("sensor '{}' measures {} {}, but the machine has {} of them; use the id that add_... returned", spec.name,
         what, spec.index == BodyId().index() ? "(never added)" : std::to_string(spec.index), count);
  }
  if (spec.target == SensorTarget::drive && parts.motions[spec.index].spec.target == MotionSpec::Target::pose) {
    fail(
        "sensor '{}' measures the drive of '{}', which prescribes a whole pose and so has no single force; use a "
        "total_force_sensor on its body",
        spec.name, parts.motions[spec.index].spec.name);
  }
}

DEM_INLINE SensorId add_sensor(Parts& parts, SensorSpec spec) {
  settle_name(spec.name, parts.sensors, "sensor", "sensors", name_in_spec);
  check_sensor(parts, spec);
  WindowAverage average(spec.window);
  parts.sample_sensors = &sample_sensors;
  return keep<SensorId>(parts, parts.sensors, Sensor{std::move(spec), average}, false);
}

}  // namespace dem::mbd::detail

#endif
