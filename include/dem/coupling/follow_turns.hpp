#pragma once

#include <dem/geometry/direction_code.hpp>
#include <dem/grain/contact_evaluator.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace dem::coupling {

namespace detail {

/// Contacts whose keys are equal but for the direction: hits of this step, and histories [first, end) of the last.
/// Those whose key is found again stay. Of the others the two that point most alike become one contact, as long as
/// there are two that are less than 60 degrees apart.
template <int Size>
void follow_turns_of(std::span<const grain::Hit> hits, ContactHistories<Size>& last, int first, int end) {
  const auto key_of = [&](int c) -> std::uint64_t& { return last.key[static_cast<std::size_t>(c)]; };
  const auto direction = [](std::uint64_t key) {
    return surface::direction_of(static_cast<std::uint32_t>(key & ((1u << surface::direction_bits) - 1u)));
  };
  const auto goes_on = [&](std::uint64_t key) {
    return std::any_of(hits.begin(), hits.end(), [&](const grain::Hit& hit) { return hit.key == key; });
  };
  const auto was_there = [&](std::uint64_t key) {
    for (int c = first; c < end; ++c) {
      if (key_of(c) == key) return true;
    }
    return false;
  };
  for (;;) {
    double most = 0.5;
    std::uint64_t new_key = 0;
    int turned = end;
    for (const grain::Hit& hit : hits) {
      if (was_there(hit.key)) continue;
      for (int c = first; c < end; ++c) {
        const double alike = dot(direction(hit.key), direction(key_of(c)));
        if (alike <= most || goes_on(key_of(c))) continue;
        most = alike;
        new_key = hit.key;
        turned = c;
      }
    }
    if (turned == end) break;
    key_of(turned) = new_key;
  }
  for (int k = first + 1; k < end; ++k) {  // in the order of keys again
    for (int c = k; c > first && key_of(c) < key_of(c - 1); --c) {
      std::swap(key_of(c), key_of(c - 1));
      for (auto& column : last.history) {
        std::swap(column[static_cast<std::size_t>(c)], column[static_cast<std::size_t>(c - 1)]);
      }
    }
  }
}

}  // namespace detail

/// Gives the contacts of the last step with a surface the keys that they have now. Some surfaces name a contact by its
/// direction (surface::NamesDirections). Such a contact changes its key as it turns, for instance that of a ball that
/// rolls in a drum. One name for all contacts would be wrong: in a groove either of two may vanish while the other one
/// stays. `hits`: of this step with that surface, keys ascending; `has_direction(key)`: whether a key ends in a
/// direction.
template <int Size, class HasDirection>
void follow_turns(std::span<const grain::Hit> hits, ContactHistories<Size>& last, HasDirection&& has_direction) {
  const auto family = [](std::uint64_t key) { return key >> surface::direction_bits; };
  const auto family_at = [&](int c) { return family(last.key[static_cast<std::size_t>(c)]); };
  if (hits.empty()) return;
  const auto begin = last.key.begin();
  const std::uint64_t from = family(hits.front().key) << surface::direction_bits;
  int at = static_cast<int>(std::lower_bound(begin, begin + last.count, from) - begin);
  for (std::size_t h = 0; h < hits.size();) {
    if (at < last.count && last.key[static_cast<std::size_t>(at)] == hits[h].key) {  // mostly nothing has changed
      ++at;
      ++h;
      continue;
    }
    const std::uint64_t now = family(hits[h].key);
    while (h > 0 && family(hits[h - 1].key) == now) --h;
    while (at > 0 && family_at(at - 1) == now) --at;
    while (at < last.count && family_at(at) < now) ++at;
    std::size_t end = h;
    int last_end = at;
    while (end < hits.size() && family(hits[end].key) == now) ++end;
    while (last_end < last.count && family_at(last_end) == now) ++last_end;
    if (last_end > at && has_direction(hits[h].key)) {
      detail::follow_turns_of(hits.subspan(h, end - h), last, at, last_end);
    }
    h = end;
    at = last_end;
  }
}

}  // namespace dem::coupling
