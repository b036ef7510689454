#pragma once
// Finds three.js, the library that draws the replay of a report.

#include <dem/core/error.hpp>

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

namespace dem::report {

/// three.js as a script that may stand in a page, or why there is none. Exactly one of the two is empty.
struct ThreeJs {
  std::string script = {};
  std::string missing = {};
};

namespace detail {

/// The bytes of a file; empty when it cannot be read.
[[nodiscard]] inline std::string bytes_of(const std::string& path) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "rb"), close);
  std::string bytes;
  std::array<char, 65536> piece = {};
  while (file) {
    const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get());
    if (count == 0) break;
    bytes.append(piece.data(), count);
  }
  return bytes;
}

/// The file that is asked for: by the option, or else by the variable DEM_THREE_JS; empty if by neither.
[[nodiscard]] inline std::string asked_three_js(const std::string& option) {
  const char* variable = std::getenv("DEM_THREE_JS");
  return !option.empty() || variable == nullptr ? option : std::string(variable);
}

/// A build as one script makes the name THREE known to the page; one as a module does not.
[[nodiscard]] inline bool is_three_js(std::string_view text) {
  return text.find("THREE={}") != std::string_view::npos || text.find("THREE = {}") != std::string_view::npos;
}

}  // namespace detail

/// Throws dem::Error when a file is asked for, by the option or by the variable DEM_THREE_JS, that cannot be read or
/// is not three.js: better before a run than after it.
inline void check_three_js(const std::string& option = {}) {
  const std::string path = detail::asked_three_js(option);
  if (path.empty()) return;
  const std::string text = detail::bytes_of(path);
  if (text.empty()) {
    fail(
        "three.js cannot be read from '{}'; name a file that is there (ReplayOptions::three_js or the variable "
        "DEM_THREE_JS), or none",
        path);
  }
  if (!detail::is_three_js(text)) {
    fail("'{}' is not three.js as one script; take its three.min.js, not its module", path);
  }
}

/// three.js from the file that is asked for, by the option or by the variable DEM_THREE_JS, or else from where Debian's
/// package libjs-three has it.
[[nodiscard]] inline ThreeJs find_three_js(const std::string& option = {}) {
  const std::string asked = detail::asked_three_js(option);
  const std::array<std::string, 3> places = {"/usr/share/javascript/three/three.min.js",
                                             "/usr/share/javascript/three/build/three.min.js",
                                             "/usr/local/share/javascript/three/three.min.js"};
  const std::string* const begin = asked.empty() ? places.data() : &asked;
  for (const std::string* path = begin; path != begin + (asked.empty() ? places.size() : 1); ++path) {
    std::string text = detail::bytes_of(*path);
    if (!detail::is_three_js(text)) continue;
    // Inside a page a script ends at the first "</script", even within a string.
    for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos; at += 2) text.insert(at + 1, "\\");
    return {.script = "/* three.js. Copyright three.js authors. SPDX-License-Identifier: MIT */\n" + text,
            .missing = {}};
  }
  return {.script = {},
          .missing =
              "The replay needs three.js. Install libjs-three (on Debian: apt-get install libjs-three) and make "
              "this report again, or name a file three.min.js in the variable DEM_THREE_JS."};
}

}  // namespace dem::report
