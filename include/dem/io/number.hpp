#pragma once
// Numbers as text for people: rounded, and recognised again for alignment.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace dem::io {

/// `value` with `digits` significant digits, without needless zeros, and without an exponent from 1e-4 up to 1e7:
/// 12345.6 -> "12346", 0.25 -> "0.25", 2.5e9 -> "2.5e+09". What is not a number is "nan", whatever its sign.
[[nodiscard]] inline std::string format_number(double value, int digits = 4) {
  if (std::isnan(value)) return "nan";
  const std::string text = fmt::format("{:.{}g}", value, std::max(1, digits));
  const bool exponent = text.find('e') != std::string::npos;
  const double size = std::abs(value);
  return exponent && size >= 1 && size < 1e7 ? fmt::format("{:.0f}", value) : text;
}

/// Whether `text` reads as a number, perhaps with a percent sign or a tolerance: "-1.2e+05", "43 %", "31 ± 2", "nan".
[[nodiscard]] inline bool looks_numeric(std::string_view text) {
  if (text == "nan" || text == "inf" || text == "-inf") return true;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto belongs = [&](char c) {
    return is_digit(c) || std::string_view("+-.eE% \xC2\xB1").find(c) != std::string_view::npos;  // C2 B1: ±
  };
  return std::any_of(text.begin(), text.end(), is_digit) && std::all_of(text.begin(), text.end(), belongs) &&
         text.front() != 'e' && text.front() != 'E';
}

}  // namespace dem::io
