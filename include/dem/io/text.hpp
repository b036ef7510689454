#pragma once
// Widths and padding of UTF-8 text on a terminal.

#include <cstddef>
#include <string>
#include <string_view>

namespace dem::io {

/// Terminal cells that `text` (UTF-8) takes: one per code point. Combining and double-width characters are not told
/// apart, because the texts here are names, numbers and units.
[[nodiscard]] inline int display_width(std::string_view text) {
  int width = 0;
  for (const char c : text) {
    const bool continues_code_point = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
    width += continues_code_point ? 0 : 1;
  }
  return width;
}

/// `text` cut to at most `width` cells, never inside a code point.
[[nodiscard]] inline std::string clip(std::string_view text, int width) {
  int cells = 0;
  std::size_t end = 0;
  while (end < text.size()) {
    std::size_t next = end + 1;
    while (next < text.size() && (static_cast<unsigned char>(text[next]) & 0xC0U) == 0x80U) ++next;
    if (++cells > width) break;
    end = next;
  }
  return std::string(text.substr(0, end));
}

/// `text` with spaces on its right up to `width` cells; longer text stays as it is.
[[nodiscard]] inline std::string pad_right(std::string_view text, int width) {
  const int spaces = width - display_width(text);
  std::string padded(text);
  if (spaces > 0) padded.append(static_cast<std::size_t>(spaces), ' ');
  return padded;
}

/// `text` with spaces on its left up to `width` cells; longer text stays as it is.
[[nodiscard]] inline std::string pad_left(std::string_view text, int width) {
  const int spaces = width - display_width(text);
  std::string padded(spaces > 0 ? static_cast<std::size_t>(spaces) : 0U, ' ');
  return padded.append(text);
}

/// `text` with every control character (line ends, tabs, escapes) turned into a space, so that it stays on one line
/// and cannot steer the terminal.
[[nodiscard]] inline std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20U || byte == 0x7FU) c = ' ';
  }
  return line;
}

}  // namespace dem::io
