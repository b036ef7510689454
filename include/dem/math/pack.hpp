#pragma once

// A pack is as many doubles as one vector register holds; laws and integrators are written once, as templates over the
// number type T, and run with T = double (machine bodies, tests, device code) or T = Pack (batches of contacts and
// grains). Where the standard library has no <experimental/simd>, a pack is a single double and everything still works.

#include <dem/core/macros.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#if !defined(__CUDACC__) && !defined(DEM_NO_SIMD) && __has_include(<experimental/simd>)
#include <experimental/simd>
#if defined(__clang__) && defined(__AVX512F__)
#include <immintrin.h>
#endif
#if defined(__cpp_lib_experimental_parallel_simd)
#define DEM_HAS_SIMD 1
#endif
#endif

namespace dem {

DEM_HOT double select(bool condition, double yes, double no) { return condition ? yes : no; }
// A NaN in the second argument stays, one in the first is dropped, as packs do: max(T(0), f) keeps what is to be
// reported.
DEM_HOT double min(double a, double b) { return a < b ? a : b; }
DEM_HOT double max(double a, double b) { return a > b ? a : b; }
// The very same functions, so that after `using namespace dem` sqrt(double) is not ambiguous.
using std::cbrt;
using std::exp;
using std::sqrt;
DEM_HOT bool any_of(bool condition) { return condition; }

#if defined(DEM_HAS_SIMD)

namespace stdx = std::experimental;
using Pack = stdx::native_simd<double>;
using PackMask = Pack::mask_type;
inline constexpr int pack_width = static_cast<int>(Pack::size());

/// The mask as bits, lane 0 lowest.
DEM_HOT std::uint32_t bits(const PackMask& mask) {
  if constexpr (requires { mask.__to_bitset(); }) {
    auto result = static_cast<std::uint32_t>(mask.__to_bitset().to_ulong());
#if defined(__AVX512F__) && !defined(__clang__)
    // g++ 12 widens a mask register into memory by storing its one byte, and reads four back: rubbish above lane 7
    // wherever registers are short. By way of a general register it cannot.
    asm("" : "+r"(result));
#endif
    return result;
  } else {
    std::uint32_t result = 0;
    for (int k = 0; k < pack_width; ++k) result |= std::uint32_t(mask[static_cast<std::size_t>(k)]) << k;
    return result;
  }
}

DEM_HOT Pack select(const PackMask& condition, const Pack& yes, const Pack& no) {
#if defined(__clang__) && defined(__AVX512F__)
  // There where() of libstdc++ 12 takes no lane at all.
  if constexpr (sizeof(Pack) == sizeof(__m512d)) {
    return std::bit_cast<Pack>(_mm512_mask_blend_pd(static_cast<__mmask8>(bits(condition)), std::bit_cast<__m512d>(no),
                                                    std::bit_cast<__m512d>(yes)));
  }
#endif
  Pack result = no;
  stdx::where(condition, result) = yes;
  return result;
}
// Not those of the standard library: libstdc++ compiles them as if there were no NaN.
DEM_HOT Pack min(const Pack& a, const Pack& b) {
  using Lanes [[gnu::vector_size(sizeof(Pack))]] = double;
  const auto x = std::bit_cast<Lanes>(a), y = std::bit_cast<Lanes>(b);
  return std::bit_cast<Pack>(x < y ? x : y);
}
DEM_HOT Pack max(const Pack& a, const Pack& b) {
  using Lanes [[gnu::vector_size(sizeof(Pack))]] = double;
  const auto x = std::bit_cast<Lanes>(a), y = std::bit_cast<Lanes>(b);
  return std::bit_cast<Pack>(x > y ? x : y);
}
DEM_HOT Pack sqrt(const Pack& a) { return stdx::sqrt(a); }
DEM_HOT Pack cbrt(const Pack& a) { return stdx::cbrt(a); }
DEM_HOT Pack exp(const Pack& a) { return stdx::exp(a); }
DEM_HOT bool any_of(const PackMask& condition) { return stdx::any_of(condition); }

/// Loads a pack from memory aligned to its size.
DEM_HOT Pack load(const double* p) { return Pack(p, stdx::vector_aligned); }
DEM_HOT Pack load_unaligned(const double* p) { return Pack(p, stdx::element_aligned); }
DEM_HOT void store(const Pack& a, double* p) { a.copy_to(p, stdx::vector_aligned); }
DEM_HOT void store_unaligned(const Pack& a, double* p) { a.copy_to(p, stdx::element_aligned); }

/// A pack whose lane k is f(k).
template <class F>
DEM_HOT Pack generate(F&& f) {
  alignas(64) double lanes[pack_width];
  for (int k = 0; k < pack_width; ++k) lanes[k] = f(k);
  return load(lanes);
}
DEM_HOT double lane(const Pack& a, int k) { return a[static_cast<std::size_t>(k)]; }
DEM_HOT double largest(const Pack& a) { return stdx::hmax(a); }
DEM_HOT double smallest(const Pack& a) { return stdx::hmin(a); }

#else

using Pack = double;
using PackMask = bool;
inline constexpr int pack_width = 1;

DEM_HOT Pack load(const double* p) { return *p; }
DEM_HOT Pack load_unaligned(const double* p) { return *p; }
DEM_HOT void store(Pack a, double* p) { *p = a; }
DEM_HOT void store_unaligned(Pack a, double* p) { *p = a; }
template <class F>
DEM_HOT Pack generate(F&& f) {
  return f(0);
}
DEM_HOT double lane(Pack a, int) { return a; }
DEM_HOT double largest(Pack a) { return a; }
DEM_HOT double smallest(Pack a) { return a; }
DEM_HOT std::uint32_t bits(bool mask) { return mask ? 1u : 0u; }

#endif

/// n rounded up to whole packs.
constexpr int round_up_to_pack(int n) { return (n + pack_width - 1) / pack_width * pack_width; }

}  // namespace dem
