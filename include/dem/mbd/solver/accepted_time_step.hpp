#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/solver/stable_time_step.hpp>

#include <algorithm>
#include <string>

namespace dem::mbd {

/// The largest time step (s, in n sub-steps) up to dt at which a machine is stable with what would be derived for that
/// step, and the part that limits it. What is derived gets stiffer as the step gets shorter and shares its bodies with
/// what is given, so the stable step of a longer one is not yet a step that is stable.
template <class I>
DEM_SETUP StableTimeStep accepted_time_step_of(Parts m, double dt, int n) {
  StableTimeStep limit;
  const auto is_stable_at = [&](double step) {
    derive_stiffness(m, step / n);
    limit = stable_time_step_of<I>(m);
    limit.dt *= n;
    return limit.dt >= step;
  };
  double low = dt, high = dt;
  std::string limited_by;
  for (int k = 0; k < 60 && !is_stable_at(low); ++k) {
    limited_by = limit.limited_by;
    high = low;
    low = std::min(0.5 * low, limit.dt);
  }
  for (int k = 0; k < 12; ++k) {  // to 2e-4 of it
    const double middle = 0.5 * (low + high);
    (is_stable_at(middle) ? low : high) = middle;
  }
  return {low, limited_by};
}

}  // namespace dem::mbd
