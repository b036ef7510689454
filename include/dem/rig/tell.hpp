#pragma once

#include <dem/core/text.hpp>
#include <dem/report/terminal.hpp>

#include <cstdio>

namespace dem::rig {

/// Says something to stderr or stdout that nobody may be there to read: a terminal that is gone is no error.
template <class... Args>
void tell(std::FILE* out, TextFormat<std::type_identity_t<Args>...> format, const Args&... arguments) {
  io::show_text(out, text(format, arguments...));
}

}  // namespace dem::rig
