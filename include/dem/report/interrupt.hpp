#pragma once
// Ctrl-C that lets a run finish its step and save its data (POSIX).

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

#include <unistd.h>

namespace dem::io {

namespace detail {

static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may touch lock-free atomics only");
inline std::atomic<int> caught_signal{0};
inline std::atomic<bool> interrupt_announced{true};
inline int interrupt_guards = 0;
inline struct sigaction interrupt_old_int {};
inline struct sigaction interrupt_old_term {};

// Only async-signal-safe calls in here.
inline void on_interrupt(int signal) {
  caught_signal.store(signal);
  std::signal(SIGINT, SIG_DFL);  // the next one ends the process, even when the run hangs
  std::signal(SIGTERM, SIG_DFL);
  if (!interrupt_announced.load()) return;
  const int saved_errno = errno;
  static constexpr std::string_view kText = "\ninterrupted: stopping after this step (again: quit at once)\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText.data(), kText.size());
  errno = saved_errno;
}

inline void catch_signal(int signal, const struct sigaction& old) {
  // A parent that made us ignore the signal (a job in the background) wants it ignored.
  if ((old.sa_flags & SA_SIGINFO) == 0 && old.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;  // a write that is under way goes on
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

}  // namespace detail

/// The signal that interrupted the run (SIGINT, SIGTERM), 0 while there was none.
[[nodiscard]] inline int interrupt_signal() noexcept { return detail::caught_signal.load(std::memory_order_relaxed); }

/// Whether Ctrl-C (SIGINT) or SIGTERM came while an InterruptGuard lived. Cheap enough to ask at every step.
[[nodiscard]] inline bool interrupted() noexcept { return interrupt_signal() != 0; }

/// Forgets an interrupt. InterruptGuard does not do it, so that one Ctrl-C ends a whole sweep of runs.
inline void clear_interrupt() noexcept { detail::caught_signal.store(0); }

/// While it lives, the first Ctrl-C or SIGTERM only makes interrupted() true, and the second one ends the process at
/// once. Its end restores the handlers that it found. Guards nest (only the outermost acts); they belong to the main
/// thread.
///
///     InterruptGuard guard;
///     while (t < t_end && !interrupted()) { ... }
///     save();
class InterruptGuard {
 public:
  enum class Message { Print, Silent };

  /// With Message::Print the first signal writes one line to stderr.
  explicit InterruptGuard(Message message = Message::Print) {
    if (detail::interrupt_guards++ > 0) return;
    detail::interrupt_announced.store(message == Message::Print);
    ::sigaction(SIGINT, nullptr, &detail::interrupt_old_int);
    ::sigaction(SIGTERM, nullptr, &detail::interrupt_old_term);
    if (interrupted()) return;  // already asked to stop: the next Ctrl-C shall end the process
    detail::catch_signal(SIGINT, detail::interrupt_old_int);
    detail::catch_signal(SIGTERM, detail::interrupt_old_term);
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard() {
    if (--detail::interrupt_guards > 0) return;
    ::sigaction(SIGINT, &detail::interrupt_old_int, nullptr);
    ::sigaction(SIGTERM, &detail::interrupt_old_term, nullptr);
  }
};

}  // namespace dem::io
