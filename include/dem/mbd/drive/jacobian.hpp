#pragma once

// The coordinates that are driven at a time, as rows of one small system of equations. Each coordinate q has a Jacobian
// J on its bodies (a force along its axis at the joint's point, or a torque); with the bodies' masses M, impulses l
// change the coordinates by A l, A = J M^-1 J^T, so they follow from A l = error.

#include <dem/core/macros.hpp>
#include <dem/math/solve_positive.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dem::mbd::detail {

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

bool gives_way(const Parts& parts, std::uint32_t body);

/// The change of velocity (m/s) and angular velocity (rad/s, global) that an impulse gives a body.
Wrench response_of(const Body& x, const Wrench& impulse);

/// Angle (rad) and axis of the rotation that is left from what is wanted to what is.
Vector3<double> rotation_off(const PrescribedMotion& p, const integrator::Motion<double>& m);

/// The directions in which a joint holds its points: a correction of its angle must not part them.
void add_held_rows(Parts& parts, JacobianRow row, const Joint& j);

/// Lists the driven coordinates of bodies that give way, as they are now. For a correction of values what the driven
/// joints hold is listed too.
void fill_rows(Parts& parts, bool of_speed);

/// The lower triangle of J D J^T (n x n) of the rows, where `response(body, force and torque)` is a body's share of D.
template <class Response>
void fill_matrix(const Parts& parts, std::vector<double>& A, Response&& response) {
  const std::vector<JacobianRow>& rows = parts.rows;
  const std::size_t n = rows.size();
  A.assign(n * n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    const JacobianRow& row = rows[k];
    for (const bool on_b : {true, false}) {
      const std::uint32_t body = on_b ? row.b : row.a;
      if (!gives_way(parts, body)) continue;
      const Wrench velocity = response(parts.bodies[body], on_b ? push_on_b(row.now) : push_on_a(row.now));
      for (std::size_t l = 0; l <= k; ++l) {
        if (rows[l].b == body) A[k * n + l] += power(push_on_b(rows[l].now), velocity);
        if (rows[l].a == body) A[k * n + l] += power(push_on_a(rows[l].now), velocity);
      }
    }
  }
}

/// Leaves rows out of the matrix A (their diagonal becomes 0) that repeat rows before them, or lie within 1e-3 of what
/// they span. That is a matter of directions and levers alone: however unlike the masses are, a row of its own is met.
void leave_out_repeated(Parts& parts, std::vector<double>& A);

/// Turns the rows' errors of value or speed into the impulses that mend them. A row that repeats rows before it gets
/// none.
void solve_rows(Parts& parts, std::vector<double>& errors);

/// Hands every body the change of velocity (m/s, rad/s) that the rows' impulses give it.
template <class Change>
void push_bodies(Parts& parts, const std::vector<double>& impulses, Change&& change) {
  for (std::size_t k = 0; k < parts.rows.size(); ++k) {
    const JacobianRow& row = parts.rows[k];
    const auto push = [&](std::uint32_t body, const Wrench& along) {
      if (gives_way(parts, body)) change(parts.bodies[body], impulses[k] * response_of(parts.bodies[body], along));
    };
    push(row.b, push_on_b(row.now));
    push(row.a, push_on_a(row.now));
  }
}

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE bool gives_way(const Parts& parts, std::uint32_t body) {
  if (body == JacobianRow::no_body || parts.bodies[body].fixed) return false;
  for (const PrescribedMotion& p : parts.motions) {
    if (p.spec.on && p.spec.target == MotionSpec::Target::pose && p.spec.body.value == body) return false;
  }
  return true;
}

DEM_INLINE Wrench response_of(const Body& x, const Wrench& impulse) {
  const Vector3<double> t = transpose_times(x.motion.rotation, impulse.torque);
  return {(1.0 / x.mass) * impulse.force,
          x.motion.rotation * Vector3<double>{t.x / x.inertia[0], t.y / x.inertia[1], t.z / x.inertia[2]}};
}

DEM_INLINE Vector3<double> rotation_off(const PrescribedMotion& p, const integrator::Motion<double>& m) {
  const Matrix3<double> wanted = rotation_from_vector(p.drive.value * p.axis) * p.start_rotation;
  return vector_from_rotation(m.rotation * transposed(wanted));
}

DEM_INLINE void add_held_rows(Parts& parts, JacobianRow row, const Joint& j) {
  if (!row.now.rotation) return;
  row.is_held = true;
  for_each_held_axis(j, traits_of(j.kind).hold, [&](const Vector3<double>& axis_in_a) {
    row.now = displacement_along(axis_in_a, j, parts.bodies[j.a], parts.bodies[j.b]);
    parts.rows.push_back(row);
  });
}

DEM_INLINE void fill_rows(Parts& parts, bool of_speed) {
  parts.rows.clear();
  for (std::size_t i = 0; i < parts.motions.size(); ++i) {
    const PrescribedMotion& p = parts.motions[i];
    if (!p.spec.on || p.spec.target == MotionSpec::Target::pose) continue;
    const Body& x = parts.bodies[p.spec.body.index()];
    JacobianRow row;
    row.motion = static_cast<std::uint32_t>(i);
    row.b = p.spec.body.value;
    row.value = p.drive.value;
    row.rate = p.drive.rate;
    if (p.spec.target == MotionSpec::Target::joint) {
      const Joint& j = parts.joints[p.spec.joint.index()];
      row.a = j.a;
      row.now = coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], p.spec.dof);
      parts.rows.push_back(row);
      if (!of_speed) add_held_rows(parts, row, j);
    } else if (x.fixed) {
      continue;
    } else if (p.spec.target == MotionSpec::Target::position) {
      row.now.axis = p.axis;
      row.now.value = dot(x.motion.position, p.axis) - p.start;
      row.now.speed = dot(x.motion.velocity, p.axis);
      parts.rows.push_back(row);
    } else {
      const Vector3<double> off = rotation_off(p, x.motion), spin = x.motion.rotation * x.motion.angular_velocity;
      const Vector3<double> across = any_across(p.axis);
      for (const Vector3<double>& n : {p.axis, across, cross(p.axis, across)}) {
        row.now = {.rotation = true, .axis = n};
        row.now.value = row.value + dot(off, row.now.axis);
        row.now.speed = dot(spin, row.now.axis);
        parts.rows.push_back(row);
        row.is_reported = false;
        row.value = row.rate = 0.0;
      }
    }
  }
}

DEM_INLINE void leave_out_repeated(Parts& parts, std::vector<double>& A) {
  const std::vector<JacobianRow>& rows = parts.rows;
  const std::size_t n = rows.size();
  if (n < 2) return;
  double lever2 = 0.0;  // m^2, of the longest lever: what makes a turn comparable with a displacement
  for (const JacobianRow& r : rows) {
    if (r.now.rotation) continue;
    if (gives_way(parts, r.a)) lever2 = std::max(lever2, dot(r.now.arm_a, r.now.arm_a));
    if (gives_way(parts, r.b)) lever2 = std::max(lever2, dot(r.now.arm_b, r.now.arm_b));
  }
  const double turning = lever2 > 0.0 ? 1.0 / lever2 : 1.0;
  std::vector<double>& G = parts.drive_directions;
  fill_matrix(parts, G, [&](const Body&, const Wrench& w) { return Wrench{w.force, turning * w.torque}; });
  factorise_positive(G, n, 1e-6);
  for (std::size_t i = 0; i < n; ++i) {
    if (G[i * n + i] > 0.0) continue;
    for (std::size_t k = 0; k < n; ++k) A[std::max(i, k) * n + std::min(i, k)] = 0.0;
  }
}

DEM_INLINE void solve_rows(Parts& parts, std::vector<double>& errors) {
  fill_matrix(parts, parts.drive_matrix, response_of);
  leave_out_repeated(parts, parts.drive_matrix);
  solve_positive(parts.drive_matrix, errors);
}

}  // namespace dem::mbd::detail

#endif
