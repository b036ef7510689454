#pragma once
// What a machine can do: threads, memory and steps (POSIX).

#include <dem/core/error.hpp>
#include <dem/core/output.hpp>

#include <omp.h>

#include <algorithm>
#include <cstdint>

#include <unistd.h>

namespace dem::rig {

/// All threads that there are (OMP_NUM_THREADS counts), but not more than one for each 1000 grains.
inline int threads_for(std::uint64_t grains) {
  const int most = std::max(1, omp_get_max_threads());
  const int share = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN)) / processes.here;  // of a machine's processors
  const auto all = static_cast<std::uint64_t>(processes.here > 1 ? std::clamp(share, 1, most) : most);
  return static_cast<int>(std::clamp<std::uint64_t>(grains / 1000, 1, all));
}

/// Throws Error, with `what_to_change`, if more memory (bytes, of each process) is needed than the machine has. `what`
/// is what takes it.
inline void require_memory(double bytes, const char* what, const char* what_to_change) {
  const double there = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
  bytes *= processes.here;
  if (bytes <= there) return;
  fail("{} need some {:.3g} GB of memory, but this machine has {:.3g} GB; {}", what, 1e-9 * bytes, 1e-9 * there,
       what_to_change);
}

/// Throws Error, with `what_to_change`, if a time (s) takes more steps than anybody can wait for: 10^10, a week of
/// steps of 60 microseconds.
inline void require_steps(double duration, double time_step, const char* what, const char* what_to_change) {
  constexpr double most = 1e10;
  if (duration / time_step <= most) return;
  fail("{} takes {:.3g} s, which are {:.3g} steps of {:.3g} s, but there may be {:g} at most; {}", what, duration,
       duration / time_step, time_step, most, what_to_change);
}

}  // namespace dem::rig
