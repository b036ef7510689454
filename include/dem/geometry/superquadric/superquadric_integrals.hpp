#pragma once

#include <dem/geometry/mass_properties.hpp>

#include <algorithm>
#include <cmath>

namespace dem::shape {

/// Integral of |x|^(k-1) |y|^(l-1) |z|^(m-1) over the solid |x/a|^p + |y/b|^q + |z/c|^r <= 1 (Dirichlet's integral):
///   8 a^k b^l c^m / (p q r) * Gamma(k/p) Gamma(l/q) Gamma(m/r) / Gamma(1 + k/p + l/q + m/r).
inline double superquadric_moment(const Vec3& radii, const Vec3& exponents, const Vec3& powers) {
  double log_sum = std::log(8.0), total = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double ratio = powers[i] / exponents[i];
    log_sum += powers[i] * std::log(radii[i]) - std::log(exponents[i]) + std::lgamma(ratio);
    total += ratio;
  }
  return std::exp(log_sum - std::lgamma(total));
}

/// Volume and inertia about the centre of a superquadric of density 1.
inline MassProperties superquadric_mass_properties(const Vec3& radii, const Vec3& exponents) {
  const Vec3 one = Vec3::Ones();
  Vec3 squares;
  for (int i = 0; i < 3; ++i) squares[i] = superquadric_moment(radii, exponents, one + 2.0 * Vec3::Unit(i));
  return {superquadric_moment(radii, exponents, one), Vec3::Zero(), diagonal_matrix(filled(squares.sum()) - squares)};
}

/// The largest distance of a superquadric's points from its centre. With the shares v_i = |x_i/r_i|^p_i, which sum to
/// 1, the squared distance sum of r_i^2 v_i^(2/p_i) is concave (exponents >= 2), so its only maximum has one slope
/// (2/p_i) r_i^2 v_i^(2/p_i - 1) = s for all i: s is found by bisection. Axes with exponent 2 have the constant slope
/// r_i^2; the longest of them takes what share the others leave.
inline double superquadric_bounding_radius(const Vec3& radii, const Vec3& exponents) {
  double floor_slope = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (exponents[i] <= 2.0 + 1e-9) floor_slope = std::max(floor_slope, radii[i] * radii[i]);
  }
  const auto share = [&](int i, double slope) {
    const double p = exponents[i];
    return p <= 2.0 + 1e-9 ? 0.0 : std::pow(2.0 * radii[i] * radii[i] / (p * slope), p / (p - 2.0));
  };
  const auto shares = [&](double slope) { return share(0, slope) + share(1, slope) + share(2, slope); };

  // At the slope |r|^2 all shares together are below 1.
  double high = std::max(floor_slope, radii.squaredNorm()), low = 1e-30 * high;
  low = std::max(low, floor_slope);
  if (!(shares(low) < 1.0)) {
    for (int k = 0; k < 200; ++k) {
      const double middle = std::sqrt(low * high);
      (shares(middle) < 1.0 ? high : low) = middle;
    }
  }
  const double slope = low;
  double squared = 0.0, rest = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double v = share(i, slope);
    rest -= v;
    if (v > 0.0) squared += radii[i] * radii[i] * std::pow(v, 2.0 / exponents[i]);
  }
  return std::sqrt(squared + floor_slope * std::max(rest, 0.0));
}

}  // namespace dem::shape
