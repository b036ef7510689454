#pragma once
// What the output goes to: a terminal or not, and how wide it is (POSIX).

#include <cstdio>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

namespace dem::io {

/// Whether `file` is a terminal (and not a pipe, a log file or a memory stream).
[[nodiscard]] inline bool is_terminal(std::FILE* file) {
  const int descriptor = ::fileno(file);
  return descriptor >= 0 && ::isatty(descriptor) == 1;
}

/// Width in cells: asked of the terminal, else of the variable COLUMNS, else 80.
[[nodiscard]] inline int terminal_width(std::FILE* file) {
  winsize size{};
  const int descriptor = ::fileno(file);
  if (descriptor >= 0 && ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  const int width = columns != nullptr ? std::atoi(columns) : 0;
  return width > 0 ? width : 80;
}

}  // namespace dem::io
