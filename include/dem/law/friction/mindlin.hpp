#pragma once

#include <dem/law/friction/friction_law.hpp>
#include <dem/law/friction/spring_slider.hpp>
#include <dem/law/normal/elastic.hpp>
#include <dem/law/normal/restitution.hpp>

#include <cmath>

namespace dem::friction {

/// Mindlin's tangential stiffness without slip inside the contact, for use with Hertz: kt = 8 G* sqrt(R* d), in
/// increments, slipping as a whole at mu Fn, with a dashpot (the share of critical damping is that of solid spheres, as
/// in CundallStrack). The spring's force is kept, not its stretch; where the contact circle shrinks, the force shrinks
/// with its radius, as the part of the circle that is gone can hold nothing: otherwise a cycle of loading, shearing and
/// unloading would create energy (Thornton, Cummins and Cleary 2013, doi:10.1016/j.powtec.2012.08.012).
struct Mindlin {
  template <class T>
  struct Parameters {
    T coefficient;    ///< mu
    T shear_modulus;  ///< G*, Pa (see contact::elastic_pair)
    T damping_ratio;  ///< of critical damping
    static constexpr const char* names[] = {"coefficient", "shear_modulus", "damping_ratio"};
  };
  template <class T>
  struct History {
    Vector3<T> spring_force;  ///< N
    T contact_radius;         ///< m, sqrt(R* d)
  };

  /// Without a damping ratio there is no dashpot. The ratio refers to 2/7 of the effective mass (see
  /// spring_slider.hpp).
  static Parameters<double> with(const contact::ElasticPair& pair, double coefficient, double damping_ratio = 0.0) {
    return {coefficient, pair.shear, damping_ratio};
  }
  /// The dashpot that leaves a sticking contact of solid spheres, at any overlap that it keeps, the given share of its
  /// tangential speed in half a swing. Throws Error unless 0.01 <= restitution <= 1.
  static Parameters<double> with_restitution(const contact::ElasticPair& pair, double coefficient, double restitution) {
    return with(pair, coefficient, contact::damping_ratio_of(restitution, true));
  }

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>& p, const TangentialState<T>& s, History<T>& h) {
    const T radius = sqrt(s.effective_radius * max(s.overlap, T(0)));
    const T stiffness = T(8) * p.shear_modulus * radius;
    const T damping = T(2) * p.damping_ratio * sqrt(T(tangential_mass_share) * s.effective_mass * stiffness);
    h.spring_force = min(T(1), radius / max(h.contact_radius, T(1e-300))) * h.spring_force;
    h.contact_radius = radius;
    h.spring_force += stiffness * s.time_step * s.velocity;
    return -slide(h.spring_force, damping, s.velocity, p.coefficient * s.normal_force);
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {
    h.spring_force = turn(h.spring_force);
  }

  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return 8.0 * p.shear_modulus * std::sqrt(s.effective_radius * s.overlap);
  }
  /// F^2/(2 kt).
  static double energy(const Parameters<double>& p, const History<double>& h) {
    const double stiffness = 8.0 * p.shear_modulus * h.contact_radius;
    return stiffness > 0.0 ? 0.5 * dot(h.spring_force, h.spring_force) / stiffness : 0.0;
  }
  static double damping(const Parameters<double>& p, const contact::NormalState<double>& s) {
    return 2.0 * p.damping_ratio * std::sqrt(tangential_mass_share * s.effective_mass * stiffness(p, s));
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.coefficient, "friction coefficient", "(no unit)");
    require_positive(p.shear_modulus, "effective shear modulus", "Pa");
    require_non_negative(p.damping_ratio, "friction damping ratio", "(no unit)");
  }
};

}  // namespace dem::friction
