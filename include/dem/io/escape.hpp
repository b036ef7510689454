#pragma once
// Escaping of text for XML and HTML.

#include <dem/io/text.hpp>

#include <string>
#include <string_view>

namespace dem::io {

/// `text` made safe both between tags and inside a quoted attribute of XML or HTML. Control characters that XML 1.0
/// forbids are dropped, bytes that are no UTF-8 become U+FFFD; tab and line ends stay.
[[nodiscard]] inline std::string escape_xml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : to_utf8(text)) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: {
        const bool forbidden = static_cast<unsigned char>(c) < 0x20U && c != '\t' && c != '\n' && c != '\r';
        if (!forbidden) escaped += c;
      }
    }
  }
  return escaped;
}

}  // namespace dem::io
