#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dem::broadphase {

/// Sorts entries of which most are in order already, as grains are that were sorted a while ago: one pass, and a sort
/// of the others alone. The result is that of std::sort where no two entries are equal.
template <class Entry, class Less>
void sort_nearly_sorted(std::vector<Entry>& entries, Less less) {
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

}  // namespace dem::broadphase
