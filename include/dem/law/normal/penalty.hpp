#pragma once

#include <dem/core/error.hpp>
#include <dem/law/normal/normal_law.hpp>

namespace dem::contact {

/// Penalty spring with an asymmetric damper (thesis eq. 25): F = K d + C d' while approaching, K d + Sp C d' while
/// separating, never pulling; the world multiplies it by the area A.
struct Penalty {
  template <class T>
  struct Parameters {
    T stiffness;          ///< K, N/m (per unit area if the shape's contact points have areas)
    T damping;            ///< C, N s/m (per unit area likewise)
    T separation_factor;  ///< Sp in [0, 1]: the share of the damping that acts while separating
    static constexpr const char* names[] = {"stiffness", "damping", "separation_factor"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    const T factor = select(s.approach_speed < T(0), p.separation_factor, T(1));
    return max(T(0), p.stiffness * s.overlap + factor * p.damping * s.approach_speed);
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>&) { return p.stiffness; }
  static double damping(const Parameters<double>& p, const NormalState<double>&) { return p.damping; }
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    return 0.5 * p.stiffness * s.overlap * s.overlap;
  }

  static void check(const Parameters<double>& p) {
    require_positive(p.stiffness, "normal stiffness", "N/m");
    require_non_negative(p.damping, "normal damping", "N s/m");
    require_within(p.separation_factor, 0.0, 1.0, "separation damping factor");
  }
};

}  // namespace dem::contact
