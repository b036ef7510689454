#pragma once

#include <dem/core/error.hpp>
#include <dem/law/cohesion/cohesion_law.hpp>

#include <cmath>
#include <numbers>

namespace dem::cohesion {

/// A liquid bridge between wet grains. It forms when they touch and breaks at the rupture distance. Until then it pulls
/// with
///   4 pi R* g/(1 + 1.05 s + 2.5 s^2),   s = gap sqrt(2 R*/V)
/// (Willett et al. 2000, doi:10.1021/la000657y, with the Derjaguin radius 2 R*). Each contact has the same volume of
/// liquid; nothing evaporates or flows.
struct LiquidBridge {
  template <class T>
  struct Parameters {
    T wetting_tension;  ///< g, N/m: surface tension times the cosine of the contact angle
    T volume;           ///< V, m^3, of one bridge
    T rupture;          ///< m, the gap at which a bridge breaks
    static constexpr const char* names[] = {"wetting_tension", "volume", "rupture"};
  };
  template <class T>
  struct History {
    T formed;  ///< 1 from first contact to the rupture
  };

  /// Constants of a liquid with the surface tension (N/m) and contact angle (rad, below pi/2): the rupture distance is
  /// (1 + angle/2) V^(1/3) (Lian, Thornton and Adams 1993, doi:10.1006/jcis.1993.1452). Throws Error for another angle.
  static Parameters<double> of(double surface_tension, double contact_angle, double volume) {
    require_within(contact_angle, 0.0, 1.5707, "contact angle (rad)");
    return {surface_tension * std::cos(contact_angle), volume, (1.0 + 0.5 * contact_angle) * std::cbrt(volume)};
  }

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>& p, const NormalState<T>& s, History<T>& h) {
    h.formed = select(s.overlap >= T(0), T(1), select(-s.overlap <= p.rupture, h.formed, T(0)));
    const T gap = max(T(0), -s.overlap) * sqrt(T(2) * s.effective_radius / p.volume);
    const T pull = T(4.0 * pi) * s.effective_radius * p.wetting_tension / (T(1) + (T(1.05) + T(2.5) * gap) * gap);
    return {h.formed * pull, T(0)};
  }

  /// The steepest slope of 1/(1 + 1.05 s + 2.5 s^2) is 1.224.
  static double stiffness(const Parameters<double>& p, const NormalState<double>& s) {
    return 1.224 * 4.0 * pi * s.effective_radius * p.wetting_tension * std::sqrt(2.0 * s.effective_radius / p.volume);
  }
  static double range(const Parameters<double>& p, double) { return p.rupture; }
  /// The pull from here to the rupture; the integral of 1/(1 + 1.05 s + 2.5 s^2) is 2/r atan((5 s + 1.05)/r),
  /// r = sqrt(10 - 1.05^2). A bridge that forms gives it away at once, which counts as dissipated.
  static double energy(const Parameters<double>& p, const NormalState<double>& s, const History<double>& h) {
    const double unit = std::sqrt(2.0 * s.effective_radius / p.volume), root = std::sqrt(10.0 - 1.05 * 1.05);
    const auto integral = [&](double gap) { return 2.0 / root * std::atan((5.0 * gap * unit + 1.05) / root) / unit; };
    const double way = integral(p.rupture) - integral(max(0.0, -s.overlap)) + max(0.0, s.overlap);
    return -h.formed * 4.0 * pi * s.effective_radius * p.wetting_tension * way;
  }

  static void check(const Parameters<double>& p) {
    require_non_negative(p.wetting_tension, "wetting tension of a liquid bridge", "N/m");
    require_positive(p.volume, "volume of a liquid bridge", "m^3");
    require_non_negative(p.rupture, "rupture distance of a liquid bridge", "m");
  }

 private:
  static constexpr double pi = std::numbers::pi;
};

}  // namespace dem::cohesion
