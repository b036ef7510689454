#pragma once

#include <string>

namespace dem {

/// The largest stable time step of something, and what limits it.
struct StableTimeStep {
  double dt = 1e300;       ///< s
  std::string limited_by;  ///< in words, e.g. "revolute joint 'crank'"; empty if nothing limits it
};

}  // namespace dem
