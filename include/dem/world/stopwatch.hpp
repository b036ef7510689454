#pragma once

#include <dem/core/compiled.hpp>

#include <array>
#include <cstddef>

namespace dem {

/// The phases of a step, for timing.
enum class Phase { neighbours, grains, machine };
inline constexpr std::array<const char*, 3> phase_names = {"neighbour lists", "contacts and motion", "machine"};

/// Adds up the wall time of each phase while it is switched on; costs one branch a phase while it is off.
class Stopwatch {
 public:
  void switch_on(bool on) {
    on_ = on;
    seconds_.fill(0.0);
  }
  /// A phase begins.
  void start() {
    if (on_) [[unlikely]]
      since_ = now();
  }
  /// The phase is over.
  void stop(Phase phase) {
    if (!on_) [[likely]]
      return;
    seconds_[static_cast<std::size_t>(phase)] += now() - since_;
  }
  /// The time in s while it is on, else 0: for work inside a phase, clock() after less clock() before.
  double clock() const {
    if (!on_) [[likely]]
      return 0.0;
    return now();
  }
  double seconds(Phase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }

 private:
  static double now();  // s

  bool on_ = false;
  double since_ = 0.0;
  std::array<double, phase_names.size()> seconds_ = {};
};

}  // namespace dem

#if DEM_DEFINES
#include <chrono>

namespace dem {

DEM_INLINE double Stopwatch::now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace dem

#endif
