#include "catch.hpp"

#include <dem/report/replay_recorder.hpp>

#include <cmath>
#include <vector>

using dem::report::GrainSample;
using dem::report::Replay;

namespace {

std::vector<double> times_of(const Replay& replay) {
  std::vector<double> times;
  for (const auto& frame : replay.frames()) times.push_back(frame.time);
  return times;
}

/// Records `calls` times, `step` seconds apart, and checks that frames start at 0, are evenly spaced by a power of two
/// times `spacing`, reach as near to the end as one spacing, and are as many as the limit allows, or more than half.
/// Frames may be late by `late` seconds.
void check_even(int limit, double interval, int calls, double step, double spacing, double late = 1e-9) {
  INFO("at most " << limit << " frames, every " << interval << " s, " << calls << " calls every " << step << " s");
  Replay replay({.frames = limit, .interval = interval});
  double time = 0.0;  // summed up, as in a run
  int made = 0;
  for (int k = 0; k < calls; ++k, time += step) {
    const bool due = replay.due(time);
    const bool recorded = replay.record(time, {});
    CHECK((due || !recorded));
    made += recorded ? 1 : 0;
    REQUIRE(replay.frames().size() <= static_cast<std::size_t>(limit));
  }
  const std::vector<double> times = times_of(replay);
  REQUIRE(times.size() >= 2);
  CHECK(made >= static_cast<int>(times.size()));
  CHECK(times.front() == 0.0);
  const double end = (calls - 1) * step, apart = spacing * std::exp2(std::round(std::log2(times[1] / spacing)));
  for (std::size_t k = 0; k < times.size(); ++k) CHECK(std::abs(times[k] - static_cast<double>(k) * apart) <= late);
  CHECK(times.back() > end - apart - late);
  const bool all_fit = std::round(end / spacing) + 1 <= limit;
  CHECK(2 * times.size() > static_cast<std::size_t>(limit) * (all_fit ? 0 : 1));
  if (all_fit) CHECK(static_cast<double>(times.size()) == std::floor(end / spacing + 1e-6) + 1);
}

}  // namespace

TEST_CASE("however long a run gets, its frames are evenly spaced and not too many") {
  for (const int calls : {2, 9, 10, 11, 12, 21, 100, 1000}) {
    check_even(10, 0.0, calls, 0.1, 0.1);
    check_even(11, 0.0, calls, 0.1, 0.1);
    check_even(2, 0.0, calls, 0.1, 0.1);
  }
  check_even(10, 0.1, 5'000, 1e-3, 0.1);                    // many calls an interval
  check_even(10, 0.1, 5'000, 1.0 / 1024, 0.1, 1.0 / 1024);  // no whole number of calls an interval
  check_even(10, 0.01, 500, 0.1, 0.1);                      // fewer calls than intervals
  check_even(100, 0.1, 900, 0.01, 0.1);                     // none too many
}

TEST_CASE("a time that was recorded before is no frame, and does not count as a call") {
  Replay replay({.frames = 4});
  for (const double t : {0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0, 4.0}) replay.record(t, {});
  CHECK(times_of(replay) == std::vector<double>{0, 2, 4});
  CHECK_FALSE(replay.due(4.0));
  CHECK_FALSE(replay.due(5.0));
  CHECK(replay.due(4.5) == false);
  replay.pass(5.0);
  CHECK(replay.due(6.0));
}

TEST_CASE("a sample of grains is even, never too large, and loses grains only") {
  GrainSample sample(1000);
  std::vector<bool> drawn;
  for (std::size_t n = 0; n < 7000; ++n) {
    sample.meet(n, 0);
    sample.meet(n / 2, 0);  // again
    REQUIRE(sample.drawn() <= 1000);
    if (n < 1000) REQUIRE(sample.drawn() == n + 1);
    if (n % 500 != 499) continue;
    drawn.resize(n + 1, true);
    for (std::size_t m = 0; m <= n; ++m) {
      if (sample.draws(m)) REQUIRE(drawn[m]);
      drawn[m] = sample.draws(m);
    }
  }
  CHECK(sample.met() == 7000);
  CHECK(sample.drawn() > 900);  // each time a hundredth more than needed goes
  // The golden ratio spreads best of all: in any stretch of numbers there are as many as there should be, give or
  // take 3.
  const double share = static_cast<double>(sample.drawn()) / 7000;
  for (std::size_t begin = 0; begin < 7000; begin += 97) {
    int count = 0;
    for (std::size_t n = begin; n < 7000; ++n) {
      count += sample.draws(n) ? 1 : 0;
      REQUIRE(std::abs(count - share * static_cast<double>(n + 1 - begin)) < 3.0);
    }
  }
  CHECK(sample.shape_of(6999) == 0);
  CHECK(sample.shape_of(7000) == GrainSample::kUnmet);
}
