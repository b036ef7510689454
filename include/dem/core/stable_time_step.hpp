#pragma once

#include <cmath>
#include <string>

namespace dem {

/// The largest stable time step of something, and what limits it.
struct StableTimeStep {
  double dt = 1e300;       ///< s
  std::string limited_by;  ///< in words, e.g. "revolute joint 'crank'"; empty if nothing limits it
};

/// A number that is greater than 0, down to four digits: what is named as allowed must be so when it is typed.
inline double rounded_down(double x) {
  const double scale = std::pow(10.0, 3.0 - std::floor(std::log10(x)));
  return std::floor(x * scale) / scale;
}

}  // namespace dem
