#pragma once

#include <dem/core/error.hpp>
#include <dem/law/friction/friction_law.hpp>

namespace dem::friction {

/// Coulomb friction with a viscous ramp instead of sticking: F = min(c |vt|, mu Fn) against the sliding velocity. It
/// remembers nothing and holds nothing: a block on a slope creeps at m g sin/c.
struct CoulombViscous {
  template <class T>
  struct Parameters {
    T coefficient;  ///< mu
    T damping;      ///< c, N s/m
    static constexpr const char* names[] = {"coefficient", "damping"};
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>& p, const TangentialState<T>& s, History<T>&) {
    const T speed = norm(s.velocity);
    const T size = min(p.damping * speed, p.coefficient * s.normal_force);
    return -(size / max(speed, T(1e-300)) * s.velocity);
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>&, Turn&&) {}

  static double stiffness(const Parameters<double>&) { return 0.0; }
  static double energy(const Parameters<double>&, const History<double>&) { return 0.0; }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>&) { return p.damping; }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "friction coefficient", "(no unit)");
    require_non_negative(p.damping, "friction damping", "N s/m");
  }
};

}  // namespace dem::friction
