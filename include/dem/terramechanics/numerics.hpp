#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace dem::terramechanics {

/// Places and weights on (0, 1) of the tanh-sinh rule (Takahasi and Mori 1974), which keeps its accuracy where the
/// integrand has a power or a thin layer at an end, as pressures and shear stresses under a wheel do.
template <std::size_t half>
struct TanhSinh {
  static constexpr std::size_t size = 2 * half + 1;
  static constexpr double reach = 3.15;  ///< where the weights have fallen to 1e-15
  std::array<double, size> place{}, weight{};

  TanhSinh() {
    const double step = reach / half;
    for (std::size_t k = 0; k < size; ++k) {
      const double t = step * (static_cast<double>(k) - static_cast<double>(half));
      const double s = 0.5 * std::numbers::pi * std::sinh(t);
      place[k] = 1.0 / (1.0 + std::exp(-2.0 * s));
      weight[k] = step * 0.25 * std::numbers::pi * std::cosh(t) / (std::cosh(s) * std::cosh(s));
    }
  }
};

/// Adds the integrals from a to b of the components of f(x), an array, to `sums`. `half` sets the number of places,
/// 2 half + 1; twice as many square the relative error.
template <std::size_t half = 40, std::size_t n, class F>
void integrate(double a, double b, F&& f, std::array<double, n>& sums) {
  static const TanhSinh<half> rule;
  if (!(b > a)) return;
  for (std::size_t k = 0; k < rule.size; ++k) {
    const std::array<double, n> y = f(a + (b - a) * rule.place[k]);
    for (std::size_t c = 0; c < n; ++c) sums[c] += (b - a) * rule.weight[k] * y[c];
  }
}

/// A zero of f between a and b, where it has different signs, to rounding: regula falsi after Anderson and Bjoerck
/// (1973), with a bisection whenever two steps together did not halve the bracket.
template <class F>
double find_root(F&& f, double a, double b) {
  double fa = f(a), fb = f(b);
  if (fa == 0.0) return a;
  if (fb == 0.0) return b;
  for (int k = 0; k < 200; ++k) {
    const double width = std::abs(b - a);
    if (width <= 2e-16 * (std::abs(a) + std::abs(b))) break;
    for (int part = 0; part < 3; ++part) {
      if (part == 2 && std::abs(b - a) <= 0.5 * width) break;
      double x = part == 2 ? 0.5 * (a + b) : b - fb * (b - a) / (fb - fa);
      if (!(x > std::min(a, b) && x < std::max(a, b))) x = 0.5 * (a + b);
      const double fx = f(x);
      if (fx == 0.0) return x;
      if ((fx > 0.0) != (fb > 0.0)) {
        a = b;
        fa = fb;
      } else {
        const double share = 1.0 - fx / fb;
        fa *= share > 0.0 ? share : 0.5;
      }
      b = x;
      fb = fx;
    }
  }
  return b;
}

}  // namespace dem::terramechanics
