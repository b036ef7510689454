#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/parallel/help.hpp>
#include <dem/parallel/places.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <system_error>
#include <thread>
#include <vector>

#include <time.h>
#include <unistd.h>

namespace dem::exec {

/// Threads that wait for work and share it as it comes.
///
/// Each member has a range of the pieces, so that it meets the same memory in each phase of a step; who is done with
/// its own range helps with the others'. Nobody waits for a member that has not begun: where another program has its
/// processor, the rest do its share. Where members cost more than they save, the caller works alone for a while (Help).
/// Members busy-wait for a tenth of a millisecond for the next work, and sleep after that. A call may want fewer
/// members than there are: calls with many and few pieces take turns within a step.
class Team {
 public:
  using Piece = void (*)(void* work, std::size_t piece, int thread);

  /// The calling thread is member 0. Throws Error if the system gives no more threads.
  explicit Team(int size);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }
  /// False in a process that was forked off: threads stay behind.
  bool is_of_this_process() const { return process_ == getpid(); }

  /// Calls `piece` for 0 ... n-1 on the first `members`, and on one that is late from a call with more; `piece` must
  /// not throw. Returns when all are done.
  void run(std::size_t n, int members, Piece piece, void* work);

 private:
  static constexpr std::uint32_t open = 1U << 31;  // of the gate; the rest of it counts who is inside

  /// Alone in its cache lines, as others write to theirs.
  struct alignas(128) Range {
    std::atomic<std::size_t> next = 0;
    std::size_t end = 0;
    Share share;  // of the member whose range it is, in the call
  };

  static double seconds(const timespec& t) {
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  /// s, in which this thread had a processor so far. Where the system counts that coarsely or not at all, time goes by
  /// as for all.
  static double processor_time();
  void keep_account(Help::Time called);

  static void pause();
  /// Ends the threads.
  void dismiss();
  void call();
  void take_part(int member);
  void serve(int member);

  std::unique_ptr<Range[]> ranges_;
  int size_;
  std::atomic<int> members_ = 0;  // of the call; a member that is late may read it as the next call begins
  int busy_waits_;                // looks before a member sleeps; none where there are more members than processors
  Help help_;                     // has no account there: who wants more members than processors gets them
  Piece piece_ = nullptr;
  void* work_ = nullptr;
  std::atomic<bool> stop_ = false;
  const pid_t process_ = getpid();
  alignas(128) std::atomic<std::uint32_t> call_ = 0;  // counts the calls to work
  alignas(128) std::atomic<std::uint32_t> gate_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace dem::exec

#if DEM_DEFINES

namespace dem::exec {

DEM_INLINE Team::Team(int size)
    : ranges_(new Range[static_cast<std::size_t>(size)]),
      size_(size),
      busy_waits_(static_cast<unsigned>(size) <= std::thread::hardware_concurrency() ? 4000 : 0) {
  try {
    for (int k = 1; k < size; ++k) threads_.emplace_back([this, k] { serve(k); });
  } catch (const std::exception& e) {
    dismiss();
    fail("thread {} of {} could not be started ({}); ask for fewer: set_threads, OMP_NUM_THREADS", threads_.size() + 2,
         size, e.what());
  }
}

DEM_INLINE Team::~Team() {
  if (process_ != getpid()) {  // a fork has none of the threads: there is nobody to wait for
    for (std::thread& t : threads_) t.detach();
    return;
  }
  dismiss();
}

DEM_INLINE void Team::run(std::size_t n, int members, Piece piece, void* work) {
  const Help::Time called = Help::Clock::now();
  if (!help_.is_worth_it(called)) {
    for (std::size_t k = 0; k < n; ++k) piece(work, k, 0);
    return;
  }
  const auto m = static_cast<std::size_t>(members);
  for (std::size_t k = 0; k < m; ++k) {
    ranges_[k].next.store(n * k / m, std::memory_order_relaxed);
    ranges_[k].end = n * (k + 1) / m;
    ranges_[k].share = {};
  }
  members_ = members;
  piece_ = piece;
  work_ = work;
  call();
  take_part(0);
  // All pieces are taken. Who has not begun need not, and the others end theirs.
  std::uint32_t inside = gate_.fetch_and(~open) & ~open;
  for (int waited = 0; inside != 0; inside = gate_.load()) {
    if (++waited < busy_waits_) {
      pause();
    } else {
      gate_.wait(inside);
    }
  }
  if (busy_waits_ > 0) keep_account(called);
}

DEM_INLINE double Team::processor_time() {
  timespec t{};
  static const clockid_t clock = [&] {
    const bool is_fine = clock_getres(CLOCK_THREAD_CPUTIME_ID, &t) == 0 && seconds(t) < 1e-5 &&
                         clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) == 0;
    return is_fine ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
  }();
  clock_gettime(clock, &t);
  return seconds(t);
}

DEM_INLINE void Team::keep_account(Help::Time called) {
  const Share& own = ranges_[0].share;
  if (own.pieces == 0) return;  // it is not known how long one takes
  double saved = 0.0;
  for (int k = 1; k < members_; ++k) saved += Help::saved_by(ranges_[static_cast<std::size_t>(k)].share, own);
  const Help::Time now = Help::Clock::now();
  const double took = std::chrono::duration<double>(now - called).count();
  help_.account(saved, std::max(0.0, took - own.seconds), now);
}

DEM_INLINE void Team::pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

DEM_INLINE void Team::dismiss() {
  stop_ = true;
  call();
  for (std::thread& t : threads_) t.join();
}

DEM_INLINE void Team::call() {
  gate_.store(open);
  call_.fetch_add(1);
  call_.notify_all();
}

DEM_INLINE void Team::take_part(int member) {
  const double began = processor_time();
  std::size_t done = 0;
  const int members = members_;
  for (int k = 0; k < members; ++k) {
    Range& range = ranges_[static_cast<std::size_t>((member + k) % members)];
    // Looked at first: adding to what is used up already would only take it from others' caches.
    while (range.next.load(std::memory_order_relaxed) < range.end) {
      const std::size_t piece = range.next.fetch_add(1, std::memory_order_relaxed);
      if (piece < range.end) piece_(work_, piece, member), ++done;
    }
  }
  ranges_[static_cast<std::size_t>(member)].share = {done, processor_time() - began};
}

DEM_INLINE void Team::serve(int member) {
  use_all_places();
  for (std::uint32_t seen = 0;;) {
    int waited = 0;
    while (call_.load() == seen) {
      if (++waited < busy_waits_) {
        pause();
      } else {
        call_.wait(seen);
      }
    }
    seen = call_.load();
    if (stop_) return;
    if (member >= members_.load()) continue;
    // In through the gate, if it is still open.
    std::uint32_t gate = gate_.load();
    while ((gate & open) != 0 && !gate_.compare_exchange_weak(gate, gate + 1)) {
    }
    if ((gate & open) == 0) continue;
    take_part(member);
    if (gate_.fetch_sub(1) == 1) gate_.notify_all();
  }
}

}  // namespace dem::exec

#endif
