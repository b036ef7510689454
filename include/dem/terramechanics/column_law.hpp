#pragma once

#include <dem/terramechanics/numerics.hpp>
#include <dem/terramechanics/soil.hpp>

#include <algorithm>
#include <cmath>

namespace dem::terramechanics {

/// What a column of soil answers to a sinkage.
struct ColumnStress {
  double pressure = 0.0;  ///< Pa, not negative
  double slope = 0.0;     ///< dp/dz of unloading, Pa/m
  double deepest = 0.0;   ///< m, the column's memory after that
  double residual = 0.0;  ///< m, the sinkage that stays when the load is gone
  bool compacts = false;  ///< the soil gives way for good; else it is elastic
  bool on_base = false;   ///< the column is squeezed against the hard ground below it
};

/// Pressure over sinkage of a column of soil with memory. Soil that was never deeper follows the pressure law; what was
/// loaded before unloads and loads again along a straight line, of the slope of Wong's k0 + A z at its deepest sinkage
/// z. The line is never flatter than `least_ratio` times the slope of the curve or of its chord there, so that the soil
/// gives back less than was put in; where the soil has no unloading stiffness k0 it is `unknown_ratio` times as steep
/// at least. A alone does not count as known: at small sinkages A z is flatter than the curve itself, as no soil
/// unloads. LETE sand has k0 = 0 and A = 503 MPa/m^2: under a plate of 0.3 m that is the slope of its chord at 25 mm.
struct ColumnLaw {
  static constexpr double least_ratio = 2.0;
  static constexpr double unknown_ratio = 10.0;  ///< soil that springs back by a tenth of its sinkage, or less

  PressureCurve curve;
  double unloading_stiffness = 0.0;  ///< k0, Pa/m; 0: not known
  double unloading_growth = 0.0;     ///< A, Pa/m^2
  double thickness = 1e300;          ///< m, of the soil over hard ground

  ColumnLaw() = default;
  /// Under a plate or wheel whose smaller side is `width` (m). thickness 0: without end.
  ColumnLaw(const Soil& soil, double width, double soil_thickness = 0.0)
      : curve(under(soil.pressure, width)),
        unloading_stiffness(soil.unloading_stiffness),
        unloading_growth(soil.unloading_growth),
        thickness(soil_thickness > 0.0 ? soil_thickness : 1e300) {}

  /// Pa/m, of unloading from a deepest sinkage above 0 (m), where the pressure law gives `pressure` (Pa).
  double slope(double deepest, double pressure) const {
    const double chord = std::max(1.0, curve.exponent) * pressure / deepest;
    return std::max(unloading_stiffness + unloading_growth * deepest,
                    (unloading_stiffness > 0.0 ? least_ratio : unknown_ratio) * chord);
  }
  /// m, the sinkage that stays when the load is gone.
  double residual(double deepest) const {
    const double p = curve.pressure(deepest);
    return deepest > 0.0 ? deepest - p / slope(deepest, p) : 0.0;
  }
  /// m, the deepest sinkage that leaves a residual one (m).
  double deepest_of(double left) const {
    if (!(left > 0.0)) return 0.0;
    // Not more than least_ratio - 1 times as much springs back again.
    const double most = left * least_ratio / (least_ratio - 1.0) * (1.0 + 1e-12);
    return find_root([&](double z) { return residual(z) - left; }, left, most);
  }
  /// The stress at a sinkage (m) of a column that was at most `deepest` (m) deep.
  ColumnStress at(double sinkage, double deepest) const {
    const bool compacts = sinkage >= deepest && sinkage > 0.0 && deepest < thickness;
    const double z = compacts ? std::min(sinkage, thickness) : deepest;
    if (!(z > 0.0)) return {};
    const double p = curve.pressure(z), k = slope(z, p);
    return {std::max(0.0, p + k * (sinkage - z)), k, z, z - p / k, compacts, z >= thickness && sinkage > z};
  }
  /// J/m^2 that unloading gives back.
  double stored(const ColumnStress& s) const { return s.slope > 0.0 ? 0.5 * s.pressure * s.pressure / s.slope : 0.0; }
};

}  // namespace dem::terramechanics
