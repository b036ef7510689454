#pragma once

#include <dem/core/error.hpp>
#include <dem/friction/friction_law.hpp>

namespace dem::friction {

/// Another friction law with a coefficient that falls with the sliding speed v and the normal pressure P:
///   mu = mu0 (rv + (1 - rv) exp(-v/v0)) (rp + (1 - rp) exp(-P/p0)),
/// mu0 the law's own coefficient (static, lightly pressed), rv = kinetic/static, rp = heavily/lightly pressed. With the
/// default ratios of 1 it is the law itself. The pressure is the normal force per area of the contact point where
/// it has one in m^2; elsewhere that of the whole contact, so that p0 is a force then, as the normal stiffness is N/m.
template <class Law>
struct Varying {
  template <class T>
  struct Parameters {
    typename Law::template Parameters<T> law;
    T kinetic_ratio = T(1.0);   ///< rv in [0, 1]
    T decay_speed = T(1.0);     ///< v0 > 0, m/s
    T pressed_ratio = T(1.0);   ///< rp in [0, 1]
    T decay_pressure = T(1.0);  ///< p0 > 0, Pa (N for spheres)
  };
  template <class T>
  using History = typename Law::template History<T>;
  static_assert(
      requires(const typename Law::template Parameters<double>& p) { p.coefficient; },
      "friction::Varying: the law that it wraps needs a parameter 'coefficient'");

  /// The factor of the coefficient.
  template <class T>
  static DEM_HOT T factor(const Parameters<T>& p, const T& speed, const T& pressure) {
    return (p.kinetic_ratio + (T(1) - p.kinetic_ratio) * exp(-speed / p.decay_speed)) *
           (p.pressed_ratio + (T(1) - p.pressed_ratio) * exp(-pressure / p.decay_pressure));
  }

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>& p, const TangentialState<T>& s, History<T>& h) {
    typename Law::template Parameters<T> law = p.law;
    law.coefficient = law.coefficient * factor(p, norm(s.velocity), s.normal_force);
    return Law::force(law, s, h);
  }
  template <class H, class Turn>
  static DEM_HOT void carry(H& h, Turn&& turn) {
    Law::carry(h, turn);
  }

  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return stiffness_of<Law>(p.law, s);
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return contact::damping_of<Law>(p.law, s);
  }

  static void check(const Parameters<double>& p) {
    Law::check(p.law);
    require_within(p.kinetic_ratio, 0.0, 1.0, "ratio of kinetic to static friction");
    require_positive(p.decay_speed, "decay speed of friction", "m/s");
    require_within(p.pressed_ratio, 0.0, 1.0, "ratio of heavily to lightly pressed friction");
    require_positive(p.decay_pressure, "decay pressure of friction", "Pa");
  }
};

}  // namespace dem::friction
