#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dem::rig {

/// The names in a text with commas between them: two in "a,b", one, which is empty, in "".
inline std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    names.emplace_back(text.substr(from, to - from));
    from = to + 1;
  }
  return names;
}

}  // namespace dem::rig
