#pragma once

#include <dem/terramechanics/least_squares.hpp>
#include <dem/terramechanics/plate_curve.hpp>
#include <dem/terramechanics/pressure.hpp>

#include <span>

namespace dem::terramechanics {

/// How the misfit of a pressure counts.
enum class PlateFit {
  pressures,            ///< (p - k z^n)^2: all pressures are as certain as each other, so deep points decide
  weighted_logarithms,  ///< p^2 (ln p - ln k - n ln z)^2: Wong's (J. Terramechanics 17, 1980), nearly the first
  logarithms            ///< (ln p - ln k - n ln z)^2: all are as certain in percent, so shallow points decide too
};

/// p = k z^n through the points of one plate.
struct PlateConstants {
  double width = 0.0;  ///< b, m
  PressureCurve curve;
  double modulus_error = 0.0;   ///< standard error of k, Pa/m^n; NaN without a point to spare
  double exponent_error = 0.0;  ///< of n
  double r_squared = 1.0;       ///< of what was fitted: pressures or logarithms
  std::size_t points = 0;
};

namespace detail {

inline void check_for_fit(const PlateCurve& curve) {
  check_plate_curve(curve);
  for (std::size_t i = 0; i < curve.sinkage.size(); ++i) {
    if (!(curve.sinkage[i] > 0.0 && curve.pressure[i] > 0.0)) {
      fail(
          "point {} of the plate of {:g} m is ({:g} m, {:g} Pa), but a power has no value there: both must be "
          "positive; "
          "count sinkage from the surface (zeroed), and leave the surface out (within)",
          i, curve.width, curve.sinkage[i], curve.pressure[i]);
    }
  }
}

/// All points of some plates in a row.
struct PlatePoints {
  std::vector<double> width, sinkage, pressure;

  explicit PlatePoints(std::span<const PlateCurve> plates) {
    for (const PlateCurve& plate : plates) {
      check_for_fit(plate);
      width.insert(width.end(), plate.sinkage.size(), plate.width);
      sinkage.insert(sinkage.end(), plate.sinkage.begin(), plate.sinkage.end());
      pressure.insert(pressure.end(), plate.pressure.begin(), plate.pressure.end());
    }
  }
};

/// Fits p = (sum of c_k u_k(b)) w(z, b)^n; `moduli` sets u and returns w. The last parameter is n. The moduli are
/// fitted as they are, so they may come out negative where the points say so.
template <std::size_t moduli, class Form>
LeastSquares<moduli + 1> fit_form(const char* what, std::span<const PlateCurve> plates, PlateFit kind, Form&& form) {
  const PlatePoints p(plates);
  const std::size_t points = p.sinkage.size();
  constexpr std::size_t n = moduli + 1;
  if (points < n) fail("{}: {} points, but {} are needed; measure more", what, points, n);
  const bool logs = kind != PlateFit::pressures;
  const auto target = [&](std::size_t i) { return logs ? std::log(p.pressure[i]) : p.pressure[i]; };
  const auto weight = [&](std::size_t i) {
    return kind == PlateFit::weighted_logarithms ? p.pressure[i] * p.pressure[i] : 1.0;
  };
  // Start: the slope of the logarithms within each plate, then each modulus as if it were alone.
  double sxx = 0.0, sxy = 0.0;
  std::size_t row = 0;
  for (const PlateCurve& plate : plates) {
    double mean_x = 0.0, mean_y = 0.0;
    const std::size_t end = row + plate.sinkage.size();
    const double count = static_cast<double>(plate.sinkage.size());
    for (std::size_t i = row; i < end; ++i) {
      mean_x += std::log(p.sinkage[i]) / count;
      mean_y += std::log(p.pressure[i]) / count;
    }
    for (; row < end; ++row) {
      const double x = std::log(p.sinkage[row]) - mean_x;
      sxx += x * x;
      sxy += x * (std::log(p.pressure[row]) - mean_y);
    }
  }
  if (!(sxx > 1e-12)) fail("{}: all points of a plate are at one sinkage; an exponent needs a range of them", what);
  std::array<double, n> start{};
  start[moduli] = sxy / sxx;
  std::array<double, moduli> u{};
  std::array<double, moduli> sums{};
  for (std::size_t i = 0; i < points; ++i) {
    const double w = std::pow(form(p.sinkage[i], p.width[i], u), start[moduli]);
    for (std::size_t c = 0; c < moduli; ++c)
      sums[c] += p.pressure[i] / (w * u[c] * static_cast<double>(moduli * points));
  }
  for (std::size_t c = 0; c < moduli; ++c) start[c] = sums[c];
  const auto model = [&](std::size_t i, const std::array<double, n>& values, std::array<double, n>& slopes) {
    std::array<double, moduli> at{};
    const double w = form(p.sinkage[i], p.width[i], at), power = std::pow(w, values[moduli]);
    double modulus = 0.0;
    for (std::size_t c = 0; c < moduli; ++c) modulus += values[c] * at[c];
    for (std::size_t c = 0; c < moduli; ++c) slopes[c] = logs ? at[c] / modulus : at[c] * power;
    slopes[moduli] = logs ? std::log(w) : modulus * power * std::log(w);
    return logs ? std::log(modulus) + values[moduli] * std::log(w) : modulus * power;
  };
  return least_squares<n>(what, points, start, model, target, weight);
}

}  // namespace detail

/// k and n of one plate. Throws Error for fewer than two points, for points that are not positive, and for all points
/// at one sinkage.
inline PlateConstants fit_plate(const PlateCurve& curve, PlateFit kind = PlateFit::pressures) {
  const auto fit =
      detail::fit_form<1>("fit of a plate", {&curve, 1}, kind, [](double z, double, std::array<double, 1>& u) {
        u = {1.0};
        return z;
      });
  return {.width = curve.width,
          .curve = {fit.value[0], fit.value[1]},
          .modulus_error = fit.error[0],
          .exponent_error = fit.error[1],
          .r_squared = fit.r_squared,
          .points = fit.points};
}

}  // namespace dem::terramechanics
