#pragma once

#include <dem/core/macros.hpp>
#include <dem/parallel/executor.hpp>

#include <cstddef>
#include <memory>

namespace dem::exec {

class Team;

/// Threads of its own, that share the work as it comes and sleep when there is none. The other programs of a machine
/// hardly slow it down, nor does it them. Unless a number is set, it uses as many threads as OpenMP offers (so
/// OMP_NUM_THREADS counts; one in a parallel region of the program; without OpenMP, as many as the machine has
/// processors), but gives each at least a few pieces of work: waking a thread costs more than a small piece.
///
/// An exception of a piece is thrown on when the others are done; of several, that of the lowest piece. A piece that
/// calls for_each itself runs the inner one alone. A copy makes threads of its own.
class Threads {
 public:
  Threads();
  Threads(const Threads& other);
  Threads& operator=(const Threads& other);
  Threads(Threads&&) noexcept;
  Threads& operator=(Threads&&) noexcept;
  ~Threads();

  int threads() const { return threads_; }
  /// Exactly n threads. Throws Error unless n >= 1. They start with the first work; where the system has none left,
  /// for_each throws Error.
  void set_threads(int n);

  template <class F>
  void for_each(std::size_t n, F&& f) {
    auto* const piece = std::addressof(f);
    const auto call = [](const void* work, std::size_t k, int thread) {
      call_piece(**static_cast<decltype(piece)*>(work), k, thread);
    };
    run(n, call, &piece);
  }

 private:
  struct Work;

  /// Calls call(work, piece, thread) for 0 ... n-1.
  void run(std::size_t n, void (*call)(const void* work, std::size_t piece, int thread), const void* work);

  int threads_;
  std::size_t least_pieces_ = 4;
  bool busy_ = false;  // within a for_each
  std::unique_ptr<Team> team_;
};

}  // namespace dem::exec

#if DEM_DEFINES
#include <dem/core/error.hpp>
#include <dem/parallel/team.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#if defined(_OPENMP)
#include <omp.h>
#endif

namespace dem::exec {

namespace detail {
inline int offered_threads() {
#if defined(_OPENMP)
  // Each thread of an OpenMP region that makes a world has it alone: its siblings have the other processors.
  return omp_in_parallel() ? 1 : omp_get_max_threads();
#else
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
#endif
}
}  // namespace detail

/// The work of one for_each, which its threads share.
struct Threads::Work {
  void (*call)(const void*, std::size_t, int);
  const void* work;
  std::exception_ptr exception = nullptr;  // of the lowest piece, whichever thread comes to it first
  std::size_t thrown_by = 0;
  std::atomic_flag taken = {};

  static void call_piece(void* shared, std::size_t piece, int thread) {
    auto& w = *static_cast<Work*>(shared);
    try {
      w.call(w.work, piece, thread);
    } catch (...) {
      w.keep(piece);
    }
  }
  DEM_SETUP void keep(std::size_t piece) {
    while (taken.test_and_set(std::memory_order_acquire)) {
    }
    if (!exception || piece < thrown_by) {
      exception = std::current_exception();
      thrown_by = piece;
    }
    taken.clear(std::memory_order_release);
  }
};

DEM_INLINE Threads::Threads() : threads_(detail::offered_threads()) {}
DEM_INLINE Threads::Threads(const Threads& other) : threads_(other.threads_), least_pieces_(other.least_pieces_) {}
DEM_INLINE Threads::Threads(Threads&&) noexcept = default;
DEM_INLINE Threads& Threads::operator=(Threads&&) noexcept = default;
DEM_INLINE Threads::~Threads() = default;

DEM_INLINE Threads& Threads::operator=(const Threads& other) {
  if (threads_ != other.threads_) team_.reset();
  threads_ = other.threads_;
  least_pieces_ = other.least_pieces_;
  return *this;
}

DEM_INLINE void Threads::set_threads(int n) {
  if (n < 1) fail("number of threads is {}, but must be at least 1", n);
  if (n != threads_) team_.reset();
  threads_ = n;
  least_pieces_ = 1;
}

DEM_INLINE void Threads::run(std::size_t n, void (*call)(const void*, std::size_t, int), const void* work) {
  const auto members = static_cast<int>(std::min(static_cast<std::size_t>(threads_), n / least_pieces_));
  if (members < 2 || busy_) {
    for (std::size_t k = 0; k < n; ++k) call(work, k, 0);
    return;
  }
  if (!team_ || team_->size() < members || !team_->is_of_this_process()) {
    team_.reset();  // its threads end before those of the larger one start
    team_ = std::make_unique<Team>(members);
  }
  Work shared{call, work};
  busy_ = true;
  team_->run(n, members, &Work::call_piece, &shared);
  busy_ = false;
  if (shared.exception) std::rethrow_exception(shared.exception);
}

}  // namespace dem::exec

#endif
