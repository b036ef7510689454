#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/compiler.hpp>
#include <dem/core/text.hpp>

#include <stdexcept>

namespace dem {

/// Thrown when the set-up of a simulation is wrong. The text says what is wrong, the value that was given, the
/// allowed range and what to change. A running step never throws: it returns a StepReport.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws Error with a formatted text.
template <class... Args>
[[noreturn]] void fail(TextFormat<std::type_identity_t<Args>...> format, const Args&... arguments) {
  throw Error(text(format, arguments...));
}

/// Throws unless `value` is finite and greater than zero; returns it.
double require_positive(double value, const char* what, const char* unit);

/// Throws unless `value` is finite and at least zero; returns it.
double require_non_negative(double value, const char* what, const char* unit);

/// Throws unless lowest <= value <= highest; returns it.
double require_within(double value, double lowest, double highest, const char* what);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE double require_positive(double value, const char* what, const char* unit) {
  if (!(value > 0.0) || value > 1e300) {
    fail("{} is {:g} {}, but must be finite and greater than zero", what, value, unit);
  }
  return value;
}

DEM_INLINE double require_non_negative(double value, const char* what, const char* unit) {
  if (!(value >= 0.0) || value > 1e300) {
    fail("{} is {:g} {}, but must be finite and not negative", what, value, unit);
  }
  return value;
}

DEM_INLINE double require_within(double value, double lowest, double highest, const char* what) {
  if (!(value >= lowest && value <= highest)) {
    fail("{} is {:g}, but must lie between {:g} and {:g}", what, value, lowest, highest);
  }
  return value;
}

}  // namespace dem

#endif
