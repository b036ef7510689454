#include "core/error_of.hpp"

#include <dem/parallel/any_executor.hpp>
#include <dem/parallel/help.hpp>
#include <dem/parallel/openmp.hpp>
#include <dem/parallel/serial.hpp>
#include <dem/parallel/threads.hpp>

#if defined(_OPENMP) && defined(__linux__)
#include <omp.h>
#include <sched.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <concepts>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

TEMPLATE_TEST_CASE("every index is called once, on any number of threads", "", dem::exec::Threads, dem::exec::OpenMP) {
  TestType executor;
  for (const int threads : {1, 2, 3, 8}) {
    executor.set_threads(threads);
    CHECK(executor.threads() == threads);
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{1000}}) {
      std::vector<std::atomic<int>> calls(n + 1);
      executor.for_each(n, [&](std::size_t k) { ++calls[k]; });
      for (std::size_t k = 0; k < n; ++k) CHECK(calls[k] == 1);
      CHECK(calls[n] == 0);
    }
  }
}

TEMPLATE_TEST_CASE("a piece is told which thread runs it, and no two run on one at once", "", dem::exec::Threads,
                   dem::exec::OpenMP, dem::exec::Serial) {
  TestType executor;
  for (const int threads : {1, 4}) {
    if (!std::same_as<TestType, dem::exec::Serial>) executor.set_threads(threads);
    std::vector<std::atomic<int>> running(static_cast<std::size_t>(executor.threads()));
    std::atomic<int> wrong = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
      executor.for_each(100, [&](std::size_t, int thread) {
        if (thread < 0 || thread >= executor.threads()) {
          ++wrong;
        } else {
          auto& mine = running[static_cast<std::size_t>(thread)];
          if (mine.fetch_add(1) != 0) ++wrong;
          mine.fetch_sub(1);
        }
      });
    }
    CHECK(wrong == 0);
  }
}

TEMPLATE_TEST_CASE("an executor of any type stands for the one that it was made from", "", dem::exec::Threads,
                   dem::exec::OpenMP, dem::exec::Serial) {
  TestType executor;
  if (!std::same_as<TestType, dem::exec::Serial>) executor.set_threads(3);
  dem::exec::AnyExecutor any(executor);
  CHECK(any.threads() == executor.threads());
  std::vector<std::atomic<int>> calls(101), threads(101);
  any.for_each(100, [&](std::size_t k) { ++calls[k]; });
  any.for_each(100, [&, copy = dem::exec::AnyExecutor(any)](std::size_t k, int thread) mutable {
    if (thread >= 0 && thread < copy.threads()) ++threads[k];
  });
  for (std::size_t k = 0; k < 100; ++k) CHECK((calls[k] == 1 && threads[k] == 1));
  CHECK((calls[100] == 0 && threads[100] == 0));
  CHECK_THROWS_AS(any.for_each(8,
                               [](std::size_t k) {
                                 if (k == 5) throw std::out_of_range("piece");
                               }),
                  std::out_of_range);
}

namespace {
std::atomic<int> calls_of_a_function = 0;
void count_call(std::size_t) { ++calls_of_a_function; }
}  // namespace

TEMPLATE_TEST_CASE("plain functions, and callables that are const, are pieces of work", "", dem::exec::Threads,
                   dem::exec::OpenMP, dem::exec::Serial) {
  TestType executor;
  dem::exec::AnyExecutor any(executor);
  const auto count = [](std::size_t k) { count_call(k); };
  calls_of_a_function = 0;
  executor.for_each(5, count_call), any.for_each(5, count_call);
  executor.for_each(5, count), any.for_each(5, count);
  CHECK(calls_of_a_function == 20);
  if constexpr (!std::same_as<TestType, dem::exec::Threads>) {  // others are called without being changed
    const TestType same;
    dem::exec::AnyExecutor(same).for_each(5, count);
    CHECK(calls_of_a_function == 25);
  }
  STATIC_REQUIRE(!std::convertible_to<int&, dem::exec::AnyExecutor>);
}

TEST_CASE("the serial executor goes through in order") {
  std::vector<std::size_t> seen;
  dem::exec::Serial().for_each(5, [&](std::size_t k) { seen.push_back(k); });
  CHECK(seen == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEMPLATE_TEST_CASE("a wrong number of threads is refused", "", dem::exec::Threads, dem::exec::OpenMP) {
  TestType many;
  check_refused([&] { many.set_threads(0); }, "threads is 0", "at least 1");
  check_refused([&] { many.set_threads(-2); }, "threads is -2");
  dem::exec::Serial one;
  one.set_threads(1);
  check_refused([&] { one.set_threads(4); }, "1 thread, not 4", "Threads");
}

TEMPLATE_TEST_CASE("an exception of a piece of work arrives, that of the lowest one, on any number of threads", "",
                   dem::exec::Threads, dem::exec::OpenMP) {
  TestType executor;
  for (const int threads : {1, 2, 3, 8}) {
    executor.set_threads(threads);
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::atomic<int> calls = 0;
      const auto work = [&](std::size_t k) {
        ++calls;
        if (k == 37 || k == 5 || k == 99) throw std::runtime_error("piece " + std::to_string(k));
      };
      CHECK_THROWS_WITH(executor.for_each(100, work), "piece 5");
      CHECK(calls == (threads == 1 ? 6 : 100));
    }
    int after = 0;  // the executor works on
    executor.for_each(1, [&](std::size_t) { ++after; });
    CHECK(after == 1);
  }
  CHECK_THROWS_WITH(dem::exec::Serial().for_each(9, [](std::size_t) { throw std::runtime_error("one"); }), "one");
}

// Ten thousand calls with little in them meet threads that are just coming, waiting, or falling asleep.
TEST_CASE("threads lose no piece and call none twice, however short the work is") {
  // More threads than processors, which are always called, however little they save.
  const int threads = static_cast<int>(std::thread::hardware_concurrency()) + 3;
  dem::exec::Threads executor;
  executor.set_threads(threads);
  std::vector<int> calls(static_cast<std::size_t>(3 * threads));
  for (int repeat = 0; repeat < 10000; ++repeat) {
    executor.for_each(calls.size(), [&](std::size_t k) { ++calls[k]; });
  }
  CHECK(calls == std::vector<int>(calls.size(), 10000));
}

#if defined(_OPENMP)
TEST_CASE("an executor that is made in an OpenMP region of the program has one thread, unless more are set") {
  const int outside = dem::exec::Threads().threads();
  CHECK(outside == omp_get_max_threads());
  std::atomic<int> regions = 0, wrong = 0;
#pragma omp parallel num_threads(3)
  {
    dem::exec::Threads executor;
    if (executor.threads() != 1) ++wrong;
    executor.set_threads(2);
    std::atomic<int> calls = 0;
    executor.for_each(100, [&](std::size_t) { ++calls; });
    if (executor.threads() != 2 || calls != 100) ++wrong;
    ++regions;
  }
  CHECK(regions == 3);
  CHECK(wrong == 0);
  CHECK(dem::exec::Threads().threads() == outside);
}
#endif

#if defined(_OPENMP) && defined(__linux__)
// Run once more with OMP_PROC_BIND, which holds the first thread on one processor.
TEST_CASE("a helper may use the processors of all of OpenMP's places") {
  const auto count = [] {
    cpu_set_t set;
    return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : -1;
  };
  int expected = count();
  if (omp_get_proc_bind() != omp_proc_bind_false) {
    expected = 0;
    for (int place = 0; place < omp_get_num_places(); ++place) expected += omp_get_place_num_procs(place);
  }
  dem::exec::Threads executor;
  executor.set_threads(2);
  std::atomic<int> of_helper = 0;
  for (int call = 0; call < 1000 && of_helper == 0; ++call) {
    executor.for_each(8, [&](std::size_t, int thread) {
      if (thread != 0) of_helper = count();
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    });
  }
  CHECK(of_helper == expected);
}
#endif

TEST_CASE("calls with many and few pieces take turns on the same threads") {
  dem::exec::Threads executor;
  executor.set_threads(4);
  // Each thread counts itself once. Ids would not do: one that ended gives its id to the next.
  static std::atomic<int> threads = 0;
  std::atomic<std::size_t> calls = 0;
  for (int repeat = 0; repeat < 50; ++repeat) {
    executor.for_each(40, [&](std::size_t) {
      [[maybe_unused]] static thread_local const int number = threads++;
      std::this_thread::sleep_for(std::chrono::microseconds(100));  // long enough for all to take part
      ++calls;
    });
    executor.for_each(2, [&](std::size_t) { ++calls; });
  }
  CHECK(calls == 50 * 42);
  CHECK(threads <= 4);  // nobody was replaced
}

TEST_CASE("threads share the work as it comes: one long piece does not keep the others") {
  dem::exec::Threads executor;
  executor.set_threads(2);
  // The first piece ends when all others have: with equal shares it would wait for its own thread for ever.
  std::atomic<int> done = 0;
  executor.for_each(64, [&](std::size_t k) {
    if (k == 0) {
      while (done != 63) std::this_thread::yield();
    } else {
      ++done;
    }
  });
  CHECK(done == 63);
}

TEST_CASE("helpers that cost more than they save are left out, longer each time, and tried again") {
  using dem::exec::Help;
  using std::chrono::milliseconds;
  const Help::Time start{};
  Help help;
  CHECK(help.is_worth_it(start));
  // Less than the 20 ms that a verdict takes.
  help.account(1e-3, 15e-3, start);
  CHECK(help.is_worth_it(start));
  // Each pause is twice as long as the one before, up to two seconds.
  Help::Time now = start;
  for (const int pause : {100, 200, 400, 800, 1600, 2000, 2000}) {
    help.account(1e-3, 30e-3, now);
    CHECK_FALSE(help.is_worth_it(now + milliseconds(pause - 1)));
    now += milliseconds(pause + 1);
    CHECK(help.is_worth_it(now));
  }
  // One good verdict, and the next pause is short.
  help.account(30e-3, 1e-3, now);
  CHECK(help.is_worth_it(now));
  help.account(1e-3, 30e-3, now);
  CHECK_FALSE(help.is_worth_it(now + milliseconds(99)));
  CHECK(help.is_worth_it(now + milliseconds(101)));
}

TEST_CASE("a helper saves the time of its pieces, but not that in which it is held up") {
  using dem::exec::Help;
  const dem::exec::Share caller{10, 1e-3};
  CHECK(Help::saved_by({0, 0.0}, caller) == 0.0);
  CHECK(Help::saved_by({10, 1.1e-3}, caller) == 1.1e-3);
  CHECK(Help::saved_by({2, 0.5e-3}, caller) == 0.5e-3);  // pieces of more work
  CHECK(Help::saved_by({1, 4e-3}, caller) == Approx(0.3e-3));
}

// As if another program had the second processor again and again: each piece that the helper does takes as long as a
// time slice.
TEST_CASE("a helper that is held up is hardly called for, and tried again") {
  if (std::thread::hardware_concurrency() < 2) return;  // more threads than processors are what the user asked for
  using Clock = std::chrono::steady_clock;
  using std::chrono::milliseconds;
  dem::exec::Threads executor;
  executor.set_threads(2);
  const auto work_for = [&](milliseconds whole, bool held_up) {
    int calls = 0, helped = 0;
    for (const auto end = Clock::now() + whole; Clock::now() < end; ++calls) {
      std::atomic<bool> by_helper = false;
      executor.for_each(8, [&](std::size_t, int thread) {
        if (thread == 1) by_helper = true;
        if (thread == 1 && held_up) {
          std::this_thread::sleep_for(milliseconds(4));
        } else {
          for (const auto done = Clock::now() + std::chrono::microseconds(50); Clock::now() < done;) {
          }
        }
      });
      helped += by_helper ? 1 : 0;
    }
    return std::pair(calls, helped);
  };
  // Alone a call takes 0.4 ms, with the helper at least 4 ms. It is tried for some 20 ms, then left out for 100, 200
  // and 400: 1 in 100 calls, and more on a busy machine, where a piece of the caller takes longer.
  const auto [calls, helped] = work_for(milliseconds(700), true);
  CAPTURE(calls, helped);
  CHECK(helped < calls / 2);
  // It is in time again: it is tried within a second.
  int tried = 0;
  for (int k = 0; k < 100 && tried == 0; ++k) tried = work_for(milliseconds(50), false).second;
  CHECK(tried > 0);
}

TEST_CASE("threads within threads: the inner work is done by the one that asks for it") {
  dem::exec::Threads executor;
  executor.set_threads(3);
  std::vector<int> calls(30);
  executor.for_each(3, [&](std::size_t k) { executor.for_each(10, [&](std::size_t j) { ++calls[10 * k + j]; }); });
  CHECK(calls == std::vector<int>(30, 1));
}

TEST_CASE("copies of threads work side by side, and so does a process that was forked off") {
  dem::exec::Threads executor;
  executor.set_threads(3);
  std::atomic<int> sum = 0;
  const auto add = [&](std::size_t k) { sum += static_cast<int>(k); };
  executor.for_each(10, add);
  dem::exec::Threads copy = executor;
  CHECK(copy.threads() == 3);
  copy.for_each(10, add);
  dem::exec::Threads moved = std::move(copy);
  moved.for_each(10, add);
  CHECK(sum == 3 * 45);

  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    sum = 0;
    executor.for_each(10, add);
    _exit(sum == 45 ? 0 : 1);
  }
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 0));
  executor.for_each(10, add);
  CHECK(sum == 4 * 45);
}

TEST_CASE("a process that is forked after work on OpenMP's threads works on") {
  dem::exec::OpenMP executor;
  executor.set_threads(4);
  const auto sum_of = [&](std::size_t n) {
    std::atomic<std::size_t> sum = 0;
    executor.for_each(n, [&](std::size_t k) { sum += k; });
    return sum.load();
  };
  REQUIRE(sum_of(100) == 4950);  // from here on there are four threads
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(20);  // ends it where it hangs
    ::_exit(sum_of(100) == 4950 && sum_of(1000) == 499500 ? 0 : 1);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(status == 0);
  CHECK(sum_of(100) == 4950);  // the parent has its threads still
}
