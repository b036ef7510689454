#pragma once

#include <dem/mbd/solver/parts.hpp>

namespace dem::mbd {

/// J, of the bodies that move.
inline double kinetic_energy(const Body& b) {
  const auto& w = b.motion.angular_velocity;
  return 0.5 * (b.mass * dot(b.motion.velocity, b.motion.velocity) + b.inertia[0] * w.x * w.x +
                b.inertia[1] * w.y * w.y + b.inertia[2] * w.z * w.z);
}

/// kg m^2/s, about the origin, global axes.
inline Vec3 angular_momentum(const Body& b) {
  return b.mass * b.position().cross(b.velocity()) +
         b.rotation() * b.inertia.cwiseProduct(to_eigen(b.motion.angular_velocity));
}

/// J, stored in a joint's penalty springs.
inline double elastic_energy(const Joint& j, const Body& a, const Body& b) {
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  const auto dots = [&](const Vector3<double>& in_a, const Vector3<double>& in_b) { return dot(A * in_a, B * in_b); };
  const auto along = [&](const Vector3<double>& axis) { return dot(A * axis, d); };
  const Axes &x = j.axes_a, &y = j.axes_b;
  const Violation v = violation_of(j, a, b);
  double energy = 0.5 * j.k * v.displacement * v.displacement;
  if (hold_of(j.kind) == Hold::bushing) {
    energy =
        0.5 * (j.k3.x * along(x.x) * along(x.x) + j.k3.y * along(x.y) * along(x.y) + j.k3.z * along(x.z) * along(x.z));
  }
  const double bend[3] = {1.0 - dots(x.x, y.x), 1.0 - dots(x.y, y.y), 1.0 - dots(x.z, y.z)};
  switch (align_of(j.kind)) {
    case Align::parallel: energy += j.kr * bend[2]; break;
    case Align::locked:
      if (j.kind == JointKind::bushing) {
        const Vector3<double> r = rotation_vector(A * x.x, A * x.y, A * x.z, B * y.x, B * y.y, B * y.z);
        energy += 0.5 * (j.kr3.x * r.x * r.x + j.kr3.y * r.y * r.y + j.kr3.z * r.z * r.z);
      } else {
        energy += 0.5 * j.kr * (bend[0] + bend[1] + bend[2]);
      }
      break;
    case Align::cross:
    case Align::constant_velocity: energy += 0.5 * j.kr * v.rotation * v.rotation; break;
    case Align::nothing: break;
  }
  return energy;
}

/// The energies of a machine in J: of motion, of height (against gravity, from the origin) and in its joints. Springs,
/// actuators, couplings, limits and the springs of friction are not counted.
struct Energy {
  double kinetic = 0.0, potential = 0.0, elastic = 0.0;
  double sum() const { return kinetic + potential + elastic; }
};

inline Energy energy_of(const Parts& m, const Vec3& gravity) {
  Energy e;
  for (const Body& b : m.bodies) {
    if (b.fixed) continue;
    e.kinetic += kinetic_energy(b);
    e.potential -= b.mass * gravity.dot(b.position());
  }
  for (const Joint& j : m.joints) e.elastic += elastic_energy(j, m.bodies[j.a], m.bodies[j.b]);
  return e;
}

}  // namespace dem::mbd
