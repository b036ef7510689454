#pragma once
// How long a job will still take.

#include <algorithm>
#include <cmath>
#include <optional>

namespace dem::io {

/// Estimates the time left from samples (time, amount done). The rate is a mean over about the last fifth of the job
/// (at least 10 s), because a step costs more once the grains are packed than while they fall.
class EtaEstimator {
 public:
  /// The job stands at `done` (any unit) at the time `now` [s].
  explicit EtaEstimator(double now = 0, double done = 0) : start_(now), last_time_(now), last_done_(done) {}

  void sample(double now, double done) {
    const double dt = now - last_time_;
    if (!(dt > 0)) return;
    const double memory = std::max(10.0, 0.2 * (now - start_));
    const double weight = 1 - std::exp(-dt / memory);
    rate_sum_ += weight * ((done - last_done_) / dt - rate_sum_);
    weight_sum_ += weight * (1 - weight_sum_);
    last_time_ = now;
    last_done_ = done;
  }

  /// Time [s] from the last sample until `total` is done; nothing while no headway is seen.
  [[nodiscard]] std::optional<double> left(double total) const {
    if (last_done_ >= total) return 0.0;
    // The quotient takes away the bias towards the zero rate that the sums started from.
    const double rate = weight_sum_ > 0 ? rate_sum_ / weight_sum_ : 0;
    if (!(rate > 0)) return std::nullopt;
    return (total - last_done_) / rate;
  }

 private:
  double start_, last_time_, last_done_;
  double rate_sum_ = 0, weight_sum_ = 0;
};

}  // namespace dem::io
