#pragma once

#include <cstdio>
#include <cstdlib>

/// DEM_FN marks a function that host and device (CUDA) code may both call.
#if defined(__CUDACC__)
#define DEM_FN __host__ __device__ __forceinline__
#else
#define DEM_FN inline
#endif

/// DEM_HOT: inlined even where the compiler's size heuristics would stop; only for kernels of the contact loop.
#if defined(__CUDACC__)
#define DEM_HOT __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define DEM_HOT __attribute__((always_inline)) inline
#else
#define DEM_HOT inline
#endif

/// DEM_ASSERT states an invariant of the library itself (never a check of user input, which throws dem::Error).
/// Active unless NDEBUG is defined.
#if defined(NDEBUG) || defined(__CUDA_ARCH__)
#define DEM_ASSERT(condition, text) ((void)0)
#else
#define DEM_ASSERT(condition, text)                                                                                \
  ((condition)                                                                                                     \
       ? (void)0                                                                                                   \
       : (std::fprintf(stderr, "dem: broken invariant '%s' at %s:%d: %s\n", #condition, __FILE__, __LINE__, text), \
          std::abort()))
#endif
