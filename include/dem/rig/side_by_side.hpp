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
  int all = 1;   ///< of all runs together
  int most = 1;  ///< that one of them may use

  /// Threads of each while so many runs go on: those of runs that have ended are shared anew.
  [[nodiscard]] int of_each(std::size_t going_on) const {
    const auto beside = static_cast<int>(std::clamp<std::size_t>(going_on, 1, static_cast<std::size_t>(runs)));
    return std::clamp(all / beside, 1, most);
  }
};

/// A thread for each run where there are as many runs as `threads` (0: all); fewer runs have more each, up to `most`
/// (0: any number). Where several processes share each run, one goes after the other, on all threads.
inline SharedThreads share_threads(std::size_t runs, int threads, int most = 0) {
  if (threads <= 0) threads = std::max(1, omp_get_max_threads());
  SharedThreads shared{.all = threads, .most = most > 0 ? std::min(most, threads) : threads};
  const std::size_t beside = processes.count > 1 ? 1 : static_cast<std::size_t>(threads);
  shared.runs = static_cast<int>(std::clamp<std::size_t>(runs, 1, beside));
  shared.each = shared.of_each(runs);
  return shared;
}

/// What one of several runs that go on side by side tells: its progress counts in that of all.
class SharedStages {
 public:
  /// `of` runs share `stages`, whose stage has begun with the total `of`: each is done when it has told 1.
  SharedStages(Stages& stages, std::size_t of, SharedThreads threads = {})
      : stages_(stages), done_(of, 0.0), status_(of), threads_(threads), going_on_(of) {}

  /// So much, from 0 to 1, of a run is done. Throws Interrupted when another run has failed; not when all are asked to
  /// stop, as each is then to save itself first. `was_done`: an earlier run did it.
  void update(std::size_t run, double done, std::string_view status, bool was_done = false) {
    if (has_failed && !io::interrupted()) throw Interrupted{};
    const std::lock_guard lock(mutex_);
    if (was_done) stages_.go_on();
    done_[run] = done;
    status_[run] = status;
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
  /// What a run told last, for use within alone().
  [[nodiscard]] const std::string& status(std::size_t run) const { return status_[run]; }
  /// Those that are shared, for use within alone().
  Stages& all() { return stages_; }
  /// Threads that each run may use now.
  [[nodiscard]] int threads() const { return threads_.of_each(going_on_); }
  /// One of the runs has ended, or will not begin.
  void end_one() { --going_on_; }
  std::atomic<bool> has_failed = false;

 private:
  Stages& stages_;
  std::vector<double> done_;
  std::vector<std::string> status_;
  SharedThreads threads_;
  std::atomic<std::size_t> going_on_;
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
  [[nodiscard]] int threads() const override { return shared_.threads(); }
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

/// Calls job(k, shared) for each k below `jobs`, which is the run k of `shared`, as many at a time as `threads` says.
/// Where several processes share each of them it is one after the other. One whose simulation is Stopped is told of,
/// and the others go on; anything else that a job throws ends them at their next update. What is thrown here once all
/// have ended is the first problem, else that all were asked to stop, else the first that Stopped.
template <class Job>
void side_by_side(std::size_t jobs, const SharedThreads& threads, Stages& stages, Job&& job) {
  SharedStages shared(stages, jobs, threads);
  std::atomic<std::size_t> next = 0;
  std::exception_ptr problem, interrupted, first_stopped;
  const auto note = [](std::exception_ptr& first) { first = first ? first : std::current_exception(); };
  const auto work = [&] {
    for (std::size_t k = next++; k < jobs; k = next++) {
      try {
        if (shared.has_failed) return;
        job(k, shared);
      } catch (const Interrupted&) {
        shared.has_failed = true;
        shared.alone([&] { note(interrupted); });
      } catch (const Stopped& stopped) {
        shared.alone([&] {
          if (jobs > 1) {
            const std::string& at = shared.status(k);
            shared.all().message(
                text("One of {} runs stopped{}: {}", jobs, at.empty() ? "" : " (" + at + ")", stopped.what()));
          }
          note(first_stopped);
        });
        if (processes.count > 1) shared.has_failed = true;  // the others may not have seen it
      } catch (...) {
        shared.has_failed = true;
        shared.alone([&] { note(problem); });
      }
      shared.end_one();
    }
  };
  const int workers = processes.count > 1 ? 1 : threads.runs;
  std::vector<std::thread> beside;
  for (int k = 1; k < workers && static_cast<std::size_t>(k) < jobs; ++k) beside.emplace_back(work);
  work();
  for (auto& thread : beside) thread.join();
  for (const auto& first : {problem, io::interrupted() ? interrupted : nullptr, first_stopped, interrupted}) {
    if (first) std::rethrow_exception(first);
  }
}

/// The same with so many at a time, of a thread each.
template <class Job>
void side_by_side(std::size_t jobs, int workers, Stages& stages, Job&& job) {
  side_by_side(jobs, SharedThreads{.runs = workers, .all = workers}, stages, std::forward<Job>(job));
}

}  // namespace dem::rig
