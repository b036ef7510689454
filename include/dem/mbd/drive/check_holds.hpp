#pragma once

#include <dem/mbd/drive/prescribe.hpp>

#include <cmath>

namespace dem::mbd {

/// Throws Error if a motion that is on would have to jump at `time` (s) to take hold of its coordinate, which would
/// tear the machine apart. To be called before each step.
inline void check_holds(Parts& parts, double time) {
  constexpr double tolerance = 1e-3;  // m or rad
  for (PrescribedMotion& p : parts.motions) {
    if (!p.spec.on) continue;
    if (p.spec.by_speed) {  // it starts from where its coordinate is
      p.drive.start = p.drive.reached = detail::coordinate_of_drive(parts, p);
      p.drive.time = time;
      p.drive.moves = false;
      p.has_hold = true;
    }
    if (p.has_hold) continue;
    const integrator::Motion<double>& m = parts.bodies[p.spec.body.index()].motion;
    double off = 0.0;
    if (p.spec.target == MotionSpec::Target::pose) {
      const Pose pose = p.spec.pose(time);
      off = norm(detail::centre_at(p, pose) - m.position) +
            std::sqrt(squared_norm(detail::rotation_at(p, pose) - m.rotation));
    } else {
      p.drive.value = p.spec.motion(time).value;
      if (p.spec.target == MotionSpec::Target::position) {
        off = p.start + p.drive.value - dot(m.position, p.axis);
      } else if (p.spec.target == MotionSpec::Target::rotation) {
        off = norm(detail::rotation_off(p, m));
      } else {
        const Joint& j = parts.joints[p.spec.joint.index()];
        off = p.drive.value - coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], p.spec.dof).value;
      }
    }
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
  }
}

}  // namespace dem::mbd
