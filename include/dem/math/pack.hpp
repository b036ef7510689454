#pragma once

// A pack is as many doubles as one vector register holds. Laws and integrators are written once, as templates over the
// number type T, and run with T = double (machine bodies, tests, device code) or T = Pack (batches of contacts and
// grains). Packs stand on the compilers' vector extensions. Elsewhere, and with DEM_NO_SIMD, a pack is a single double
// and everything still works.

#include <dem/core/macros.hpp>
#include <dem/core/pack_widths.hpp>

#include <cmath>
#include <cstdint>

#if !defined(__CUDACC__) && !defined(DEM_NO_SIMD) && (defined(__GNUC__) || defined(__clang__))
#define DEM_HAS_SIMD 1
#include <dem/math/simd_register.hpp>
#endif

namespace dem {

DEM_HOT double select(bool condition, double yes, double no) { return condition ? yes : no; }
// A NaN in the second argument stays, one in the first is dropped, as packs do: max(T(0), f) keeps what is to be
// reported.
DEM_HOT double min(double a, double b) { return a < b ? a : b; }
DEM_HOT double max(double a, double b) { return a > b ? a : b; }
// The very same functions, so that after `using namespace dem` sqrt(double) is not ambiguous.
using std::abs;
using std::cbrt;
using std::exp;
using std::log;
using std::pow;
using std::sqrt;
using std::tanh;
DEM_HOT bool any_of(bool condition) { return condition; }
template <class F>
DEM_HOT double by_lane(double x, F&& f) {
  return f(x);
}

#if defined(DEM_HAS_SIMD)

inline constexpr int pack_width = simd::width;

/// A truth value for each lane.
struct PackMask {
  simd::Mask lanes;

  PackMask() = default;
  DEM_HOT explicit PackMask(simd::Mask m) : lanes(m) {}
  DEM_HOT explicit PackMask(bool all) : lanes(simd::mask_of(all)) {}

  friend DEM_HOT PackMask operator&&(const PackMask& a, const PackMask& b) {
    return PackMask(static_cast<simd::Mask>(a.lanes & b.lanes));
  }
  friend DEM_HOT PackMask operator||(const PackMask& a, const PackMask& b) {
    return PackMask(static_cast<simd::Mask>(a.lanes | b.lanes));
  }
  friend DEM_HOT PackMask operator!(const PackMask& a) { return PackMask(static_cast<simd::Mask>(~a.lanes)); }
};

/// `pack_width` doubles.
struct Pack {
  simd::Register lanes;

  Pack() = default;
  DEM_HOT Pack(double all) : lanes(simd::register_of(all)) {}
  DEM_HOT explicit Pack(simd::Register r) : lanes(r) {}

  DEM_HOT Pack& operator+=(const Pack& b) { return lanes += b.lanes, *this; }
  DEM_HOT Pack& operator-=(const Pack& b) { return lanes -= b.lanes, *this; }
  DEM_HOT Pack& operator*=(const Pack& b) { return lanes *= b.lanes, *this; }
  DEM_HOT Pack& operator/=(const Pack& b) { return lanes /= b.lanes, *this; }

  friend DEM_HOT Pack operator+(const Pack& a, const Pack& b) { return Pack(a.lanes + b.lanes); }
  friend DEM_HOT Pack operator-(const Pack& a, const Pack& b) { return Pack(a.lanes - b.lanes); }
  friend DEM_HOT Pack operator*(const Pack& a, const Pack& b) { return Pack(a.lanes * b.lanes); }
  friend DEM_HOT Pack operator/(const Pack& a, const Pack& b) { return Pack(a.lanes / b.lanes); }
  friend DEM_HOT Pack operator-(const Pack& a) { return Pack(-a.lanes); }
  friend DEM_HOT PackMask operator<(const Pack& a, const Pack& b) { return PackMask(simd::less(a.lanes, b.lanes)); }
  friend DEM_HOT PackMask operator>(const Pack& a, const Pack& b) { return PackMask(simd::less(b.lanes, a.lanes)); }
  friend DEM_HOT PackMask operator<=(const Pack& a, const Pack& b) {
    return PackMask(simd::less_or_equal(a.lanes, b.lanes));
  }
  friend DEM_HOT PackMask operator>=(const Pack& a, const Pack& b) {
    return PackMask(simd::less_or_equal(b.lanes, a.lanes));
  }
  friend DEM_HOT PackMask operator==(const Pack& a, const Pack& b) { return PackMask(simd::equal(a.lanes, b.lanes)); }
  friend DEM_HOT PackMask operator!=(const Pack& a, const Pack& b) { return !(a == b); }
};

/// The mask as bits, lane 0 lowest.
DEM_HOT std::uint32_t bits(const PackMask& mask) { return simd::bits(mask.lanes); }
DEM_HOT bool any_of(const PackMask& mask) { return bits(mask) != 0; }

DEM_HOT Pack select(const PackMask& condition, const Pack& yes, const Pack& no) {
  return Pack(simd::select(condition.lanes, yes.lanes, no.lanes));
}
DEM_HOT Pack min(const Pack& a, const Pack& b) { return Pack(simd::min(a.lanes, b.lanes)); }
DEM_HOT Pack max(const Pack& a, const Pack& b) { return Pack(simd::max(a.lanes, b.lanes)); }
DEM_HOT Pack sqrt(const Pack& a) { return Pack(simd::sqrt(a.lanes)); }

DEM_HOT double lane(const Pack& a, int k) { return a.lanes[k]; }
/// A pack whose lane k is f(k).
template <class F>
DEM_HOT Pack generate(F&& f) {
  simd::Register r = {};
  for (int k = 0; k < pack_width; ++k) r[k] = f(k);
  return Pack(r);
}
/// f of each lane: for functions that packs do not have. Of a double it is f(x).
template <class F>
DEM_HOT Pack by_lane(const Pack& a, F&& f) {
  return generate([&](int k) { return f(lane(a, k)); });
}
DEM_HOT Pack cbrt(const Pack& a) {
  return by_lane(a, [](double x) { return std::cbrt(x); });
}
DEM_HOT Pack exp(const Pack& a) {
  return by_lane(a, [](double x) { return std::exp(x); });
}
DEM_HOT Pack log(const Pack& a) {
  return by_lane(a, [](double x) { return std::log(x); });
}
DEM_HOT Pack tanh(const Pack& a) {
  return by_lane(a, [](double x) { return std::tanh(x); });
}
DEM_HOT Pack pow(const Pack& a, const Pack& exponent) {
  return generate([&](int k) { return std::pow(lane(a, k), lane(exponent, k)); });
}
DEM_HOT Pack abs(const Pack& a) { return max(a, -a); }

/// Loads a pack from memory aligned to its size.
DEM_HOT Pack load(const double* p) { return Pack(*reinterpret_cast<const simd::StoredRegister*>(p)); }
DEM_HOT Pack load_unaligned(const double* p) { return Pack(*reinterpret_cast<const simd::UnalignedRegister*>(p)); }
DEM_HOT void store(const Pack& a, double* p) { *reinterpret_cast<simd::StoredRegister*>(p) = a.lanes; }
DEM_HOT void store_unaligned(const Pack& a, double* p) { *reinterpret_cast<simd::UnalignedRegister*>(p) = a.lanes; }

DEM_HOT double largest(const Pack& a) {
  double result = lane(a, 0);
  for (int k = 1; k < pack_width; ++k) result = max(result, lane(a, k));
  return result;
}
DEM_HOT double smallest(const Pack& a) {
  double result = lane(a, 0);
  for (int k = 1; k < pack_width; ++k) result = min(result, lane(a, k));
  return result;
}

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

#if !defined(__CUDACC__)
// Each source of a program says its width: functions that are the same to the linker must be the same. A world refuses
// to be made of sources that differ.
namespace {
[[maybe_unused]] const bool pack_width_is_told = detail::pack_widths.add(pack_width);
}
#endif

}  // namespace dem
