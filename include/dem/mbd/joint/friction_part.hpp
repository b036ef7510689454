#pragma once

// Friction of joints: how it is added, and what the solver asks of it.

#include <dem/core/macros.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/solver/effective_mass.hpp>
#include <dem/mbd/solver/part_kind.hpp>

namespace dem::mbd {

namespace detail {

inline const JointFriction& given_friction(const Parts& m, const JointFrictionState& e) {
  return *m.joint_specs[e.joint].friction;
}
std::pair<double, double> inverse_mass_of(const Parts& m, const JointFrictionState& e);
void derive(const Parts& m, JointFrictionState& e, const Derivation& derivation);

inline constexpr PartKind friction_kind = {
    .rank = 2,
    .add_forces =
        [](Parts& m, const Evaluation& now) {
          for (JointFrictionState& e : m.friction) {
            const Joint& j = m.joints[e.joint];
            apply_friction(e, j, m.bodies[j.a], m.bodies[j.b], now.slip_time);
          }
        },
    .list_elements =
        [](const Parts& m, std::vector<Element>& list) {
          for (std::size_t i = 0; i < m.friction.size(); ++i) {
            const JointFrictionState& e = m.friction[i];
            add_element(list, friction_kind, i, m.joints[e.joint], inverse_mass_of(m, e), e.law.stiffness,
                        e.law.velocity_stiffness);
          }
        },
    .name_of = [](const Parts& m, std::size_t i) { return "friction of " + joint_in_words(m, m.friction[i].joint); },
    .derive =
        [](Parts& m, const Derivation& derivation) {
          for (JointFrictionState& e : m.friction) detail::derive(m, e, derivation);
        },
    .soften =
        [](Parts& m, const Derivation& derivation) {
          double worst = 0.0;
          for (JointFrictionState& e : m.friction) {
            if (!traits_of(m.joints[e.joint].kind).changes_with_pose) continue;
            worst = std::max(worst, 1.0);
            JointFrictionState now = e;
            detail::derive(m, now, derivation);
            lower_to(e.law.stiffness, now.law.stiffness, worst);
            lower_to(e.law.velocity_stiffness, now.law.velocity_stiffness, worst);
          }
          return worst;
        },
    .first_underived = [](const Parts& m) -> std::string {
      for (const JointFrictionState& e : m.friction) {
        const JointFriction& given = given_friction(m, e);
        if (!(given.stiffness && given.velocity_stiffness)) {
          return "friction of '" + m.joint_specs[e.joint].name + "'";
        }
      }
      return {};
    },
    .may_grow =
        [](const Parts& m) {
          return std::any_of(m.friction.begin(), m.friction.end(), [&](const JointFrictionState& e) {
            const JointFriction& given = given_friction(m, e);
            return traits_of(m.joints[e.joint].kind).changes_with_pose && (given.stiffness || given.velocity_stiffness);
          });
        }};

/// Throws Error if the joint cannot rub, or its bearing's radius (m) is missing or is none.
void check_friction(const JointSpec& s, const std::string& who);

/// Adds the friction of joint number `joint`. Throws Error for what cannot be.
void add_friction(Parts& parts, JointSpec& s, const Joint&, std::uint32_t joint);

}  // namespace detail

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE std::pair<double, double> inverse_mass_of(const Parts& m, const JointFrictionState& e) {
  const Joint& j = m.joints[e.joint];
  return inverse_mass_of_friction(j, m.bodies[j.a], m.bodies[j.b], e.radius);
}

DEM_INLINE void derive(const Parts& m, JointFrictionState& e, const Derivation& derivation) {
  const JointFriction& given = given_friction(m, e);
  const double w = derivation.shared(m.joints[e.joint], inverse_mass_of(m, e));
  e.law.stiffness = given.stiffness.value_or(derivation.stiffness(friction_frequency, w));
  e.law.velocity_stiffness = given.velocity_stiffness.value_or(Derivation::damping(e.law.stiffness, w));
}

DEM_INLINE void check_friction(const JointSpec& s, const std::string& who) {
  const JointTraits& traits = traits_of(s.kind);
  if (traits.bearing == Bearing::none) {
    fail(
        "{} has friction, but a {} has no bearing surface that a load presses together and that could rub; give "
        "with_friction to a joint that slides or turns on one (revolute, prismatic, cylindrical, spherical ...); a "
        "bushing has dampers",
        who, name_of(s.kind));
  }
  const double radius = s.friction->radius;
  const std::string what = "JointFriction::radius, of the bearing of " + who;
  if (traits.bearing == Bearing::guide || traits.bearing == Bearing::point) {
    if (radius != 0.0) {
      fail("{} is {:g} m, but only the sliding of a {} rubs; leave the radius out", what, radius, traits.name);
    }
  } else if (traits.bearing == Bearing::plate) {
    require_non_negative(radius, what.c_str(), "m");
  } else {
    require_positive(radius, what.c_str(), "m");
  }
}

DEM_INLINE void add_friction(Parts& parts, JointSpec& s, const Joint&, std::uint32_t joint) {
  const std::string who = dem::text("{} '{}'", name_of(s.kind), s.name);
  check_friction(s, who);
  const JointFriction& f = *s.friction;
  JointFrictionState e;
  e.joint = joint;
  e.radius = f.radius;
  e.preload = require_non_negative(f.preload, ("preload of " + who).c_str(), "N");
  e.lever = require_non_negative(f.lever, ("lever of " + who).c_str(), "m");
  e.law = {f.coefficient, f.stiffness.value_or(0.0), f.velocity_stiffness.value_or(0.0), f.breaking_factor};
  friction::AsperitySpring::check(e.law);
  use(parts, friction_kind);
  parts.friction.push_back(e);
}

}  // namespace dem::mbd::detail

namespace dem::mbd {

DEM_INLINE JointSpec JointSpec::with_friction(const JointFriction& f) const {
  JointSpec s = *this;
  s.friction = f;
  s.add_friction = detail::add_friction;
  return s;
}

}  // namespace dem::mbd

#endif
