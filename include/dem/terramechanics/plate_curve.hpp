#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace dem::terramechanics {

/// A measured pressure-sinkage curve of one plate.
struct PlateCurve {
  double width = 0.0;            ///< b, m: the smaller side of the plate, or its radius
  std::vector<double> sinkage;   ///< m, in the order of the measurement
  std::vector<double> pressure;  ///< Pa, as many
};

/// Throws Error unless there are as many pressures as sinkages, all finite, and the width is positive.
inline void check_plate_curve(const PlateCurve& curve) {
  require_positive(curve.width, "width of a plate", "m");
  if (curve.sinkage.size() != curve.pressure.size()) {
    fail("the curve of the plate of {:g} m has {} sinkages and {} pressures; give as many of both", curve.width,
         curve.sinkage.size(), curve.pressure.size());
  }
  for (std::size_t i = 0; i < curve.sinkage.size(); ++i) {
    if (!std::isfinite(curve.sinkage[i]) || !std::isfinite(curve.pressure[i])) {
      fail("point {} of the plate of {:g} m is ({:g} m, {:g} Pa), but must be finite", i, curve.width, curve.sinkage[i],
           curve.pressure[i]);
    }
  }
}

/// The curve with its sinkage counted from where the pressure first reaches a threshold (Pa), found between two points
/// by a straight line: loose grains on the surface and a plate that does not yet lie flat are so left out. Points
/// before are dropped. Throws Error if the threshold is never reached.
inline PlateCurve zeroed(const PlateCurve& curve, double threshold = 1000.0) {
  check_plate_curve(curve);
  require_positive(threshold, "pressure at which sinkage begins", "Pa");
  std::size_t first = 0;
  while (first < curve.pressure.size() && curve.pressure[first] < threshold) ++first;
  if (first == curve.pressure.size()) {
    fail("the plate of {:g} m never reaches {:g} Pa in {} points; lower the threshold, or press deeper", curve.width,
         threshold, first);
  }
  double zero = curve.sinkage[first];
  if (first > 0) {
    const double share = (threshold - curve.pressure[first - 1]) / (curve.pressure[first] - curve.pressure[first - 1]);
    zero = curve.sinkage[first - 1] + share * (curve.sinkage[first] - curve.sinkage[first - 1]);
  }
  PlateCurve from_zero{.width = curve.width, .sinkage = {}, .pressure = {}};
  for (std::size_t i = first; i < curve.pressure.size(); ++i) {
    from_zero.sinkage.push_back(curve.sinkage[i] - zero);
    from_zero.pressure.push_back(curve.pressure[i]);
  }
  return from_zero;
}

/// The points whose sinkage lies within a range (m), both ends counted.
inline PlateCurve within(const PlateCurve& curve, double least, double most) {
  PlateCurve part{.width = curve.width, .sinkage = {}, .pressure = {}};
  for (std::size_t i = 0; i < curve.sinkage.size(); ++i) {
    if (!(curve.sinkage[i] >= least && curve.sinkage[i] <= most)) continue;
    part.sinkage.push_back(curve.sinkage[i]);
    part.pressure.push_back(curve.pressure[i]);
  }
  return part;
}

}  // namespace dem::terramechanics
