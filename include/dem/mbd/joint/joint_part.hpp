#pragma once

// Joints: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/free.hpp>
#include <dem/mbd/joint/make_joint.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd::detail {

/// One that is switched off may be switched on again, so it counts as if it were on.
void list_joint(const Parts& m, std::size_t index, const PartKind& kind, std::vector<Element>& list);

void derive(const Parts& m, const JointSpec& s, Joint& j, const Derivation& derivation);

double soften_joints(Parts& m, const Derivation& derivation);

std::string first_underived_joint(const Parts& m);

inline constexpr PartKind joint_kind = {
    .rank = 1,
    .add_forces =
        [](Parts& m, const Evaluation& now) {
          for (Joint& j : m.joints) {
            if (j.on && !j.rigid) [[likely]] {
              traits_of(j.kind).force(j, m.bodies[j.a], m.bodies[j.b], m.global_angular_velocity[j.a],
                                      m.global_angular_velocity[j.b], now.followed());
            } else if (j.turns) {
              follow_turns(j, m.bodies[j.a], m.bodies[j.b], m.global_angular_velocity[j.a],
                           m.global_angular_velocity[j.b], now.followed());
            }
          }
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.joints.size(); ++i) list_joint(m, i, joint_kind, list);
        },
    .name_of = joint_in_words,
    .derive =
        [](Parts& m, const Derivation& derivation) {
          for (std::size_t i = 0; i < m.joints.size(); ++i) {
            detail::derive(m, m.joint_specs[i], m.joints[i], derivation);
          }
        },
    .soften = soften_joints,
    .first_underived = first_underived_joint,
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.joint_specs.begin(), m.joint_specs.end(), [](const JointSpec& s) {
            const JointTraits& traits = traits_of(s.kind);
            return traits.changes_with_pose && (traits.stiffness == Stiffness::own || s.has_stiffness_or_damping());
          });
        }};

JointId add_joint(Parts& parts, JointSpec spec);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE void list_joint(const Parts& m, std::size_t index, const PartKind& kind, std::vector<Element>& list) {
  const Joint& j = m.joints[index];
  const Stiffness stiffness = traits_of(j.kind).stiffness;
  if (stiffness == Stiffness::none) return;
  const JointInverseMass w = inverse_mass_of(j, m.bodies[j.a], m.bodies[j.b]);
  Element e{&kind, index, {{j.a}, {j.b}}};
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

DEM_INLINE void derive(const Parts& m, const JointSpec& s, Joint& j, const Derivation& derivation) {
  if (traits_of(j.kind).stiffness != Stiffness::derived) return;
  const JointInverseMass w = inverse_mass_of(j, m.bodies[j.a], m.bodies[j.b]);
  const double displacement = derivation.shared(j, {w.displacement_a, w.displacement_b});
  const double rotation = derivation.shared(j, {w.rotation_a, w.rotation_b});
  const bool both = displacement > 0.0 && rotation > 0.0;
  const double factor = joint_frequency * (both ? std::sqrt(0.5) : 1.0);
  // Derived damping belongs to the joint's whole frequency, which is higher than that of its displacements alone.
  const auto damping_of = [&](const std::optional<double>& k, double derived, double inverse_mass) {
    return k ? Derivation::damping(*k, inverse_mass) : 2.0 * damping_ratio * derived * derivation.dt / joint_frequency;
  };
  j.k = s.stiffness.value_or(derivation.stiffness(factor, displacement));
  j.kr = s.rotational_stiffness.value_or(derivation.stiffness(factor, rotation));
  j.c = s.damping.value_or(damping_of(s.stiffness, j.k, displacement));
  j.cr = s.rotational_damping.value_or(damping_of(s.rotational_stiffness, j.kr, rotation));
}

DEM_INLINE double soften_joints(Parts& m, const Derivation& derivation) {
  double worst = 0.0;
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    Joint& j = m.joints[i];
    const JointSpec& s = m.joint_specs[i];
    const JointTraits& traits = traits_of(s.kind);
    const bool given = s.stiffness && s.damping && s.rotational_stiffness && s.rotational_damping;
    if (!traits.changes_with_pose || traits.stiffness != Stiffness::derived || given) continue;
    worst = std::max(worst, 1.0);
    Joint now = j;
    derive(m, s, now, derivation);
    lower_to(j.k, now.k, worst);
    lower_to(j.c, now.c, worst);
    lower_to(j.kr, now.kr, worst);
    lower_to(j.cr, now.cr, worst);
  }
  return worst;
}

DEM_INLINE std::string first_underived_joint(const Parts& m) {
  for (const JointSpec& s : m.joint_specs) {
    const JointTraits& traits = traits_of(s.kind);
    if (traits.stiffness != Stiffness::derived) continue;
    const bool displacement = traits.hold != Hold::nothing && !(s.stiffness && s.damping);
    const bool rotation = traits.align != Align::nothing && !(s.rotational_stiffness && s.rotational_damping);
    if (displacement || rotation) return name_of(s.kind) + (" '" + s.name + "'");
  }
  return {};
}

DEM_INLINE JointId add_joint(Parts& parts, JointSpec spec) {
  require_no_step(parts);  // before its limits and friction are kept
  settle_name(spec.name, parts.joint_specs, "joint", "joints", [](const JointSpec& s) { return s.name; });
  const Joint j = make_joint(parts, spec);
  const auto number = static_cast<std::uint32_t>(parts.joints.size());
  const std::size_t limits = parts.limits.size();
  try {
    if (spec.add_limits) spec.add_limits(parts, spec, j, number);
    if (spec.add_friction) spec.add_friction(parts, spec, j, number);
  } catch (...) {  // a refused joint leaves nothing behind
    parts.limits.resize(limits);
    throw;
  }
  use(parts, joint_kind);
  parts.joints.push_back(j);
  return keep<JointId>(parts, parts.joint_specs, std::move(spec));
}

}  // namespace dem::mbd::detail

#endif
