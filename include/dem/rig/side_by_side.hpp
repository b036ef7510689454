#pragma once
// Several runs of a stage side by side, each on a thread of its own, or on several.

#include <dem/rig/stages.hpp>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace dem::rig {

/// How several runs share threads.
struct SharedThreads {
  int runs = 1;  ///< that go side by side
  int each = 1;  ///< threads of each
};

/// A thread for each run where there are as many runs as `threads` (0: all); fewer runs have as many more each. Where
/// several processes share each run, one goes after the other, on all threads.
inline SharedThreads share_threads(std::size_t runs, int threads) {
  if (threads <= 0) threads = std::max(1, omp_get_max_threads());
  if (processes.count > 1) return {1, threads};
  const int beside = static_cast<int>(std::clamp<std::size_t>(runs, 1, static_cast<std::size_t>(threads)));
  return {beside, threads / beside};
}

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
  /// `stages` are begun one after the other, each a like share of the run. Where none is begun, update() tells the
  /// share of the run itself.
  StagesOfOne(SharedStages& shared, std::size_t run, int stages = 1) : shared_(shared), run_(run), stages_(stages) {}
  void begin(std::string_view name, double total = unknown) override {
    ++stage_;
    name_ = name;
    total_ = total;
  }
  void update(double done, std::string_view status = {}) override {
    const double before = std::max(0, stage_ - 1), share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
    const char* between = name_.empty() || status.empty() ? "" : ", ";
    shared_.update(run_, std::min(1.0, (before + share) / stages_), name_ + between + std::string(status),
                   std::exchange(goes_on_, false));
    save_if_due();
  }
  void go_on() override { goes_on_ = true; }
  void alone(const std::function<void()>& f) override { shared_.alone(f); }
  void message(std::string_view text) override {
    shared_.alone([&] { shared_.all().message(text); });
  }

 private:
  SharedStages& shared_;
  std::size_t run_;
  int stages_, stage_ = 0;
  std::string name_;
  double total_ = 1.0;  ///< of the stage that it is in
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
