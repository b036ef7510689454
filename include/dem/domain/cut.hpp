#pragma once

// How work is cut into parts along the order of grains. Needs no MPI.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace dem::domain {

/// Cuts chunks, with the work that each of them is, into ranges of nearly the same work: the chunks of part k are those
/// from entry k to entry k + 1 of the result.
inline std::vector<std::uint32_t> cut_by_work(const std::vector<double>& of_chunks, int parts) {
  double all = 0.0, before = 0.0;
  for (const double w : of_chunks) all += w;
  std::vector<std::uint32_t> first(static_cast<std::size_t>(parts) + 1, static_cast<std::uint32_t>(of_chunks.size()));
  first[0] = 0;
  std::size_t next = 1;
  for (std::size_t c = 0; c < of_chunks.size(); ++c) {
    // A chunk goes to the part of the work in which its middle lies.
    while (next < first.size() - 1 && before + 0.5 * of_chunks[c] >= all * double(next) / parts) {
      first[next++] = static_cast<std::uint32_t>(c);
    }
    before += of_chunks[c];
  }
  return first;
}

/// The most work of a part, over the mean of all parts. `first` is what cut_by_work returned.
inline double imbalance_of(const std::vector<double>& of_chunks, const std::vector<std::uint32_t>& first) {
  double all = 0.0, most = 0.0;
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    double of_part = 0.0;
    for (std::size_t c = first[k]; c < first[k + 1]; ++c) of_part += of_chunks[c];
    all += of_part, most = std::max(most, of_part);
  }
  return all > 0.0 ? most * static_cast<double>(first.size() - 1) / all : 1.0;
}

}  // namespace dem::domain
