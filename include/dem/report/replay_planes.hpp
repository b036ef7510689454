#pragma once
// Frames as differences to the frame before, each kind of byte for itself, as a compressor likes them.

#include <dem/report/quantise.hpp>
#include <dem/report/replay_data.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::report {

/// A grain of a frame, quantised.
struct PackedGrain {
  std::array<std::uint16_t, 3> position = {};  ///< pack_coordinate in the box of the run
  std::uint32_t rotation = 0x1ff7fdffU;        ///< pack_rotation; none at all to begin with
  std::array<std::uint8_t, 2> scalars = {};    ///< pack_scalar of speed and force
  bool present = false;
  bool asleep = false;

  bool operator==(const PackedGrain&) const = default;
};

/// The bytes of all frames, in 13 planes. Plane 0 has a byte for each grain and frame: what has changed since the grain
/// was last there. It is a sum: 1 position, 2 rotation, 4 scalars, 8 not there, 16 asleep. The other planes hold only
/// what has changed, as differences with their sign in the lowest bit:
///   1 to 6   low and high bytes of x, y and z
///   7 to 9   low bytes of the three components of the rotation
///   10       what is left of these: the change of the two highest bits, then two bits of each
///   11, 12   speed, force
/// Compressed, a grain at rest costs a bit a frame, and less among others at rest.
struct ReplayPlanes {
  std::array<std::string, 13> bytes = {};
};

namespace detail {

/// A difference with its sign in the lowest bit, of `bits` bits around which it wraps.
[[nodiscard]] inline std::uint32_t fold(std::uint32_t now, std::uint32_t before, unsigned bits) {
  const std::uint32_t range = std::uint32_t{1} << bits, d = (now - before) & (range - 1);
  return d < range / 2 ? 2 * d : 2 * (range - d) - 1;
}
/// What follows from the value before and the folded difference.
[[nodiscard]] inline std::uint32_t unfold(std::uint32_t folded, std::uint32_t before, unsigned bits) {
  const std::uint32_t half = folded / 2, d = folded % 2 == 0 ? half : ~half;
  return (before + d) & ((std::uint32_t{1} << bits) - 1);
}

[[nodiscard]] inline char byte(std::uint32_t value) { return static_cast<char>(value & 0xffU); }

}  // namespace detail

/// Appends a frame: `before` holds each grain as it was last there, and is brought up to date.
inline void add_frame(ReplayPlanes& planes, std::span<const PackedGrain> now, std::vector<PackedGrain>& before) {
  using detail::byte, detail::fold;
  auto& plane = planes.bytes;
  for (std::size_t g = 0; g < now.size(); ++g) {
    const PackedGrain &a = now[g], &b = before[g];
    if (!a.present) {
      plane[0] += byte(8);
      continue;
    }
    const bool moved = a.position != b.position, turned = a.rotation != b.rotation, other = a.scalars != b.scalars;
    plane[0] += byte((moved ? 1U : 0U) + (turned ? 2U : 0U) + (other ? 4U : 0U) + (a.asleep ? 16U : 0U));
    for (std::size_t k = 0; moved && k < 3; ++k) {
      const std::uint32_t d = fold(a.position[k], b.position[k], 16);
      plane[1 + 2 * k] += byte(d);
      plane[2 + 2 * k] += byte(d >> 8U);
    }
    if (turned) {
      std::uint32_t rest = (a.rotation ^ b.rotation) >> 30U;
      for (unsigned k = 0; k < 3; ++k) {
        const std::uint32_t d = fold(a.rotation >> 10 * k & 1023U, b.rotation >> 10 * k & 1023U, 10);
        plane[7 + k] += byte(d);
        rest |= d >> 8U << (2 + 2 * k);
      }
      plane[10] += byte(rest);
    }
    for (std::size_t k = 0; other && k < 2; ++k) plane[11 + k] += byte(fold(a.scalars[k], b.scalars[k], 8));
    before[g] = a;
  }
}

/// Reads back what add_frame has written, frame after frame: what the page does, for tests.
class PlaneReader {
 public:
  PlaneReader(ReplayPlanes planes, std::size_t grains) : planes_(std::move(planes)), grains_(grains) {}

  /// The next frame; grains that are not there keep what they last were.
  const std::vector<PackedGrain>& next() {
    using detail::unfold;
    for (PackedGrain& g : grains_) {
      const std::uint32_t what = take(0);
      g.present = what != 8;
      if (!g.present) continue;
      g.asleep = (what & 16U) != 0;
      for (std::size_t k = 0; (what & 1U) != 0 && k < 3; ++k) {
        const std::uint32_t low = take(1 + 2 * k), high = take(2 + 2 * k);
        g.position[k] = static_cast<std::uint16_t>(unfold(low | high << 8U, g.position[k], 16));
      }
      if ((what & 2U) != 0) {
        const std::uint32_t rest = take(10);
        std::uint32_t rotation = ((g.rotation >> 30U) ^ (rest & 3U)) << 30U;
        for (unsigned k = 0; k < 3; ++k) {
          const std::uint32_t d = take(7 + k) | (rest >> (2 + 2 * k) & 3U) << 8U;
          rotation |= unfold(d, g.rotation >> 10 * k & 1023U, 10) << 10 * k;
        }
        g.rotation = rotation;
      }
      for (std::size_t k = 0; (what & 4U) != 0 && k < 2; ++k) {
        g.scalars[k] = static_cast<std::uint8_t>(unfold(take(11 + k), g.scalars[k], 8));
      }
    }
    return grains_;
  }

 private:
  std::uint32_t take(std::size_t plane) { return static_cast<unsigned char>(planes_.bytes[plane].at(at_[plane]++)); }

  ReplayPlanes planes_;
  std::array<std::size_t, 13> at_ = {};
  std::vector<PackedGrain> grains_;
};

}  // namespace dem::report
