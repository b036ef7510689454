#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <numbers>

namespace dem::contact {

/// An elastic material.
struct Solid {
  double young;    ///< E, Pa
  double poisson;  ///< nu, in [-0.99, 0.5]

  double shear() const { return young / (2.0 * (1.0 + poisson)); }  ///< G, Pa
};

/// What the elasticity of two materials means for their contact.
struct ElasticPair {
  double modulus;  ///< E*, Pa: 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b
  double shear;    ///< G*, Pa: 1/G* = (2 - nu_a)/G_a + (2 - nu_b)/G_b
};

/// Throws Error unless both moduli are positive and both Poisson ratios in [-0.99, 0.5].
inline ElasticPair elastic_pair(const Solid& a, const Solid& b) {
  for (const Solid& s : {a, b}) {
    require_positive(s.young, "Young's modulus", "Pa");
    require_within(s.poisson, -0.99, 0.5, "Poisson ratio");
  }
  return {1.0 / ((1.0 - a.poisson * a.poisson) / a.young + (1.0 - b.poisson * b.poisson) / b.young),
          1.0 / ((2.0 - a.poisson) / a.shear() + (2.0 - b.poisson) / b.shear())};
}
inline ElasticPair elastic_pair(const Solid& both) { return elastic_pair(both, both); }

/// Tangential over normal stiffness of Hertz's contact without slip, 4 G*/E* (Mindlin 1949, doi:10.1115/1.4009973): for
/// equal materials 2 (1 - nu)/(2 - nu), from 1 at nu = 0 to 2/3 at nu = 1/2.
inline double tangential_share(const ElasticPair& pair) {
  require_positive(pair.modulus, "effective modulus", "Pa");
  require_positive(pair.shear, "effective shear modulus", "Pa");
  return 4.0 * pair.shear / pair.modulus;
}

/// The impact for which a linear spring stands in for Hertz's contact.
struct Impact {
  double effective_radius;  ///< m, 1/(1/Ri + 1/Rj)
  double effective_mass;    ///< kg, 1/(1/mi + 1/mj)
  double speed;             ///< m/s
};

/// Largest overlap (m) of Hertz's contact in an impact without damping: d^(5/2) = 15/16 m v^2/(E* sqrt(R)) (Johnson,
/// Contact Mechanics, 1985, eq. 11.23).
inline double hertz_overlap(const ElasticPair& pair, const Impact& impact) {
  require_positive(pair.modulus, "effective modulus", "Pa");
  require_positive(impact.effective_radius, "effective radius of an impact", "m");
  require_positive(impact.effective_mass, "effective mass of an impact", "kg");
  require_positive(impact.speed, "speed of an impact", "m/s");
  return std::pow(0.9375 * impact.effective_mass * impact.speed * impact.speed /
                      (pair.modulus * std::sqrt(impact.effective_radius)),
                  0.4);
}

/// Stiffness (N/m) of the linear spring that stores the impact's energy at the same overlap as Hertz's contact: k = m
/// (v/d)^2.
inline double stiffness_of_equal_energy(const ElasticPair& pair, const Impact& impact) {
  const double rate = impact.speed / hertz_overlap(pair, impact);
  return impact.effective_mass * rate * rate;
}

/// Stiffness (N/m) of the linear spring whose contact lasts as long as Hertz's: t = 2 d/v times the integral of
/// dx/sqrt(1 - x^(5/2)) from 0 to 1, which is sqrt(pi) Gamma(7/5)/Gamma(9/10) = 1.4716.
inline double stiffness_of_equal_time(const ElasticPair& pair, const Impact& impact) {
  const double time = 2.0 * std::sqrt(std::numbers::pi) * std::tgamma(1.4) / std::tgamma(0.9);  // in units of d/v
  return std::numbers::pi * std::numbers::pi / (time * time) * stiffness_of_equal_energy(pair, impact);
}

}  // namespace dem::contact
