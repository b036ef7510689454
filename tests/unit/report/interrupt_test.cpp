#include "catch.hpp"

#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/report/interrupt.hpp>

#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

using dem::io::clear_interrupt;
using dem::io::interrupt_signal;
using dem::io::interrupted;
using dem::io::InterruptGuard;

namespace {

constexpr auto kSilent = InterruptGuard::Message::Silent;

auto handler_of(int signal) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler;
}

/// The signal that ends a process which does `actions`; 0 when it ends by itself.
template <class Actions>
int signal_that_ends(Actions&& actions) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    actions();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

TEST_CASE("the first Ctrl-C sets the flag") {
  clear_interrupt();
  {
    const InterruptGuard guard(kSilent);
    CHECK(!interrupted());
    std::raise(SIGINT);
    CHECK(interrupted());
    CHECK(interrupt_signal() == SIGINT);
    CHECK(handler_of(SIGINT) == SIG_DFL);
    CHECK(handler_of(SIGTERM) == SIG_DFL);
  }
  CHECK(interrupted());  // so that a sweep of runs ends, too
  clear_interrupt();
  CHECK(!interrupted());
}

TEST_CASE("SIGTERM is an interrupt as well") {
  clear_interrupt();
  const InterruptGuard guard(kSilent);
  std::raise(SIGTERM);
  CHECK(interrupt_signal() == SIGTERM);
  clear_interrupt();
}

TEST_CASE("the second Ctrl-C ends the process") {
  clear_interrupt();
  CHECK(signal_that_ends([] {
          const InterruptGuard guard(kSilent);
          std::raise(SIGINT);
        }) == 0);
  CHECK(signal_that_ends([] {
          const InterruptGuard guard(kSilent);
          std::raise(SIGINT);
          std::raise(SIGINT);
        }) == SIGINT);
  CHECK(signal_that_ends([] {
          const InterruptGuard guard(kSilent);
          std::raise(SIGINT);
          std::raise(SIGTERM);
        }) == SIGTERM);
  CHECK(signal_that_ends([] {
          {
            const InterruptGuard first(kSilent), nested(kSilent);
            std::raise(SIGINT);
          }
          const InterruptGuard next(kSilent);  // nobody has cleared the flag: this one must not catch again
          std::raise(SIGINT);
        }) == SIGINT);
}

TEST_CASE("a closed terminal is an interrupt, however often it says so, and nobody has to read the message") {
  clear_interrupt();
  CHECK(signal_that_ends([] {
          std::signal(SIGHUP, SIG_DFL);
          int ends[2];
          if (::pipe(ends) != 0 || ::dup2(ends[1], STDERR_FILENO) < 0) ::_exit(1);
          ::close(ends[0]);
          ::close(ends[1]);
          const InterruptGuard guard;  // its message goes to a pipe that nobody reads: no SIGPIPE either
          std::raise(SIGHUP);
          std::raise(SIGHUP);
          if (interrupt_signal() != SIGHUP) std::raise(SIGKILL);
        }) == 0);
  CHECK(signal_that_ends([] {
          std::signal(SIGHUP, SIG_IGN);  // as nohup does
          const InterruptGuard guard(kSilent);
          std::raise(SIGHUP);
          if (interrupted()) std::raise(SIGKILL);
          std::raise(SIGINT);
          std::raise(SIGHUP);  // ignored as before
        }) == 0);
  CHECK(signal_that_ends([] {
          std::signal(SIGTERM, SIG_IGN);
          const InterruptGuard guard(kSilent);
          std::raise(SIGINT);
          std::raise(SIGTERM);  // ignored as before
        }) == 0);
}

TEST_CASE("an interrupt ends a machine's run after the step that is under way") {
  using dem::mbd::Machine;
  clear_interrupt();
  const InterruptGuard guard(kSilent);
  Machine<dem::integrator::VelocityVerlet> m;
  m.add_body(dem::mbd::box_body("brick", {1, 1, 1}, 1000));
  int steps = 0;
  const auto report = m.run(1.0, 1e-3, [&] {
    if (++steps == 3) std::raise(SIGINT);
    return !interrupted();
  });
  CHECK(report);
  CHECK(steps == 3);
  CHECK(m.time() == Catch::Approx(3e-3));
  clear_interrupt();
}

TEST_CASE("only the outermost guard restores the handlers") {
  clear_interrupt();
  const auto before = handler_of(SIGINT);
  {
    const InterruptGuard outer(kSilent);
    const auto caught = handler_of(SIGINT);
    CHECK(caught != before);
    { const InterruptGuard inner(kSilent); }
    CHECK(handler_of(SIGINT) == caught);
  }
  CHECK(handler_of(SIGINT) == before);
}

TEST_CASE("a signal that the parent ignores stays ignored") {
  clear_interrupt();
  const auto before = std::signal(SIGINT, SIG_IGN);
  {
    const InterruptGuard guard(kSilent);
    std::raise(SIGINT);
    CHECK(!interrupted());
  }
  std::signal(SIGINT, before);
}
