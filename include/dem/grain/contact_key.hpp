#pragma once

#include <cstddef>
#include <cstdint>

namespace dem::grain {

/// Key of a contact of two grains: candidate of the chunk, feature of the pair; contacts are found in this order.
struct PairKey {
  static constexpr std::uint64_t make(std::size_t candidate, std::uint32_t feature) {
    return std::uint64_t{candidate} << 32 | feature;
  }
  static constexpr std::size_t candidate(std::uint64_t key) { return key >> 32; }
  static constexpr std::uint32_t feature(std::uint64_t key) { return static_cast<std::uint32_t>(key); }
};

/// Key of a surface contact: surface, grain in the chunk, sample point of the grain, feature of the surface; contacts
/// are found in this order.
struct SurfaceKey {
  static constexpr std::uint64_t make(std::size_t surface, std::size_t local, std::uint32_t sample,
                                      std::uint32_t feature) {
    return std::uint64_t{surface} << 48 | std::uint64_t{local} << 40 | std::uint64_t{sample} << 28 | feature;
  }
  static constexpr std::size_t surface(std::uint64_t key) { return key >> 48; }
  static constexpr std::size_t local(std::uint64_t key) { return key >> 40 & 0xff; }
  static constexpr std::uint32_t sample(std::uint64_t key) { return key >> 28 & 0xfff; }
  static constexpr std::uint64_t with_local(std::uint64_t key, std::size_t local) {
    return (key & ~(std::uint64_t{0xff} << 40)) | std::uint64_t{local} << 40;
  }
  /// Sample point and feature: where a grain and a surface touch, whichever they are.
  static constexpr std::uint64_t place(std::uint64_t key) { return key & ((std::uint64_t{1} << 40) - 1); }
  static constexpr std::uint64_t at_place(std::size_t surface, std::size_t local, std::uint64_t place) {
    return std::uint64_t{surface} << 48 | std::uint64_t{local} << 40 | place;
  }
  /// A key in two halves, as histories carry it.
  static constexpr std::uint32_t upper(std::uint64_t key) { return static_cast<std::uint32_t>(key >> 32); }
  static constexpr std::uint32_t lower(std::uint64_t key) { return static_cast<std::uint32_t>(key); }
  static constexpr std::uint64_t whole(std::uint32_t upper, std::uint32_t lower) {
    return std::uint64_t{upper} << 32 | lower;
  }
};

}  // namespace dem::grain
