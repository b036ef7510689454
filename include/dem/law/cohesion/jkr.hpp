#pragma once

#include <dem/law/cohesion/cohesion_law.hpp>
#include <dem/law/normal/elastic.hpp>
#include <dem/law/normal/hertz.hpp>

#include <cmath>
#include <numbers>

namespace dem::cohesion {

/// Adhesion of soft grains (Johnson, Kendall and Roberts 1971, doi:10.1098/rspa.1971.0141). The contact circle of
/// radius a carries F = 4 E* a^3/(3 R) - sqrt(8 pi w E* a^3) at the overlap d = a^2/R - sqrt(2 pi w a/E*). It starts
/// when the partners touch and holds until they are 3/4 (pi^2 w^2 R/E*^2)^(1/3) apart; the largest pull is 3/2 pi w R.
/// Only with Hertz of the same E*, whose elastic force the pull replaces by JKR's. Friction is limited by
/// mu (F + 3 pi w R), which is F and twice the pull-off force (Thornton 1991, doi:10.1088/0022-3727/24/11/007). The
/// springs of friction::Mindlin are those of Hertz's circle: across a gap they hold nothing, CundallStrack's do.
///
/// With a in units of (2 pi w R^2/E*)^(1/3), called x, and d in units of its square over R, called D:
///   D = x^2 - sqrt(x),   F = pi w R (8/3 x^3 - 4 x^(3/2)),
/// and with z = sqrt(x), z^4 - z - D = 0 is solved by Ferrari's formula.
struct JKR {
  using NormalLaw = contact::Hertz;

  template <class T>
  struct Parameters {
    T work_of_adhesion;  ///< w, J/m^2, of both surfaces together
    T modulus;           ///< E*, Pa: that of the Hertz law
    static constexpr const char* names[] = {"work_of_adhesion", "modulus"};
  };
  template <class T>
  struct History {
    T joined;  ///< 1 from first contact to the pull-off
  };

  static Parameters<double> with(const contact::ElasticPair& pair, double work_of_adhesion) {
    return {work_of_adhesion, pair.modulus};
  }

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>& p, const NormalState<T>& s, History<T>& h) {
    const T unit = unit_of_radius(p, s), d = s.effective_radius * s.overlap / (unit * unit);
    h.joined = select(s.overlap >= T(0), T(1), select(d >= T(last_overlap), h.joined, T(0)));
    const T z = root_of_radius(max(d, T(last_overlap))), y = z * z * z;
    const T pull_off = T(1.5 * pi) * p.work_of_adhesion * s.effective_radius;
    const T stiff = T(4.0 / 3.0) * p.modulus * (unit * unit * unit) / s.effective_radius;  // pi w R 8/3
    const T jkr = stiff * y * y - T(8.0 / 3.0) * pull_off * y;
    const T over = max(s.overlap, T(0));
    const T hertz = T(4.0 / 3.0) * p.modulus * sqrt(s.effective_radius * over) * over;
    const T pull = hertz - jkr;
    return {h.joined * pull, h.joined * (T(2) * pull_off - pull)};
  }

  /// What JKR's slope exceeds Hertz's by at the overlap of the state. Across a gap wider than
  /// that of the largest pull the slope is steeper, but negative: no spring on which partners could swing.
  static double stiffness(const Parameters<double>& p, const NormalState<double>& s) {
    if (!(p.work_of_adhesion > 0.0)) return 0.0;
    const double unit = unit_of_radius(p, s), z = root_of_radius(s.effective_radius * s.overlap / (unit * unit));
    const double x = z * z;
    const double slope = (8.0 * x * x - 6.0 * z) / (2.0 * x - 0.5 / z) * pi * p.work_of_adhesion * s.effective_radius *
                         s.effective_radius / (unit * unit);
    return std::max(0.0, slope - 2.0 * p.modulus * std::sqrt(s.effective_radius * s.overlap));
  }
  /// The integral of JKR's force from the pull-off, less what Hertz's spring stores: in units of pi w R times that of
  /// d, 16/15 x^5 - 8/3 x^(7/2) + x^2.
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>& h) {
    const double unit = unit_of_radius(p, s), per_unit = unit * unit / s.effective_radius;
    const double z = root_of_radius(max(s.overlap / per_unit, last_overlap));
    const auto integral = [](double x, double root) {
      const double x2 = x * x;
      return 16.0 / 15.0 * x2 * x2 * x - 8.0 / 3.0 * x2 * x * root + x2;
    };
    const double last = std::cbrt(1.0 / 16.0), over = max(0.0, s.overlap);  // x^(3/2) = 1/4
    const double jkr = pi * p.work_of_adhesion * s.effective_radius * per_unit *
                       (integral(z * z, z) - integral(last, std::sqrt(last)));
    const double hertz = 8.0 / 15.0 * p.modulus * std::sqrt(s.effective_radius * over) * over * over;
    return h.joined * (jkr - hertz);
  }
  static double range(const Parameters<double>& p, double radius) {
    return 0.75 * std::cbrt(pi * pi * p.work_of_adhesion * p.work_of_adhesion * radius / (p.modulus * p.modulus));
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.work_of_adhesion, "work of adhesion", "J/m^2");
    require_positive(p.modulus, "effective modulus", "Pa");
  }
  static void check_with(const Parameters<double>& p, const NormalLaw::Parameters<double>& normal) {
    if (std::abs(p.modulus - normal.modulus) <= 1e-6 * normal.modulus) return;
    fail(
        "JKR's effective modulus is {:g} Pa, but Hertz's is {:g} Pa; both must be the same: make them of one "
        "ElasticPair",
        p.modulus, normal.modulus);
  }

 private:
  static constexpr double pi = std::numbers::pi;
  static constexpr double last_overlap = -0.472470393710577;  ///< -3/4^(4/3), where dD/dx = 0

  template <class T>
  static DEM_HOT T unit_of_radius(const Parameters<T>& p, const NormalState<T>& s) {
    // Without adhesion the tiny number is the unit, and what is left is Hertz's force.
    return cbrt(T(2.0 * pi) * p.work_of_adhesion * s.effective_radius * s.effective_radius / p.modulus + T(1e-60));
  }
  /// The largest root z of z^4 - z - D = 0, from that of the resolvent m^3 + D m - 1/8 = 0.
  template <class T>
  static DEM_HOT T root_of_radius(const T& d) {
    const T u = cbrt(T(1.0 / 16.0) + sqrt(max(T(0), T(1.0 / 256.0) + d * d * d * T(1.0 / 27.0))));
    const T rough = u - d / (T(3) * u);
    // For d > 0 that is a difference; what it is good for is m^2 + d, and m = 1/8 / (m^2 + d).
    const T m = select(d > T(0), T(0.125) / (rough * rough + d), rough);
    const T root = sqrt(T(2) * m);
    return T(0.5) * (root + sqrt(max(T(0), T(2) / root - T(2) * m)));
  }
};

}  // namespace dem::cohesion
