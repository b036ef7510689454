#pragma once

// How easily bodies give way. The effective mass of a body at a point and in a direction n is 1/(n.W n), where W is the
// acceleration per unit force there; of a rotation it is an inertia. What is computed is its inverse, 0 for fixed
// bodies.

#include <dem/mbd/joint/coordinate.hpp>
#include <dem/mbd/joint/friction.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dem::mbd::detail {

/// Largest eigenvalue of a symmetric matrix, by the trigonometric solution of its cubic.
inline double largest_eigenvalue(const Mat3& m) {
  const double mean = m.trace() / 3.0;
  const Mat3 rest = m - mean * Mat3::Identity();
  const double p = std::sqrt(rest.squaredNorm() / 6.0);
  if (p <= 1e-15 * std::abs(mean) || p < 1e-300) return mean;
  const double cosine = std::clamp(Mat3(rest / p).determinant() / 2.0, -1.0, 1.0);
  return mean + 2.0 * p * std::cos(std::acos(cosine) / 3.0);
}

/// The same of one that has no negative eigenvalue and at most two that are not 0: half of their sum and difference.
inline double largest_eigenvalue_of_two(const Mat3& m) {
  const double sum = m.trace();
  return 0.5 * (sum + std::sqrt(std::max(0.0, 2.0 * m.squaredNorm() - sum * sum)));
}

inline Mat3 inverse_inertia_of(const Body& b) {
  if (b.fixed) return Mat3::Zero();
  return b.rotation() * b.inertia.cwiseInverse().asDiagonal() * b.rotation().transpose();
}
/// Displacement per unit force at `arm` (global) from the centre of mass.
inline Mat3 inverse_mass_matrix(const Body& b, const Vec3& arm) {
  if (b.fixed) return Mat3::Zero();
  Mat3 x;
  x << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return Mat3::Identity() / b.mass + x * inverse_inertia_of(b) * x.transpose();
}

/// Turn about a unit vector n (global) per unit torque, and displacement along it at `arm` (global) per unit force.
inline double inverse_inertia_about(const Body& b, const Vector3<double>& n) {
  if (b.fixed) return 0.0;
  const Vector3<double> t = transpose_times(b.motion.rotation, n);
  return t.x * t.x / b.inertia[0] + t.y * t.y / b.inertia[1] + t.z * t.z / b.inertia[2];
}
inline double inverse_mass_at(const Body& b, const Vector3<double>& arm, const Vector3<double>& n) {
  return b.fixed ? 0.0 : 1.0 / b.mass + inverse_inertia_about(b, cross(arm, n));
}

/// The largest turn per unit torque about any axis, and displacement per unit force at `arm` in any direction. A force
/// along the arm turns nothing, so at most two directions of the turn's share are left.
inline double largest_inverse_inertia(const Body& b) { return b.fixed ? 0.0 : 1.0 / b.inertia.minCoeff(); }
inline double largest_inverse_mass(const Body& b, const Vec3& arm) {
  if (b.fixed) return 0.0;
  return 1.0 / b.mass + largest_eigenvalue_of_two(inverse_mass_matrix(b, arm) - Mat3::Identity() / b.mass);
}

/// Inverse effective masses of the two bodies of a joint (1/kg), and inverse effective inertias (1/(kg m^2)), each the
/// largest in a held direction. Of a bushing they are times its stiffness.
struct JointInverseMass {
  double displacement_a, displacement_b, rotation_a, rotation_b;
};
inline JointInverseMass inverse_mass_of(const Joint& j, const Body& a, const Body& b) {
  const JointTraits& traits = traits_of(j.kind);
  const Mat3 A = a.rotation();
  const auto global = [&](const Vector3<double>& v) { return Vec3(A * to_eigen(v)); };
  Mat3 axes;
  axes << global(j.axes_a.x), global(j.axes_a.y), global(j.axes_a.z);
  const Vec3 point = b.point(to_eigen(j.point_b));
  const auto largest = [&](const Mat3& root, const Mat3& w) {
    return traits.stiffness == Stiffness::own ? largest_eigenvalue(root * w * root)
                                              : largest_eigenvalue_of_two(root * w * root);
  };
  const Mat3 held = held_displacements(j, traits.hold, axes, point - a.point(to_eigen(j.point_a)));
  const auto displacement = [&](const Body& x) {
    const Vec3 arm = point - x.position();
    return traits.hold == Hold::point ? largest_inverse_mass(x, arm) : largest(held, inverse_mass_matrix(x, arm));
  };
  const Mat3 aligned = held_rotations(j, traits.align, axes, b.rotation());
  const auto rotation = [&](const Body& x) {
    return traits.align == Align::locked ? largest_inverse_inertia(x) : largest(aligned, inverse_inertia_of(x));
  };
  return {displacement(a), displacement(b), rotation(a), rotation(b)};
}

/// Inverse effective masses or inertias of the two bodies along a coordinate of their joint. The axis of a bend may
/// point anywhere.
inline std::pair<double, double> inverse_mass_along(const Joint& j, const Body& a, const Body& b, Dof dof) {
  if (dof == Dof::bend) {
    return {largest_inverse_inertia(a), largest_inverse_inertia(b)};
  }
  const Coordinate q = coordinate_of(j, a, b, dof);
  if (q.rotation) return {inverse_inertia_about(a, q.axis), inverse_inertia_about(b, q.axis)};
  return {inverse_mass_at(a, q.arm_a, q.axis), inverse_mass_at(b, q.arm_b, q.axis)};
}

/// The same along the directions that a joint's friction acts in: the largest of them, as all have the same spring;
/// rotations times the square of the bearing's radius, which turns sliding into rotation.
inline std::pair<double, double> inverse_mass_of_friction(const Joint& j, const Body& a, const Body& b, double radius) {
  std::pair<double, double> most = {0.0, 0.0};
  for (const Dof dof : rubbing_dofs(traits_of(j.kind).bearing)) {
    const double share = is_rotation(dof) ? radius * radius : 1.0;
    const auto [wa, wb] = inverse_mass_along(j, a, b, dof);
    most = {std::max(most.first, share * wa), std::max(most.second, share * wb)};
  }
  return most;
}

/// The same along the line between two points.
inline std::pair<double, double> inverse_mass_of_line(const Vector3<double>& point_a, const Vector3<double>& point_b,
                                                      const Body& a, const Body& b) {
  const Coordinate q = distance_of(point_a, point_b, a, b);
  return {inverse_mass_at(a, q.arm_a, q.axis), inverse_mass_at(b, q.arm_b, q.axis)};
}

}  // namespace dem::mbd::detail
