#pragma once

#include <dem/core/error.hpp>
#include <dem/law/friction/spring_slider.hpp>
#include <dem/law/rolling/rolling_law.hpp>

#include <cmath>

namespace dem::rolling {

/// Elastic-plastic rolling resistance: a spring and a dashpot between the rolling partners that slip at the torque
/// mu_r R* Fn (type C of Ai et al. 2011, doi:10.1016/j.powtec.2010.09.030). It holds a ball on every slope below
/// atan(mu_r). The spring is kr = k R*^2: k = kt, the tangential stiffness, is the choice of Wensrich and Katterfeld
/// (2012, doi:10.1016/j.powtec.2011.10.057), k = 2.25 mu_r^2 kn that of Jiang et al. as Ai et al. use it. Spring and
/// dashpot together never exceed the limit, as in friction. It does not resist a turn about the normal, by which single
/// balls pivot on a floor for ever: rolling::Sum<ElasticPlastic, Torsion> stops that as well.
struct ElasticPlastic {
  template <class T>
  struct Parameters {
    T coefficient;    ///< mu_r, the tangent of the slope on which a ball begins to roll
    T stiffness;      ///< k, N/m
    T damping_ratio;  ///< of critical damping; 0.3 is common
    static constexpr const char* names[] = {"coefficient", "stiffness", "damping_ratio"};
  };
  template <class T>
  struct History {
    Vector3<T> angle;  ///< rad, stretch of the spring
  };

  template <class T>
  static DEM_HOT Vector3<T> torque(const Parameters<T>& p, const RollingState<T>& s, History<T>& h) {
    const T radius2 = s.effective_radius * s.effective_radius, k = p.stiffness * radius2;
    const T damping = T(2) * p.damping_ratio * sqrt(T(rolling_inertia) * s.effective_mass * radius2 * k);
    Vector3<T> spring = k * (h.angle + s.time_step * s.rolling);
    const Vector3<T> sum =
        friction::slide(spring, damping, s.rolling, p.coefficient * s.effective_radius * s.normal_force);
    h.angle = T(1) / k * spring;
    return -sum;
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {
    h.angle = turn(h.angle);
  }

  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return p.stiffness * s.effective_radius * s.effective_radius;
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    const double radius2 = s.effective_radius * s.effective_radius;
    return 2.0 * p.damping_ratio * std::sqrt(rolling_inertia * s.effective_mass * p.stiffness) * radius2;
  }

  static double energy(const Parameters<double>& p, double radius, const History<double>& h) {
    return 0.5 * p.stiffness * radius * radius * dot(h.angle, h.angle);
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "rolling coefficient", "(no unit)");
    require_positive(p.stiffness, "rolling stiffness", "N/m");
    require_non_negative(p.damping_ratio, "rolling damping ratio", "(no unit)");
  }
};

}  // namespace dem::rolling
