#pragma once

#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>

namespace dem {

/// The implicit function of a superquadric about its own axes (thesis eq. 31): F(x) = sum |x_k/r_k|^p_k - 1, negative
/// inside, convex for exponents of 1 and more. shape::SuperquadricSolid is the same for grains, with faster powers that
/// round otherwise.
struct SuperquadricFunction {
  double radius[3];    ///< m, half sizes
  double exponent[3];  ///< 2: round; large: boxy

  double value(const double* x) const {
    double f = -1.0;
    for (int k = 0; k < 3; ++k) f += std::pow(std::abs(x[k]) / radius[k], exponent[k]);
    return f;
  }
  void gradient(const double* x, double* g) const {
    for (int k = 0; k < 3; ++k) {
      const double u = std::abs(x[k]) / radius[k];
      g[k] = std::copysign(exponent[k] / radius[k] * std::pow(u, exponent[k] - 1.0), x[k]);
    }
  }
};

/// A place on a surface and the unit normal there, away from the inside.
struct SurfacePlace {
  Vector3<double> point, normal;
};

namespace detail {

/// |x| of the place x with x + s F'(x) = p in one coordinate: Newton's method kept inside a bracket. Increasing in x,
/// so there is one solution between 0 and |p|.
inline double foot_coordinate(double p, double s, double radius, double exponent) {
  double low = 0.0, high = p, x = std::min(p, radius);
  for (int k = 0; k < 60 && high - low > 1e-16 * radius; ++k) {
    const double u = x / radius, power = std::pow(u, exponent - 1.0);
    const double f = x + s * exponent / radius * power - p;
    (f > 0.0 ? high : low) = x;
    const double slope = 1.0 + (u > 0.0 ? s * exponent * (exponent - 1.0) / (radius * radius) * power / u : 0.0);
    const double next = x - f / slope;
    if (std::abs(f) <= 1e-16 * p) break;
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

}  // namespace detail

/// The nearest place of the surface to a point outside. With x + s grad F(x) = p each coordinate depends on s alone,
/// and F(x(s)) falls steadily: two nested searches for one root each, safe for every convex superquadric.
inline SurfacePlace nearest_from_outside(const SuperquadricFunction& f, const Vector3<double>& p) {
  const double at[3] = {p.x, p.y, p.z};
  double x[3] = {p.x, p.y, p.z};
  const auto foot = [&](double s) {
    for (int k = 0; k < 3; ++k) {
      x[k] = std::copysign(detail::foot_coordinate(std::abs(at[k]), s, f.radius[k], f.exponent[k]), at[k]);
    }
    return f.value(x);
  };
  double low = 0.0, high = f.radius[0] * f.radius[0], f_low = f.value(x), f_high = foot(high);
  for (int k = 0; k < 200 && f_high > 0.0; ++k) {
    low = high;
    f_low = f_high;
    f_high = foot(high *= 4.0);
  }
  // Regula falsi; the Illinois variant halves the value at an end that stays, so that both ends move.
  int side = 0;
  for (int k = 0; k < 100 && high - low > 1e-15 * high; ++k) {
    const double s = (low * f_high - high * f_low) / (f_high - f_low);
    const double tried = s > low && s < high && k < 50 ? s : 0.5 * (low + high);
    const double value = foot(tried);
    if (std::abs(value) < 1e-15) break;
    (value > 0.0 ? low : high) = tried;
    (value > 0.0 ? f_low : f_high) = value;
    if (value > 0.0 && side > 0) f_high *= 0.5;
    if (value < 0.0 && side < 0) f_low *= 0.5;
    side = value > 0.0 ? 1 : -1;
  }
  double g[3];
  f.gradient(x, g);
  const Vector3<double> normal = {g[0], g[1], g[2]};
  return {{x[0], x[1], x[2]}, (1.0 / norm(normal)) * normal};
}

/// A nearest place of the surface to a point inside: the place where the ray along the normal leaves, with the normal
/// of the place before, until it stays. Converges to the nearest one while the depth is below the surface's radius of
/// curvature there; deeper points still get a way out, if not the shortest.
inline SurfacePlace nearest_from_inside(const SuperquadricFunction& f, const Vector3<double>& p) {
  double at[3] = {p.x, p.y, p.z}, g[3];
  f.gradient(at, g);
  Vector3<double> normal = {g[0], g[1], g[2]}, point = p;
  const double smallest = std::min({f.radius[0], f.radius[1], f.radius[2]});
  if (norm(normal) * smallest < 1e-12) {  // at the centre: along the shortest axis
    normal = {0, 0, 0};
    (f.radius[0] == smallest ? normal.x : f.radius[1] == smallest ? normal.y : normal.z) = 1.0;
  }
  normal = (1.0 / norm(normal)) * normal;
  const double far = 2.0 * (f.radius[0] + f.radius[1] + f.radius[2]);
  double last = far;
  for (int round = 0; round < 60; ++round) {
    double low = 0.0, high = far;  // F rises along the ray from a value that is not positive
    double t = std::min(last, 0.5 * far);
    for (int k = 0; k < 80 && high - low > 1e-15 * far; ++k) {
      const double x[3] = {p.x + t * normal.x, p.y + t * normal.y, p.z + t * normal.z};
      const double value = f.value(x);
      if (std::abs(value) < 1e-15) break;
      (value > 0.0 ? high : low) = t;
      f.gradient(x, g);
      const double slope = g[0] * normal.x + g[1] * normal.y + g[2] * normal.z;
      const double next = t - value / slope;
      t = slope > 0.0 && next > low && next < high ? next : 0.5 * (low + high);
    }
    point = p + t * normal;
    const double x[3] = {point.x, point.y, point.z};
    f.gradient(x, g);
    const Vector3<double> fresh = {g[0], g[1], g[2]};
    const Vector3<double> unit = (1.0 / norm(fresh)) * fresh;
    const Vector3<double> change = unit - normal;
    normal = unit;
    last = t;
    if (dot(change, change) < 1e-28) break;
  }
  return {point, normal};
}

}  // namespace dem
