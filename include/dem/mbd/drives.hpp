#pragma once

// Prescribed motion (eq. 19): the impulses that bring every driven coordinate to its value and speed, all at once. Each
// coordinate q of the rows has a Jacobian J on its bodies (a force along its axis at the joint's point, or a torque);
// with the bodies' masses M, impulses l change the coordinates by A l, A = J M^-1 J^T, so they follow from A l = error.

#include <dem/math/solve_positive.hpp>
#include <dem/mbd/parts.hpp>

#include <algorithm>
#include <cmath>

namespace dem::mbd {

namespace detail {

/// A force or an impulse on a body: N or N s, and N m or N m s about the centre of mass; global.
inline Wrench push_on_b(const Coordinate& q) {
  return q.rotation ? Wrench{{0, 0, 0}, q.axis} : Wrench{q.axis, cross(q.arm_b, q.axis)};
}
inline Wrench push_on_a(const Coordinate& q) {
  return q.rotation ? Wrench{{0, 0, 0}, -q.axis} : Wrench{-q.axis, -cross(q.arm_a, q.axis)};
}
inline double power(const Wrench& w, const Wrench& velocity) {
  return dot(w.force, velocity.force) + dot(w.torque, velocity.torque);
}

inline bool gives_way(const Parts& parts, std::uint32_t body) {
  if (body == DriveRow::no_body || parts.bodies[body].fixed) return false;
  for (const PrescribedMotion& p : parts.motions) {
    if (p.spec.on && p.spec.target == MotionSpec::Target::pose && p.spec.body.value == body) return false;
  }
  return true;
}

/// The change of velocity (m/s) and angular velocity (rad/s, global) that an impulse gives a body.
inline Wrench response_of(const Body& x, const Wrench& impulse) {
  const Vector3<double> t = transpose_times(x.motion.rotation, impulse.torque);
  return {(1.0 / x.mass) * impulse.force,
          x.motion.rotation * Vector3<double>{t.x / x.inertia[0], t.y / x.inertia[1], t.z / x.inertia[2]}};
}

/// Sets a body whose pose is prescribed.
inline void carry(PrescribedMotion& p, integrator::Motion<double>& m, double time) {
  const Pose pose = p.spec.pose(time);
  m.position = from_eigen(pose.position);
  m.rotation = from_eigen(pose.rotation);
  Vec3 velocity = pose.velocity.value_or(Vec3::Zero()), spin = pose.angular_velocity.value_or(Vec3::Zero());
  if (!pose.velocity || !pose.angular_velocity) {
    constexpr double h = 1e-6;
    const Pose before = p.spec.pose(time - h), after = p.spec.pose(time + h);
    if (!pose.velocity) velocity = (after.position - before.position) / (2.0 * h);
    if (!pose.angular_velocity) {
      const Mat3 r = after.rotation * before.rotation.transpose();  // its skew part is the small turn between the two
      spin = Vec3(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)) / (4.0 * h);
    }
  }
  m.velocity = from_eigen(velocity);
  m.angular_velocity = transpose_times(m.rotation, from_eigen(spin));
  p.drive.value = m.position.x + m.position.y + m.position.z;  // only to tell whether it is a number
}

/// Angle (rad) and axis of the rotation that is left from what is wanted to what is.
inline Vector3<double> rotation_off(const PrescribedMotion& p, const integrator::Motion<double>& m) {
  const Matrix3<double> wanted = rotation_from_vector(p.drive.value * p.axis) * p.start_rotation;
  const Eigen::AngleAxisd off(to_eigen(m.rotation) * to_eigen(wanted).transpose());
  return from_eigen(Vec3(off.angle() * off.axis()));
}

/// Sets the position or the rotation of a fixed body.
inline void carry_fixed(const PrescribedMotion& p, integrator::Motion<double>& m) {
  const PrescribedMotion::Drive& d = p.drive;
  if (p.spec.target == MotionSpec::Target::position) {
    m.position += (p.start + d.value - dot(m.position, p.axis)) * p.axis;
    m.velocity += (d.rate - dot(m.velocity, p.axis)) * p.axis;
  } else {
    m.rotation = rotation_from_vector(d.value * p.axis) * p.start_rotation;
    m.angular_velocity = transpose_times(m.rotation, d.rate * p.axis);
  }
}

/// Samples the signals, and sets the bodies that give way to nothing.
inline void sample_motions(Parts& parts, double time) {
  for (PrescribedMotion& p : parts.motions) {
    if (!p.spec.on) continue;
    Body& x = parts.bodies[p.spec.body.index()];
    if (p.spec.target == MotionSpec::Target::pose) {
      carry(p, x.motion, time);
      continue;
    }
    const Signal::Sample s = p.spec.motion(time);
    p.drive.value = s.value;
    p.drive.rate = s.rate;
    if (x.fixed && p.spec.target != MotionSpec::Target::joint) carry_fixed(p, x.motion);
  }
}

/// The directions in which a joint holds its points: a correction of its angle must not part them.
inline void add_held_rows(Parts& parts, DriveRow row, const Joint& j) {
  const Hold hold = hold_of(j.kind);
  if (!row.now.rotation || hold == Hold::nothing || hold == Hold::length || hold == Hold::bushing) return;
  row.is_held = true;
  const auto add = [&](const Vector3<double>& axis_in_a) {
    row.now = displacement_along(axis_in_a, j, parts.bodies[j.a], parts.bodies[j.b]);
    parts.drive_rows.push_back(row);
  };
  if (hold != Hold::plane) add(j.axes_a.x);
  if (hold != Hold::plane) add(j.axes_a.y);
  if (hold != Hold::line) add(j.axes_a.z);
}

/// Lists the driven coordinates of bodies that give way, as they are now. For a correction of values those that are
/// driven by speed want to stay where they are, and what the driven joints hold is listed too.
inline void fill_rows(Parts& parts, bool of_speed) {
  parts.drive_rows.clear();
  for (std::size_t i = 0; i < parts.motions.size(); ++i) {
    const PrescribedMotion& p = parts.motions[i];
    if (!p.spec.on || p.spec.target == MotionSpec::Target::pose) continue;
    const Body& x = parts.bodies[p.spec.body.index()];
    DriveRow row;
    row.motion = static_cast<std::uint32_t>(i);
    row.b = p.spec.body.value;
    row.value = p.drive.value;
    row.rate = p.drive.rate;
    if (p.spec.target == MotionSpec::Target::joint) {
      const Joint& j = parts.joints[p.spec.joint.index()];
      row.a = j.a;
      row.now = coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], p.spec.freedom);
      if (p.spec.by_speed) row.value = row.now.value;
      parts.drive_rows.push_back(row);
      if (!of_speed) add_held_rows(parts, row, j);
    } else if (x.fixed) {
      continue;
    } else if (p.spec.target == MotionSpec::Target::position) {
      row.now.axis = p.axis;
      row.now.value = dot(x.motion.position, p.axis) - p.start;
      row.now.speed = dot(x.motion.velocity, p.axis);
      parts.drive_rows.push_back(row);
    } else {
      const Vector3<double> off = rotation_off(p, x.motion), spin = x.motion.rotation * x.motion.angular_velocity;
      const Vec3 axis = to_eigen(p.axis), across = axis.unitOrthogonal();
      for (const Vec3& n : {axis, across, Vec3(axis.cross(across))}) {
        row.now = {.rotation = true, .axis = from_eigen(n)};
        row.now.value = row.value + dot(off, row.now.axis);
        row.now.speed = dot(spin, row.now.axis);
        parts.drive_rows.push_back(row);
        row.is_reported = false;
        row.value = row.rate = 0.0;
      }
    }
  }
}

/// Turns the rows' errors of value or speed into the impulses that mend them. A row that depends on rows before it gets
/// none.
inline void solve_rows(Parts& parts, std::vector<double>& errors) {
  const std::vector<DriveRow>& rows = parts.drive_rows;
  const std::size_t n = rows.size();
  std::vector<double>& A = parts.drive_matrix;
  A.assign(n * n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const DriveRow& row = rows[k];
    for (const bool on_b : {true, false}) {
      const std::uint32_t body = on_b ? row.b : row.a;
      if (!gives_way(parts, body)) continue;
      const Wrench velocity = response_of(parts.bodies[body], on_b ? push_on_b(row.now) : push_on_a(row.now));
      for (std::size_t l = 0; l <= k; ++l) {
        if (rows[l].b == body) A[k * n + l] += power(push_on_b(rows[l].now), velocity);
        if (rows[l].a == body) A[k * n + l] += power(push_on_a(rows[l].now), velocity);
      }
    }
  }
  solve_positive(A, errors);
}

/// Hands every body the change of velocity (m/s, rad/s) that the rows' impulses give it.
template <class Change>
void push_bodies(Parts& parts, const std::vector<double>& impulses, Change&& change) {
  for (std::size_t k = 0; k < parts.drive_rows.size(); ++k) {
    const DriveRow& row = parts.drive_rows[k];
    const auto push = [&](std::uint32_t body, const Wrench& along) {
      if (gives_way(parts, body)) change(parts.bodies[body], impulses[k] * response_of(parts.bodies[body], along));
    };
    push(row.b, push_on_b(row.now));
    push(row.a, push_on_a(row.now));
  }
}

/// What the drives put on a fixed body goes to its own drive; along or about its axis.
inline double impulse_on(const Parts& parts, const PrescribedMotion& p, const std::vector<double>& impulses) {
  const bool rotation = p.spec.target == MotionSpec::Target::rotation;
  double sum = 0.0;
  for (std::size_t k = 0; k < parts.drive_rows.size(); ++k) {
    const DriveRow& row = parts.drive_rows[k];
    Wrench w;
    if (row.b == p.spec.body.value) w = w + push_on_b(row.now);
    if (row.a == p.spec.body.value) w = w + push_on_a(row.now);
    sum += impulses[k] * dot(p.axis, rotation ? w.torque : w.force);
  }
  return sum;
}

/// Adds the impulses to those of their motions, and reports forces if dt > 0 (s).
inline void report_forces(Parts& parts, const std::vector<double>& impulses, double dt) {
  for (std::size_t k = 0; k < parts.drive_rows.size(); ++k) {
    const DriveRow& row = parts.drive_rows[k];
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

/// Newton's iteration to the values: one is exact but for rotations, each squares what is left.
inline void correct_values(Parts& parts) {
  using V = Vector3<double>;
  std::vector<double>&x = parts.drive_errors, &held = parts.drive_held;
  for (int k = 0; k < 5; ++k) {
    fill_rows(parts, false);
    if (k == 0) {
      held.clear();
      for (const DriveRow& r : parts.drive_rows) held.push_back(r.now.value);
    }
    x.clear();
    bool met = true;
    for (std::size_t i = 0; i < parts.drive_rows.size(); ++i) {
      const DriveRow& r = parts.drive_rows[i];
      const double off = (r.is_held ? held[i] : r.value) - r.now.value;
      x.push_back(off);
      met &= std::abs(off) <= 1e-15 * std::max(1.0, std::abs(r.value));
    }
    if (met) break;
    solve_rows(parts, x);
    push_bodies(parts, x, [](Body& b, const Wrench& by) {
      b.motion.position += by.force;
      const V spin = b.motion.rotation * b.motion.angular_velocity;  // global, unchanged
      b.motion.rotation = rotation_from_vector(by.torque) * b.motion.rotation;
      b.motion.angular_velocity = transpose_times(b.motion.rotation, spin);
    });
  }
}

}  // namespace detail

/// Sets the prescribed values and speeds for `time` (s). `dt` (s) is the time since the drives' forces were reported; 0
/// where the step is not over, and none are.
inline void apply_motions(Parts& parts, double time, double dt) {
  detail::sample_motions(parts, time);
  detail::correct_values(parts);
  detail::fill_rows(parts, true);
  std::vector<double>& x = parts.drive_errors;
  x.clear();
  for (const DriveRow& r : parts.drive_rows) x.push_back(r.rate - r.now.speed);
  detail::solve_rows(parts, x);
  detail::push_bodies(parts, x, [](Body& b, const Wrench& by) {
    b.motion.velocity += by.force;
    b.motion.angular_velocity += transpose_times(b.motion.rotation, by.torque);
  });
  detail::report_forces(parts, x, dt);
}

}  // namespace dem::mbd
