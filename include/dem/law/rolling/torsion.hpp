#pragma once

#include <dem/core/error.hpp>
#include <dem/law/rolling/rolling_law.hpp>

#include <cmath>

namespace dem::rolling {

/// Resistance against twisting about the normal: a spring k R*^2 and a dashpot that slip at the torque mu_t R* Fn. For
/// a contact circle of radius a pressed as Hertz says, friction mu slips at 3 pi/16 mu a Fn (Johnson, Contact
/// Mechanics, 1985, section 7.4): mu_t = 3 pi/16 mu a/R*. Laws of friction and rolling resistance leave this motion
/// free: without torsion a single ball pivots about the vertical for ever.
struct Torsion {
  template <class T>
  struct Parameters {
    T coefficient;    ///< mu_t
    T stiffness;      ///< k, N/m
    T damping_ratio;  ///< of critical damping
    static constexpr const char* names[] = {"coefficient", "stiffness", "damping_ratio"};
  };
  template <class T>
  struct History {
    T angle;  ///< rad about the normal, of i relative to j: the same seen from j
  };

  template <class T>
  static DEM_HOT Vector3<T> torque(const Parameters<T>& p, const RollingState<T>& s, History<T>& h) {
    const T radius2 = s.effective_radius * s.effective_radius, k = p.stiffness * radius2;
    const T damping = T(2) * p.damping_ratio * sqrt(T(twisting_inertia) * s.effective_mass * radius2 * k);
    const T limit = p.coefficient * s.effective_radius * s.normal_force;
    const auto limited = [&](const T& value) { return max(-limit, min(limit, value)); };
    const T spring = limited(k * (h.angle + s.time_step * s.twisting));
    h.angle = spring / k;
    return -(limited(spring + damping * s.twisting) * s.normal);
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>&, Turn&&) {}

  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return p.stiffness * s.effective_radius * s.effective_radius;
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    const double radius2 = s.effective_radius * s.effective_radius;
    return 2.0 * p.damping_ratio * std::sqrt(twisting_inertia * s.effective_mass * p.stiffness) * radius2;
  }

  static double energy(const Parameters<double>& p, double radius, const History<double>& h) {
    return 0.5 * p.stiffness * radius * radius * h.angle * h.angle;
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "twisting coefficient", "(no unit)");
    require_positive(p.stiffness, "twisting stiffness", "N/m");
    require_non_negative(p.damping_ratio, "twisting damping ratio", "(no unit)");
  }
};

}  // namespace dem::rolling
