#pragma once
// What of a long run and of many grains a replay keeps: fewer, and spread evenly.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace dem::report {

/// Says which calls become frames. A call ticks when a new interval has begun, or always if the interval is 0; every
/// stride-th tick is a frame, from the first on.
class FrameTicks {
 public:
  explicit FrameTicks(double interval) : interval_(interval) {}

  /// Whether a call at this time (s), no earlier than the last one, would be a frame.
  [[nodiscard]] bool due(double time) const { return ticks(time) && ticks_ % stride_ == 0; }

  /// Counts the call.
  void count(double time) {
    if (ticks_ == 0) start_ = time;
    if (!ticks(time)) return;
    last_slot_ = slot_of(time);
    ++ticks_;
  }

  /// Every second frame is given up, and half as many are due from now on.
  void halve() { stride_ *= 2; }

  /// For a run that goes on after it was stopped.
  template <class V>
  void fields(V& v) {
    v("start", start_, "s"), v("last_slot", last_slot_), v("ticks", ticks_), v("stride", stride_);
  }

 private:
  [[nodiscard]] bool ticks(double time) const { return ticks_ == 0 || interval_ == 0.0 || slot_of(time) > last_slot_; }
  /// A hair too early counts: times of a run are sums of time steps.
  [[nodiscard]] double slot_of(double time) const {
    return interval_ > 0.0 ? std::floor((time - start_) / interval_ + 1e-6) : 0.0;
  }

  double interval_, start_ = 0.0, last_slot_ = 0.0;
  std::size_t ticks_ = 0, stride_ = 1;
};

/// Chooses which grains are drawn: all, or about as many as the limit, never more. A grain that is given up stays so.
class GrainSample {
 public:
  explicit GrainSample(std::size_t limit) : limit_(limit) {}

  /// Shape of a grain that was met, by its number; kUnmet of any other.
  [[nodiscard]] std::uint32_t shape_of(std::size_t number) const {
    return number < shapes_.size() ? shapes_[number] : kUnmet;
  }
  static constexpr std::uint32_t kUnmet = 0xffffffffU;

  /// Whether a grain of this number is drawn.
  [[nodiscard]] bool draws(std::size_t number) const {
    // Multiples of the golden ratio, without their whole parts, fill the unit interval evenly.
    return static_cast<std::uint32_t>(number) * std::uint32_t{2654435769U} <= below_;
  }

  /// Notes that there is such a grain.
  void meet(std::size_t number, std::size_t shape) {
    if (number >= shapes_.size()) shapes_.resize(number + 1, kUnmet);
    if (shapes_[number] != kUnmet) return;
    shapes_[number] = static_cast<std::uint32_t>(shape);
    ++met_;
    if (!draws(number) || ++drawn_ <= limit_) return;
    while (drawn_ > limit_) {
      // A hundredth more than needed, as counting again takes time.
      below_ = static_cast<std::uint32_t>(0.99 * below_ * static_cast<double>(limit_) / static_cast<double>(drawn_));
      drawn_ = 0;
      for (std::size_t n = 0; n < shapes_.size(); ++n) drawn_ += shapes_[n] != kUnmet && draws(n) ? 1U : 0U;
    }
  }

  [[nodiscard]] std::size_t met() const { return met_; }
  [[nodiscard]] std::size_t drawn() const { return drawn_; }
  /// One more than the highest number that was met.
  [[nodiscard]] std::size_t numbers() const { return shapes_.size(); }

  template <class V>
  void fields(V& v) {
    v("met", met_), v("drawn", drawn_), v("below", below_), v.bytes("shapes", shapes_);
  }

 private:
  std::size_t limit_, met_ = 0, drawn_ = 0;
  std::uint32_t below_ = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> shapes_;  // by number
};

}  // namespace dem::report
