#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/prescribe.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dem::mbd {

namespace detail {

/// How far (m or rad) a motion may be off its coordinate when it takes hold of it.
double allowed_off(const Parts& parts, const PrescribedMotion& p);

/// How far a motion is off its coordinate at `time` (s).
double off_hold(const Parts& parts, PrescribedMotion& p, double time);

/// Whether a motion that was loaded gives another value than it had when it was saved: it has to take hold again. One
/// whose value was set for the step that comes next is on its way there, as it was.
bool differs_from_saved(const PrescribedMotion& p, double time, double tolerance);

}  // namespace detail

/// Throws Error if a motion that is on would have to jump at `time` (s) to take hold of its coordinate, which would
/// tear the machine apart, or press a part into grains. To be called before each step.
void check_holds(Parts& parts, double time);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE double allowed_off(const Parts& parts, const PrescribedMotion& p) {
  const bool turns = p.spec.target == MotionSpec::Target::rotation ||
                     (p.spec.target == MotionSpec::Target::joint && is_rotation(p.spec.dof));
  return turns ? 1e-3 : std::min(1e-3, parts.allowed_jump);
}

DEM_INLINE double off_hold(const Parts& parts, PrescribedMotion& p, double time) {
  const integrator::Motion<double>& m = parts.bodies[p.spec.body.index()].motion;
  if (p.spec.target == MotionSpec::Target::pose) {
    const Pose pose = p.spec.pose(time);
    const double turned = std::sqrt(squared_norm(rotation_at(p, pose) - m.rotation));  // rad; 1e-3 is allowed
    return norm(centre_at(p, pose) - m.position) + allowed_off(parts, p) / 1e-3 * turned;
  }
  p.drive.value = p.spec.motion(time).value;
  if (p.spec.target == MotionSpec::Target::rotation) return norm(rotation_off(p, m));
  return p.drive.value - coordinate_of_drive(parts, p);
}

DEM_INLINE bool differs_from_saved(const PrescribedMotion& p, double time, double tolerance) {
  if (p.spec.target == MotionSpec::Target::pose) return true;  // which is compared whole
  if (p.drive.way.is_ahead()) return false;
  return std::abs(p.spec.motion(time).value - p.drive.value) > tolerance;
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE void check_holds(Parts& parts, double time) {
  for (PrescribedMotion& p : parts.motions) {
    if (!p.spec.on) continue;
    p.drive.time = time;
    p.drive.moves = false;
    if (p.spec.by_speed) {  // it starts from where its coordinate is
      p.drive.start = p.drive.reached = detail::coordinate_of_drive(parts, p);
      p.has_hold = true;
    }
    if (p.drive.way.is_ahead()) p.drive.way.from = detail::coordinate_of_drive(parts, p);
    if (p.has_hold && !p.was_loaded) [[likely]]
      continue;
    const double tolerance = detail::allowed_off(parts, p);
    if (std::exchange(p.was_loaded, false) && p.has_hold && !p.spec.by_speed) {
      p.has_hold = !detail::differs_from_saved(p, time, tolerance);
    }
    if (p.has_hold) continue;
    const double off = detail::off_hold(parts, p, time);
    if (std::abs(off) > tolerance) {
      fail(
          "prescribed motion '{}' is {:g} m or rad off at t = {:g} s, where it takes hold of its coordinate; allowed "
          "is {:g}: {}, or move a body",
          p.spec.name, std::abs(off), time, tolerance,
          p.spec.target == MotionSpec::Target::pose
              ? "let the pose of the body's reference frame, or of that in MotionSpec::frame, start there (set_pose)"
              : "let its signal start there (set_motion), say with starting_at what the joint's coordinate is at "
                "assembly");
    }
    p.has_hold = true;
    if (p.spec.target == MotionSpec::Target::joint) p.drive.value = detail::coordinate_of_drive(parts, p);
  }
}

}  // namespace dem::mbd

#endif
