#pragma once

#include <dem/law/normal/elastic.hpp>
#include <dem/law/normal/normal_law.hpp>
#include <dem/law/normal/restitution.hpp>

namespace dem::contact {

/// Hertz's contact of curved elastic bodies, with the viscous damper that gives every impact the same restitution
/// (Tsuji et al. 1992, doi:10.1016/0032-5910(92)88030-L; closed form by Antypov and Elliott 2011):
///   F = k d^(3/2) + sqrt(5) b sqrt(k m) d^(1/4) d',   k = 4/3 E* sqrt(R*),   b the damping ratio.
/// It stiffens with the overlap. The stable time step takes it at WorldOptions::overlap_limit, the overlap above which
/// a run is reported as broken. So a limit a few times the expected overlaps allows longer steps; impacts overlap more
/// than grains at rest.
struct Hertz {
  template <class T>
  struct Parameters {
    T modulus;            ///< E*, Pa (see elastic_pair)
    T damping_ratio;      ///< b
    T may_pull = T(0.0);  ///< 1: the damper may pull at the end of a contact; 0: never
    static constexpr const char* names[] = {"modulus", "damping_ratio", "may_pull"};
  };
  template <class T>
  struct History {};

  /// Constants with which grains rebound with the given coefficient of restitution, exactly (see restitution_of).
  /// Throws Error unless 0.01 <= restitution <= 1.
  static Parameters<double> with_restitution(const ElasticPair& pair, double restitution, bool may_pull = false) {
    return {pair.modulus, damping_ratio_of(restitution, may_pull), may_pull ? 1.0 : 0.0};
  }

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const NormalState<T>& s, History<T>&) {
    const T k = T(4.0 / 3.0) * p.modulus * sqrt(s.effective_radius);
    const T root = sqrt(max(s.overlap, T(0)));
    const T damping = T(root_of_5) * p.damping_ratio * sqrt(k * s.effective_mass * root);
    const T f = k * s.overlap * root + damping * s.approach_speed;
    return select(p.may_pull > T(0), f, max(T(0), f));
  }

  static double stiffness(const Parameters<double>& p, const NormalState<double>& s) {
    return 2.0 * p.modulus * std::sqrt(s.effective_radius * s.overlap);
  }
  static double damping(const Parameters<double>& p, const NormalState<double>& s) {
    const double k = 4.0 / 3.0 * p.modulus * std::sqrt(s.effective_radius);
    return root_of_5 * p.damping_ratio * std::sqrt(k * s.effective_mass * std::sqrt(s.overlap));
  }
  /// 2/5 k d^(5/2).
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>&) {
    return 8.0 / 15.0 * p.modulus * std::sqrt(s.effective_radius * s.overlap) * s.overlap * s.overlap;
  }

  static void check(const Parameters<double>& p) {
    require_positive(p.modulus, "effective modulus", "Pa");
    require_non_negative(p.damping_ratio, "normal damping ratio", "(no unit)");
    require_within(p.may_pull, 0.0, 1.0, "may_pull (0: no, 1: yes)");
  }

 private:
  static constexpr double root_of_5 = 2.23606797749978969641;
};

}  // namespace dem::contact
