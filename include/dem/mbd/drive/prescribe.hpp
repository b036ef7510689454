#pragma once

// Prescribed motion (eq. 19): the impulses that bring every driven coordinate to its value and speed, all at once.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/jacobian.hpp>

#include <algorithm>
#include <cmath>

namespace dem::mbd {

namespace detail {

/// Where a pose puts the centre of mass (m), and the body frame's rotation.
inline Vector3<double> centre_at(const PrescribedMotion& p, const Pose& pose) {
  return from_eigen(pose.position) + from_eigen(pose.rotation) * p.centre;
}
inline Matrix3<double> rotation_at(const PrescribedMotion& p, const Pose& pose) {
  return from_eigen(pose.rotation) * p.axes;
}

/// Sets a body whose pose is prescribed.
void carry(PrescribedMotion& p, integrator::Motion<double>& m, double time);

/// Sets the position or the rotation of a fixed body.
void carry_fixed(const PrescribedMotion& p, integrator::Motion<double>& m);

/// Where the coordinate of a motion, but not of a pose, is now (m or rad); a body's turn in the round of the value that
/// was set last.
double coordinate_of_drive(const Parts& parts, const PrescribedMotion& p);

/// Notes where a step starts that ends at `time` (s). All its stages ask for the same time.
void start_step(PrescribedMotion& p, double time);

/// The value of a motion by speed at the end of a step of dt (s): that at its start, and the integral of its speed. The
/// start is where the coordinate was, not where it should have been: what another drive or a user moved is not made up
/// for.
double integrated(const PrescribedMotion& p, double time, double dt, double rate);

/// Samples the signals. Sets the bodies that no force moves: fixed ones, and those whose pose is prescribed.
void sample_motions(Parts& parts, double time, double dt);

/// What the drives put on a fixed body goes to its own drive; along or about its axis.
double impulse_on(const Parts& parts, const PrescribedMotion& p, const std::vector<double>& impulses);

/// Adds the impulses to those of their motions, and reports forces if dt > 0 (s).
void report_forces(Parts& parts, const std::vector<double>& impulses, double dt);

/// Moves bodies by what the rows' corrections give them; their spins stay.
void shift_bodies(Parts& parts, std::vector<double>& corrections);

/// Takes back how far forces moved driven coordinates within the step: as the impulses do that take back their speeds,
/// whatever that does to the joints. If it were done about the joints' points, speeds and positions would not fit: a
/// hinge beside a centre of mass would stand with a speed of its own, which its damper takes for slip.
void take_back_moves(Parts& parts);

/// Newton's iteration to the values: one is exact but for rotations, each squares what is left.
void correct_values(Parts& parts);

}  // namespace detail

/// Sets the prescribed values and speeds for `time` (s) in steps of `dt` (s; 0: not known). The drives' forces are
/// reported where the step is over.
void apply_motions(Parts& parts, double time, double dt, bool is_over);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void carry(PrescribedMotion& p, integrator::Motion<double>& m, double time) {
  using V = Vector3<double>;
  const Pose pose = p.spec.pose(time);
  m.position = centre_at(p, pose);
  m.rotation = rotation_at(p, pose);
  V velocity = pose.velocity ? from_eigen(*pose.velocity) : V{0, 0, 0};
  V spin = pose.angular_velocity ? from_eigen(*pose.angular_velocity) : V{0, 0, 0};
  if (!pose.velocity || !pose.angular_velocity) {
    constexpr double h = 1e-6;
    const Pose before = p.spec.pose(time - h), after = p.spec.pose(time + h);
    if (!pose.velocity) velocity = (from_eigen(after.position) - from_eigen(before.position)) / (2.0 * h);
    if (!pose.angular_velocity) {  // the skew part of the small turn between the two
      const Matrix3<double> r = from_eigen(after.rotation) * transposed(from_eigen(before.rotation));
      spin = V{r.row2.y - r.row1.z, r.row0.z - r.row2.x, r.row1.x - r.row0.y} / (4.0 * h);
    }
  }
  m.velocity = velocity + cross(spin, from_eigen(pose.rotation) * p.centre);
  m.angular_velocity = transpose_times(m.rotation, spin);
  const V all = m.position + m.velocity + m.angular_velocity;
  p.drive.value = all.x + all.y + all.z;  // only to tell whether all of it are numbers
}

DEM_INLINE void carry_fixed(const PrescribedMotion& p, integrator::Motion<double>& m) {
  const PrescribedMotion::Drive& d = p.drive;
  if (p.spec.target == MotionSpec::Target::position) {
    m.position += (p.start + d.value - dot(m.position, p.axis)) * p.axis;
    m.velocity += (d.rate - dot(m.velocity, p.axis)) * p.axis;
  } else {
    m.rotation = rotation_from_vector(d.value * p.axis) * p.start_rotation;
    m.angular_velocity = transpose_times(m.rotation, d.rate * p.axis);
  }
}

DEM_INLINE double coordinate_of_drive(const Parts& parts, const PrescribedMotion& p) {
  const integrator::Motion<double>& m = parts.bodies[p.spec.body.index()].motion;
  if (p.spec.target == MotionSpec::Target::position) return dot(m.position, p.axis) - p.start;
  if (p.spec.target == MotionSpec::Target::rotation) return p.drive.value + dot(rotation_off(p, m), p.axis);
  const Joint& j = parts.joints[p.spec.joint.index()];
  return coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], p.spec.dof).value;
}

DEM_INLINE void start_step(PrescribedMotion& p, double time) {
  PrescribedMotion::Drive& d = p.drive;
  if (time == d.time) return;
  d.start = p.spec.by_speed ? d.reached : d.value;
  d.start_rate = d.rate;
  d.time = time;
  d.moves = true;
}

DEM_INLINE double integrated(const PrescribedMotion& p, double time, double dt, double rate) {
  const PrescribedMotion::Drive& d = p.drive;
  if (!d.moves || dt <= 0.0) return d.start;
  const double at_start = p.spec.motion(time - dt, dt).rate, half_way = p.spec.motion(time - 0.5 * dt, dt).rate;
  return d.start + dt / 6.0 * (at_start + 4.0 * half_way + rate);
}

DEM_INLINE void sample_motions(Parts& parts, double time, double dt) {
  for (PrescribedMotion& p : parts.motions) {
    if (!p.spec.on) continue;
    Body& x = parts.bodies[p.spec.body.index()];
    if (p.spec.target == MotionSpec::Target::pose) {
      carry(p, x.motion, time);
      continue;
    }
    PrescribedMotion::Drive& d = p.drive;
    const Signal::Sample s = p.spec.motion(time, dt);
    start_step(p, time);
    d.rate = s.rate;
    d.value = p.spec.by_speed ? integrated(p, time, dt, s.rate) : d.way.at(time, s);
    d.expected = p.spec.by_speed ? d.value : d.start + 0.5 * dt * (d.start_rate + s.rate);
    if (x.fixed && p.spec.target != MotionSpec::Target::joint) carry_fixed(p, x.motion);
  }
}

DEM_INLINE double impulse_on(const Parts& parts, const PrescribedMotion& p, const std::vector<double>& impulses) {
  const bool rotation = p.spec.target == MotionSpec::Target::rotation;
  double sum = 0.0;
  for (std::size_t k = 0; k < parts.rows.size(); ++k) {
    const JacobianRow& row = parts.rows[k];
    Wrench w;
    if (row.b == p.spec.body.value) w = w + push_on_b(row.now);
    if (row.a == p.spec.body.value) w = w + push_on_a(row.now);
    sum += impulses[k] * dot(p.axis, rotation ? w.torque : w.force);
  }
  return sum;
}

DEM_INLINE void report_forces(Parts& parts, const std::vector<double>& impulses, double dt) {
  for (std::size_t k = 0; k < parts.rows.size(); ++k) {
    const JacobianRow& row = parts.rows[k];
    if (row.is_reported) parts.motions[row.motion].drive.impulse += impulses[k];
  }
  for (PrescribedMotion& p : parts.motions) {
    PrescribedMotion::Drive& d = p.drive;
    const Body& x = parts.bodies[p.spec.body.index()];
    const bool moves_fixed = p.spec.on && x.fixed && p.spec.target != MotionSpec::Target::joint;
    if (moves_fixed) d.impulse -= impulse_on(parts, p, impulses);
    if (dt <= 0.0) continue;
    d.force = p.spec.on ? d.impulse / dt : 0.0;
    if (moves_fixed) d.force -= dot(p.axis, p.spec.target == MotionSpec::Target::rotation ? x.torque : x.force);
    d.impulse = 0.0;
  }
}

DEM_INLINE void shift_bodies(Parts& parts, std::vector<double>& corrections) {
  using V = Vector3<double>;
  solve_rows(parts, corrections);
  push_bodies(parts, corrections, [](Body& b, const Wrench& by) {
    b.motion.position += by.force;
    const V spin = b.motion.rotation * b.motion.angular_velocity;  // global, unchanged
    b.motion.rotation = rotation_from_vector(by.torque) * b.motion.rotation;
    b.motion.angular_velocity = transpose_times(b.motion.rotation, spin);
  });
}

DEM_INLINE void take_back_moves(Parts& parts) {
  fill_rows(parts, true);
  std::vector<double>& x = parts.drive_errors;
  x.clear();
  bool turns_joints = false;  // all others are moved the same below
  for (const JacobianRow& r : parts.rows) {
    const PrescribedMotion::Drive& d = parts.motions[r.motion].drive;
    const double off = r.value - r.now.value, by_forces = off - (r.is_reported ? d.value - d.expected : 0.0);
    x.push_back(d.moves ? std::clamp(by_forces, std::min(off, 0.0), std::max(off, 0.0)) : 0.0);
    turns_joints |= r.now.rotation && r.a != JacobianRow::no_body && x.back() != 0.0;
  }
  if (turns_joints) shift_bodies(parts, x);
}

DEM_INLINE void correct_values(Parts& parts) {
  take_back_moves(parts);
  std::vector<double>&x = parts.drive_errors, &held = parts.drive_held;
  for (int k = 0; k < 5; ++k) {
    fill_rows(parts, false);
    if (k == 0) {
      held.clear();
      for (const JacobianRow& r : parts.rows) held.push_back(r.now.value);
    }
    x.clear();
    bool met = true;
    for (std::size_t i = 0; i < parts.rows.size(); ++i) {
      const JacobianRow& r = parts.rows[i];
      const double off = (r.is_held ? held[i] : r.value) - r.now.value;
      x.push_back(off);
      met &= std::abs(off) <= 1e-15 * std::max(1.0, std::abs(r.value));
    }
    if (met) break;
    shift_bodies(parts, x);
  }
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE void apply_motions(Parts& parts, double time, double dt, bool is_over) {
  if (parts.motions.empty()) return;
  detail::sample_motions(parts, time, dt);
  detail::correct_values(parts);
  for (PrescribedMotion& p : parts.motions) {
    if (p.spec.by_speed) p.drive.reached = detail::coordinate_of_drive(parts, p);
  }
  detail::fill_rows(parts, true);
  std::vector<double>& x = parts.drive_errors;
  x.clear();
  for (const JacobianRow& r : parts.rows) x.push_back(r.rate - r.now.speed);
  detail::solve_rows(parts, x);
  detail::push_bodies(parts, x, [](Body& b, const Wrench& by) {
    b.motion.velocity += by.force;
    b.motion.angular_velocity += transpose_times(b.motion.rotation, by.torque);
  });
  detail::report_forces(parts, x, is_over ? dt : 0.0);
}

}  // namespace dem::mbd

#endif
