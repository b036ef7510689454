#pragma once

#include <dem/core/macros.hpp>

#include <bit>
#include <cstdint>

namespace dem::flat {

/// How many bits of a word are set.
DEM_FN std::uint32_t count_bits(std::uint64_t word) {
#if defined(__CUDA_ARCH__)
  return static_cast<std::uint32_t>(__popcll(word));
#else
  return static_cast<std::uint32_t>(std::popcount(word));
#endif
}

/// The number of the lowest bit that is set; there must be one.
DEM_FN int lowest_bit(std::uint64_t word) {
#if defined(__CUDA_ARCH__)
  return __ffsll(static_cast<long long>(word)) - 1;
#else
  return std::countr_zero(word);
#endif
}

/// Bits below number `bit`.
DEM_FN std::uint64_t below(int bit) { return (std::uint64_t{1} << bit) - 1; }

}  // namespace dem::flat
