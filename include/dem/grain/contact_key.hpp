#pragma once

#include <cstddef>
#include <cstdint>

// Keys say who touches whom, and where. Contacts are found in the order of their keys. Lists of contacts, which serve
// every kind of key, and saved states hold the numbers.

namespace dem::grain {

/// Key of a contact of two grains: candidate of the chunk, feature of the pair.
struct PairKey {
  std::uint64_t value = 0;

  static constexpr PairKey make(std::size_t candidate, std::uint32_t feature) {
    return {std::uint64_t{candidate} << 32 | feature};
  }
  constexpr std::size_t candidate() const { return value >> 32; }
  constexpr std::uint32_t feature() const { return static_cast<std::uint32_t>(value); }
};

/// Key of a surface contact: surface, grain in the chunk, sample point of the grain, feature of the surface.
struct SurfaceKey {
  std::uint64_t value = 0;

  static constexpr SurfaceKey make(std::size_t surface, std::size_t local, std::uint32_t sample,
                                   std::uint32_t feature) {
    return {std::uint64_t{surface} << 48 | std::uint64_t{local} << 40 | std::uint64_t{sample} << 28 | feature};
  }
  static constexpr SurfaceKey at_place(std::size_t surface, std::size_t local, std::uint64_t place) {
    return {std::uint64_t{surface} << 48 | std::uint64_t{local} << 40 | place};
  }
  constexpr std::size_t surface() const { return value >> 48; }
  constexpr std::size_t local() const { return value >> 40 & 0xff; }
  constexpr std::uint32_t sample() const { return value >> 28 & 0xfff; }
  constexpr SurfaceKey with_local(std::size_t local) const {
    return {(value & ~(std::uint64_t{0xff} << 40)) | std::uint64_t{local} << 40};
  }
  /// Sample point and feature: where a grain and a surface touch, whichever they are.
  constexpr std::uint64_t place() const { return value & ((std::uint64_t{1} << 40) - 1); }
  /// In two halves, as histories carry it.
  constexpr std::uint32_t upper() const { return static_cast<std::uint32_t>(value >> 32); }
  constexpr std::uint32_t lower() const { return static_cast<std::uint32_t>(value); }
  static constexpr SurfaceKey whole(std::uint32_t upper, std::uint32_t lower) {
    return {std::uint64_t{upper} << 32 | lower};
  }
};

}  // namespace dem::grain
