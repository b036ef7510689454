#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd {

inline void clear_forces(Parts& m) {
  for (Body& b : m.bodies) b.force = b.torque = {0, 0, 0};
}

/// All forces of the machine itself, added to what the bodies already carry (the grains' contact forces). `time` (s) is
/// that of the state the forces are evaluated at, `dt` (s) the machine's time step; see Evaluation.
void add_forces(Parts& m, double time, double dt, double slip_time = 0.0, bool is_last_stage = false,
                bool is_trial = false);

/// Turn counts are sums of speed times dt; now and then they are set to the exact angles.
void settle_turns(Parts& m);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE void add_forces(Parts& m, double time, double dt, double slip_time, bool is_last_stage, bool is_trial) {
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    m.global_angular_velocity[i] = b.motion.rotation * b.motion.angular_velocity;
    m.outside[i] = {b.force, b.torque};
  }
  for (const detail::PartKind* kind : m.kinds) {
    if (kind->add_forces) kind->add_forces(m, {time, dt, slip_time, is_last_stage, is_trial});
  }
}

DEM_INLINE void settle_turns(Parts& m) {
  for (Joint& j : m.joints) {
    if (!j.turns) continue;
    j.angle_estimate = rotation_of(j, m.bodies[j.a], m.bodies[j.b]).value - j.angle_offset;
  }
}

}  // namespace dem::mbd

#endif
