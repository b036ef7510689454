#pragma once

// What dem needs of the compiler's options, refused in words where it is not there.

#if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__
#error \
    "dem finds blow-ups by numbers that are not finite, which -ffast-math and -ffinite-math-only take away: compile without them (dem::native has the safe part of it, -fno-math-errno -fno-trapping-math)"
#endif

#if !defined(__cpp_exceptions)
#error "dem tells mistakes of a set-up by exceptions (dem::Error): compile without -fno-exceptions"
#endif
