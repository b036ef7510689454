#pragma once

#include <dem/core/error.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace dem::terramechanics {

/// Shear strength after Mohr and Coulomb, tau = c + sigma tan(phi) (thesis eq. 10), from a least-squares fit.
struct MohrCoulomb {
  double friction_angle = 0.0;        ///< phi, rad
  double cohesion = 0.0;              ///< c, Pa
  double friction_angle_error = 0.0;  ///< standard error, rad; NaN where there are too few points to tell
  double cohesion_error = 0.0;        ///< standard error, Pa; NaN likewise, 0 for a fit through the origin
  double r_squared = 1.0;  ///< 1 - residual/total sum of squares; total about the mean, or about 0 through the origin
  std::size_t points = 0;

  double strength(double normal_stress) const { return cohesion + normal_stress * std::tan(friction_angle); }  ///< Pa
};

enum class Intercept {
  free,  ///< c is fitted too: at least 2 points at different normal stresses, 3 for standard errors
  zero   ///< c = 0: at least 1 point, 2 for the standard error
};

/// Fits shear strengths tau (Pa) over normal stresses sigma (Pa, positive in compression). The standard errors are
/// those of ordinary least squares, sigma_slope = s/sqrt(Sxx) and sigma_c = s sqrt(1/n + mean^2/Sxx), carried over to
/// the angle by d(phi) = cos^2(phi) d(slope). Throws Error for too few points, points at one stress only, or numbers
/// that are not finite.
inline MohrCoulomb fit_mohr_coulomb(std::span<const double> sigma, std::span<const double> tau,
                                    Intercept intercept = Intercept::free) {
  const std::size_t n = sigma.size();
  const std::size_t parameters = intercept == Intercept::free ? 2 : 1;
  if (n != tau.size()) fail("Mohr-Coulomb fit: {} normal and {} shear stresses; give as many of both", n, tau.size());
  if (n < parameters) {
    fail("Mohr-Coulomb fit: {} points, but {} are needed; run more normal loads{}", n, parameters,
         n == 1 ? ", or fit through the origin" : "");
  }
  const double count = static_cast<double>(n);
  double mean_x = 0.0, mean_y = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(sigma[i]) || !std::isfinite(tau[i])) {
      fail("Mohr-Coulomb fit: point {} is ({:g}, {:g}) Pa, but must be finite", i, sigma[i], tau[i]);
    }
    mean_x += sigma[i] / count;
    mean_y += tau[i] / count;
    largest = std::fmax(largest, std::fabs(sigma[i]));
  }
  const double x0 = intercept == Intercept::free ? mean_x : 0.0, y0 = intercept == Intercept::free ? mean_y : 0.0;
  double sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = sigma[i] - x0, y = tau[i] - y0;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
  }
  if (!(sxx > 1e-18 * largest * largest * count)) {
    fail("Mohr-Coulomb fit: all normal stresses are {:g} Pa; a line needs different ones", mean_x);
  }
  const double slope = sxy / sxx;
  MohrCoulomb m;
  m.points = n;
  m.friction_angle = std::atan(slope);
  m.cohesion = intercept == Intercept::free ? mean_y - slope * mean_x : 0.0;
  double residual = 0.0;
  for (std::size_t i = 0; i < n; ++i) residual += std::pow(tau[i] - m.cohesion - slope * sigma[i], 2);
  m.r_squared = syy > 0.0 ? 1.0 - residual / syy : 1.0;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const double scatter = n > parameters ? std::sqrt(residual / static_cast<double>(n - parameters)) : unknown;
  m.friction_angle_error = std::pow(std::cos(m.friction_angle), 2) * scatter / std::sqrt(sxx);
  m.cohesion_error = intercept == Intercept::free ? scatter * std::sqrt(1.0 / count + mean_x * mean_x / sxx) : 0.0;
  return m;
}

}  // namespace dem::terramechanics
