#pragma once

#include <dem/core/short_list.hpp>
#include <dem/geometry/contact_shares.hpp>

#include <cstdint>
#include <utility>

namespace dem::shape {

/// Finds the points of one contact with find(callback(feature, point)) and hands them on to `callback`, weighted so
/// that they are one whole contact (contact::fit_weights).
template <class Find, class Callback>
DEM_HOT void share_points(Find&& find, Callback&& callback) {
  ShortList<std::pair<std::uint32_t, contact::ContactPoint<double>>, 32> list;
  auto& found = list.items;
  find([&](std::uint32_t feature, const contact::ContactPoint<double>& point) { found.emplace_back(feature, point); });
  contact::fit_weights(found.size(), contact::Fit::always,
                       [&](std::size_t k) -> contact::ContactPoint<double>& { return found[k].second; });
  for (const auto& [feature, point] : found) callback(feature, point);
}

}  // namespace dem::shape
