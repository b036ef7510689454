#pragma once

// Effective masses. That of a body at a point and in a direction n is 1/(n.W n), where W is the acceleration per unit
// force there; of a rotation it is an inertia. What is computed is its inverse, 0 for fixed bodies.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/coordinate.hpp>
#include <dem/mbd/joint/friction.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dem::mbd::detail {

/// The inverse of the inertia (1/(kg m^2)), global axes.
Matrix3<double> inverse_inertia_of(const Body& b);
/// What turning adds to the displacement per unit force at `arm` (global) from the centre of mass (1/kg).
Matrix3<double> inverse_mass_by_turning(const Body& b, const Vector3<double>& arm);
/// Displacement per unit force at `arm` (1/kg).
Matrix3<double> inverse_mass_matrix(const Body& b, const Vector3<double>& arm);

/// Turn about a unit vector n (global) per unit torque, and displacement along it at `arm` (global) per unit force.
double inverse_inertia_about(const Body& b, const Vector3<double>& n);
inline double inverse_mass_at(const Body& b, const Vector3<double>& arm, const Vector3<double>& n) {
  return b.fixed ? 0.0 : 1.0 / b.mass + inverse_inertia_about(b, cross(arm, n));
}

/// The largest turn per unit torque about any axis, and displacement per unit force at `arm` in any direction. A force
/// along the arm turns nothing, so at most two directions of the turn's share are left.
inline double largest_inverse_inertia(const Body& b) {
  return b.fixed ? 0.0 : 1.0 / std::min({b.inertia[0], b.inertia[1], b.inertia[2]});
}
inline double largest_inverse_mass(const Body& b, const Vector3<double>& arm) {
  return b.fixed ? 0.0 : 1.0 / b.mass + largest_eigenvalue_of_two(inverse_mass_by_turning(b, arm));
}

/// Inverse effective masses of the two bodies of a joint (1/kg), and inverse effective inertias (1/(kg m^2)), each the
/// largest in a held direction. Of a bushing they are times its stiffness.
struct JointInverseMass {
  double displacement_a, displacement_b, rotation_a, rotation_b;
};
JointInverseMass inverse_mass_of(const Joint& j, const Body& a, const Body& b);

/// Inverse effective masses or inertias of the two bodies along a coordinate of their joint. The axis of a bend may
/// point anywhere.
std::pair<double, double> inverse_mass_along(const Joint& j, const Body& a, const Body& b, Dof dof);

/// The same where a joint's friction acts: the largest in whatever mixture of its directions, as all have the same
/// spring. A force beside the centre of mass turns a body, so directions may be softer together than each of them
/// alone. Rotations are times the bearing's radius, which turns sliding into rotation.
std::pair<double, double> inverse_mass_of_friction(const Joint& j, const Body& a, const Body& b, double radius);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Matrix3<double> inverse_inertia_of(const Body& b) {
  if (b.fixed) return diagonal_matrix(0, 0, 0);
  const Matrix3<double>& r = b.motion.rotation;
  return r * diagonal_matrix(1.0 / b.inertia[0], 1.0 / b.inertia[1], 1.0 / b.inertia[2]) * transposed(r);
}

DEM_INLINE Matrix3<double> inverse_mass_by_turning(const Body& b, const Vector3<double>& arm) {
  const Matrix3<double> x = cross_matrix(arm);
  return x * inverse_inertia_of(b) * transposed(x);
}

DEM_INLINE Matrix3<double> inverse_mass_matrix(const Body& b, const Vector3<double>& arm) {
  if (b.fixed) return diagonal_matrix(0, 0, 0);
  return diagonal_matrix(1.0 / b.mass, 1.0 / b.mass, 1.0 / b.mass) + inverse_mass_by_turning(b, arm);
}

DEM_INLINE double inverse_inertia_about(const Body& b, const Vector3<double>& n) {
  if (b.fixed) return 0.0;
  const Vector3<double> t = transpose_times(b.motion.rotation, n);
  return t.x * t.x / b.inertia[0] + t.y * t.y / b.inertia[1] + t.z * t.z / b.inertia[2];
}

DEM_INLINE JointInverseMass inverse_mass_of(const Joint& j, const Body& a, const Body& b) {
  const JointTraits& traits = traits_of(j.kind);
  using V = Vector3<double>;
  using M = Matrix3<double>;
  const FrameOfA at{j, a.motion.rotation};
  const V point = b.motion.position + b.motion.rotation * j.point_b;
  const auto largest = [&](const M& root, const M& w) {
    return traits.stiffness == Stiffness::own ? largest_eigenvalue(root * w * root)
                                              : largest_eigenvalue_of_two(root * w * root);
  };
  const V gap = point - a.motion.position - a.motion.rotation * j.point_a;
  const M held = held_displacements(j, traits.hold, at, gap),
          aligned = held_rotations(j, traits.align, at, b.motion.rotation);
  const auto displacement = [&](const Body& x) {
    const V arm = point - x.motion.position;
    return traits.hold == Hold::point ? largest_inverse_mass(x, arm) : largest(held, inverse_mass_matrix(x, arm));
  };
  const auto rotation = [&](const Body& x) {
    return traits.align == Align::locked ? largest_inverse_inertia(x) : largest(aligned, inverse_inertia_of(x));
  };
  return {displacement(a), displacement(b), rotation(a), rotation(b)};
}

DEM_INLINE std::pair<double, double> inverse_mass_along(const Joint& j, const Body& a, const Body& b, Dof dof) {
  if (dof == Dof::bend) {
    return {largest_inverse_inertia(a), largest_inverse_inertia(b)};
  }
  const Coordinate q = coordinate_of(j, a, b, dof);
  if (q.rotation) return {inverse_inertia_about(a, q.axis), inverse_inertia_about(b, q.axis)};
  return {inverse_mass_at(a, q.arm_a, q.axis), inverse_mass_at(b, q.arm_b, q.axis)};
}

DEM_INLINE std::pair<double, double> inverse_mass_of_friction(const Joint& j, const Body& a, const Body& b,
                                                              double radius) {
  const Dofs dofs = friction_dofs(traits_of(j.kind).bearing);
  std::pair<double, double> alone = {0.0, 0.0};
  for (const Dof dof : dofs) {
    const double share = is_rotation(dof) ? radius * radius : 1.0;
    const auto [wa, wb] = inverse_mass_along(j, a, b, dof);
    alone = {std::max(alone.first, share * wa), std::max(alone.second, share * wb)};
  }
  if (dofs.end() - dofs.begin() < 2) return alone;  // of a bend it is the largest about any axis
  const auto together = [&](const Body& x, Vector3<double> Coordinate::*arm, double most) {
    if (x.fixed) return 0.0;
    Vector3<double> force[3] = {}, torque[3] = {};  // on the body, per unit of each direction
    for (std::size_t k = 0; const Dof dof : dofs) {
      const Coordinate q = coordinate_of(j, a, b, dof);
      if (!q.rotation) force[k] = q.axis;
      torque[k++] = q.rotation ? radius * q.axis : cross(q.*arm, q.axis);
    }
    const Matrix3<double> F = from_columns(force[0], force[1], force[2]);
    const Matrix3<double> T = from_columns(torque[0], torque[1], torque[2]);
    const double all =
        largest_eigenvalue((1.0 / x.mass) * (transposed(F) * F) + transposed(T) * inverse_inertia_of(x) * T);
    return all > (1.0 + 1e-12) * most ? all : most;  // no more than rounding where they are independent
  };
  return {together(a, &Coordinate::arm_a, alone.first), together(b, &Coordinate::arm_b, alone.second)};
}

}  // namespace dem::mbd::detail

#endif
