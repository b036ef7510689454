#pragma once
// Several runs of a stage side by side, each on a thread of its own.

#include <dem/rig/stages.hpp>

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace dem::rig {

/// What one of several runs that go on side by side tells: its progress counts in that of all.
class SharedStages {
 public:
  /// `of` runs share `stages`, whose stage has begun with the total `of`: each is done when it has told 1.
  SharedStages(Stages& stages, std::size_t of) : stages_(stages), done_(of, 0.0) {}

  /// So much, from 0 to 1, of a run is done. Throws Interrupted when another run has failed; not when all are asked to
  /// stop, as each is then to save itself first. `was_done`: an earlier run did it.
  void update(std::size_t run, double done, std::string_view status, bool was_done = false) {
    if (has_failed && !io::interrupted()) throw Interrupted{};
    const std::lock_guard lock(mutex_);
    if (was_done) stages_.go_on();
    done_[run] = done;
    double sum = 0.0;
    for (const double d : done_) sum += d;
    stages_.update(sum, status);
  }
  /// Calls something that only one run at a time may do, as writing messages.
  template <class F>
  void alone(F&& f) {
    const std::lock_guard lock(mutex_);
    f();
  }
  /// Those that are shared, for use within alone().
  Stages& all() { return stages_; }
  std::atomic<bool> has_failed = false;

 private:
  Stages& stages_;
  std::vector<double> done_;
  std::mutex mutex_;
};

/// The stages of one of them: what they tell is told of it.
class StagesOfOne final : public Stages {
 public:
  StagesOfOne(SharedStages& shared, std::size_t run) : shared_(shared), run_(run) {}
  void update(double done, std::string_view status = {}) override {
    shared_.update(run_, done, status, std::exchange(goes_on_, false));
    save_if_due();
  }
  void go_on() override { goes_on_ = true; }
  void message(std::string_view text) override {
    shared_.alone([&] { shared_.all().message(text); });
  }

 private:
  SharedStages& shared_;
  std::size_t run_;
  bool goes_on_ = false;
};

/// Calls job(k, shared) for each k below `jobs`, up to `workers` at a time. Where several processes share each of them
/// it is one after the other. What a job throws ends the others at their
/// next update, and is thrown here once all have ended; a problem goes before an interruption.
template <class Job>
void side_by_side(std::size_t jobs, int workers, Stages& stages, Job&& job) {
  SharedStages shared(stages, jobs);
  std::atomic<std::size_t> next = 0;
  std::exception_ptr problem, interrupted;
  const auto work = [&] {
    for (std::size_t k = next++; k < jobs; k = next++) {
      try {
        if (shared.has_failed) return;
        job(k, shared);
      } catch (const Interrupted&) {
        shared.has_failed = true;
        shared.alone([&] { interrupted = std::current_exception(); });
      } catch (...) {
        shared.has_failed = true;
        shared.alone([&] { problem = problem ? problem : std::current_exception(); });
      }
    }
  };
  if (processes.count > 1) workers = 1;
  std::vector<std::thread> threads;
  for (int k = 1; k < workers && static_cast<std::size_t>(k) < jobs; ++k) threads.emplace_back(work);
  work();
  for (auto& thread : threads) thread.join();
  if (problem) std::rethrow_exception(problem);
  if (interrupted) std::rethrow_exception(interrupted);
}

}  // namespace dem::rig
