#pragma once

// Limits of joints: how they are added, and what the solver asks of them.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd {

namespace detail {

/// The limits that a joint's user gave for a coordinate.
const JointLimits& given_limits(const Parts& m, const JointLimitState& e);
std::pair<double, double> inverse_mass_of(const Parts& m, const JointLimitState& e);
void derive(const Parts& m, JointLimitState& e, const Derivation& derivation);

inline constexpr PartKind limits_kind = {
    .rank = 3,
    .add_forces =
        [](Parts& m, const Evaluation&) {
          for (JointLimitState& e : m.limits) {
            const Joint& j = m.joints[e.joint];
            apply_limits(e, j, m.bodies[j.a], m.bodies[j.b]);
          }
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.limits.size(); ++i) {
            const JointLimitState& e = m.limits[i];
            add_element(list, limits_kind, i, m.joints[e.joint], inverse_mass_of(m, e), e.stiffness, e.damping);
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "limits of " + joint_in_words(m, m.limits[i].joint); },
    .derive =
        [](Parts& m, const Derivation& derivation) {
          for (JointLimitState& e : m.limits) detail::derive(m, e, derivation);
        },
    .soften =
        [](Parts& m, const Derivation& derivation) {
          double worst = 0.0;
          for (JointLimitState& e : m.limits) {
            if (!traits_of(m.joints[e.joint].kind).changes_with_pose) continue;
            worst = std::max(worst, 1.0);
            JointLimitState now = e;
            detail::derive(m, now, derivation);
            lower_to(e.stiffness, now.stiffness, worst);
            lower_to(e.damping, now.damping, worst);
          }
          return worst;
        },
    .first_underived = [](const Parts& m) -> std::string {
      for (const JointLimitState& e : m.limits) {
        const JointLimits& given = given_limits(m, e);
        if (!(given.stiffness && given.damping)) return "limits of '" + m.joint_specs[e.joint].name + "'";
      }
      return {};
    },
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.limits.begin(), m.limits.end(), [&](const JointLimitState& e) {
            const JointLimits& given = given_limits(m, e);
            return traits_of(m.joints[e.joint].kind).changes_with_pose && (given.stiffness || given.damping);
          });
        }};

/// Adds the limits of a joint that is about to be added, as number `joint`.
void add_limits(Parts& parts, JointSpec& s, const Joint& j, std::uint32_t joint);

}  // namespace detail

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE const JointLimits& given_limits(const Parts& m, const JointLimitState& e) {
  const std::vector<JointLimits>& given = m.joint_specs[e.joint].limits;
  return *std::find_if(given.begin(), given.end(), [&](const JointLimits& l) { return l.dof == e.dof; });
}

DEM_INLINE std::pair<double, double> inverse_mass_of(const Parts& m, const JointLimitState& e) {
  const Joint& j = m.joints[e.joint];
  return inverse_mass_along(j, m.bodies[j.a], m.bodies[j.b], e.dof);
}

DEM_INLINE void derive(const Parts& m, JointLimitState& e, const Derivation& derivation) {
  const JointLimits& given = given_limits(m, e);
  const double w = derivation.shared(m.joints[e.joint], inverse_mass_of(m, e));
  e.stiffness = given.stiffness.value_or(derivation.stiffness(joint_frequency, w));
  e.damping = given.damping.value_or(Derivation::damping(e.stiffness, w));
}

DEM_INLINE void add_limits(Parts& parts, JointSpec& s, const Joint& j, std::uint32_t joint) {
  const std::string who = dem::text("{} '{}'", name_of(s.kind), s.name);
  for (JointLimits& l : s.limits) {
    l.dof = require_free_dof(s.kind, l.dof, "a limit of " + who);
    if (!(l.lower < l.upper)) {
      fail("the limits of {} are {:g} to {:g}: the lower one must be below the upper one", who, l.lower, l.upper);
    }
    const double start = coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b], l.dof).value;
    if (!(start >= l.lower - s.tolerance && start <= l.upper + s.tolerance)) {
      fail(
          "the limits of {} are {:g} to {:g}, but its {} starts at {:g}; widen them, move a body, or say with "
          "starting_at what the coordinate is at assembly",
          who, l.lower, l.upper, name_of(l.dof), start);
    }
    if (l.stiffness) require_non_negative(*l.stiffness, ("limit stiffness of " + who).c_str(), "N/m or N m/rad");
    if (l.damping) require_non_negative(*l.damping, ("limit damping of " + who).c_str(), "N s/m or N m s/rad");
    for (const JointLimitState& e : parts.limits) {
      if (e.joint == joint && e.dof == l.dof) {
        fail("{} has two pairs of limits for its {}; give one", who, name_of(l.dof));
      }
    }
    use(parts, limits_kind);
    parts.limits.push_back(
        {joint, l.dof, l.lower, l.upper, l.stiffness.value_or(0.0), l.damping.value_or(0.0), 0.0, {0, 0, 0}});
  }
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE JointSpec JointSpec::with_limits(const JointLimits& given) const {
  JointSpec s = *this;
  s.limits.push_back(given);
  s.add_limits = detail::add_limits;
  return s;
}

}  // namespace dem::mbd

#endif
