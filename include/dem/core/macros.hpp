#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/compiler.hpp>

#include <cstdio>
#include <cstdlib>

/// DEM_FN marks a function that host and device (CUDA) code may both call, as far as what it is given may: laws,
/// integrators, spheres, plain surfaces and the superquadric's function do (tests/cuda). Packs are the host's.
#if defined(__CUDACC__)
#define DEM_FN __host__ __device__ __forceinline__
#else
#define DEM_FN inline
#endif

// Sanitizers put checks into every function: inlining all of them by force would take minutes a file.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DEM_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DEM_SANITIZED 1
#endif
#endif

/// DEM_HOT: inlined even where the compiler's size heuristics would stop; only for kernels of the contact loop.
/// DEM_FLATTEN: all calls in the function are inlined.
#if defined(__CUDACC__)
#define DEM_HOT __host__ __device__ __forceinline__
#define DEM_FLATTEN
#elif defined(__GNUC__) && !defined(DEM_SANITIZED)
#define DEM_HOT __attribute__((always_inline)) inline
#define DEM_FLATTEN [[gnu::flatten]]
#else
#define DEM_HOT inline
#define DEM_FLATTEN
#endif

/// DEM_HOT_HOST: the same of what the host alone calls, as it makes room in lists.
#if defined(__CUDACC__)
#define DEM_HOT_HOST inline
#else
#define DEM_HOT_HOST DEM_HOT
#endif

/// DEM_UNROLL before a loop of few turns: on devices, whose registers have no numbers that a loop could count, it is
/// written out.
#if defined(__CUDA_ARCH__)
#define DEM_UNROLL _Pragma("unroll")
#else
#define DEM_UNROLL
#endif

/// DEM_SETUP: called, never inlined into what runs. For set-up and what goes wrong: it costs a compiler less. Not
/// [[gnu::cold]], which would make callers cold as well, the program of a user among them.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define DEM_SETUP [[gnu::noinline]]
#else
#define DEM_SETUP
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
