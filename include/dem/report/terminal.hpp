#pragma once
// What a person looks at: a terminal or not, how wide it is, and writing to it as long as it is there (POSIX).

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>
#if __has_include(<stdio_ext.h>)
#include <stdio_ext.h>
#endif

namespace dem::io {

/// Whether `file` is a terminal (and not a pipe, a log file or a memory stream).
[[nodiscard]] inline bool is_terminal(std::FILE* file) {
  const int descriptor = file != nullptr ? ::fileno(file) : -1;
  return descriptor >= 0 && ::isatty(descriptor) == 1;
}

/// Width in cells: asked of the terminal, else of the variable COLUMNS, else 80.
[[nodiscard]] inline int terminal_width(std::FILE* file) {
  winsize size{};
  const int descriptor = file != nullptr ? ::fileno(file) : -1;
  if (descriptor >= 0 && ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  const char* columns = std::getenv("COLUMNS");
  const int width = columns != nullptr ? std::atoi(columns) : 0;
  return width > 0 ? width : 80;
}

namespace detail {

/// While it lives, SIGPIPE does not reach this thread; one that came meanwhile is gone afterwards.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    sigset_t waiting;
    ::sigpending(&waiting);
    was_waiting_ = ::sigismember(&waiting, SIGPIPE) == 1;
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;
  ~NoPipeSignal() {
    const std::timespec at_once{};
    while (!was_waiting_ && ::sigtimedwait(&pipe_, nullptr, &at_once) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_, before_;
  bool was_waiting_ = false;
};

}  // namespace detail

/// Writes a text that only informs, to a stream that may be gone: a terminal that was closed, a pipe that nobody reads
/// any more, a full disk. Returns false if it could not be written; that is no error, and raises no SIGPIPE. Nothing is
/// written to a null pointer.
inline bool show_text(std::FILE* out, std::string_view text) noexcept {
  if (out == nullptr) return false;
  const detail::NoPipeSignal guard;
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0;
#if __has_include(<stdio_ext.h>)
  if (!written) ::__fpurge(out);  // else the end of the program would try again, without the guard
#endif
  return written;
}

}  // namespace dem::io
