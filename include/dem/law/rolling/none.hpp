#pragma once

#include <dem/law/rolling/rolling_law.hpp>

namespace dem::rolling {

/// Grains roll and twist over each other freely; compiles to nothing.
struct None {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT Vector3<T> torque(const Parameters<T>&, const RollingState<T>&, History<T>&) {
    return {T(0), T(0), T(0)};
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>&, Turn&&) {}
  static double stiffness(const Parameters<double>&, const contact::NormalState<double>&) { return 0.0; }
  static double energy(const Parameters<double>&, double, const History<double>&) { return 0.0; }
  static void check(const Parameters<double>&) {}
};

}  // namespace dem::rolling
