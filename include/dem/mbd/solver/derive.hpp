#pragma once

#include <dem/mbd/solver/stability.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace dem::mbd {

inline constexpr double endless_step = 1e30;  ///< s

/// The limits that a joint's user gave for a coordinate that is limited.
inline const JointLimits& given_limits(const JointSpec& s, Dof dof) {
  return *std::find_if(s.limits.begin(), s.limits.end(), [&](const JointLimits& l) { return l.dof == dof; });
}

namespace detail {

/// Fills in the stiffness and damping that users left open, as the formula in stability.hpp gives them in the present
/// pose, and leaves alone what they gave.
struct Derivation {
  double dt = 0.0;             ///< s, time step
  std::vector<double> shares;  ///< on each body

  Derivation() = default;
  Derivation(const Parts& m, double time_step)
      : dt(require_positive(time_step, "time step", "s")), shares(shares_of(m, elements_of(m))) {}

  void fill(const Parts& m, const JointSpec& s, Joint& j) const {
    if (traits_of(j.kind).stiffness != Stiffness::derived) return;
    const JointInverseMass w = inverse_mass_of(j, m.bodies[j.a], m.bodies[j.b]);
    const double displacement = shares[j.a] * w.displacement_a + shares[j.b] * w.displacement_b;
    const double rotation = shares[j.a] * w.rotation_a + shares[j.b] * w.rotation_b;
    const bool both = displacement > 0.0 && rotation > 0.0;
    const double factor = joint_frequency * (both ? std::sqrt(0.5) : 1.0);
    // Derived damping belongs to the joint's whole frequency, which is higher than that of its displacements alone.
    const auto damping_of = [&](const std::optional<double>& k, double derived, double inverse_mass) {
      return k ? damp(*k, inverse_mass) : 2.0 * damping_ratio * derived * dt / joint_frequency;
    };
    j.k = s.stiffness.value_or(stiff(factor, displacement));
    j.kr = s.rotational_stiffness.value_or(stiff(factor, rotation));
    j.c = s.damping.value_or(damping_of(s.stiffness, j.k, displacement));
    j.cr = s.rotational_damping.value_or(damping_of(s.rotational_stiffness, j.kr, rotation));
  }
  void fill(const Parts& m, const JointLimits& given, JointLimitState& e) const {
    const double w = along(m, m.joints[e.joint], e.dof);
    e.stiffness = given.stiffness.value_or(stiff(joint_frequency, w));
    e.damping = given.damping.value_or(damp(e.stiffness, w));
  }
  void fill(const Parts& m, const JointFriction& given, JointFrictionState& e) const {
    const Joint& j = m.joints[e.joint];
    const auto [wa, wb] = inverse_mass_of_friction(j, m.bodies[j.a], m.bodies[j.b], e.radius);
    const double w = shares[j.a] * wa + shares[j.b] * wb;
    e.law.stiffness = given.stiffness.value_or(stiff(friction_frequency, w));
    e.law.velocity_stiffness = given.velocity_stiffness.value_or(damp(e.law.stiffness, w));
  }
  void fill(const Parts& m, const CouplingSpec& s, Coupling& g) const {
    double w = 0.0;
    for (const auto& term : s.terms) {
      w += term.ratio * term.ratio * static_cast<double>(s.terms.size()) *
           along(m, m.joints[term.joint.index()], term.dof);
    }
    g.k = s.stiffness.value_or(stiff(joint_frequency, w));
    g.c = s.damping.value_or(damp(g.k, w));
  }

 private:
  /// Stiffness for a frequency of `factor`/dt, where 1 N moves the shares by `w` m/s^2; nothing moves: nothing to hold.
  double stiff(double factor, double w) const { return w > 0.0 ? factor * factor / (dt * dt * w) : 0.0; }
  static double damp(double k, double w) { return w > 0.0 ? 2.0 * damping_ratio * std::sqrt(k / w) : 0.0; }
  double along(const Parts& m, const Joint& j, Dof dof) const {
    const auto [wa, wb] = inverse_mass_along(j, m.bodies[j.a], m.bodies[j.b], dof);
    return shares[j.a] * wa + shares[j.b] * wb;
  }
};

}  // namespace detail

/// Fills in every stiffness and damping that the user left open, for a time step dt (s); the formula stands in
/// stability.hpp. What the user gave stays.
inline void derive_stiffness(Parts& m, double dt) {
  const detail::Derivation derivation(m, dt);
  for (std::size_t i = 0; i < m.joints.size(); ++i) derivation.fill(m, m.joint_specs[i], m.joints[i]);
  for (JointLimitState& e : m.limits) derivation.fill(m, given_limits(m.joint_specs[e.joint], e.dof), e);
  for (JointFrictionState& e : m.friction) derivation.fill(m, *m.joint_specs[e.joint].friction, e);
  for (Coupling& g : m.couplings) derivation.fill(m, g.spec, g);
}

/// The same machine with what its user gave alone: laid out for a step without end, all that is derived vanishes but
/// for dampers that belong to a given stiffness.
inline Parts without_derived(Parts m) {
  derive_stiffness(m, endless_step);
  return m;
}

/// What has no stiffness yet: its name, or an empty text. Without a time step nothing can be derived.
inline std::string first_underived(const Parts& m) {
  using namespace detail;
  for (const JointSpec& s : m.joint_specs) {
    const JointTraits& traits = traits_of(s.kind);
    const bool holds = traits.stiffness == Stiffness::derived;
    const bool displacement = holds && traits.hold != Hold::nothing && !(s.stiffness && s.damping);
    const bool rotation = holds && traits.align != Align::nothing && !(s.rotational_stiffness && s.rotational_damping);
    if (displacement || rotation) return fmt::format("{} '{}'", name_of(s.kind), s.name);
    for (const JointLimits& l : s.limits) {
      if (!(l.stiffness && l.damping)) return fmt::format("limits of '{}'", s.name);
    }
    if (s.friction && !(s.friction->stiffness && s.friction->velocity_stiffness)) {
      return fmt::format("friction of '{}'", s.name);
    }
  }
  for (const Coupling& g : m.couplings) {
    if (!(g.spec.stiffness && g.spec.damping)) return fmt::format("coupling '{}'", g.spec.name);
  }
  return {};
}

}  // namespace dem::mbd
