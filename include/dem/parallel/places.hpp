#pragma once

// Which processors the threads of a team may use.

#include <dem/core/macros.hpp>

#if defined(_OPENMP) && _OPENMP >= 201511 && defined(__linux__)

namespace dem::exec {

/// Lets the calling thread use all of OpenMP's places. Where these are bound (OMP_PROC_BIND, OMP_PLACES), OpenMP holds
/// the first thread of a program in one of them, and the threads that it starts inherit that: a whole team on one
/// processor. A thread that the program bound itself counts as bound by OpenMP then. Where OpenMP binds nothing,
/// nothing is changed.
void use_all_places();

}  // namespace dem::exec

#if DEM_DEFINES

#include <omp.h>
#include <sched.h>

#include <vector>

namespace dem::exec {

DEM_INLINE void use_all_places() {
  if (omp_get_proc_bind() == omp_proc_bind_false) return;
  cpu_set_t processors;
  CPU_ZERO(&processors);
  std::vector<int> of_place;
  for (int place = 0; place < omp_get_num_places(); ++place) {
    of_place.resize(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, of_place.data());
    for (const int p : of_place) {
      if (p >= 0 && p < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(p), &processors);
    }
  }
  if (CPU_COUNT(&processors) > 0) (void)sched_setaffinity(0, sizeof(processors), &processors);
}

}  // namespace dem::exec

#endif

#else

namespace dem::exec {

inline void use_all_places() {}

}  // namespace dem::exec

#endif
