#pragma once

// What joints, couplings and prescribed motions hold, as rows of one system of equations: each row is a direction in
// the space of all bodies' velocities, along which nothing may move. With the bodies' masses M, impulses l along the
// rows J change the speeds along them by A l, A = J M^-1 J^T.

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/jacobian.hpp>
#include <dem/mbd/joint/align.hpp>
#include <dem/mbd/joint/locked_shafts.hpp>

#include <cstdint>
#include <vector>

namespace dem::mbd::detail {

/// One row: what a unit impulse along it puts on each of its bodies.
struct HeldRow {
  struct Side {
    std::uint32_t body;
    Wrench push;  ///< about the centre of mass, global
  };
  std::vector<Side> sides;
  double rate = 0.0;   ///< wanted, m/s or rad/s
  double error = 0.0;  ///< m or rad, by which a joint or a coupling is off along it; of prescribed motions 0
};

HeldRow row_of(const Coordinate& q, std::uint32_t a, std::uint32_t b, double rate = 0.0, double error = 0.0);

/// The rows of a joint: of displacements if `holds`, of rotations if `aligns`.
void add_rows(const Parts& m, const Joint& j, bool holds, bool aligns, std::vector<HeldRow>& rows);

/// All that is held without give of its own: joints and couplings whose stiffness is derived, and what is prescribed.
/// Fills the scratch of the prescribed motions.
std::vector<HeldRow> held_rows(Parts& m);

/// The speed along a row.
double speed_of(const Parts& m, const HeldRow& row);

/// The impulses along the rows that give them `rates`, in place. `response(body, impulse)` is the change of velocity
/// that an impulse gives a body, of those that give way. Rows that others make up but for a share below `tolerance` get
/// none (solve_positive).
template <class Response>
void solve_held(const Parts& m, const std::vector<HeldRow>& rows, std::vector<double>& rates, Response&& response,
                double tolerance = 1e-13) {
  struct On {
    std::size_t row;
    const Wrench* push;
  };
  std::vector<std::vector<On>> on(m.bodies.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const HeldRow::Side& s : rows[k].sides) on[s.body].push_back({k, &s.push});
  }
  const std::size_t n = rows.size();
  std::vector<double> A(n * n, 0.0);
  for (std::size_t i = 0; i < on.size(); ++i) {
    if (!gives_way(m, static_cast<std::uint32_t>(i))) continue;
    for (const On& k : on[i]) {
      const Wrench velocity = response(i, *k.push);
      for (const On& l : on[i]) {
        if (l.row <= k.row) A[k.row * n + l.row] += power(*l.push, velocity);
      }
    }
  }
  solve_positive(A, rates, tolerance);
}

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE HeldRow row_of(const Coordinate& q, std::uint32_t a, std::uint32_t b, double rate, double error) {
  HeldRow row;
  row.error = error;
  row.rate = rate;
  if (b != JacobianRow::no_body) row.sides.push_back({b, push_on_b(q)});
  if (a != JacobianRow::no_body) row.sides.push_back({a, push_on_a(q)});
  return row;
}

DEM_INLINE void add_rows(const Parts& m, const Joint& j, bool holds, bool aligns, std::vector<HeldRow>& rows) {
  const Body &a = m.bodies[j.a], &b = m.bodies[j.b];
  const JointTraits& traits = traits_of(j.kind);
  if (holds && traits.hold == Hold::length) {
    const Coordinate q = distance_of(j.point_a, j.point_b, a, b);
    rows.push_back(row_of(q, j.a, j.b, 0.0, q.value - j.length));
  }
  if (holds) {
    for_each_held_axis(j, traits.hold, [&](const Vector3<double>& axis) {
      const Coordinate q = displacement_along(axis, j, a, b);
      rows.push_back(row_of(q, j.a, j.b, 0.0, q.value));
    });
  }
  if (!aligns) return;
  const Vector3<double> off = rotation_off(j, traits.align, a.motion.rotation, b.motion.rotation);
  for_each_held_rotation(j, traits.align, a.motion.rotation, b.motion.rotation, [&](const Vector3<double>& axis) {
    rows.push_back(row_of(rotation_about(axis, 0.0, a, b), j.a, j.b, 0.0, dot(off, axis)));
  });
}

DEM_INLINE std::vector<HeldRow> held_rows(Parts& m) {
  std::vector<HeldRow> rows;
  fill_rows(m, true);
  for (const JacobianRow& r : m.rows) rows.push_back(row_of(r.now, r.a, r.b, r.rate));
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const JointSpec& s = m.joint_specs[i];
    if (traits_of(s.kind).stiffness != Stiffness::derived || !is_on(m.joints[i])) continue;
    add_rows(m, m.joints[i], !s.stiffness, !s.rotational_stiffness, rows);
  }
  for (const Coupling& g : m.couplings) {
    if (g.spec.stiffness || !is_on(g.spec)) continue;
    HeldRow row;
    row.error = coupling_sum(g.spec, m.joints, m.bodies) - g.offset;
    for (const auto& term : g.spec.terms) {
      const Joint& j = m.joints[term.joint.index()];
      const Coordinate q = coordinate_of(j, m.bodies[j.a], m.bodies[j.b], term.dof);
      row.sides.push_back({j.b, term.ratio * push_on_b(q)});
      row.sides.push_back({j.a, term.ratio * push_on_a(q)});
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

DEM_INLINE double speed_of(const Parts& m, const HeldRow& row) {
  double sum = 0.0;
  for (const HeldRow::Side& s : row.sides) {
    const integrator::Motion<double>& x = m.bodies[s.body].motion;
    sum += power(s.push, {x.velocity, x.rotation * x.angular_velocity});
  }
  return sum;
}

}  // namespace dem::mbd::detail

#endif
