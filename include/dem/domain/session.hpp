#pragma once

// One program on several processes (MPI: link dem::mpi). Programs include <dem/domain/ranks.hpp>.

#include <dem/core/error.hpp>
#include <dem/core/output.hpp>
#include <dem/domain/call.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#ifndef OMPI_SKIP_MPICXX
#define OMPI_SKIP_MPICXX 1  // the C interface is enough
#endif
#include <mpi.h>

namespace dem::domain {

namespace detail {

inline int rank_of_process() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}
inline int count_of_ranks() {
  int count = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}
/// Of them on this machine.
inline int count_of_ranks_here() {
  MPI_Comm machine;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int here = 1;
  MPI_Comm_size(machine, &here);
  MPI_Comm_free(&machine);
  return here;
}
/// The reduction with which each call begins that ranks make together.
inline CallNumbers compare_calls(Call call, const CallHashes& hashes = {}) {
  CallNumbers numbers(call, rank_of_process(), hashes);
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  return numbers;
}
/// Throws Error, on every rank, unless all are in this call.
inline void require_same_call(Call call) {
  if (const std::string difference = compare_calls(call).difference(); !difference.empty()) throw Error(difference);
}
inline bool any_rank(bool yes) {
  require_same_call(Call::decide);
  int mine = yes ? 1 : 0, any = mine;
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return any != 0;
}
inline int of_first_rank(int value) {
  require_same_call(Call::decide);
  MPI_Bcast(&value, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return value;
}
/// Apart from all other messages, which may be under way.
inline MPI_Comm meeting = MPI_COMM_NULL;
inline bool all_ranks_come() {
  MPI_Request all;
  MPI_Ibarrier(meeting, &all);
  int came = 0;
  for (const double start = MPI_Wtime(); came == 0 && MPI_Wtime() - start < 15.0;) {
    MPI_Test(&all, &came, MPI_STATUS_IGNORE);
    if (came == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return came != 0;
}
/// The exception that is under way, in words.
inline void print_exception(const char* where) {
  std::fflush(stdout);
  try {
    throw;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "rank %d of %d, %s: %s\n", rank_of_process(), count_of_ranks(), where, e.what());
  } catch (...) {
    std::fprintf(stderr, "rank %d of %d, %s: an exception that is no std::exception\n", rank_of_process(),
                 count_of_ranks(), where);
  }
  std::fflush(stderr);
}
/// Nobody catches the exception: all ranks end, as the others would wait for this one for ever.
[[noreturn]] inline void end_all_ranks() {
  if (std::current_exception()) print_exception("no one caught");
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

}  // namespace detail

/// What makes a program one of several ranks. Make one at the start of main(), before any world, and let it live to the
/// end:
///
///     int main(int argc, char** argv) {
///       dem::domain::Session mpi(argc, argv);
///       ...
///     }
///
///     mpirun -np 4 ./program
///
/// All ranks run the whole program. What it prints and the files that it writes through this library come from rank 0
/// alone: standard output of the others goes nowhere. Standard error stays. Without mpirun there is one rank.
///
/// An exception that leaves main() or a step ends all ranks, in words. So does one that is caught and ends main().
/// Where a rank makes another call than the others, of those that ranks make together (domain/ranks.hpp), all throw
/// Error.
class Session {
 public:
  /// Throws Error where there is a Session already.
  Session(int& argc, char**& argv) : unwinding_(std::uncaught_exceptions()) {
    int is_running = 0;
    MPI_Initialized(&is_running);
    if (is_running)
      fail("a program has one domain::Session, and MPI runs already; make it once, at the start of main()");
    int offered = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &offered);
    rank_ = detail::rank_of_process();
    ranks_ = detail::count_of_ranks();
    process_writes_files = rank_ == 0;
    if (rank_ != 0) {
      std::fflush(stdout);
      const int nowhere = ::open("/dev/null", O_WRONLY);
      if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO), ::close(nowhere);
    }
    if (ranks_ == 1) return;
    std::set_terminate(detail::end_all_ranks);
    MPI_Comm_dup(MPI_COMM_WORLD, &detail::meeting);
    processes = {.rank = rank_,
                 .count = ranks_,
                 .here = detail::count_of_ranks_here(),
                 .any = detail::any_rank,
                 .of_first = detail::of_first_rank,
                 .all_come = detail::all_ranks_come,
                 .end = [](int code) { MPI_Abort(MPI_COMM_WORLD, code); }};
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    // An exception passes. Who catches it has something to say; mpirun ends the others when this process ends.
    if (std::uncaught_exceptions() > unwinding_) return;
    processes = {};
    if (ranks_ > 1) end_together();
    MPI_Finalize();
  }

  int rank() const { return rank_; }
  int ranks() const { return ranks_; }
  /// Whether this is the rank that prints and writes.
  bool is_root() const { return rank_ == 0; }

 private:
  /// Others that run on would wait for this rank for ever.
  void end_together() const {
    const std::string difference = detail::compare_calls(Call::end).difference();
    if (difference.empty()) return;
    std::fflush(stdout);
    std::fprintf(stderr, "rank %d of %d: %s\n", rank_, ranks_, difference.c_str());
    std::fflush(stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }

  int rank_ = 0, ranks_ = 1, unwinding_;
};

}  // namespace dem::domain
