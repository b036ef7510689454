#include "catch.hpp"

#include <dem/rig/runs_in_turn.hpp>
#include <dem/rig/scatter.hpp>
#include <dem/rig/side_by_side.hpp>
#include <dem/rig/steady_window.hpp>

#include <barrier>
#include <cmath>
#include <csignal>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace steady_window_test {

using Catch::Approx;
using namespace dem::rig;

TEST_CASE("mean and standard deviation are those of the values, and not known without any") {
  const std::vector<double> values{1.0, 2.0, 3.0, 6.0};
  const auto m = mean_of(values);
  CHECK(m.mean == Approx(3.0));
  CHECK(m.deviation == Approx(std::sqrt(3.5)));  // (4 + 1 + 0 + 9)/4
  CHECK(std::isnan(mean_of({}).mean));
}

TEST_CASE("how values scatter is told of those that are known, and of two at the least") {
  const std::vector<double> values{1.0, not_known, 2.0, 3.0, 6.0};
  const Scatter s = scatter_of(values);
  CHECK(s.count == 4);
  CHECK(s.mean == Approx(3.0));
  CHECK(s.deviation == Approx(std::sqrt(14.0 / 3.0)));  // (4 + 1 + 0 + 9)/(4 - 1)
  CHECK(s.error() == Approx(std::sqrt(14.0 / 12.0)));
  const std::vector<double> one{not_known, 2.0};
  CHECK(scatter_of(one).mean == Approx(2.0));
  CHECK(std::isnan(scatter_of(one).deviation));
  CHECK(std::isnan(scatter_of(one).error()));
  CHECK(scatter_of({}).count == 0);
  CHECK(std::isnan(scatter_of({}).mean));
}

TEST_CASE("the error of a mean is that of ten parts, so that values which err alike count as one") {
  std::vector<double> values{7.0, -3.0};  // more than ten parts of ten: the first are left out
  for (int i = 0; i < 100; ++i) values.push_back(i / 10);
  CHECK(error_of_mean(values) == Approx(std::sqrt(82.5 / 90.0)));  // squares about 4.5, over 10 times 9
  CHECK(std::isnan(error_of_mean(std::vector<double>(9, 1.0))));
}

TEST_CASE("the steady window leaves a transient out and keeps what is steady") {
  // An exponential of 20 values' decay under noise of 0.1: after 5 decays, 100 values, 0.7 % of it are left, less than
  // the noise of a batch. Before 2 decays it is above the noise.
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(std::exp(-i / 20.0) + (i % 2 == 0 ? 0.1 : -0.1));
  const auto window = steady_window(values);
  CHECK(window.is_steady);
  CHECK(window.first >= 40);
  CHECK(window.first <= 160);
}

TEST_CASE("noise alone is steady from the start on, and what goes on rising is not steady") {
  std::vector<double> noise, rising;
  for (int i = 0; i < 400; ++i) {
    noise.push_back(i % 10 < 5 ? 1.0 : -1.0);  // a batch of 5 is one or the other
    rising.push_back(i);
  }
  CHECK(steady_window(noise).is_steady);
  CHECK(steady_window(noise).first <= 5);
  const auto window = steady_window(rising);
  CHECK_FALSE(window.is_steady);
  CHECK(window.first == 200);
  CHECK_FALSE(steady_window(std::vector<double>(49, 1.0)).is_steady);  // too few to tell
  // It drifts and swings ever more. Its quiet start makes the standard error small: by MSER-5 alone it is steady there.
  std::vector<double> drifting;
  for (int i = 0; i < 400; ++i) {
    const double t = i / 400.0;
    drifting.push_back(60.0 * t + 40.0 * t * t * (i / 20 % 2 == 0 ? 1.0 : -1.0));
  }
  CHECK_FALSE(steady_window(drifting).is_steady);
  CHECK(steady_window(drifting).first == 200);
}

TEST_CASE("runs side by side share the progress of their stage, and each is run once") {
  struct Told : Stages {
    void update(double done, std::string_view) override { last = done; }
    double last = 0.0;
  } told;
  std::vector<int> runs(7, 0);
  side_by_side(runs.size(), 3, told, [&](std::size_t k, SharedStages& stages) {
    ++runs[k];
    stages.update(k, 0.5, "");
    stages.update(k, 1.0, "");
  });
  CHECK(runs == std::vector<int>(7, 1));
  CHECK(told.last == Approx(7.0));
}

TEST_CASE("each of several runs that go on says what of it was done before") {
  struct Told : Stages {
    void update(double done, std::string_view) override {
      if (!std::exchange(goes_on, false)) headway += done - last;
      last = done;
    }
    void go_on() override { goes_on = true; }
    double headway = 0.0, last = 0.0;
    bool goes_on = false;
  } told;
  side_by_side(3, 1, told, [&](std::size_t k, SharedStages& stages) {
    StagesOfOne own(stages, k);
    if (k < 2) own.go_on(), own.update(0.4);  // the third begins
    own.update(1.0);
  });
  CHECK(told.last == Approx(3.0));
  CHECK(told.headway == Approx(0.6 + 0.6 + 1.0));
}

TEST_CASE("stages of one of several runs are each a share of it") {
  struct Told : Stages {
    void update(double done, std::string_view status) override { all.push_back(done), text = status; }
    std::vector<double> all;
    std::string text;
  } told;
  side_by_side(1, 1, told, [&](std::size_t k, SharedStages& stages) {
    StagesOfOne own(stages, k, 4);
    own.begin("fill", 2.0), own.update(1.0, "slow");
    own.begin("let go"), own.update(7.0);  // its end is not known
    own.begin("rest", 1.0), own.update(3.0);
    CHECK(told.text == "rest");
    own.begin("creep", 1.0), own.update(0.5, "slower");
  });
  CHECK(told.all == std::vector{0.125, 0.25, 0.75, 0.875});
  CHECK(told.text == "creep, slower");
}

TEST_CASE("a thread for each run, and more where there are fewer runs") {
  const auto shared = [](std::size_t runs, int threads) {
    const SharedThreads t = share_threads(runs, threads);
    return std::pair(t.runs, t.each);
  };
  CHECK(shared(4, 2) == std::pair(2, 1));
  CHECK(shared(4, 4) == std::pair(4, 1));
  CHECK(shared(3, 8) == std::pair(3, 2));
  CHECK(shared(1, 8) == std::pair(1, 8));
  CHECK(shared(0, 8) == std::pair(1, 8));
  CHECK(shared(1000, 0).second == 1);
}

TEST_CASE("runs that go on share the threads of those that have ended") {
  const SharedThreads of_nine = share_threads(9, 2), of_three = share_threads(3, 8), of_small = share_threads(5, 4, 2);
  CHECK(of_nine.of_each(9) == 1);
  CHECK(of_nine.of_each(2) == 1);
  CHECK(of_nine.of_each(1) == 2);
  CHECK(of_three.of_each(3) == 2);
  CHECK(of_three.of_each(2) == 4);
  CHECK(of_three.of_each(1) == 8);
  CHECK(of_small.of_each(1) == 2);  // not more than a run may use
  Stages quiet;
  std::vector<int> threads;
  side_by_side(3, SharedThreads{.runs = 1, .all = 4, .most = 4}, quiet, [&](std::size_t k, SharedStages& stages) {
    const StagesOfOne own(stages, k);
    threads.push_back(own.threads());
  });
  CHECK(threads == std::vector{4, 4, 4});  // one after the other, each has all
  threads.clear();
  std::mutex mutex;
  std::barrier both(2);
  side_by_side(3, SharedThreads{.runs = 2, .all = 2, .most = 2}, quiet, [&](std::size_t k, SharedStages& stages) {
    const StagesOfOne own(stages, k);
    if (k < 2) both.arrive_and_wait();
    while (k == 2 && own.threads() < 2) std::this_thread::yield();  // until the other one has ended
    const std::lock_guard lock(mutex);
    threads.push_back(own.threads());
  });
  REQUIRE(threads.size() == 3);
  CHECK(threads.front() == 1);
  CHECK(threads.back() == 2);
}

TEST_CASE("a run that fails ends those beside it, and its problem is thrown") {
  Stages quiet;
  int begun = 0;
  const auto run = [&](std::size_t k, SharedStages& stages) {
    ++begun;
    if (k == 1) throw std::runtime_error("the second one");
    for (int i = 0; i < 10; ++i) stages.update(k, 0.1 * i, "");
  };
  CHECK_THROWS_WITH(side_by_side(5, 1, quiet, run), "the second one");
  CHECK(begun == 2);
}

struct Told : Stages {
  void message(std::string_view text) override { said.emplace_back(text); }
  std::vector<std::string> said;
};

TEST_CASE("a run whose simulation is stopped is told of, and those beside it go on") {
  Told told;
  int done = 0;
  const auto run = [&](std::size_t k, SharedStages& stages) {
    if (k == 3) stages.update(k, 0.5, "slip 0.3");
    if (k == 1 || k == 3) throw Stopped(dem::text("grain {} is lost", k));
    stages.update(k, 1.0, "");
    ++done;
  };
  CHECK_THROWS_WITH(side_by_side(5, 1, told, run), "grain 1 is lost");
  CHECK(done == 3);
  CHECK(told.said == std::vector<std::string>{"One of 5 runs stopped: grain 1 is lost",
                                              "One of 5 runs stopped (slip 0.3): grain 3 is lost"});
}

TEST_CASE("where one run is stopped and all are then asked to stop, that is what is told, as the others are saved") {
  Told told;
  const dem::io::InterruptGuard guard(dem::io::InterruptGuard::Message::Silent);
  const auto run = [&](std::size_t k, SharedStages&) {
    if (k == 0) throw Stopped("grain 1 is lost");
    std::raise(SIGINT);
    throw Interrupted{};
  };
  CHECK_THROWS_AS(side_by_side(3, 1, told, run), Interrupted);
  CHECK(told.said == std::vector<std::string>{"One of 3 runs stopped: grain 1 is lost"});
}

TEST_CASE(
    "of runs in turn one whose simulation is stopped is told of, the others go on, and the first is thrown at the "
    "end") {
  Told told;
  int done = 0;
  RunsInTurn runs(told, 3);
  runs.run("", [&] { throw Stopped("grain 1 is lost"); });
  runs.run("twice as wide", [&] { ++done; });
  runs.run("twice as deep", [&] { throw Stopped("grain 2 is lost"); });
  CHECK(done == 1);
  CHECK(told.said == std::vector<std::string>{"the run itself stopped; the others go on: grain 1 is lost",
                                              "twice as deep stopped; the others go on: grain 2 is lost"});
  CHECK_THROWS_WITH(runs.end(), "grain 1 is lost");
  CHECK_THROWS_AS(runs.run("", [] { throw Interrupted{}; }), Interrupted);
  RunsInTurn one(told, 1);
  CHECK_THROWS_WITH(one.run("", [] { throw Stopped("grain 3 is lost"); }), "grain 3 is lost");
}

}  // namespace steady_window_test
