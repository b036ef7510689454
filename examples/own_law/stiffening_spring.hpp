#pragma once

#include <dem/core/error.hpp>
#include <dem/law/normal/normal_law.hpp>

struct StiffeningSpring {  // F = K d (1 + (d/depth)^2) + C d', never pulling
  template <class T>
  struct Parameters {
    T stiffness, depth, damping;
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const dem::contact::NormalState<T>& s, History<T>&) {
    const T x = s.overlap / p.depth;
    return dem::max(T(0), p.stiffness * s.overlap * (T(1) + x * x) + p.damping * s.approach_speed);
  }
  static double stiffness(const Parameters<double>& p, const dem::contact::NormalState<double>& s) {
    const double x = s.overlap / p.depth;
    return p.stiffness * (1 + 3 * x * x);
  }
  static void check(const Parameters<double>& p) { dem::require_positive(p.stiffness, "normal stiffness", "N/m"); }
};
