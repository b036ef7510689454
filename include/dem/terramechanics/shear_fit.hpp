#pragma once

#include <dem/terramechanics/least_squares.hpp>
#include <dem/terramechanics/mohr_coulomb.hpp>
#include <dem/terramechanics/shear.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace dem::terramechanics {

/// A measured shear curve at one normal stress.
struct ShearCurve {
  double normal_stress = 0.0;        ///< sigma, Pa
  std::vector<double> displacement;  ///< j, m
  std::vector<double> stress;        ///< tau, Pa, as many
};

/// tau = tau_max (1 - exp(-j/K)) through a shear curve.
struct JanosiFit {
  double normal_stress = 0.0;       ///< Pa
  double strength = 0.0;            ///< tau_max, Pa
  double strength_error = 0.0;      ///< standard error, Pa; NaN without a point to spare
  double displacement = 0.0;        ///< K, m
  double displacement_error = 0.0;  ///< standard error, m
  double r_squared = 1.0;
  std::size_t points = 0;
};

namespace detail {

/// How far a shear curve goes.
struct ShearReach {
  double displacement = 0.0, stress = 0.0;  ///< m, Pa; the largest, or 0
};

/// Throws Error unless a curve has a displacement with each stress, and all are finite.
inline ShearReach reach_of(const ShearCurve& curve) {
  const std::size_t n = curve.displacement.size();
  if (n != curve.stress.size()) {
    fail("shear curve at {:g} Pa: {} displacements and {} stresses; give as many of both", curve.normal_stress, n,
         curve.stress.size());
  }
  ShearReach reach;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(curve.displacement[i]) || !std::isfinite(curve.stress[i])) {
      fail("shear curve at {:g} Pa: point {} is ({:g} m, {:g} Pa), but must be finite", curve.normal_stress, i,
           curve.displacement[i], curve.stress[i]);
    }
    reach.displacement = std::fmax(reach.displacement, curve.displacement[i]);
    reach.stress = std::fmax(reach.stress, curve.stress[i]);
  }
  return reach;
}

/// A point of tau = tau_max (1 - exp(-j/K)), with its slopes by tau_max and by ln K: fitted by its logarithm, K stays
/// positive.
struct JanosiPoint {
  double stress, by_strength, by_log_k;

  JanosiPoint(double displacement, double strength, double log_k) {
    const double ratio = displacement / std::exp(log_k);
    by_strength = -std::expm1(-ratio);
    by_log_k = -strength * ratio * std::exp(-ratio);
    stress = strength * by_strength;
  }
};

}  // namespace detail

/// Fits K and tau_max to a curve that bends towards a strength, all points of equal weight. Throws Error for fewer than
/// 2 points, numbers that are not finite, no positive displacement or stress, and a curve that does not bend: K above
/// 10 times the largest displacement.
inline JanosiFit fit_janosi(const ShearCurve& curve) {
  const auto [furthest, largest] = detail::reach_of(curve);
  if (!(furthest > 0.0 && largest > 0.0)) {
    fail("shear curve at {:g} Pa: no displacement or no stress is positive; give both in the direction of shearing",
         curve.normal_stress);
  }
  // Start: the strength at the top, and K where 63 % of it is passed.
  const std::size_t n = curve.displacement.size();
  double reached = furthest;
  for (std::size_t i = n; i-- > 0;) {
    if (curve.stress[i] >= 0.632 * largest && curve.displacement[i] > 0.0) {
      reached = std::fmin(reached, curve.displacement[i]);
    }
  }
  const auto model = [&](std::size_t i, const std::array<double, 2>& values, std::array<double, 2>& slopes) {
    const detail::JanosiPoint p(curve.displacement[i], values[0], values[1]);
    slopes = {p.by_strength, p.by_log_k};
    return p.stress;
  };
  const auto fit = least_squares<2>(
      "fit of a shear curve", n, {largest, std::log(reached)}, model, [&](std::size_t i) { return curve.stress[i]; },
      [](std::size_t) { return 1.0; });
  const double k = std::exp(fit.value[1]);
  if (!(k < 10.0 * furthest)) {
    fail(
        "shear curve at {:g} Pa does not bend towards a strength within {:g} m: K would be {:g} m; shear further, or "
        "leave out the unloading",
        curve.normal_stress, furthest, k);
  }
  return {.normal_stress = curve.normal_stress,
          .strength = fit.value[0],
          .strength_error = fit.error[0],
          .displacement = k,
          .displacement_error = k * fit.error[1],
          .r_squared = fit.r_squared,
          .points = n};
}

/// The same with a strength (Pa) that is known, as the greatest stress that was measured: K alone is fitted. A curve
/// that still rises at its end then has a K of the size of its displacements, and not one from beyond them. Throws
/// Error for a strength that is not positive, numbers that are not finite, and a curve that does not reach 63 % of the
/// strength.
inline JanosiFit fit_janosi_below(const ShearCurve& curve, double strength) {
  require_positive(strength, "strength that a shear curve is fitted below", "Pa");
  detail::reach_of(curve);
  const std::size_t n = curve.displacement.size();
  double reached = 0.0;  // where 63 % are first passed
  for (std::size_t i = n; i-- > 0;) {
    if (curve.displacement[i] > 0.0 && curve.stress[i] >= 0.632 * strength) reached = curve.displacement[i];
  }
  if (!(reached > 0.0)) {
    fail("shear curve at {:g} Pa does not reach two thirds of its strength, {:g} Pa; shear further",
         curve.normal_stress, strength);
  }
  const auto model = [&](std::size_t i, const std::array<double, 1>& values, std::array<double, 1>& slopes) {
    const detail::JanosiPoint p(curve.displacement[i], strength, values[0]);
    slopes = {p.by_log_k};
    return p.stress;
  };
  const auto fit = least_squares<1>(
      "fit of a shear curve", n, {std::log(reached)}, model, [&](std::size_t i) { return curve.stress[i]; },
      [](std::size_t) { return 1.0; });
  const double k = std::exp(fit.value[0]);
  return {.normal_stress = curve.normal_stress,
          .strength = strength,
          .strength_error = 0.0,
          .displacement = k,
          .displacement_error = k * fit.error[0],
          .r_squared = fit.r_squared,
          .points = n};
}

/// Strength and shear displacement of a soil from shear curves at several normal stresses.
struct ShearConstants {
  JanosiHanamoto law;
  MohrCoulomb strength;             ///< of the fitted tau_max over the normal stresses
  double displacement_error = 0.0;  ///< of K, m: standard error of the mean over the curves; NaN for one curve
  std::vector<JanosiFit> curves;
};

/// Fits each curve, then c and phi through the strengths, and takes the mean of K. Throws Error as fit_janosi and
/// fit_mohr_coulomb do. A negative cohesion is kept; fit through the origin where it has no meaning.
inline ShearConstants fit_shear(std::span<const ShearCurve> curves, Intercept intercept = Intercept::free) {
  ShearConstants result;
  std::vector<double> sigma, tau;
  double mean = 0.0;
  for (const ShearCurve& curve : curves) {
    const JanosiFit fit = fit_janosi(curve);
    result.curves.push_back(fit);
    sigma.push_back(fit.normal_stress);
    tau.push_back(fit.strength);
    mean += fit.displacement / static_cast<double>(curves.size());
  }
  result.strength = fit_mohr_coulomb(sigma, tau, intercept);
  double squares = 0.0;
  for (const JanosiFit& fit : result.curves) squares += (fit.displacement - mean) * (fit.displacement - mean);
  const double count = static_cast<double>(curves.size());
  result.displacement_error =
      count > 1.0 ? std::sqrt(squares / (count - 1.0) / count) : std::numeric_limits<double>::quiet_NaN();
  result.law = {result.strength.cohesion, result.strength.friction_angle, mean};
  return result;
}

}  // namespace dem::terramechanics
