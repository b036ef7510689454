#pragma once

#include <dem/core/macros.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>

namespace dem::exec {

/// What a member of a team did in one call.
struct Share {
  std::size_t pieces = 0;
  double seconds = 0.0;  ///< s, in which it had a processor
};

/// Whether it is worth calling others to help: an account, in seconds, of the work that they save the caller and of
/// what they cost it. Where another program runs, a helper may lose its processor in the middle of a piece, and the
/// caller waits for some milliseconds, in which it could have done many pieces; or the helper and the other program
/// take the caller's. Where helpers cost more than they save, they are not called for a tenth of a second, then tried
/// again; each time that they fail, they are left out twice as long, at most two seconds.
class Help {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  bool is_worth_it(Time now) const { return now >= alone_until_; }

  /// The time (s) in which the caller would have done what a helper did. Some pieces are more work than others, but a
  /// helper whose pieces take more than three times as long as the caller's is held up.
  static double saved_by(const Share& helper, const Share& caller);

  /// A call is over (s): what helpers saved, and how long the caller did not work, but called them, waited for them, or
  /// had no processor.
  void account(double saved, double cost, Time now);

 private:
  using Seconds = std::chrono::duration<double>;

  // Several time slices of an operating system, so that one that was lost by chance does not decide.
  static constexpr double window = 0.02;  // s
  static constexpr Seconds shortest_pause{0.1}, longest_pause{2.0};

  double saved_ = 0.0, cost_ = 0.0;  // s, since the last verdict
  Seconds pause_ = shortest_pause;
  Time alone_until_{};
};

}  // namespace dem::exec

#if DEM_DEFINES

namespace dem::exec {

DEM_INLINE double Help::saved_by(const Share& helper, const Share& caller) {
  if (helper.pieces == 0) return 0.0;
  const double alike = static_cast<double>(helper.pieces) * caller.seconds / static_cast<double>(caller.pieces);
  return std::min(helper.seconds, 3.0 * alike);
}

DEM_INLINE void Help::account(double saved, double cost, Time now) {
  saved_ += saved;
  cost_ += cost;
  if (saved_ + cost_ < window) return;
  if (cost_ > saved_) {
    alone_until_ = now + std::chrono::duration_cast<Clock::duration>(pause_);
    pause_ = std::min(2.0 * pause_, longest_pause);
  } else {
    pause_ = shortest_pause;
  }
  saved_ = cost_ = 0.0;
}

}  // namespace dem::exec

#endif
