#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/parts.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace dem::mbd {

/// What is hardly meant as it was given: joints that are there twice, coordinates that two drives hold, actuators that
/// do nothing. In words; empty if there is nothing odd. Looked for where a machine is laid out, and told as it was
/// then.
std::string odd_parts(const Parts& m);

/// The free bodies that no joint, spring, drive or load is at.
std::vector<std::uint32_t> loose_bodies(const Parts& m);

/// That the first of some bodies falls; empty if there is none.
std::string note_of_loose(const Parts& m, const std::vector<std::uint32_t>& loose);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE std::string odd_parts(const Parts& m) {
  std::string text;
  const auto tell = [&](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  const auto are_one = [](const Vector3<double>& p, const Vector3<double>& q) { return norm(p - q) < 1e-6; };
  const auto joint_name = [&](JointId id) { return m.joint_specs[id.index()].name; };

  for (std::size_t k = 0; k < m.joints.size(); ++k) {
    const Joint& j = m.joints[k];
    if (!j.on || traits_of(j.kind).stiffness != Stiffness::derived) continue;
    for (std::size_t i = 0; i < k; ++i) {
      const Joint& other = m.joints[i];
      const bool is_twin = j.a == other.a && j.b == other.b && j.kind == other.kind && other.on &&
                           are_one(j.point_a, other.point_a) && are_one(j.point_b, other.point_b) &&
                           are_one(j.axes_a.z, other.axes_a.z) && are_one(j.axes_b.z, other.axes_b.z);
      if (!is_twin) continue;
      tell(dem::text("Joints '{}' and '{}' hold the same bodies at the same point: each tells half of the reaction.",
                     m.joint_specs[i].name, m.joint_specs[k].name));
    }
  }
  const auto does_nothing = [](const ActuatorSpec& s) {
    return s.position_gain == 0.0 && s.speed_gain == 0.0 && !s.has_throttle();
  };
  const auto is_of_joint = [](const PrescribedMotion& p) {
    return p.spec.on && p.spec.target == MotionSpec::Target::joint;
  };
  for (std::size_t k = 0; k < m.motions.size(); ++k) {
    const MotionSpec& motion = m.motions[k].spec;
    if (!is_of_joint(m.motions[k])) continue;
    for (std::size_t i = 0; i < k; ++i) {
      const MotionSpec& other = m.motions[i].spec;
      if (is_of_joint(m.motions[i]) && other.joint == motion.joint && other.dof == motion.dof) {
        tell(dem::text("Motions '{}' and '{}' prescribe the same coordinate of joint '{}': the first one counts.",
                       other.name, motion.name, joint_name(motion.joint)));
      }
    }
    for (const Actuator& u : m.actuators) {
      if (!u.spec.on || does_nothing(u.spec) || u.spec.max_force == 0.0) continue;
      if (u.spec.joint.valid() && u.spec.joint == motion.joint && u.spec.dof == motion.dof) {
        tell(
            dem::text("Actuator '{}' acts on joint '{}', whose coordinate motion '{}' prescribes: the motion has to "
                      "overcome it.",
                      u.spec.name, joint_name(motion.joint), motion.name));
      }
    }
  }
  for (const Actuator& u : m.actuators) {
    if (u.spec.on && does_nothing(u.spec))
      tell(dem::text("Actuator '{}' has no gain and is no motor: it does nothing.", u.spec.name));
  }
  return text;
}

DEM_INLINE std::vector<std::uint32_t> loose_bodies(const Parts& m) {
  std::vector<char> held(m.bodies.size());
  const auto hold = [&](BodyId id) {
    if (id.valid()) held[id.index()] = 1;
  };
  for (const Joint& j : m.joints) {
    if (traits_of(j.kind).stiffness != Stiffness::none) held[j.a] = held[j.b] = 1;
  }
  const auto hold_joint = [&](std::size_t k) { held[m.joints[k].a] = held[m.joints[k].b] = 1; };
  for (const JointLimitState& e : m.limits) hold_joint(e.joint);
  for (const Clutch& u : m.clutches) {
    hold(u.spec.a), hold(u.spec.b);
    for (const CouplingSpec::Term& term : u.spec.terms) hold_joint(term.joint.index());
  }
  for (const Spring& s : m.springs) held[s.a] = held[s.b] = 1;
  for (const Actuator& u : m.actuators) held[u.a] = held[u.b] = 1;
  for (const Load& l : m.loads) hold(l.spec.body);
  for (const PrescribedMotion& p : m.motions) hold(p.spec.body);
  std::vector<std::uint32_t> loose;
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    if (!m.bodies[i].fixed && !held[i]) loose.push_back(static_cast<std::uint32_t>(i));
  }
  return loose;
}

DEM_INLINE std::string note_of_loose(const Parts& m, const std::vector<std::uint32_t>& loose) {
  if (loose.empty()) return {};
  return dem::text("Nothing holds body '{}'{}: it falls freely.", m.bodies[loose.front()].name,
                   loose.size() > 1 ? dem::text(" and {} more", loose.size() - 1) : "");
}

}  // namespace dem::mbd

#endif
