#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace dem::exec {

/// Whether it is worth calling others to help: an account, in seconds, of the work that they save the caller and of
/// what they cost it. A helper may lose its processor to another program in the middle of a piece. The caller then
/// waits for some milliseconds, in which it could have done many pieces. Where helpers cost more than they save, they
/// are not called for a tenth of a second, then tried again; each time that they fail, they are left out twice as long,
/// at most a second.
class Help {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  bool is_worth_it(Time now) const { return now >= alone_until_; }

  /// Work of n pieces, of which the caller did `own` itself from `began` to `ended`. It was called at `called`, and all
  /// was done at `done`.
  void account(std::size_t n, std::size_t own, Time called, Time began, Time ended, Time done) {
    if (own > 0) piece_ = seconds(ended - began) / static_cast<double>(own);
    saved_ += static_cast<double>(n - own) * piece_;
    cost_ += seconds(began - called) + seconds(done - ended);
    if (saved_ + cost_ < window) return;
    if (cost_ > saved_) {
      alone_until_ = done + std::chrono::duration_cast<Clock::duration>(pause_);
      pause_ = std::min(2.0 * pause_, longest_pause);
    } else {
      pause_ = shortest_pause;
    }
    saved_ = cost_ = 0.0;
  }

 private:
  using Seconds = std::chrono::duration<double>;
  static double seconds(Clock::duration d) { return Seconds(d).count(); }

  // Several time slices of an operating system, so that one that was lost by chance does not decide.
  static constexpr double window = 0.02;  // s
  static constexpr Seconds shortest_pause{0.1}, longest_pause{1.0};

  double piece_ = 0.0;               // s, of the latest pieces that the caller did itself
  double saved_ = 0.0, cost_ = 0.0;  // s, since the last verdict
  Seconds pause_ = shortest_pause;
  Time alone_until_{};
};

}  // namespace dem::exec
