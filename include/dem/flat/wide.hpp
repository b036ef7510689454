#pragma once

#include <dem/core/macros.hpp>

#include <cstddef>

namespace dem::flat {

/// A struct from flat memory, 16 bytes at a time: its neighbours in memory are other threads' business, so each load
/// costs what it touches. T is as large as some times 16 bytes and begins at a multiple of that.
template <class T>
DEM_FN T load_wide(const T* from) {
  static_assert(sizeof(T) % 16 == 0);
#if defined(__CUDA_ARCH__)
  T value;
  DEM_UNROLL for (std::size_t k = 0; k < sizeof(T) / 16; ++k) {
    reinterpret_cast<double2*>(&value)[k] = reinterpret_cast<const double2*>(from)[k];
  }
  return value;
#else
  return *from;
#endif
}
template <class T>
DEM_FN void store_wide(T* to, const T& value) {
  static_assert(sizeof(T) % 16 == 0);
#if defined(__CUDA_ARCH__)
  DEM_UNROLL for (std::size_t k = 0; k < sizeof(T) / 16; ++k) {
    reinterpret_cast<double2*>(to)[k] = reinterpret_cast<const double2*>(&value)[k];
  }
#else
  *to = value;
#endif
}

}  // namespace dem::flat
