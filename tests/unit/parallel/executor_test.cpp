#include "core/error_of.hpp"

#include <dem/parallel/openmp.hpp>
#include <dem/parallel/serial.hpp>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

TEST_CASE("every index is called once, on any number of threads") {
  dem::exec::OpenMP executor;
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

TEST_CASE("the serial executor goes through in order") {
  std::vector<std::size_t> seen;
  dem::exec::Serial().for_each(5, [&](std::size_t k) { seen.push_back(k); });
  CHECK(seen == std::vector<std::size_t>{0, 1, 2, 3, 4});
}

TEST_CASE("a wrong number of threads is refused") {
  dem::exec::OpenMP many;
  check_refused([&] { many.set_threads(0); }, "threads is 0", "at least 1");
  check_refused([&] { many.set_threads(-2); }, "threads is -2");
  dem::exec::Serial one;
  one.set_threads(1);
  check_refused([&] { one.set_threads(4); }, "1 thread, not 4", "OpenMP");
}

TEST_CASE("an exception of a piece of work arrives, that of the lowest one, on any number of threads") {
  dem::exec::OpenMP executor;
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
