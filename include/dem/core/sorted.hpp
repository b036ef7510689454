#pragma once

#include <dem/core/compiled.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace dem {

// std::sort of what is sorted in many places, compiled once.

void sort_ascending(std::span<std::uint32_t> numbers);
/// By key; those of one key by number.
void sort_ascending(std::vector<std::pair<std::uint64_t, std::uint32_t>>& keys);
/// Ascending, each once.
void sort_and_drop_doubles(std::vector<std::uint32_t>& numbers);

}  // namespace dem

#if DEM_DEFINES
#include <algorithm>

namespace dem {

DEM_INLINE void sort_ascending(std::span<std::uint32_t> numbers) { std::sort(numbers.begin(), numbers.end()); }

DEM_INLINE void sort_ascending(std::vector<std::pair<std::uint64_t, std::uint32_t>>& keys) {
  std::sort(keys.begin(), keys.end());
}

DEM_INLINE void sort_and_drop_doubles(std::vector<std::uint32_t>& numbers) {
  sort_ascending(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace dem

#endif
