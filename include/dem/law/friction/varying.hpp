#pragma once

#include <dem/core/error.hpp>
#include <dem/law/friction/friction_law.hpp>

#include <algorithm>
#include <numbers>

namespace dem::friction {

/// Another friction law with a coefficient that falls or rises with the sliding speed v and the normal pressure P:
///   mu = mu0 (rv + (1 - rv) exp(-v/v0)) (rp + (1 - rp) exp(-P/p0))
/// mu0 is the law's own coefficient: static, lightly pressed. rv = fast/static, rp = heavily/lightly pressed. A ratio
/// below 1 lets friction fall, one above 1 lets it rise. With the default ratios of 1 it is the law itself.
/// What P is follows from mean_pressure:
///   0: the normal force F of the whole contact, in N; p0 is then a force. Where points have areas in m^2, F per area,
///      in Pa.
///   1: F over the area pi R* d of Hertz's circle, in Pa: for contacts of curved bodies.
/// Friction that rises steeply is a damper of its own, mu0 (rv - 1) F/v0, which the stable time step does not count.
/// Take v0 well above mu F dt/m, the speed that friction takes off in a step.
template <class Law>
struct Varying {
  template <class T>
  struct Parameters {
    typename Law::template Parameters<T> law;
    T kinetic_ratio = T(1.0);   ///< rv >= 0
    T decay_speed = T(1.0);     ///< v0 > 0, m/s
    T pressed_ratio = T(1.0);   ///< rp >= 0
    T decay_pressure = T(1.0);  ///< p0 > 0, N or Pa as P
    T mean_pressure = T(0.0);   ///< 1: P is the mean pressure on Hertz's circle; 0: the force
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
    const T circle = T(std::numbers::pi) * s.effective_radius * max(s.overlap, T(0));
    const T area = select(p.mean_pressure > T(0), max(circle, T(1e-30)), T(1));  // across a gap: pressed to the utmost
    law.coefficient = law.coefficient * factor(p, norm(s.velocity), s.normal_force / area);
    return Law::force(law, s, h);
  }
  template <class H, class Turn>
  static DEM_HOT void carry(H& h, Turn&& turn) {
    Law::carry(h, turn);
  }

  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return stiffness_of<Law>(roughest(p), s);
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return contact::damping_of<Law>(roughest(p), s);
  }

  static double energy(const Parameters<double>& p, const History<double>& h) requires requires {
    Law::energy(p.law, h);
  }
  { return Law::energy(p.law, h); }

  static void check(const Parameters<double>& p) {
    Law::check(p.law);
    require_non_negative(p.kinetic_ratio, "ratio of kinetic to static friction", "(no unit)");
    require_positive(p.decay_speed, "decay speed of friction", "m/s");
    require_non_negative(p.pressed_ratio, "ratio of heavily to lightly pressed friction", "(no unit)");
    require_positive(p.decay_pressure, "decay pressure of friction", "N or Pa");
    if (p.mean_pressure != 0.0 && p.mean_pressure != 1.0) {
      fail("mean_pressure is {:g}, but must be 0 (the normal force counts) or 1 (the pressure on Hertz's circle)",
           p.mean_pressure);
    }
  }

 private:
  /// The law with the largest coefficient that it can have, for laws whose slopes depend on it.
  static typename Law::template Parameters<double> roughest(const Parameters<double>& p) {
    auto law = p.law;
    law.coefficient *= std::max(1.0, p.kinetic_ratio) * std::max(1.0, p.pressed_ratio);
    return law;
  }
};

}  // namespace dem::friction
