#pragma once

// What acts along the line between two points, a spring or a ram, also holds them across it where it pulls: as a taut
// string does, with the tension over the length. And it turns each body towards the line, as weight turns a pendulum.
// With the stiffness k along the line n, the tension T, the length L and the arm r from a centre of mass,
//   K = k n n^T + T/L (1 - n n^T) at the two points,   T (|r| + r.p) / 2 at most about the centre of mass,
// where p is the direction in which the body is pulled. What pushes lowers the frequencies, which is left out.

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

#include <cmath>

namespace dem::mbd::detail {

/// The force (N) in a line, positive where it pulls, with its stiffness (N/m) and damping (N s/m).
struct LineForce {
  double stiffness, damping, tension;
};

/// 1/s^2, of a body that is pulled along a unit vector (global) at `arm` from its centre of mass, on its side of a
/// line.
double pulled_frequency(const Body& b, const Vector3<double>& arm, const Vector3<double>& pull, const LineForce& line,
                        double length);

/// Lists what acts along the line between two points, whose distance is `q`.
void add_line_element(std::vector<Element>& list, const Parts& m, const PartKind& kind, std::size_t index,
                      std::uint32_t a, std::uint32_t b, const Coordinate& q, const LineForce& line);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE double pulled_frequency(const Body& b, const Vector3<double>& arm, const Vector3<double>& pull,
                                   const LineForce& line, double length) {
  if (b.fixed) return 0.0;
  const Matrix3<double> along = outer(pull, pull);
  const Matrix3<double> root =
      std::sqrt(line.stiffness) * along + std::sqrt(line.tension / length) * (diagonal_matrix(1, 1, 1) - along);
  const double turning = 0.5 * line.tension * (norm(arm) + dot(arm, pull));
  return largest_eigenvalue(root * inverse_mass_matrix(b, arm) * root) + turning * largest_inverse_inertia(b);
}

DEM_INLINE void add_line_element(std::vector<Element>& list, const Parts& m, const PartKind& kind, std::size_t index,
                                 std::uint32_t a, std::uint32_t b, const Coordinate& q, const LineForce& line) {
  const Body &body_a = m.bodies[a], &body_b = m.bodies[b];
  const std::pair w = {inverse_mass_at(body_a, q.arm_a, q.axis), inverse_mass_at(body_b, q.arm_b, q.axis)};
  add_element(list, kind, index, a, b, w, line.stiffness, line.damping);
  if (!(line.tension > 0.0)) return;
  Element& e = list.back();
  e.sides[0].k = pulled_frequency(body_a, q.arm_a, q.axis, line, q.value);
  e.sides[1].k = pulled_frequency(body_b, q.arm_b, -q.axis, line, q.value);
}

}  // namespace dem::mbd::detail

#endif
