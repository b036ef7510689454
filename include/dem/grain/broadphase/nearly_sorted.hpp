#pragma once

#include <dem/parallel/blocks.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace dem::broadphase {

/// Sorts entries of which most are in order already, as grains are that were sorted a while ago: one pass, and a sort
/// of the others alone. The result is that of std::sort where no two entries are equal.
template <class Entry, class Less>
void sort_nearly_sorted(std::span<Entry> entries, Less less) {
  std::vector<Entry> strays;
  std::size_t kept = 0, in_a_row = 0;  // entries that are in order; how many have strayed since the last of them
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Entry e = entries[i];  // a copy: its place may be written to
    if (kept > 0 && less(e, entries[kept - 1])) {
      // Either this entry has strayed, or those before it have that are above it. It is those if they are fewer.
      if (kept > in_a_row + 1 && less(e, entries[kept - 2 - in_a_row])) {
        strays.push_back(e);
        ++in_a_row;
        continue;
      }
      while (kept > 0 && less(e, entries[kept - 1])) strays.push_back(entries[--kept]);
    }
    in_a_row = 0;
    entries[kept++] = e;
  }
  std::sort(strays.begin(), strays.end(), less);
  // Merged from the back, where there is room.
  std::size_t to = entries.size(), left = strays.size();
  while (left > 0) {
    if (kept > 0 && less(strays[left - 1], entries[kept - 1])) entries[--to] = entries[--kept];
    else entries[--to] = strays[--left];
  }
}

/// The same on the executor's threads, whose number does not change the result. Some of the entries divide all of them
/// into four parts a thread, and each part is sorted by itself. `scratch` is kept for the next time.
template <class Entry, class Less, class Executor>
void sort_nearly_sorted(std::vector<Entry>& entries, std::vector<Entry>& scratch, Less less, Executor& executor) {
  const std::size_t n = entries.size(), parts = 4 * static_cast<std::size_t>(executor.threads());
  if (executor.threads() == 1 || n < parts * exec::block_size / 4) return sort_nearly_sorted(std::span(entries), less);

  std::vector<Entry> bounds;  // the lowest entry of each part but the first
  for (std::size_t k = 1; k < parts; ++k) bounds.push_back(entries[k * n / parts]);
  std::sort(bounds.begin(), bounds.end(), less);
  // Mostly an entry goes where the one before it went.
  const auto part_of = [&](const Entry& e, std::size_t last) {
    const bool is_there = (last == 0 || !less(e, bounds[last - 1])) && (last + 1 == parts || less(e, bounds[last]));
    if (is_there) return last;
    return static_cast<std::size_t>(std::upper_bound(bounds.begin(), bounds.end(), e, less) - bounds.begin());
  };
  const auto stretch = [&](std::size_t k) { return k * n / parts; };
  std::vector<std::size_t> places(parts * parts + 1, 0);  // where a stretch's entries of a part begin
  executor.for_each(parts, [&](std::size_t k) {
    std::vector<std::size_t> counts(parts, 0);
    std::size_t part = k;
    for (std::size_t i = stretch(k); i < stretch(k + 1); ++i) ++counts[part = part_of(entries[i], part)];
    for (part = 0; part < parts; ++part) places[part * parts + k + 1] = counts[part];
  });
  std::partial_sum(places.begin(), places.end(), places.begin());
  scratch.resize(n);
  executor.for_each(parts, [&](std::size_t k) {
    std::vector<std::size_t> next(parts);
    for (std::size_t part = 0; part < parts; ++part) next[part] = places[part * parts + k];
    std::size_t part = k;
    for (std::size_t i = stretch(k); i < stretch(k + 1); ++i) {
      part = part_of(entries[i], part);
      scratch[next[part]++] = entries[i];
    }
  });
  executor.for_each(parts, [&](std::size_t part) {
    const std::size_t first = places[part * parts], last = places[(part + 1) * parts];
    sort_nearly_sorted(std::span(scratch).subspan(first, last - first), less);
  });
  entries.swap(scratch);
}

}  // namespace dem::broadphase
