#pragma once

// A register of doubles of the processor that the program is compiled for, and what packs need of it. Arithmetic is the
// compilers' vector extension; intrinsics stand only where that has no word for an instruction.

#include <dem/core/macros.hpp>

#include <cstdint>

#if defined(__AVX512F__) || defined(__AVX__) || defined(__SSE2__)
#include <immintrin.h>
#endif

namespace dem::simd {

#if defined(__AVX512F__)
inline constexpr int width = 8;
#elif defined(__AVX__)
inline constexpr int width = 4;
#else
inline constexpr int width = 2;
#endif

typedef double Register __attribute__((vector_size(width * sizeof(double))));
/// The same as it lies in an array of doubles, aligned to its size or not.
typedef double StoredRegister __attribute__((vector_size(width * sizeof(double)), may_alias));
typedef double UnalignedRegister __attribute__((vector_size(width * sizeof(double)), may_alias, aligned(8)));

DEM_HOT Register register_of(double all) { return all - Register{}; }

#if defined(__AVX512F__)

/// A bit for each lane.
using Mask = std::uint8_t;

DEM_HOT Mask mask_of(bool all) { return all ? Mask(0xff) : Mask(0); }
DEM_HOT Mask less(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OS); }
DEM_HOT Mask less_or_equal(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OS); }
DEM_HOT Mask equal(Register a, Register b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
DEM_HOT Register select(Mask m, Register yes, Register no) { return _mm512_mask_blend_pd(m, no, yes); }
// With a mask of all lanes, which makes the same instruction. Without one g++ 12 warns wherever these are inlined: its
// own header leaves the lanes that no mask selects uninitialised.
DEM_HOT Register sqrt(Register a) { return _mm512_mask_sqrt_pd(a, Mask(0xff), a); }
DEM_HOT Register min(Register a, Register b) { return _mm512_mask_min_pd(a, Mask(0xff), a, b); }
DEM_HOT Register max(Register a, Register b) { return _mm512_mask_max_pd(a, Mask(0xff), a, b); }
DEM_HOT std::uint32_t bits(Mask m) {
  std::uint32_t result = m;
#if !defined(__clang__)
  // g++ 12 widens a mask register into memory by storing its one byte, and reads four back: rubbish above lane 7
  // wherever registers are short. By way of a general register it cannot.
  asm("" : "+r"(result));
#endif
  return result;
}

#else

/// All bits of a lane or none.
using Mask = std::int64_t __attribute__((vector_size(width * sizeof(double))));

DEM_HOT Mask mask_of(bool all) { return Mask{} - std::int64_t{all}; }
DEM_HOT Mask less(Register a, Register b) { return a < b; }
DEM_HOT Mask less_or_equal(Register a, Register b) { return a <= b; }
DEM_HOT Mask equal(Register a, Register b) { return a == b; }
DEM_HOT Register select(Mask m, Register yes, Register no) { return m ? yes : no; }
DEM_HOT Register min(Register a, Register b) { return a < b ? a : b; }
DEM_HOT Register max(Register a, Register b) { return a > b ? a : b; }

#if defined(__AVX__)
DEM_HOT Register sqrt(Register a) { return _mm256_sqrt_pd(a); }
DEM_HOT std::uint32_t bits(Mask m) { return static_cast<std::uint32_t>(_mm256_movemask_pd((__m256d)m)); }
#elif defined(__SSE2__)
DEM_HOT Register sqrt(Register a) { return _mm_sqrt_pd(a); }
DEM_HOT std::uint32_t bits(Mask m) { return static_cast<std::uint32_t>(_mm_movemask_pd((__m128d)m)); }
#else
DEM_HOT Register sqrt(Register a) {
  for (int k = 0; k < width; ++k) a[k] = __builtin_sqrt(a[k]);
  return a;
}
DEM_HOT std::uint32_t bits(Mask m) {
  std::uint32_t result = 0;
  for (int k = 0; k < width; ++k) result |= static_cast<std::uint32_t>(m[k] & 1) << k;
  return result;
}
#endif

#endif

}  // namespace dem::simd
