#pragma once

#include <dem/law/friction/friction_law.hpp>
#include <dem/law/friction/spring_slider.hpp>
#include <dem/law/normal/elastic.hpp>
#include <dem/law/normal/restitution.hpp>

#include <cmath>

namespace dem::friction {

/// Linear tangential spring with a dashpot, slipping at mu Fn (Cundall and Strack 1979,
/// doi:10.1680/geot.1979.29.1.47). The dashpot is given as a share of critical damping of the tangential swing of solid
/// spheres, whose mass is 2/7 of the effective mass (see spring_slider.hpp).
struct CundallStrack {
  template <class T>
  struct Parameters {
    T coefficient;    ///< mu
    T stiffness;      ///< kt, N/m
    T damping_ratio;  ///< of critical damping
    static constexpr const char* names[] = {"coefficient", "stiffness", "damping_ratio"};
  };
  template <class T>
  struct History {
    Vector3<T> spring;  ///< m, stretch
  };

  /// The spring that belongs to a linear normal spring (N/m) by the materials' Poisson ratios: see
  /// contact::tangential_share.
  static Parameters<double> with(const contact::ElasticPair& pair, double coefficient, double normal_stiffness,
                                 double damping_ratio = 0.0) {
    return {coefficient, contact::tangential_share(pair) * normal_stiffness, damping_ratio};
  }
  /// The same with the dashpot that leaves a sticking contact of solid spheres the given share of its tangential speed
  /// in half a swing. Throws Error unless 0.01 <= restitution <= 1.
  static Parameters<double> with_restitution(const contact::ElasticPair& pair, double coefficient,
                                             double normal_stiffness, double restitution) {
    return with(pair, coefficient, normal_stiffness, contact::damping_ratio_of(restitution, true));
  }

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>& p, const TangentialState<T>& s, History<T>& h) {
    const T damping = T(2) * p.damping_ratio * sqrt(T(tangential_mass_share) * s.effective_mass * p.stiffness);
    Vector3<T> spring = p.stiffness * (h.spring + s.time_step * s.velocity);
    const Vector3<T> f = slide(spring, damping, s.velocity, p.coefficient * s.normal_force);
    h.spring = T(1) / p.stiffness * spring;
    return -f;
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {
    h.spring = turn(h.spring);
  }

  static double stiffness(const Parameters<double>& p) { return p.stiffness; }
  static double energy(const Parameters<double>& p, const History<double>& h) {
    return 0.5 * p.stiffness * dot(h.spring, h.spring);
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return 2.0 * p.damping_ratio * std::sqrt(tangential_mass_share * s.effective_mass * p.stiffness);
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "friction coefficient", "(no unit)");
    require_positive(p.stiffness, "friction spring stiffness", "N/m");
    require_non_negative(p.damping_ratio, "friction damping ratio", "(no unit)");
  }
};

}  // namespace dem::friction
