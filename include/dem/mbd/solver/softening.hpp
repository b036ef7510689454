#pragma once

#include <dem/mbd/solver/derive.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace dem::mbd {

/// Keeps what was derived for one pose stable in others. A joint at a lever L of a body moves it by 1/m + L^2/I per
/// newton, so a spring that was laid out for a short lever is too stiff for a long one. Every few steps such springs
/// are lowered to what would be derived in the present pose, with their limits, friction and couplings; users' values
/// are left alone. Nothing is raised again, as a strained spring that gets stiffer gains energy, while one that gets
/// softer loses some.
///
/// Laid out at omega dt = 0.7 and half of critical damping, a part stays stable until a newton moves its bodies 2.1
/// times as far, with each of the integrators. So it is looked at again after a single step where it was found too
/// stiff by a fifth, and each time twice as late, up to 64 steps, where it was by less than a twentieth.
class Softening {
 public:
  Softening() = default;
  /// For what has been derived in `m` for steps of dt (s).
  Softening(const Parts& m, double dt) {
    for (std::uint32_t i = 0; i < m.joints.size(); ++i) {
      const JointSpec& s = m.joint_specs[i];
      const bool given = s.stiffness && s.damping && s.rotational_stiffness && s.rotational_damping;
      const JointTraits& traits = traits_of(s.kind);
      if (traits.changes_with_pose && traits.stiffness == Stiffness::derived && !given) joints_.push_back(i);
    }
    const auto changes = [&](std::uint32_t joint) { return traits_of(m.joints[joint].kind).changes_with_pose; };
    for (std::uint32_t i = 0; i < m.limits.size(); ++i) {
      if (changes(m.limits[i].joint)) limits_.push_back(i);
    }
    for (std::uint32_t i = 0; i < m.friction.size(); ++i) {
      if (changes(m.friction[i].joint)) friction_.push_back(i);
    }
    for (std::uint32_t i = 0; i < m.couplings.size(); ++i) {
      const auto& terms = m.couplings[i].spec.terms;
      if (std::any_of(terms.begin(), terms.end(), [&](const auto& t) { return changes(t.joint.value); })) {
        couplings_.push_back(i);
      }
    }
    if (joints_.size() + limits_.size() + friction_.size() + couplings_.size() > 0) derivation_ = {m, dt};
  }

  /// To be called at the end of each step.
  void follow(Parts& m) {
    if (derivation_.shares.empty() || --steps_left_ > 0) return;
    const double excess = lower(m);
    interval_ = excess > 1.2 ? 1 : excess > 1.05 ? interval_ : std::min(2 * interval_, longest_interval);
    steps_left_ = interval_;
  }

 private:
  static constexpr int longest_interval = 64;  // steps

  /// Returns how many times too stiff the worst one was.
  double lower(Parts& m) const {
    double worst = 1.0;
    const auto cut = [&](double& value, double allowed) {
      if (!(value > 1.001 * allowed)) return;  // not for rounding alone
      worst = std::max(worst, value / allowed);
      value = allowed;
    };
    for (const std::uint32_t i : joints_) {
      Joint& j = m.joints[i];
      Joint now = j;
      derivation_.fill(m, m.joint_specs[i], now);
      cut(j.k, now.k);
      cut(j.c, now.c);
      cut(j.kr, now.kr);
      cut(j.cr, now.cr);
    }
    for (const std::uint32_t i : limits_) {
      JointLimitState& e = m.limits[i];
      JointLimitState now = e;
      derivation_.fill(m, given_limits(m.joint_specs[e.joint], e.dof), now);
      cut(e.stiffness, now.stiffness);
      cut(e.damping, now.damping);
    }
    for (const std::uint32_t i : friction_) {
      JointFrictionState& e = m.friction[i];
      JointFrictionState now = e;
      derivation_.fill(m, *m.joint_specs[e.joint].friction, now);
      cut(e.law.stiffness, now.law.stiffness);
      cut(e.law.velocity_stiffness, now.law.velocity_stiffness);
    }
    for (const std::uint32_t i : couplings_) {
      Coupling& g = m.couplings[i];
      Coupling now = g;
      derivation_.fill(m, g.spec, now);
      cut(g.k, now.k);
      cut(g.c, now.c);
    }
    return worst;
  }

  detail::Derivation derivation_;
  std::vector<std::uint32_t> joints_, limits_, friction_, couplings_;
  int interval_ = 1, steps_left_ = 1;
};

}  // namespace dem::mbd
