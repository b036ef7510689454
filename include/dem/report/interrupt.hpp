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
inline constexpr int interrupt_signals[] = {SIGINT, SIGTERM, SIGHUP};  ///< Ctrl-C, kill, a terminal that is closed
inline struct sigaction interrupt_old[3] = {};

// Only async-signal-safe calls in here.
inline void on_interrupt(int signal) {
  const int saved_errno = errno;
  int none = 0;
  if (!caught_signal.compare_exchange_strong(none, signal)) return;  // a closed terminal may say so several times
  for (const int s : {SIGINT, SIGTERM}) {  // the next one ends the process, even when the run hangs
    struct sigaction now {};
    ::sigaction(s, nullptr, &now);
    if (now.sa_handler == on_interrupt) std::signal(s, SIG_DFL);  // others were to be ignored
  }
  if (!interrupt_announced.load()) {
    errno = saved_errno;
    return;
  }
  struct sigaction ignore = {}, before = {};
  ignore.sa_handler = SIG_IGN;
  ::sigemptyset(&ignore.sa_mask);
  ::sigaction(SIGPIPE, &ignore, &before);  // nobody may be left to read this
  static constexpr std::string_view kText =
      "\ninterrupted: stopping after this step, or where the run can be saved (again: quit at once)\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText.data(), kText.size());
  ::sigaction(SIGPIPE, &before, nullptr);
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

/// The signal that interrupted the run (SIGINT, SIGTERM, SIGHUP), 0 while there was none.
[[nodiscard]] inline int interrupt_signal() noexcept { return detail::caught_signal.load(std::memory_order_relaxed); }

/// Whether Ctrl-C (SIGINT), SIGTERM or SIGHUP came while an InterruptGuard lived. Cheap enough to be asked after every
/// step of a run.
[[nodiscard]] inline bool interrupted() noexcept { return interrupt_signal() != 0; }

/// Forgets an interrupt. InterruptGuard does not do it, so that one Ctrl-C ends a whole sweep of runs.
inline void clear_interrupt() noexcept { detail::caught_signal.store(0); }

/// While it lives, the first Ctrl-C, SIGTERM or SIGHUP (of a terminal that is closed) only makes interrupted() true,
/// and a second Ctrl-C or SIGTERM ends the process at once. Its end restores the handlers that it found. Guards nest
/// (only the outermost acts); they belong to the main thread. Signals that the process was started to ignore, as SIGHUP
/// by nohup, stay ignored.
///
///     InterruptGuard guard;
///     while (world.time() < end && !interrupted()) (void)world.run_for(1e-3);   // look at the report
///     save(world, "state.h5");
class InterruptGuard {
 public:
  enum class Message { Print, Silent };

  /// With Message::Print the first signal writes one line to stderr, if that is there.
  explicit InterruptGuard(Message message = Message::Print) {
    if (detail::interrupt_guards++ > 0) return;
    detail::interrupt_announced.store(message == Message::Print);
    for (int k = 0; k < 3; ++k) {
      ::sigaction(detail::interrupt_signals[k], nullptr, &detail::interrupt_old[k]);
      if (interrupted()) continue;  // already asked to stop: the next Ctrl-C shall end the process
      detail::catch_signal(detail::interrupt_signals[k], detail::interrupt_old[k]);
    }
  }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard() {
    if (--detail::interrupt_guards > 0) return;
    for (int k = 0; k < 3; ++k) ::sigaction(detail::interrupt_signals[k], &detail::interrupt_old[k], nullptr);
  }
};

}  // namespace dem::io
