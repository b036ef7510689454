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
  const Vector3<double>& w = b.motion.angular_velocity;
  const Vector3<double> spin = {b.inertia[0] * w.x, b.inertia[1] * w.y, b.inertia[2] * w.z};
  return to_eigen(b.mass * cross(b.motion.position, b.motion.velocity) + b.motion.rotation * spin);
}

/// J, stored in a joint's penalty springs.
inline double elastic_energy(const Joint& j, const Body& a, const Body& b) {
  const JointTraits& traits = traits_of(j.kind);
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  const detail::FrameOfA at{j, A};
  return detail::holding_energy(j, traits.hold, at, d) + detail::aligning_energy(j, traits.align, at, B);
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
    e.potential -= b.mass * dot(from_eigen(gravity), b.motion.position);
  }
  for (const Joint& j : m.joints) e.elastic += elastic_energy(j, m.bodies[j.a], m.bodies[j.b]);
  return e;
}

}  // namespace dem::mbd
