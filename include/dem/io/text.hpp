#pragma once
// UTF-8 text: repaired where it is none, and its widths and padding on a terminal.

#include <cstddef>
#include <string>
#include <string_view>

namespace dem::io {

namespace detail {

/// Bytes of the character at the start of `text`; 0 where that is no UTF-8 (Unicode, table 3-7) or no character of XML
/// (U+FFFE, U+FFFF).
[[nodiscard]] inline std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const auto follows = [&](std::size_t k, unsigned low = 0x80U, unsigned high = 0xBFU) {
    return byte(k) >= low && byte(k) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first < 0xC2U || first > 0xF4U) return 0;
  if (first < 0xE0U) return follows(1) ? 2 : 0;
  if (first < 0xF0U) {
    const unsigned low = first == 0xE0U ? 0xA0U : 0x80U,
                   high = first == 0xEDU ? 0x9FU : 0xBFU;  // no long forms, halves
    const bool is_none = first == 0xEFU && byte(1) == 0xBFU && byte(2) >= 0xBEU;
    return follows(1, low, high) && follows(2) && !is_none ? 3 : 0;
  }
  const unsigned low = first == 0xF0U ? 0x90U : 0x80U, high = first == 0xF4U ? 0x8FU : 0xBFU;
  return follows(1, low, high) && follows(2) && follows(3) ? 4 : 0;
}

}  // namespace detail

/// `text` with U+FFFD, the replacement character, for each byte that belongs to no character: names may come from files
/// and folders, which may hold any bytes, while XML, HTML and SVG may not.
[[nodiscard]] inline std::string to_utf8(std::string_view text) {
  std::string valid;
  valid.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = detail::utf8_length(text);
    valid += length > 0 ? text.substr(0, length) : "\xEF\xBF\xBD";
    text.remove_prefix(length > 0 ? length : 1);
  }
  return valid;
}

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
