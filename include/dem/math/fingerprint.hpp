#pragma once

#include <dem/math/vector.hpp>

#include <bit>
#include <cstdint>
#include <iterator>
#include <type_traits>

namespace dem {

/// Mixes a word into a hash.
inline void mix(std::uint64_t& hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
  hash ^= hash >> 29;
}

namespace detail {

template <class T>
void mix_numbers(std::uint64_t& hash, const T& x) {
  if constexpr (std::is_same_v<T, double>) {
    mix(hash, std::bit_cast<std::uint64_t>(x));
  } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    mix(hash, static_cast<std::uint64_t>(x));
  } else if constexpr (requires { T::RowsAtCompileTime; }) {
    mix(hash, static_cast<std::uint64_t>(x.size()));
    for (auto k = x.size() * 0; k < x.size(); ++k) mix_numbers(hash, x.data()[k]);
  } else if constexpr (std::is_same_v<T, Vector3<double>>) {
    mix_numbers(hash, x.x), mix_numbers(hash, x.y), mix_numbers(hash, x.z);
  } else {
    mix(hash, std::size(x));
    for (const auto& item : x) mix_numbers(hash, item);
  }
}

}  // namespace detail

/// 64 bits that tell whether numbers are others: doubles, whole numbers, enums, vectors, matrices, and containers of
/// these. Each number is taken by itself, so no byte of padding enters.
template <class... Numbers>
std::uint64_t fingerprint_of(const Numbers&... numbers) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  (detail::mix_numbers(hash, numbers), ...);
  return hash;
}

}  // namespace dem
