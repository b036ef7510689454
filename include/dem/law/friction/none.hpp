#pragma once

#include <dem/law/friction/friction_law.hpp>

namespace dem::friction {

/// No friction at all; compiles to nothing.
struct None {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Vector3<T> force(const Parameters<T>&, const TangentialState<T>&, History<T>&) {
    return {T(0), T(0), T(0)};
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>&, Turn&&) {}
  static double stiffness(const Parameters<double>&) { return 0.0; }
  static double energy(const Parameters<double>&, const History<double>&) { return 0.0; }
  static void check(const Parameters<double>&) {}
};

}  // namespace dem::friction
