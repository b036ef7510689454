#pragma once

#include <dem/grain/chunk.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::grain {

/// What a grain does, as bits. One that sleeps is watched in a step if it or a grain beside it has just fallen asleep
/// or has woken: all of its contacts are evaluated then. `changed`: it did so since contacts were evaluated. `touched`:
/// it sleeps, and grains that are awake, or surfaces, act on it.
inline constexpr std::uint8_t awake = 1, watched = 2, changed = 4, touched = 8;

/// What the grains of all rows do, images too; empty where no grain may sleep.
using Wakefulness = std::span<const std::uint8_t>;

/// Whether a contact is held: both grains sleep, so it bears what it bore.
inline bool is_held(Wakefulness doing, std::size_t i, std::size_t j) { return ((doing[i] | doing[j]) & awake) == 0; }

/// Whether a contact is evaluated: one of the two grains is awake or watched.
inline bool is_evaluated(Wakefulness doing, std::size_t i, std::size_t j) {
  return ((doing[i] | doing[j]) & (awake | watched)) != 0;
}

/// Lists the candidates whose contacts are evaluated. Others keep their histories, and what they bear.
template <class Model>
void list_evaluated(const Chunk<Model>& chunk, std::size_t begin, Wakefulness doing, std::vector<std::uint32_t>& listed,
                    std::vector<std::uint8_t>& evaluates) {
  const std::size_t candidates = chunk.candidate.size();
  listed.resize(candidates);
  evaluates.resize(candidates);
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < candidates; ++k) {
    const std::uint8_t evaluated = is_evaluated(doing, begin + chunk.owner[k], chunk.candidate[k]) ? 1 : 0;
    evaluates[k] = evaluated;
    listed[count] = k;
    count += evaluated;
  }
  listed.resize(count);
}

}  // namespace dem::grain
