#pragma once

// What ranks do together. Needs no MPI.

#include <dem/core/macros.hpp>
#include <dem/core/text.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace dem::domain {

/// What ranks do together. Each of these begins with the same reduction, in which all ranks say what they do: ranks
/// that do different things meet there, and would else wait for each other for ever.
enum class Call : std::uint32_t { end, decide, prepare, first_forces, run, contacts, state, restore, rest, tiles };

/// What a rank does, in words.
constexpr const char* in_words(Call call) {
  switch (call) {
    case Call::end: return "ends the program";
    case Call::decide: return "agrees on something with the others";
    case Call::prepare: return "prepares to run";
    case Call::first_forces: return "finds the first forces";
    case Call::run: return "runs";
    case Call::contacts: return "looks at contacts";
    case Call::state: return "takes or saves a state";
    case Call::restore: return "loads a state";
    case Call::rest: return "looks for a machine's rest";
    case Call::tiles: return "takes or lays tiles";
  }
  return "does something else";
}

/// Hashes of what a rank knows and is asked, part by part: all ranks must have the same ones.
using CallHashes = std::array<std::uint64_t, 7>;

/// What ranks say of their calls. The largest number of each, of all ranks, tells all of them whether they agree.
class CallNumbers {
 public:
  CallNumbers(Call call, int rank, const CallHashes& hashes);
  std::uint64_t* data() { return numbers_.data(); }
  std::size_t size() const { return numbers_.size(); }

  /// Of the largest numbers: what two ranks do that do different things, in words; empty where all do the same.
  std::string difference() const;
  /// The first of the hashes that is not the same on all ranks; their number where all are.
  std::size_t differing_part() const;

 private:
  static std::pair<Call, std::uint32_t> call_and_rank(std::uint64_t x) {
    return {static_cast<Call>(x >> 32), static_cast<std::uint32_t>(x)};
  }
  void put(std::size_t k, std::uint64_t x) { numbers_[2 * k] = x, numbers_[2 * k + 1] = ~x; }
  std::uint64_t most(std::size_t k) const { return numbers_[2 * k]; }
  std::uint64_t least(std::size_t k) const { return ~numbers_[2 * k + 1]; }

  std::array<std::uint64_t, 2 * (1 + CallHashes{}.size())> numbers_ = {};
};

}  // namespace dem::domain

#if DEM_DEFINES

namespace dem::domain {

DEM_INLINE CallNumbers::CallNumbers(Call call, int rank, const CallHashes& hashes) {
  put(0, std::uint64_t{static_cast<std::uint32_t>(call)} << 32 | static_cast<std::uint32_t>(rank));
  for (std::size_t k = 0; k < hashes.size(); ++k) put(k + 1, hashes[k]);
}

DEM_INLINE std::string CallNumbers::difference() const {
  auto one = call_and_rank(least(0)), other = call_and_rank(most(0));
  if (one.first == other.first) return {};
  if (one.second > other.second) std::swap(one, other);
  return dem::text("ranks are not in the same call: rank {} {}, rank {} {}; make this call on every rank", one.second,
                   in_words(one.first), other.second, in_words(other.first));
}

DEM_INLINE std::size_t CallNumbers::differing_part() const {
  std::size_t k = 0;
  while (k < CallHashes{}.size() && least(k + 1) == most(k + 1)) ++k;
  return k;
}

}  // namespace dem::domain

#endif
