#pragma once

// How stiff a machine is, and how stiff it may be.
//
// Element bound: give each of the n elements on a body 1/n of the body's mass and inertia. Then the highest frequency
// of the whole machine is at most the highest frequency of a single element with its shares (the machine's energies are
// the sums of the elements' energies). With the inverse effective mass W of a body at the joint, per unit force or
// torque,
//   omega_e^2 <= sum over the element's bodies of n * largest eigenvalue(K^1/2 W K^1/2).
// A stiffness that the user leaves open is derived so that omega_e dt = 0.7:
//   k = share (0.7/dt)^2 / sum(n W),  share = 1/2 if the joint holds both displacements and rotations, else 1,
// and the damping so that this frequency has the damping ratio 0.5: c = k dt/0.7, or sqrt(k / sum(n W)) if
// the stiffness is the user's. Limits and joint friction are derived in the same way (friction with omega_e dt = 0.1).

#include <dem/core/stable_time_step.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

namespace detail {

inline constexpr double joint_frequency = 0.7, friction_frequency = 0.1, damping_ratio = 0.5;

/// What a part adds to the stiffness of the machine: for each of its bodies, omega^2 and omega-damping per share.
struct Element {
  struct Side {
    std::uint32_t body;
    double k = 0.0;  ///< 1/s^2
    double c = 0.0;  ///< 1/s
  };
  enum class Part { joint, friction, limits, coupling, spring, actuator };
  Part part;
  std::size_t index;  ///< among the parts of its kind
  std::vector<Side> sides;
};

/// What an element is called in reports.
inline std::string name_of(const Parts& m, const Element& e) {
  const auto joint = [&](std::size_t i) {
    return fmt::format("{} '{}'", name_of(m.joint_specs[i].kind), m.joint_specs[i].name);
  };
  switch (e.part) {
    case Element::Part::joint: return joint(e.index);
    case Element::Part::friction: return "friction of " + joint(m.friction[e.index].joint);
    case Element::Part::limits: return "limits of " + joint(m.limits[e.index].joint);
    case Element::Part::coupling: return fmt::format("coupling '{}'", m.couplings[e.index].spec.name);
    case Element::Part::spring: return fmt::format("spring '{}'", m.springs[e.index].spec.name);
    case Element::Part::actuator: return fmt::format("actuator '{}'", m.actuators[e.index].spec.name);
  }
  return {};
}

/// Every element with its present stiffness; what is still to be derived counts as 0.
inline std::vector<Element> elements_of(const Parts& m) {
  using enum Element::Part;
  std::vector<Element> list;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const Joint& j = m.joints[i];
    const Stiffness stiffness = traits_of(j.kind).stiffness;
    if (stiffness == Stiffness::none) continue;
    const JointInverseMass w = inverse_mass_of(j, m.bodies[j.a], m.bodies[j.b]);
    Element e{joint, i, {{j.a}, {j.b}}};
    if (stiffness == Stiffness::own) {  // its inverse masses hold the stiffness, and those of its dampers the damping
      Joint damper = j;
      damper.k3 = j.c3;
      damper.kr3 = j.cr3;
      const JointInverseMass d = inverse_mass_of(damper, m.bodies[j.a], m.bodies[j.b]);
      e.sides[0] = {j.a, w.displacement_a + w.rotation_a, d.displacement_a + d.rotation_a};
      e.sides[1] = {j.b, w.displacement_b + w.rotation_b, d.displacement_b + d.rotation_b};
    } else {
      e.sides[0] = {j.a, j.k * w.displacement_a + j.kr * w.rotation_a, j.c * w.displacement_a + j.cr * w.rotation_a};
      e.sides[1] = {j.b, j.k * w.displacement_b + j.kr * w.rotation_b, j.c * w.displacement_b + j.cr * w.rotation_b};
    }
    list.push_back(std::move(e));
  }
  const auto add = [&](Element::Part part, std::size_t i, std::uint32_t a, std::uint32_t b,
                       const std::pair<double, double>& w, double k, double c) {
    list.push_back({part, i, {{a, k * w.first, c * w.first}, {b, k * w.second, c * w.second}}});
  };
  for (std::size_t i = 0; i < m.friction.size(); ++i) {
    const JointFrictionState& x = m.friction[i];
    const Joint& j = m.joints[x.joint];
    add(friction, i, j.a, j.b, inverse_mass_of_friction(j, m.bodies[j.a], m.bodies[j.b], x.radius), x.law.stiffness,
        x.law.velocity_stiffness);
  }
  const auto along = [&](const Joint& j, Dof dof) { return inverse_mass_along(j, m.bodies[j.a], m.bodies[j.b], dof); };
  for (std::size_t i = 0; i < m.limits.size(); ++i) {
    const JointLimitState& x = m.limits[i];
    const Joint& j = m.joints[x.joint];
    add(limits, i, j.a, j.b, along(j, x.dof), x.stiffness, x.damping);
  }
  for (std::size_t i = 0; i < m.couplings.size(); ++i) {
    const Coupling& g = m.couplings[i];
    Element e{coupling, i, {}};
    for (const auto& term : g.spec.terms) {
      const Joint& j = m.joints[term.joint.index()];
      const auto [wa, wb] = along(j, term.dof);
      const double r2 = term.ratio * term.ratio * static_cast<double>(g.spec.terms.size());  // (sum x)^2 <= n sum x^2
      e.sides.push_back({j.a, g.k * r2 * wa, g.c * r2 * wa});
      e.sides.push_back({j.b, g.k * r2 * wb, g.c * r2 * wb});
    }
    list.push_back(std::move(e));
  }
  for (std::size_t i = 0; i < m.springs.size(); ++i) {
    const Spring& s = m.springs[i];
    const std::uint32_t a = s.spec.a.value, b = s.spec.b.value;
    add(spring, i, a, b, inverse_mass_of_line(s.point_a, s.point_b, m.bodies[a], m.bodies[b]),
        s.spec.force_over_length.empty() ? 0.0 : s.spec.force_over_length.steepest(),
        s.spec.force_over_speed.empty() ? 0.0 : s.spec.force_over_speed.steepest());
  }
  for (std::size_t i = 0; i < m.actuators.size(); ++i) {
    const Actuator& u = m.actuators[i];
    const double c = u.spec.torque_curve.empty() ? u.spec.speed_gain : u.spec.torque_curve.steepest();
    add(actuator, i, u.a, u.b,
        u.spec.joint.valid() ? along(m.joints[u.spec.joint.index()], u.spec.dof)
                             : inverse_mass_of_line(u.point_a, u.point_b, m.bodies[u.a], m.bodies[u.b]),
        u.spec.position_gain, c);
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
