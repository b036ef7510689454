#pragma once

#include <dem/domain/messages.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace dem::domain {

/// By what a grain is sorted among those of all ranks.
struct SortKey {
  std::uint64_t place = 0;   ///< of its cell along the curve
  std::uint32_t row = 0;     ///< that it has so far: decides within a cell
  float work = 0.0f;         ///< that it is, in whole numbers
  std::uint32_t asleep = 0;  ///< 1: behind all that are 0

  friend bool operator<(const SortKey& a, const SortKey& b) {
    return std::tie(a.asleep, a.place, a.row) < std::tie(b.asleep, b.place, b.row);
  }
};

/// The new rows of grains that ranks sorted together.
struct SortedRows {
  std::vector<std::uint32_t> row;      ///< of each key of this rank
  std::vector<double> work_of_chunks;  ///< of all chunks of so many rows
};

/// Sorts the keys of all ranks into one order. Those of this rank are sorted already. No rank sees all keys: each gets
/// a stretch of the order, as samples of all keys divide it, and tells who sent a key which row it is. Every rank calls
/// it. `all` keys there are on all ranks.
inline SortedRows sort_rows(const Messages& ranks, const std::vector<SortKey>& keys, std::size_t all,
                            std::size_t rows_of_a_chunk) {
  constexpr std::size_t samples_for_a_rank = 64;
  const auto count = static_cast<std::size_t>(ranks.ranks());

  // Some keys of each rank, as many as it has for its share, divide all into stretches.
  const std::size_t stride = std::max<std::size_t>(1, all / (samples_for_a_rank * count));
  std::vector<SortKey> samples;
  for (std::size_t k = stride / 2; k < keys.size(); k += stride) samples.push_back(keys[k]);
  samples = ranks.gathered(samples, false);
  std::sort(samples.begin(), samples.end());
  std::vector<std::vector<SortKey>> to(count);
  auto next = keys.begin();
  for (std::size_t r = 0; r < count; ++r) {
    auto end = keys.end();
    if (r + 1 < count && !samples.empty()) {
      end = std::lower_bound(next, keys.end(), samples[(r + 1) * samples.size() / count]);
    }
    to[r].assign(next, end);
    next = end;
  }
  const std::pair<std::vector<SortKey>, std::vector<int>> exchanged = ranks.exchanged(to);
  const std::vector<SortKey>& came = exchanged.first;
  const std::vector<int>& first = exchanged.second;

  // This rank's stretch: sorted lists of all ranks, one after the other.
  std::vector<std::uint32_t> order;
  for (std::size_t r = 0; r < count; ++r) {
    const auto middle = static_cast<std::ptrdiff_t>(order.size());
    for (int k = first[r]; k < first[r + 1]; ++k) order.push_back(static_cast<std::uint32_t>(k));
    std::inplace_merge(order.begin(), order.begin() + middle, order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return came[a] < came[b]; });
  }
  const std::vector<std::uint64_t> sizes = ranks.gathered(std::vector<std::uint64_t>{came.size()}, false);
  std::size_t before = 0;
  for (std::size_t r = 0; r < static_cast<std::size_t>(ranks.rank()); ++r) before += sizes[r];

  // Sums of whole numbers, which are exact in whatever parts they are made.
  std::vector<double> work;
  std::vector<std::uint32_t> row_of(came.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t row = before + k, chunk = row / rows_of_a_chunk - before / rows_of_a_chunk;
    row_of[order[k]] = static_cast<std::uint32_t>(row);
    work.resize(chunk + 1, 0.0);
    work[chunk] += came[order[k]].work;
  }
  const std::vector<double> of_stretches = ranks.gathered(work, false);
  SortedRows sorted;
  sorted.work_of_chunks.assign((all + rows_of_a_chunk - 1) / rows_of_a_chunk, 0.0);
  std::size_t row = 0, at = 0;
  for (const std::uint64_t size : sizes) {
    const std::size_t chunks = size == 0 ? 0 : (row + size - 1) / rows_of_a_chunk - row / rows_of_a_chunk + 1;
    for (std::size_t c = 0; c < chunks; ++c) sorted.work_of_chunks[row / rows_of_a_chunk + c] += of_stretches[at++];
    row += size;
  }

  std::vector<std::vector<std::uint32_t>> back(count);
  for (std::size_t r = 0; r < count; ++r) back[r].assign(row_of.begin() + first[r], row_of.begin() + first[r + 1]);
  sorted.row = ranks.exchanged(back).first;  // the stretches follow each other, as this rank's keys do
  return sorted;
}

}  // namespace dem::domain
