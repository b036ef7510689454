#pragma once

#include <dem/grain/chunk.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::grain {

/// What a grain does, as bits.
/// - `awake`: it is moved.
/// - `watched`: all of its contacts are evaluated in this step. It, or a grain beside it, fell asleep or woke, or
///   neighbours were listed anew.
/// - `changed`: it fell asleep or woke since contacts were evaluated.
/// - `touched`: it sleeps, and grains that are awake, or surfaces, act on it.
/// - `recorded`: its contacts are evaluated because energy is counted, and for nothing else.
/// - `counted`: those beside it know that it is awake (Sleepers::awake_beside).
/// - `asked`: a grain beside it is watched.
inline constexpr std::uint8_t awake = 1, watched = 2, changed = 4, touched = 8, recorded = 16, counted = 32, asked = 64;

/// What the grains of all rows do, images too; empty where no grain may sleep.
using Wakefulness = std::span<const std::uint8_t>;

/// Whether a contact sleeps: both grains do, so it bears what it bore.
inline bool sleeps(Wakefulness doing, std::size_t i, std::size_t j) { return ((doing[i] | doing[j]) & awake) == 0; }

/// Whether what a contact bears must be made anew: one of the two grains is awake or watched.
inline bool is_evaluated(Wakefulness doing, std::size_t i, std::size_t j) {
  return ((doing[i] | doing[j]) & (awake | watched)) != 0;
}

/// Calls f(first, stop) for runs of grains that are awake.
template <class F>
void for_each_awake_run(std::size_t begin, std::size_t end, Wakefulness doing, F&& f) {
  if (doing.empty()) return f(begin, end);
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t first = i;
    while (i < end && (doing[i] & awake) != 0) ++i;
    if (first < i) f(first, i);
  }
}

/// Whether so many grains of a chunk are awake or watched, three in four, that it costs less to evaluate all of its
/// candidates than to choose. Contacts between sleepers bear what they bore, as their grains do not move.
inline bool evaluates_all(std::size_t begin, std::size_t end, Wakefulness doing) {
  std::size_t count = 0;
  for (std::size_t row = begin; row < end; ++row) count += (doing[row] & (awake | watched)) != 0 ? 1U : 0U;
  return 4 * count >= 3 * (end - begin);
}

/// Lists the candidates whose contacts are evaluated where not all are. `renews`, by candidate: whether that counts.
/// Contacts that are only recorded keep their histories, and what they bear, as those do that are not evaluated.
/// `awake_beside`, by row: how many grains are awake of those that are its candidates, or whose candidate it is.
template <class Model>
void list_evaluated(const Chunk<Model>& chunk, std::size_t begin, Wakefulness doing,
                    std::span<const std::uint16_t> awake_beside, std::vector<std::uint32_t>& listed,
                    std::vector<std::uint8_t>& renews) {
  constexpr std::uint8_t counts = awake | watched;
  listed.resize(chunk.candidate.size());
  renews.assign(chunk.candidate.size(), 0);
  std::size_t count = 0;
  for (std::size_t row = 0; row < chunk_size; ++row) {
    const std::uint32_t first = chunk.candidate_first[row], end = chunk.candidate_first[row + 1];
    if (first == end || ((doing[begin + row] & (counts | recorded | asked)) == 0 && awake_beside[begin + row] == 0)) {
      continue;
    }
    for (std::uint32_t k = first; k < end; ++k) {
      const auto both = static_cast<std::uint8_t>(doing[begin + row] | doing[chunk.candidate[k]]);
      renews[k] = both & counts;
      listed[count] = k;
      count += (both & (counts | recorded)) != 0 ? 1U : 0U;
    }
  }
  listed.resize(count);
}

}  // namespace dem::grain
