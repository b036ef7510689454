#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <variant>

namespace dem::terramechanics {

/// Pressure under a plate of one width, p = k z^n. What every pressure law below comes to once the width is known.
struct PressureCurve {
  double modulus = 0.0;   ///< k, Pa/m^n
  double exponent = 1.0;  ///< n

  /// Pa at a sinkage (m); 0 above the surface.
  double pressure(double sinkage) const { return sinkage > 0.0 ? modulus * std::pow(sinkage, exponent) : 0.0; }
  /// m at a pressure (Pa); 0 for none.
  double sinkage(double pressure) const { return pressure > 0.0 ? std::pow(pressure / modulus, 1.0 / exponent) : 0.0; }
  /// dp/dz, Pa/m, at a sinkage above 0 (m).
  double slope(double sinkage) const { return exponent * modulus * std::pow(sinkage, exponent - 1.0); }
  /// Work of sinking, J/m^2: the integral of p from the surface.
  double work(double sinkage) const { return pressure(sinkage) * sinkage / (exponent + 1.0); }
};

/// Bekker: p = (k_c/b + k_phi) z^n under a plate whose smaller side is b (Bekker, Introduction to Terrain-Vehicle
/// Systems, 1969).
struct Bekker {
  double k_c = 0.0;    ///< cohesive modulus, Pa/m^(n-1)
  double k_phi = 0.0;  ///< frictional modulus, Pa/m^n
  double n = 1.0;      ///< exponent of sinkage

  PressureCurve under(double width) const { return {k_c / width + k_phi, n}; }
};

/// Reece: p = (c k_c' + gamma b k_phi') (z/b)^n (thesis eq. 41; Reece, Principles of soil-vehicle
/// mechanics, Proc. IMechE 180, 1965). The moduli are numbers without unit.
struct Reece {
  double k_c = 0.0;          ///< k_c'
  double k_phi = 0.0;        ///< k_phi'
  double n = 1.0;            ///< exponent of sinkage
  double cohesion = 0.0;     ///< c, Pa
  double unit_weight = 0.0;  ///< gamma, N/m^3: density times gravity

  PressureCurve under(double width) const {
    return {(cohesion * k_c + unit_weight * width * k_phi) / std::pow(width, n), n};
  }
};

/// Wong and Reece as the thesis uses it: p = k (z/b_plate)^n (eq. 5) with the plate that k was measured with, whatever
/// it is then applied to.
struct WongReece {
  double k = 0.0;            ///< Pa
  double n = 1.0;            ///< exponent of sinkage
  double plate_width = 0.0;  ///< b_plate, m

  PressureCurve under(double) const { return {k / std::pow(plate_width, n), n}; }
};

using PressureLaw = std::variant<Bekker, Reece, WongReece>;

/// The curve under a plate, or a wheel, whose smaller side is `width` (m).
inline PressureCurve under(const PressureLaw& law, double width) {
  if (const auto* bekker = std::get_if<Bekker>(&law)) return bekker->under(width);
  if (const auto* reece = std::get_if<Reece>(&law)) return reece->under(width);
  return std::get<WongReece>(law).under(width);
}

/// Throws Error unless the exponent is positive and no modulus is negative, and one of them is positive.
inline void check_pressure(const PressureLaw& law) {
  const auto check = [](const char* form, double n, double cohesive, double frictional, const char* units) {
    if (!(n > 0.0 && n < 10.0)) {
      fail("exponent n of {}'s pressure is {:g}, but must lie between 0 and 10; soils have 0.3 to 1.8", form, n);
    }
    if (!(cohesive >= 0.0 && frictional >= 0.0 && cohesive + frictional > 0.0 && cohesive + frictional < 1e300)) {
      fail(
          "moduli of {}'s pressure are k_c = {:g} and k_phi = {:g} ({}), but must not be negative, and not both zero; "
          "where a fit over plates gives such, take WongReece of one plate",
          form, cohesive, frictional, units);
    }
  };
  if (const auto* bekker = std::get_if<Bekker>(&law)) {
    check("Bekker", bekker->n, bekker->k_c, bekker->k_phi, "Pa/m^(n-1) and Pa/m^n");
  } else if (const auto* reece = std::get_if<Reece>(&law)) {
    check("Reece", reece->n, reece->k_c, reece->k_phi, "no unit");
    require_non_negative(reece->cohesion, "cohesion of Reece's pressure", "Pa");
    require_non_negative(reece->unit_weight, "unit weight of Reece's pressure", "N/m^3");
    if (!(reece->cohesion * reece->k_c + reece->unit_weight * reece->k_phi > 0.0)) {
      fail(
          "Reece's pressure is zero for every plate: cohesion {:g} Pa times k_c' {:g}, unit weight {:g} N/m^3 times "
          "k_phi' {:g}; give a soil with one of the two products positive",
          reece->cohesion, reece->k_c, reece->unit_weight, reece->k_phi);
    }
  } else {
    const auto& wong = std::get<WongReece>(law);
    check("Wong and Reece", wong.n, 0.0, wong.k, "Pa");
    require_positive(wong.plate_width, "plate width of Wong and Reece's pressure", "m");
  }
}

}  // namespace dem::terramechanics
