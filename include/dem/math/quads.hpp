#pragma once

#include <dem/math/pack.hpp>

#include <array>
#include <cstddef>
#include <cstring>

namespace dem {

/// Records of four doubles, one for each lane of a pack. Loaded as they lie in memory, combined, and only then turned
/// into four packs: in registers, for a detour through memory stalls on loads that are wider than the stores before.
struct Quads {
  std::array<Pack, 4> rows;
};

#if defined(DEM_HAS_SIMD)
namespace quads_detail {

using Register = simd::Register;
inline constexpr int width = pack_width;

/// Two quads behind each other, as a pack of 8.
template <class R>
DEM_HOT R two(const double* low, const double* high) {
  using Quad = double __attribute__((vector_size(4 * sizeof(double))));
  Quad a, b;
  std::memcpy(&a, low, sizeof(a));
  std::memcpy(&b, high, sizeof(b));
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Exchanges lanes that are Step apart between two rows.
template <int Step, int... Lane>
DEM_HOT void exchange(Pack& a, Pack& b, std::integer_sequence<int, Lane...>) {
  const Register x = a.lanes, y = b.lanes;
  a = Pack(Register(__builtin_shufflevector(x, y, ((Lane & Step) ? width + Lane - Step : Lane)...)));
  b = Pack(Register(__builtin_shufflevector(x, y, ((Lane & Step) ? width + Lane : Lane + Step)...)));
}
template <int Step>
DEM_HOT void exchange(Pack& a, Pack& b) {
  exchange<Step>(a, b, std::make_integer_sequence<int, width>());
}

}  // namespace quads_detail
#endif

/// address(lane) points to the record of a lane.
template <class Address>
DEM_HOT Quads load_quads(Address&& address) {
  Quads q;
  for (int k = 0; k < 4; ++k) {
    Pack& row = q.rows[static_cast<std::size_t>(k)];
#if defined(DEM_HAS_SIMD)
    if constexpr (pack_width == 8) {
      row = Pack(quads_detail::two<simd::Register>(address(k), address(k + 4)));
      continue;
    } else if constexpr (pack_width == 4) {
      row = load_unaligned(address(k));
      continue;
    }
#endif
    row = generate([&](int lane) { return address(lane)[k]; });
  }
  return q;
}

/// b - a in the first three numbers of the records and b + a in the last.
DEM_HOT Quads difference_and_sum(const Quads& b, const Quads& a) {
  alignas(64) constexpr double share[8] = {-1, -1, -1, 1, -1, -1, -1, 1};
  Quads q;
  for (std::size_t k = 0; k < 4; ++k) {
    const Pack factor = pack_width == 4 || pack_width == 8 ? load(share) : Pack(share[k]);
    q.rows[k] = b.rows[k] + factor * a.rows[k];
  }
  return q;
}

/// The four numbers of the records, a pack each.
DEM_HOT std::array<Pack, 4> packs(Quads q) {
#if defined(DEM_HAS_SIMD)
  if constexpr (pack_width == 4 || pack_width == 8) {
    quads_detail::exchange<1>(q.rows[0], q.rows[1]);
    quads_detail::exchange<1>(q.rows[2], q.rows[3]);
    quads_detail::exchange<2>(q.rows[0], q.rows[2]);
    quads_detail::exchange<2>(q.rows[1], q.rows[3]);
  }
#endif
  return q.rows;
}

}  // namespace dem
