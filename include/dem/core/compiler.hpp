#pragma once

// What dem needs of the compiler's options, refused in words where it is not there.

#if __cplusplus < 202002L
#error "dem needs C++20: compile with -std=c++20"
#elif defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error \
    "dem finds blow-ups by numbers that are not finite, which -ffast-math and -ffinite-math-only take away: compile without them (dem::native has the safe part of it, -fno-math-errno -fno-trapping-math)"
#elif defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error \
    "dem's results are the same bits in every run, for which sums and quotients have to be as they are written: compile without -funsafe-math-optimizations, -fassociative-math and -freciprocal-math (dem::native has what is safe, -fno-math-errno -fno-trapping-math)"
#elif !defined(__cpp_exceptions)
#error "dem tells mistakes of a set-up by exceptions (dem::Error): compile without -fno-exceptions"
#else
#define DEM_COMPILER_FITS
#endif

// A header that is not there ends the compilation: hundreds of errors of what follows would hide the one above.
#if !defined(DEM_COMPILER_FITS)
#include <the_error_above_says_how_to_compile>
#endif
