#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace dem::rig {

/// Prints to stderr or stdout what nobody may be there to read: a terminal that is gone is no error.
template <class... Args>
void tell(std::FILE* out, fmt::format_string<Args...> text, Args&&... args) {
  const std::string line = fmt::format(text, std::forward<Args>(args)...);
  std::fwrite(line.data(), 1, line.size(), out);
  std::fflush(out);
}

}  // namespace dem::rig
