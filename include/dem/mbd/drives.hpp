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

/// Sets what is fixed or wholly prescribed, and lists the other driven coordinates with their present state.
inline void fill_rows(Parts& parts, double time) {
  using V = Vector3<double>;
  parts.drive_rows.clear();
  for (std::size_t i = 0; i < parts.motions.size(); ++i) {
    PrescribedMotion& p = parts.motions[i];
    if (!p.spec.on) continue;
    integrator::Motion<double>& m = parts.bodies[p.spec.body.index()].motion;
    if (p.spec.target == MotionSpec::Target::pose) {
      const Pose pose = p.spec.pose(time);
      m.position = from_eigen(pose.position);
      m.velocity = from_eigen(pose.velocity);
      m.rotation = from_eigen(pose.rotation);
      m.angular_velocity = transpose_times(m.rotation, from_eigen(pose.angular_velocity));
      continue;
    }
    const Signal::Sample s = p.spec.motion(time);
    p.drive.value = s.value;
    p.drive.rate = s.rate;
    DriveRow row;
    row.motion = static_cast<std::uint32_t>(i);
    row.b = p.spec.body.value;
    row.value = s.value;
    row.rate = s.rate;
    const bool fixed = parts.bodies[row.b].fixed;
    if (p.spec.target == MotionSpec::Target::joint) {
      const Joint& j = parts.joints[p.spec.joint.index()];
      row.a = j.a;
      row.now = coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], p.spec.freedom);
      parts.drive_rows.push_back(row);
    } else if (p.spec.target == MotionSpec::Target::position) {
      row.now.axis = p.axis;
      row.now.value = dot(m.position, p.axis) - p.start;
      row.now.speed = dot(m.velocity, p.axis);
      if (fixed) {
        m.position += (s.value - row.now.value) * p.axis;
        m.velocity += (s.rate - row.now.speed) * p.axis;
      } else {
        parts.drive_rows.push_back(row);
      }
    } else {
      const Matrix3<double> wanted = rotation_from_vector(s.value * p.axis) * p.start_rotation;
      if (fixed) {
        m.rotation = wanted;
        m.angular_velocity = transpose_times(wanted, s.rate * p.axis);
        continue;
      }
      const Eigen::AngleAxisd off(to_eigen(m.rotation) * to_eigen(wanted).transpose());
      const V rotation = from_eigen(Vec3(off.angle() * off.axis()));
      const V spin = m.rotation * m.angular_velocity;
      const Vec3 axis = to_eigen(p.axis), across = axis.unitOrthogonal();
      for (const Vec3& n : {axis, across, Vec3(axis.cross(across))}) {
        row.now = {.rotation = true, .axis = from_eigen(n)};
        row.now.value = (row.is_reported ? s.value : 0.0) + dot(rotation, row.now.axis);
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
    const double size = impulses[k];
    if (gives_way(parts, row.b))
      change(parts.bodies[row.b], size * response_of(parts.bodies[row.b], push_on_b(row.now)));
    if (gives_way(parts, row.a))
      change(parts.bodies[row.a], size * response_of(parts.bodies[row.a], push_on_a(row.now)));
  }
}

/// What the other drives put on a fixed body goes to its own drive; along or about its axis.
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

}  // namespace detail

/// Sets the prescribed values and speeds for `time` (s). `dt` (s) is the time since the drives' forces were reported; 0
/// where the step is not over, and none are.
inline void apply_motions(Parts& parts, double time, double dt) {
  using V = Vector3<double>;
  std::vector<double>& x = parts.drive_errors;
  for (int k = 0; k < 5; ++k) {  // Newton's iteration: one is exact but for rotations, each squares what is left
    detail::fill_rows(parts, time);
    x.clear();
    for (const DriveRow& r : parts.drive_rows) x.push_back(r.value - r.now.value);
    if (std::all_of(x.begin(), x.end(), [](double e) { return std::abs(e) < 1e-15; })) break;
    detail::solve_rows(parts, x);
    detail::push_bodies(parts, x, [](Body& b, const Wrench& by) {
      b.motion.position += by.force;
      const V spin = b.motion.rotation * b.motion.angular_velocity;  // global, unchanged
      b.motion.rotation = rotation_from_vector(by.torque) * b.motion.rotation;
      b.motion.angular_velocity = transpose_times(b.motion.rotation, spin);
    });
  }
  detail::fill_rows(parts, time);
  x.clear();
  for (const DriveRow& r : parts.drive_rows) x.push_back(r.rate - r.now.speed);
  detail::solve_rows(parts, x);
  detail::push_bodies(parts, x, [](Body& b, const Wrench& by) {
    b.motion.velocity += by.force;
    b.motion.angular_velocity += transpose_times(b.motion.rotation, by.torque);
  });
  detail::report_forces(parts, x, dt);
}

/// Throws Error if a motion does not start where its coordinate is: it would tear the machine apart.
inline void check_starts(Parts& parts, double time) {
  constexpr double tolerance = 1e-3;  // m or rad
  detail::fill_rows(parts, time);
  for (const DriveRow& r : parts.drive_rows) {
    if (std::abs(r.value - r.now.value) > tolerance) {
      fail(
          "prescribed motion '{}' is {:g} at t = {:g} s, but its coordinate is {:g} (m or rad), further than {:g} off: "
          "let it start there, say with starting_at what the joint's coordinate is at assembly, or move a body",
          parts.motions[r.motion].spec.name, r.value, time, r.now.value, tolerance);
    }
  }
}

}  // namespace dem::mbd
