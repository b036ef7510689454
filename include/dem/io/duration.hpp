#pragma once
// Time spans in words, and the clock they are measured with.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <string>

namespace dem::io {

/// Seconds [s] on a clock that never jumps; only differences mean something.
[[nodiscard]] inline double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A time span [s] in two units at most: "0.4 s", "12 s", "3 min 05 s", "2 h 07 min", "3 d 04 h"; "?" when it is
/// not a finite number >= 0.
[[nodiscard]] inline std::string format_duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0 || seconds > 1e12) return "?";
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long long s = std::llround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  const long long min = std::llround(seconds / 60);
  if (min < 24LL * 60) return fmt::format("{} h {:02} min", min / 60, min % 60);
  const long long h = std::llround(seconds / 3600);
  return fmt::format("{} d {:02} h", h / 24, h % 24);
}

}  // namespace dem::io
