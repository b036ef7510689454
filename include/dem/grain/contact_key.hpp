#pragma once

#include <cstddef>
#include <cstdint>

namespace dem::grain {

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
};

}  // namespace dem::grain
