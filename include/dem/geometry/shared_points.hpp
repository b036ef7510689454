#pragma once

#include <dem/geometry/contact_shares.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace dem::shape {

/// Finds the points of one contact with find(sink(feature, touch)) and hands them on to `sink`, weighted so that they
/// are one whole contact (contact::fit_weights).
template <class Find, class Sink>
void share_points(Find&& find, Sink&& sink) {
  static thread_local std::vector<std::pair<std::uint32_t, contact::PointTouch<double>>> found;
  found.clear();
  find([&](std::uint32_t feature, const contact::PointTouch<double>& touch) { found.push_back({feature, touch}); });
  contact::fit_weights(found.size(), contact::Fit::always,
                       [&](std::size_t k) -> contact::PointTouch<double>& { return found[k].second; });
  for (const auto& [feature, touch] : found) sink(feature, touch);
}

}  // namespace dem::shape
