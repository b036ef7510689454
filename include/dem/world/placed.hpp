#pragma once

#include <dem/core/macros.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace dem {

/// Some of a world's surfaces: few at a time.
struct SurfaceSet {
  std::vector<std::size_t> all;

  bool has(std::size_t s) const { return std::find(all.begin(), all.end(), s) != all.end(); }
  void add(std::size_t s) {
    if (!has(s)) all.push_back(s);
  }
};

/// What was last put somewhere by hand, between two steps.
struct Placed {
  std::uint64_t at = ~0ull;  ///< the step before

  void grain(std::uint64_t step, std::uint32_t id);
  void surface(std::uint64_t step, std::size_t s) { begin(step), surfaces_.add(s); }

  bool has_grain(std::uint32_t id) const;
  bool has_surface(std::size_t s) const { return surfaces_.has(s); }
  std::size_t bytes() const { return ids_.capacity() * sizeof(Range); }

 private:
  struct Range {
    std::uint32_t first, end;
  };
  void begin(std::uint64_t step);
  /// How many ranges begin at an id or before it.
  std::ptrdiff_t ranges_from(std::uint32_t id) const;

  SurfaceSet surfaces_;
  std::vector<Range> ids_;  // ascending: most grains are added one after the other
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE void Placed::grain(std::uint64_t step, std::uint32_t id) {
  begin(step);
  const auto next = ids_.begin() + ranges_from(id);
  if (next != ids_.begin() && id <= std::prev(next)->end) {
    std::prev(next)->end = std::max(std::prev(next)->end, id + 1);
  } else {
    ids_.insert(next, {id, id + 1});
  }
}

DEM_INLINE bool Placed::has_grain(std::uint32_t id) const {
  const auto ranges = ranges_from(id);
  return ranges > 0 && id < ids_[static_cast<std::size_t>(ranges - 1)].end;
}

DEM_INLINE void Placed::begin(std::uint64_t step) {
  if (at != step) *this = {};
  at = step;
}

DEM_INLINE std::ptrdiff_t Placed::ranges_from(std::uint32_t id) const {
  return std::upper_bound(ids_.begin(), ids_.end(), id, [](auto a, const Range& r) { return a < r.first; }) -
         ids_.begin();
}

}  // namespace dem

#endif
