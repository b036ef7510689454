#pragma once
// Numbers of results: those that are not known, and how tables and files show them.

#include <dem/core/text.hpp>

#include <cmath>
#include <limits>
#include <string>

namespace dem::rig {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// As a cell of a table; "-" where it is not known.
inline std::string number(double value, const char* format = "{:.2f}") {
  return std::isfinite(value) ? dem::text_of(format, {value}) : "-";
}

/// As a cell of a CSV file; empty where it is not known.
inline std::string cell(double value) { return std::isfinite(value) ? text("{}", value) : std::string(); }

}  // namespace dem::rig
