#pragma once

#include <dem/core/ids.hpp>
#include <dem/math/vector.hpp>

#include <cmath>
#include <cstddef>

namespace dem::soil {

/// Root mean square of the grains' speeds (m/s).
template <class World>
double rms_speed(const World& world) {
  const auto grains = world.grains();
  double sum = 0.0;
  for (const GrainId p : grains) sum += world.velocity(p).squaredNorm();
  return grains.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(grains.size()));
}

/// The speed (m/s) below which grains of size d (m) count as at rest: 1 % of sqrt(g d), the speed of a fall through
/// half of their size. Without gravity give a speed of your own.
inline double rest_speed(double size, double gravity = 9.81) { return 0.01 * std::sqrt(gravity * size); }

/// Says when a quantity has stayed under a limit for a while (of time, s): fed with samples, forgets on each one above.
class StaysBelow {
 public:
  StaysBelow(double limit, double duration) : limit_(limit), duration_(duration) {}

  /// True once all samples over the last `duration` were below the limit.
  bool operator()(double time, double value) {
    if (!(value < limit_)) since_ = -1.0;
    else if (since_ < 0.0) since_ = time;
    return since_ >= 0.0 && time - since_ >= duration_;
  }

  /// For a run that goes on after it was stopped.
  template <class V>
  void fields(V& v) {
    v("since", since_, "s");
  }

 private:
  double limit_, duration_;
  double since_ = -1.0;
};

}  // namespace dem::soil
