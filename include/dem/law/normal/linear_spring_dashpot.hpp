#pragma once

#include <dem/law/normal/normal_law.hpp>
#include <dem/law/normal/restitution.hpp>

namespace dem::contact {

/// Linear spring and dashpot (Cundall and Strack 1979): F = k d + 2 b sqrt(k m) d'. With the effective mass m in the
/// dashpot, the restitution is the same for grains of every size and at every speed.
struct LinearSpringDashpot {
  template <class T>
  struct Parameters {
    T stiffness;          ///< k, N/m (per unit area if the shape's contact points have areas)
    T damping_ratio;      ///< b, of critical damping
    T may_pull = T(0.0);  ///< 1: the dashpot may pull at the end of a contact; 0: never
    static constexpr const char* names[] = {"stiffness", "damping_ratio", "may_pull"};
  };
  template <class T>
  struct History {};

  /// Constants with which grains rebound with the given coefficient of restitution, exactly (see restitution_of).
  /// Throws Error unless 0.01 <= restitution <= 1.
  static Parameters<double> with_restitution(double stiffness, double restitution, bool may_pull = false) {
    return {stiffness, damping_ratio_of(restitution, may_pull), may_pull ? 1.0 : 0.0};
  }

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    const T damping = T(2) * p.damping_ratio * sqrt(p.stiffness * s.effective_mass);
    const T f = p.stiffness * s.overlap + damping * s.approach_speed;
    return select(p.may_pull > T(0), f, max(T(0), f));
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>&) { return p.stiffness; }
  static double damping(const Parameters<double>& p, const NormalState<double>& s) {
    return 2.0 * p.damping_ratio * std::sqrt(p.stiffness * s.effective_mass);
  }
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    return 0.5 * p.stiffness * s.overlap * s.overlap;
  }

  static void check(const Parameters<double>& p) {
    require_positive(p.stiffness, "normal stiffness", "N/m");
    require_non_negative(p.damping_ratio, "normal damping ratio", "(no unit)");
    require_within(p.may_pull, 0.0, 1.0, "may_pull (0: no, 1: yes)");
  }
};

}  // namespace dem::contact
