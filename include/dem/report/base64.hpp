#pragma once
// Base64, for pictures inside HTML.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace dem::io {

/// RFC 4648 base64 of `bytes`, with padding and without line breaks.
[[nodiscard]] inline std::string base64(std::string_view bytes) {
  static constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();  // n bytes of a group fill n + 1 characters
      text += padding ? '=' : kAlphabet[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

}  // namespace dem::io
