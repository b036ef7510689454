#pragma once

// How stiff a machine is, and how stiff it may be.
//
// Element bound: give each of the n elements on a body 1/n of the body's mass and inertia. Then the highest frequency
// of the whole machine is at most the highest frequency of a single element with its shares (the machine's energies are
// the sums of the elements' energies). With the mobility W = M^-1 of a body at the joint, per unit force or torque,
//   omega_e^2 <= sum over the element's bodies of n * largest eigenvalue(K^1/2 W K^1/2).
// A stiffness that the user leaves open is derived so that omega_e dt = 0.7:
//   k = share (0.7/dt)^2 / sum(n W),  share = 1/2 if the joint holds both displacements and rotations, else 1,
// and the damping so that this frequency has the damping ratio 0.5: c = k dt/0.7, or sqrt(k / sum(n W)) if
// the stiffness is the user's. Stops and joint friction are derived in the same way (friction with omega_e dt = 0.1).

#include <dem/integrator/motion.hpp>
#include <dem/mbd/parts.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace dem::mbd {

/// The time step a machine can take, and what limits it.
struct StableTimeStep {
  double dt = 1e300;       ///< s
  std::string limited_by;  ///< e.g. "revolute joint 'crank'"; empty if nothing limits it
};

namespace detail {

inline constexpr double joint_frequency = 0.7, friction_frequency = 0.1, damping_ratio = 0.5;

/// What a part adds to the stiffness of the machine: for each of its bodies, omega^2 and omega-damping per share.
struct Element {
  struct Side {
    std::uint32_t body;
    double k = 0.0;  ///< 1/s^2
    double c = 0.0;  ///< 1/s
  };
  std::string name;
  std::vector<Side> sides;
};

/// Largest eigenvalue of a symmetric matrix, by the trigonometric solution of its cubic.
inline double largest_eigenvalue(const Mat3& m) {
  const double mean = m.trace() / 3.0;
  const Mat3 rest = m - mean * Mat3::Identity();
  const double p = std::sqrt(rest.squaredNorm() / 6.0);
  if (p <= 1e-15 * std::abs(mean) || p < 1e-300) return mean;
  const double cosine = std::clamp(Mat3(rest / p).determinant() / 2.0, -1.0, 1.0);
  return mean + 2.0 * p * std::cos(std::acos(cosine) / 3.0);
}

inline Mat3 rotational_mobility(const Body& b) {
  if (b.fixed) return Mat3::Zero();
  return b.rotation() * b.inertia.cwiseInverse().asDiagonal() * b.rotation().transpose();
}
/// Displacement per unit force at `arm` (global) from the centre of mass.
inline Mat3 point_mobility(const Body& b, const Vec3& arm) {
  if (b.fixed) return Mat3::Zero();
  Mat3 x;
  x << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
  return Mat3::Identity() / b.mass + x * rotational_mobility(b) * x.transpose();
}

/// Square roots of a joint's stiffness, of size 1 where it is the same in all held directions; global axes.
struct HeldDirections {
  Mat3 displacement = Mat3::Zero(), rotation = Mat3::Zero();
};
inline HeldDirections held_directions(const Joint& j, const Body& a, const Body& b) {
  const Mat3 A = a.rotation();
  const auto global = [&](const Vector3<double>& v) { return Vec3(A * to_eigen(v)); };
  Mat3 axes;
  axes << global(j.axes_a.x), global(j.axes_a.y), global(j.axes_a.z);
  const Vec3 z = axes.col(2);
  const auto roots = [&](const Vector3<double>& k) {
    return Mat3(axes * to_eigen(k).cwiseSqrt().asDiagonal() * axes.transpose());
  };
  HeldDirections held;
  switch (hold_of(j.kind)) {
    case Hold::point: held.displacement.setIdentity(); break;
    case Hold::line: held.displacement = Mat3::Identity() - z * z.transpose(); break;
    case Hold::plane: held.displacement = z * z.transpose(); break;
    case Hold::length: {
      const Vec3 n = (b.point(to_eigen(j.point_b)) - a.point(to_eigen(j.point_a))).normalized();
      held.displacement = n * n.transpose();
      break;
    }
    case Hold::bushing: held.displacement = roots(j.k3); break;
    case Hold::nothing: break;
  }
  switch (align_of(j.kind)) {
    case Align::parallel: held.rotation = Mat3::Identity() - z * z.transpose(); break;
    case Align::locked: held.rotation = j.kind == JointKind::bushing ? roots(j.kr3) : Mat3(Mat3::Identity()); break;
    case Align::cross:
    case Align::constant_velocity: {
      const Vec3 g = z + b.rotation() * to_eigen(j.axes_b.z);  // between the shafts: close to both gradients
      held.rotation = g.normalized() * g.normalized().transpose();
      break;
    }
    case Align::nothing: break;
  }
  return held;
}

/// Mobilities of the two bodies of a joint, displacement and rotation in held directions.
struct JointMobility {
  double displacement_a, displacement_b, rotation_a, rotation_b;
};
inline JointMobility mobility_of(const Joint& j, const Body& a, const Body& b) {
  const HeldDirections held = held_directions(j, a, b);
  const Vec3 at = b.point(to_eigen(j.point_b));
  const Mat3 wa = point_mobility(a, at - a.position()), wb = point_mobility(b, at - b.position());
  const Mat3 ra = rotational_mobility(a), rb = rotational_mobility(b);
  const auto gain = [](const Mat3& root, const Mat3& w) { return std::max(0.0, largest_eigenvalue(root * w * root)); };
  return {gain(held.displacement, wa), gain(held.displacement, wb), gain(held.rotation, ra), gain(held.rotation, rb)};
}

/// Mobilities of the two bodies along a coordinate of their joint. The axis of a bend may point anywhere.
inline std::pair<double, double> coordinate_mobility(const Joint& j, const Body& a, const Body& b, Freedom freedom) {
  if (freedom == Freedom::bend) {
    return {largest_eigenvalue(rotational_mobility(a)), largest_eigenvalue(rotational_mobility(b))};
  }
  const Coordinate q = coordinate_of(j, a, b, freedom);
  const Vec3 n = to_eigen(q.axis), at = b.point(to_eigen(j.point_b));
  if (q.rotation) return {n.dot(rotational_mobility(a) * n), n.dot(rotational_mobility(b) * n)};
  return {n.dot(point_mobility(a, at - a.position()) * n), n.dot(point_mobility(b, at - b.position()) * n)};
}

/// Mobilities of the two bodies along the directions that a joint's friction acts in: the largest of them, as all have
/// the same spring; rotations times the square of the bearing's radius, which turns sliding into rotation.
inline std::pair<double, double> rubbing_mobility(const Joint& j, const Body& a, const Body& b, double radius) {
  std::pair<double, double> most = {0.0, 0.0};
  const auto consider = [&](Freedom freedom) {
    const double share = is_rotation(freedom) ? radius * radius : 1.0;
    const auto [wa, wb] = coordinate_mobility(j, a, b, freedom);
    most = {std::max(most.first, share * wa), std::max(most.second, share * wb)};
  };
  switch (j.kind) {
    case JointKind::planar:
    case JointKind::point_on_plane:
      consider(Freedom::slide_x);
      consider(Freedom::slide_y);
      break;
    case JointKind::cylindrical:
      consider(Freedom::turn);
      consider(Freedom::slide);
      break;
    case JointKind::revolute: consider(Freedom::turn); break;
    case JointKind::prismatic:
    case JointKind::point_on_line: consider(Freedom::slide); break;
    default: consider(Freedom::bend); break;
  }
  return most;
}

/// Mobility of the line between two points.
inline std::pair<double, double> line_mobility(const Vector3<double>& point_a, const Vector3<double>& point_b,
                                               const Body& a, const Body& b) {
  const Coordinate q = distance_of(point_a, point_b, a, b);
  const Vec3 n = to_eigen(q.axis);
  return {n.dot(point_mobility(a, to_eigen(q.arm_a)) * n), n.dot(point_mobility(b, to_eigen(q.arm_b)) * n)};
}

/// Every element with its present stiffness; what is still to be derived counts as 0.
inline std::vector<Element> elements_of(const Parts& m) {
  std::vector<Element> list;
  const auto label = [&](std::size_t i) {
    return fmt::format("{} '{}'", name_of(m.joint_specs[i].kind), m.joint_specs[i].name);
  };
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const Joint& j = m.joints[i];
    const JointMobility w = mobility_of(j, m.bodies[j.a], m.bodies[j.b]);
    if (j.kind == JointKind::free) continue;
    Element e{label(i), {{j.a}, {j.b}}};
    if (j.kind == JointKind::bushing) {  // its mobilities hold the stiffness, and those of its dampers the damping
      Joint damper = j;
      damper.k3 = j.c3;
      damper.kr3 = j.cr3;
      const JointMobility d = mobility_of(damper, m.bodies[j.a], m.bodies[j.b]);
      e.sides[0] = {j.a, w.displacement_a + w.rotation_a, d.displacement_a + d.rotation_a};
      e.sides[1] = {j.b, w.displacement_b + w.rotation_b, d.displacement_b + d.rotation_b};
    } else {
      e.sides[0] = {j.a, j.k * w.displacement_a + j.kr * w.rotation_a, j.c * w.displacement_a + j.cr * w.rotation_a};
      e.sides[1] = {j.b, j.k * w.displacement_b + j.kr * w.rotation_b, j.c * w.displacement_b + j.cr * w.rotation_b};
    }
    list.push_back(std::move(e));
  }
  const auto along = [&](std::string name, const Joint& j, Freedom freedom, double k, double c) {
    const auto [wa, wb] = coordinate_mobility(j, m.bodies[j.a], m.bodies[j.b], freedom);
    list.push_back({std::move(name), {{j.a, k * wa, c * wa}, {j.b, k * wb, c * wb}}});
  };
  for (const JointRubbing& x : m.rubbing) {
    const Joint& j = m.joints[x.joint];
    const auto [wa, wb] = rubbing_mobility(j, m.bodies[j.a], m.bodies[j.b], x.radius);
    const double k = x.law.stiffness, c = x.law.velocity_stiffness;
    list.push_back({"friction of " + label(x.joint), {{j.a, k * wa, c * wa}, {j.b, k * wb, c * wb}}});
  }
  for (const JointStops& x : m.stops) {
    along("stops of " + label(x.joint), m.joints[x.joint], x.freedom, x.stiffness, x.damping);
  }
  for (const Coupling& g : m.couplings) {
    Element e{fmt::format("coupling '{}'", g.spec.name), {}};
    for (const auto& term : g.spec.terms) {
      const Joint& j = m.joints[term.joint.index()];
      const auto [wa, wb] = coordinate_mobility(j, m.bodies[j.a], m.bodies[j.b], term.freedom);
      const double r2 = term.ratio * term.ratio * static_cast<double>(g.spec.terms.size());  // (sum x)^2 <= n sum x^2
      e.sides.push_back({j.a, g.k * r2 * wa, g.c * r2 * wa});
      e.sides.push_back({j.b, g.k * r2 * wb, g.c * r2 * wb});
    }
    list.push_back(std::move(e));
  }
  const auto line = [&](std::string name, const auto& part, std::uint32_t a, std::uint32_t b, double k, double c) {
    const auto [wa, wb] = line_mobility(part.point_a, part.point_b, m.bodies[a], m.bodies[b]);
    list.push_back({std::move(name), {{a, k * wa, c * wa}, {b, k * wb, c * wb}}});
  };
  for (const Spring& s : m.springs) {
    line(fmt::format("spring '{}'", s.spec.name), s, s.spec.a.value, s.spec.b.value,
         s.spec.force_over_length.empty() ? 0.0 : s.spec.force_over_length.steepest(),
         s.spec.force_over_speed.empty() ? 0.0 : s.spec.force_over_speed.steepest());
  }
  for (const Actuator& u : m.actuators) {
    const double k = u.spec.position_gain;
    const double c = u.spec.torque_curve.empty() ? u.spec.speed_gain : u.spec.torque_curve.steepest();
    const std::string name = fmt::format("actuator '{}'", u.spec.name);
    if (!u.spec.joint.valid()) {
      line(name, u, u.a, u.b, k, c);
    } else {
      along(name, m.joints[u.spec.joint.index()], u.spec.freedom, k, c);
    }
  }
  return list;
}

/// Number of elements on each body: the shares into which its mass is cut. Counts parts, whatever their stiffness is.
inline std::vector<double> shares_of(const Parts& m, const std::vector<Element>& elements) {
  std::vector<double> n(m.bodies.size(), 0.0);
  for (const Element& e : elements) {
    for (const Element::Side& s : e.sides) n[s.body] += 1.0;
  }
  return n;
}

}  // namespace detail
}  // namespace dem::mbd
