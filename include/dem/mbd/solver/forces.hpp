#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

namespace dem::mbd {

inline void clear_forces(Parts& m) {
  for (Body& b : m.bodies) b.force = b.torque = {0, 0, 0};
}

inline void sample_sensors(Parts& m, double dt) {
  for (Sensor& s : m.sensors) {
    const std::size_t i = s.spec.index;
    Wrench w;
    switch (s.spec.target) {
      case SensorTarget::contacts: w = m.outside[i]; break;
      case SensorTarget::total: w = {m.bodies[i].force, m.bodies[i].torque}; break;
      case SensorTarget::joint: w = reaction_of(m, i); break;
      case SensorTarget::actuator: w.force.x = m.actuators[i].force; break;
      case SensorTarget::drive: w.force.x = m.motions[i].drive.force; break;
    }
    s.average.add(w, dt);
  }
}

/// All forces of the machine itself, added to what the bodies already carry (the grains' contact forces). `time` (s) is
/// that of the state the forces are evaluated at, `dt` (s) the machine's time step. Joint friction is evaluated from
/// the committed history, and committed, like turns, in the last stage only; sensors are sampled after it
/// (sample_sensors).
inline void add_forces(Parts& m, double time, double dt, bool is_last_stage) {
  const double followed = is_last_stage ? dt : 0.0;
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    m.spin[i] = b.motion.rotation * b.motion.angular_velocity;
    m.outside[i] = {b.force, b.torque};
  }
  for (Load& load : m.loads) apply_load(load, m.bodies, time, dt);
  for (Joint& j : m.joints) {
    traits_of(j.kind).force(j, m.bodies[j.a], m.bodies[j.b], m.spin[j.a], m.spin[j.b], followed);
  }
  for (JointFrictionState& e : m.friction) {
    const Joint& j = m.joints[e.joint];
    apply_friction(e, j, m.bodies[j.a], m.bodies[j.b], followed, is_last_stage);
  }
  for (JointLimitState& e : m.limits)
    apply_limits(e, m.joints[e.joint], m.bodies[m.joints[e.joint].a], m.bodies[m.joints[e.joint].b]);
  for (Coupling& g : m.couplings) apply_coupling(g, m.joints, m.bodies);
  for (Spring& s : m.springs) apply_spring(s, m.bodies);
  for (Actuator& u : m.actuators) apply_actuator(u, m.joints, m.bodies, time, dt);
}

}  // namespace dem::mbd
