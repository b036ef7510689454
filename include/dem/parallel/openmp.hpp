#pragma once

#include <dem/core/error.hpp>
#include <dem/parallel/executor.hpp>

#include <algorithm>
#include <exception>

#if defined(_OPENMP)
#include <omp.h>
#if __has_include(<pthread.h>)
#include <pthread.h>
#endif
#endif

namespace dem::exec {

#if defined(_OPENMP)
namespace detail {

/// Whether this process was forked from one that had run on several threads. The fork has none of them, and GNU's
/// OpenMP would wait for them for ever.
inline bool is_without_threads = false;

/// To be called before the first work on several threads.
inline void watch_for_forks() {
#if __has_include(<pthread.h>)
  [[maybe_unused]] static const int once = ::pthread_atfork(nullptr, nullptr, [] { is_without_threads = true; });
#endif
}

}  // namespace detail
#endif

/// OpenMP's threads, for programs that use OpenMP themselves and want no others; runs on one thread when the compiler
/// has no OpenMP. Its threads have equal shares and busy-wait for work, unless OMP_WAIT_POLICY=passive: exec::Threads
/// is the better choice where other programs run. Unless a number is set, it uses as many threads as OpenMP offers, but
/// gives each at least a few pieces of work: waking a thread costs more than a small piece.
///
/// An exception of a piece is thrown on when the others are done; of several, that of the lowest piece.
///
/// A process that is forked after work on several threads goes on with one (POSIX): the results are the same. What else
/// uses OpenMP in such a process may hang, as GNU's OpenMP does not outlive a fork.
class OpenMP {
 public:
  int threads() const { return threads_; }
  /// Exactly n threads. Throws Error unless n >= 1.
  void set_threads(int n) {
    if (n < 1) fail("number of threads is {}, but must be at least 1", n);
    threads_ = n;
    least_pieces_ = 1;
  }

  template <class F>
  void for_each(std::size_t n, F&& f) const {
    const auto count = static_cast<std::ptrdiff_t>(n);
#if defined(_OPENMP)
    const int team = static_cast<int>(std::min<std::ptrdiff_t>(threads_, count / least_pieces_));
    if (team > 1 && !detail::is_without_threads) {
      detail::watch_for_forks();
      Thrown thrown;
#pragma omp parallel for schedule(static) num_threads(team)
      for (std::ptrdiff_t k = 0; k < count; ++k) {
        try {
          call_piece(f, static_cast<std::size_t>(k), omp_get_thread_num());
        } catch (...) {  // an exception must not leave a thread of OpenMP
          thrown.keep(k);
        }
      }
      if (thrown.first) std::rethrow_exception(thrown.first);
      return;
    }
#endif
    for (std::ptrdiff_t k = 0; k < count; ++k) call_piece(f, static_cast<std::size_t>(k), 0);
  }

 private:
#if defined(_OPENMP)
  /// The exception of the lowest piece, whichever thread comes to it first.
  struct Thrown {
    std::exception_ptr first;
    std::ptrdiff_t piece = 0;
    void keep(std::ptrdiff_t k) {
#pragma omp critical(dem_thrown)
      if (!first || k < piece) {
        first = std::current_exception();
        piece = k;
      }
    }
  };

  int threads_ = omp_get_max_threads();
#else
  int threads_ = 1;
#endif
  std::ptrdiff_t least_pieces_ = 4;
};

}  // namespace dem::exec
