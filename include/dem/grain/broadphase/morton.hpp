#pragma once

#include <cmath>
#include <cstdint>

/// Cells of nested grids, numbered along a Z-order (Morton) curve: the bits of x, y and z take turns. A cell of level l
/// holds 8 cells of level l - 1, which follow each other on the curve.
namespace dem::broadphase::morton {

inline constexpr unsigned bits = 21;  ///< of a coordinate, at level 0

/// The cell that a coordinate (in cells) is in. Beyond 4e18, and for what is no number, some cell.
inline std::int64_t cell(double u) {
  const double c = std::floor(u);
  if (c >= -4e18 && c <= 4e18) return static_cast<std::int64_t>(c);
  return c > 0.0 ? 4'000'000'000'000'000'000 : -4'000'000'000'000'000'000;
}

inline std::uint64_t spread(std::uint64_t v) {  // abc -> a00b00c00
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

/// The number of a cell of level 0. Coordinates are taken modulo 2^21: cells that far apart share a number, which
/// brings needless candidates but loses none.
inline std::uint64_t code(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t mask = (1u << bits) - 1;
  const auto part = [](std::int64_t c) { return spread(static_cast<std::uint64_t>(c) & mask); };
  return part(x) | part(y) << 1 | part(z) << 2;
}

/// The bits that belong to x in the number of a cell of this level; those of y and z are one and two higher.
inline std::uint64_t axis(unsigned level) {
  return 0x1249249249249249ULL & ((std::uint64_t{1} << 3 * (bits - level)) - 1);
}
/// One step up or down in one interleaved coordinate, which wraps round (arithmetic on the dilated bits alone).
inline std::uint64_t up(std::uint64_t c, std::uint64_t m) { return (((c | ~m) + (m & (0 - m))) & m) | (c & ~m); }
inline std::uint64_t down(std::uint64_t c, std::uint64_t m) { return (((c & m) - (m & (0 - m))) & m) | (c & ~m); }

/// The name of a cell among those of all levels: its number under a leading 1.
inline std::uint64_t key(std::uint64_t code_of_level_0, unsigned level) {
  return code_of_level_0 >> 3 * level | std::uint64_t{1} << 3 * (bits - level);
}

}  // namespace dem::broadphase::morton
