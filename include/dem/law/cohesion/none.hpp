#pragma once

#include <dem/law/cohesion/cohesion_law.hpp>

namespace dem::cohesion {

/// Dry grains; compiles to nothing.
struct None {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Attraction<T> force(const Parameters<T>&, const NormalState<T>&, History<T>&) {
    return {T(0), T(0)};
  }
  static double stiffness(const Parameters<double>&, const NormalState<double>&) { return 0.0; }
  static double energy(const Parameters<double>&, const NormalState<double>&, const History<double>&) { return 0.0; }
  static void check(const Parameters<double>&) {}
};

}  // namespace dem::cohesion
