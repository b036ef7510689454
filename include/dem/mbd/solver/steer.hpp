#pragma once

// What a machine is steered with while it runs: set points, brakes, switches.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/actuator_part.hpp>
#include <dem/mbd/drive/carried_bodies.hpp>
#include <dem/mbd/joint/take_hold.hpp>
#include <dem/mbd/solver/parts.hpp>

namespace dem::mbd::detail {

void set_friction_preload(Parts& parts, JointId id, double newtons);

/// `lasts`: it stays until another is given, so a number that would brake by mistake is refused.
void set_target(ActuatorSpec& s, Signal signal, bool lasts = true);
void set_throttle(ActuatorSpec& s, double throttle);

void switch_on(Parts& parts, PrescribedMotion& p, bool on);

/// A joint that is switched on holds the bodies as they are now; one that is off holds nothing.
void switch_on(Parts& parts, JointId id, bool on);

void set_fixed(Parts& parts, Body& b, bool fixed);

void set_load(LoadSpec& s, Signal size);

void set_motion(PrescribedMotion& p, Signal motion);
void set_motion(PrescribedMotion& p, double value, double rate);

void set_pose(PrescribedMotion& p, PoseFunction pose);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void set_friction_preload(Parts& parts, JointId id, double newtons) {
  for (JointFrictionState& e : parts.friction) {
    if (e.joint == id.value) {
      e.preload = require_non_negative(newtons, "preload of a joint's friction", "N");
      return;
    }
  }
  fail("joint '{}' has no friction to preload; add it with with_friction", known(parts.joint_specs, id, "joint").name);
}

DEM_INLINE void set_target(ActuatorSpec& s, Signal signal, bool lasts) {
  if (s.has_throttle()) fail("actuator '{}' is a motor, which has no set point; use set_throttle", s.name);
  if (lasts) refuse_constant_speed(s, signal, dem::text("actuator '{}'", s.name));
  s.set_point = s.by_speed ? signal.as_rate() : std::move(signal);
}

DEM_INLINE void set_throttle(ActuatorSpec& s, double throttle) {
  if (!s.has_throttle()) fail("actuator '{}' is no motor, so it has no throttle; use set_target", s.name);
  s.throttle = s.engine_map.empty() ? require_within(throttle, -1.0, 1.0, "throttle of a motor")
                                    : require_within(throttle, 0.0, 1.0, "throttle of an engine");
}

DEM_INLINE void switch_on(Parts& parts, PrescribedMotion& p, bool on) {
  Body& b = parts.bodies[p.spec.body.index()];
  if (!on && p.spec.on && b.fixed && p.spec.target != MotionSpec::Target::joint) {
    b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
  }
  p.has_hold &= on && p.spec.on;
  const bool was_carried = !on && p.spec.on && CarriedBodies(parts).has(p.spec.body);
  p.spec.on = on;
  if (was_carried && !CarriedBodies(parts).has(p.spec.body)) ++parts.releases;
}

DEM_INLINE void switch_on(Parts& parts, JointId id, bool on) {
  Joint& j = known(parts.joints, id, "joint");
  if (on && !j.on) take_hold(j, parts.bodies[j.a], parts.bodies[j.b]);
  j.on = on;
  if (!on) j.force = j.torque = {0, 0, 0};
}

DEM_INLINE void set_fixed(Parts& parts, Body& b, bool fixed) {
  if (b.fixed == fixed) return;
  b.fixed = fixed;
  try {
    check_body(b);
  } catch (...) {
    b.fixed = true;
    throw;
  }
  if (fixed) b.motion.velocity = b.motion.angular_velocity = {0, 0, 0};
  ++parts.revision;
}

DEM_INLINE void set_load(LoadSpec& s, Signal size) {
  if (s.has_law()) {
    fail("load '{}' has a law of its own and no size; let the law give other forces, or switch it off", s.name);
  }
  s.size = std::move(size);
}

DEM_INLINE void set_motion(PrescribedMotion& p, Signal motion) {
  if (p.spec.target == MotionSpec::Target::pose) {
    fail("prescribed motion '{}' is a whole pose, which no signal gives; use set_pose", p.spec.name);
  }
  p.spec.motion = p.spec.by_speed ? motion.as_rate() : std::move(motion);
  p.drive.way.drop();
  p.has_hold = false;
}

DEM_INLINE void set_motion(PrescribedMotion& p, double value, double rate) {
  if (p.spec.by_speed) {
    fail("prescribed motion '{}' is one of speed and takes no value with a rate; use set_motion(id, speed)",
         p.spec.name);
  }
  const bool has_hold = p.has_hold;
  set_motion(p, Signal::held(value, rate));
  p.drive.way.set();
  p.has_hold = has_hold;
}

DEM_INLINE void set_pose(PrescribedMotion& p, PoseFunction pose) {
  if (p.spec.target != MotionSpec::Target::pose) {
    fail("prescribed motion '{}' is that of one coordinate, not of a pose; use set_motion", p.spec.name);
  }
  if (!pose) fail("prescribed motion '{}' was given no function that gives the pose", p.spec.name);
  p.spec.pose = std::move(pose);
  p.has_hold = false;
}

}  // namespace dem::mbd::detail

#endif
