#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

namespace dem::mbd {

/// J, of the bodies that move.
double kinetic_energy(const Body& b);

/// kg m^2/s, about the origin, global axes.
Vec3 angular_momentum(const Body& b);

/// J, stored in a joint's penalty springs, or those of a bushing.
double elastic_energy(const Joint& j, const Body& a, const Body& b);

/// J, stored in a coupling's spring.
double elastic_energy(const Coupling& g, const std::vector<Joint>& joints, const std::vector<Body>& bodies);

/// J, stored in a spring: 0 where its force is 0, or at the start of its table if it is 0 nowhere.
double elastic_energy(const Spring& s, const std::vector<Joint>& joints, const std::vector<Body>& bodies);

/// J, stored in a limit that is pressed.
double elastic_energy(const JointLimitState& e, const std::vector<Joint>& joints, const std::vector<Body>& bodies);

/// J, in the asperities of a joint's friction.
inline double elastic_energy(const JointFrictionState& e) {
  return 0.5 * e.law.stiffness * dot(e.committed.slip, e.committed.slip);
}

/// The energies of a machine in J: of motion, of height (against gravity, from the origin), in the penalty springs of
/// its joints and their limits, and in what else gives way: couplings, springs, clutches and brakes that stick, and
/// friction of joints. What is stored in the contacts of grains is theirs (see EnergyBalance). Fixed bodies count none.
struct Energy {
  double kinetic = 0.0, potential = 0.0;
  double elastic = 0.0;  ///< in joints and their limits
  double springs = 0.0;  ///< in springs
  double couplings = 0.0;
  double friction = 0.0;  ///< in clutches, brakes and the friction of joints, while they stick
  double sum() const { return kinetic + potential + elastic + springs + couplings + friction; }
};

Energy energy_of(const Parts& m, const Vec3& gravity);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE double kinetic_energy(const Body& b) {
  const auto& w = b.motion.angular_velocity;
  return 0.5 * (b.mass * dot(b.motion.velocity, b.motion.velocity) + b.inertia[0] * w.x * w.x +
                b.inertia[1] * w.y * w.y + b.inertia[2] * w.z * w.z);
}

DEM_INLINE Vec3 angular_momentum(const Body& b) {
  const Vector3<double>& w = b.motion.angular_velocity;
  const Vector3<double> spin = {b.inertia[0] * w.x, b.inertia[1] * w.y, b.inertia[2] * w.z};
  return to_eigen(b.mass * cross(b.motion.position, b.motion.velocity) + b.motion.rotation * spin);
}

DEM_INLINE double elastic_energy(const Joint& j, const Body& a, const Body& b) {
  if (!j.on) return 0.0;
  const JointTraits& traits = traits_of(j.kind);
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const Vector3<double> d = b.motion.position + B * j.point_b - a.motion.position - A * j.point_a;
  const detail::FrameOfA at{j, A};
  if (traits.energy) return traits.energy(j, at, B, d);
  return detail::holding_energy(j, traits.hold, at, d) + detail::aligning_energy(j, traits.align, at, B);
}

DEM_INLINE double elastic_energy(const Coupling& g, const std::vector<Joint>& joints, const std::vector<Body>& bodies) {
  if (!g.spec.on) return 0.0;
  const double error = coupling_sum(g.spec, joints, bodies) - g.offset;
  return 0.5 * g.k * error * error;
}

DEM_INLINE double elastic_energy(const Spring& s, const std::vector<Joint>& joints, const std::vector<Body>& bodies) {
  const Curve& c = s.spec.force_over_length;
  if (!s.spec.on || c.empty()) return 0.0;
  const double x = coordinate_of(s, joints, bodies[s.a], bodies[s.b]).value - s.start;
  return -c.integral(c.zero_or(c.points().front().first), x);
}

DEM_INLINE double elastic_energy(const JointLimitState& e, const std::vector<Joint>& joints,
                                 const std::vector<Body>& bodies) {
  const Joint& j = joints[e.joint];
  if (!j.on) return 0.0;
  const double q = coordinate_of(j, bodies[j.a], bodies[j.b], e.dof).value;
  const double depth = q < e.lower ? e.lower - q : q > e.upper ? q - e.upper : 0.0;
  return 0.5 * e.stiffness * depth * depth;
}

DEM_INLINE Energy energy_of(const Parts& m, const Vec3& gravity) {
  Energy e;
  for (const Body& b : m.bodies) {
    if (b.fixed) continue;
    e.kinetic += kinetic_energy(b);
    e.potential -= b.mass * dot(from_eigen(gravity), b.motion.position);
  }
  for (const Joint& j : m.joints) e.elastic += elastic_energy(j, m.bodies[j.a], m.bodies[j.b]);
  for (const JointLimitState& l : m.limits) e.elastic += elastic_energy(l, m.joints, m.bodies);
  for (const Spring& s : m.springs) e.springs += elastic_energy(s, m.joints, m.bodies);
  for (const Coupling& g : m.couplings) e.couplings += elastic_energy(g, m.joints, m.bodies);
  for (const Clutch& u : m.clutches) e.friction += u.elastic_energy();
  for (const JointFrictionState& f : m.friction) e.friction += elastic_energy(f);
  return e;
}

}  // namespace dem::mbd

#endif
