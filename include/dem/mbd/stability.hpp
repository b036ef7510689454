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

/// Mobilities of the two bodies of a joint, displacement and rotation in held directions, and along the coordinate.
struct JointMobility {
  double displacement_a, displacement_b, rotation_a, rotation_b, coordinate_a, coordinate_b;
};
inline JointMobility mobility_of(const Joint& j, const Body& a, const Body& b) {
  const HeldDirections held = held_directions(j, a, b);
  const Vec3 at = b.point(to_eigen(j.point_b));
  const Mat3 wa = point_mobility(a, at - a.position()), wb = point_mobility(b, at - b.position());
  const Mat3 ra = rotational_mobility(a), rb = rotational_mobility(b);
  const auto gain = [](const Mat3& root, const Mat3& w) { return std::max(0.0, largest_eigenvalue(root * w * root)); };
  const Vec3 z = a.rotation() * to_eigen(j.axes_a.z);
  const bool all = j.kind == JointKind::spherical, turning = turns(j.kind);
  const auto along = [&](const Mat3& w, const Mat3& r) {
    return all ? largest_eigenvalue(r) : turning ? z.dot(r * z) : z.dot(w * z);
  };
  return {gain(held.displacement, wa),
          gain(held.displacement, wb),
          gain(held.rotation, ra),
          gain(held.rotation, rb),
          along(wa, ra),
          along(wb, rb)};
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
  std::vector<JointMobility> mobility;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const Joint& j = m.joints[i];
    const JointMobility w = mobility_of(j, m.bodies[j.a], m.bodies[j.b]);
    mobility.push_back(w);
    if (j.kind == JointKind::free) continue;
    Element e{label(i), {{j.a}, {j.b}}};
    if (j.kind == JointKind::bushing) {  // its mobility holds the stiffness; the dampers count in the same proportion
      const auto ratio = [](const Vector3<double>& c, const Vector3<double>& k) {
        return std::max({c.x / max(k.x, 1e-30), c.y / max(k.y, 1e-30), c.z / max(k.z, 1e-30)});
      };
      const double t = ratio(j.c3, j.k3), r = ratio(j.cr3, j.kr3);
      e.sides[0] = {j.a, w.displacement_a + w.rotation_a, t * w.displacement_a + r * w.rotation_a};
      e.sides[1] = {j.b, w.displacement_b + w.rotation_b, t * w.displacement_b + r * w.rotation_b};
    } else {
      e.sides[0] = {j.a, j.k * w.displacement_a + j.kr * w.rotation_a, j.c * w.displacement_a + j.cr * w.rotation_a};
      e.sides[1] = {j.b, j.k * w.displacement_b + j.kr * w.rotation_b, j.c * w.displacement_b + j.cr * w.rotation_b};
    }
    list.push_back(std::move(e));
  }
  for (const JointExtras& x : m.extras) {
    const Joint& j = m.joints[x.joint];
    const JointMobility& w = mobility[x.joint];
    const double r2 = turns(j.kind) || j.kind == JointKind::spherical ? x.radius * x.radius : 1.0;
    if (x.rubs) {
      const double k = r2 * x.law.stiffness, c = r2 * x.law.velocity_stiffness;
      list.push_back({"friction of " + label(x.joint),
                      {{j.a, k * w.coordinate_a, c * w.coordinate_a}, {j.b, k * w.coordinate_b, c * w.coordinate_b}}});
    }
    if (x.limited) {
      const double k = x.stop_stiffness, c = x.stop_damping;
      list.push_back({"stops of " + label(x.joint),
                      {{j.a, k * w.coordinate_a, c * w.coordinate_a}, {j.b, k * w.coordinate_b, c * w.coordinate_b}}});
    }
  }
  for (const Coupling& g : m.couplings) {
    Element e{fmt::format("coupling '{}'", g.spec.name), {}};
    for (const auto& term : g.spec.terms) {
      const JointMobility& w = mobility[term.joint.index()];
      const Joint& j = m.joints[term.joint.index()];
      const double r2 = term.ratio * term.ratio * static_cast<double>(g.spec.terms.size());  // (sum x)^2 <= n sum x^2
      e.sides.push_back({j.a, g.k * r2 * w.coordinate_a, g.c * r2 * w.coordinate_a});
      e.sides.push_back({j.b, g.k * r2 * w.coordinate_b, g.c * r2 * w.coordinate_b});
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
      const JointMobility& w = mobility[u.spec.joint.index()];
      list.push_back(
          {name, {{u.a, k * w.coordinate_a, c * w.coordinate_a}, {u.b, k * w.coordinate_b, c * w.coordinate_b}}});
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
