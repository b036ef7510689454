#pragma once
// Piles of one kind, and how their values scatter.

#include <dem/rig/sand_pile/results.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace dem::rig::sand_pile {

inline constexpr double degrees = 180.0 / std::numbers::pi;

/// Mean and standard deviation of what is known; the latter of two at the least.
struct Spread {
  double mean = not_known, deviation = not_known;
};
inline Spread spread_of(const std::vector<double>& values) {
  double sum = 0.0, square = 0.0, n = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v, n += 1.0;
  }
  if (n == 0.0) return {};
  for (const double v : values) {
    if (std::isfinite(v)) square += (v - sum / n) * (v - sum / n);
  }
  return {sum / n, n > 1.0 ? std::sqrt(square / (n - 1.0)) : not_known};
}

/// The piles of one kind, in the order in which they were made.
inline std::vector<std::vector<const PileResult*>> by_kind(const Campaign& c) {
  std::vector<std::vector<const PileResult*>> kinds;
  for (const PileResult& r : c.piles) {
    if (kinds.empty() || kinds.back().front()->kind.name != r.kind.name) kinds.emplace_back();
    kinds.back().push_back(&r);
  }
  return kinds;
}

}  // namespace dem::rig::sand_pile
