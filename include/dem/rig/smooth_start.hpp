#pragma once

#include <dem/mbd/drive/signal.hpp>

#include <algorithm>

namespace dem::rig {

/// The way of something that starts smoothly: from `from` (m or rad) at the time t0 (s) to the full speed (per s)
/// within `ramp` (s), then on.
inline mbd::Signal smooth_start(double speed, double ramp, double t0, double from = 0.0) {
  const double over = std::max(ramp, 1e-9);
  return mbd::Signal::function(
      [=](double t) {
        const double x = std::clamp((t - t0) / over, 0.0, 1.0);
        return from + speed * over * x * x * x * (1.0 - 0.5 * x) + speed * std::max(0.0, t - t0 - over);
      },
      [=](double t) {
        const double x = std::clamp((t - t0) / over, 0.0, 1.0);
        return speed * x * x * (3.0 - 2.0 * x);
      });
}

}  // namespace dem::rig
