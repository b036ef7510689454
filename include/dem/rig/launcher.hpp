#pragma once
// Programs that mpirun has started, though their processes know nothing of each other.

#include <dem/core/output.hpp>
#include <dem/core/text.hpp>
#include <dem/rig/tell.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace dem::rig {

/// Whether main() has a MpiSession, so that the program can be built to run on ranks.
inline bool can_have_ranks = false;

namespace detail {

/// A whole number that a launcher of MPI (mpirun, mpiexec) leaves in the environment; `otherwise` without one.
inline int left_by_launcher(const char* of_open_mpi, const char* of_others, int otherwise) {
  for (const char* name : {of_open_mpi, of_others}) {
    if (const char* value = std::getenv(name)) return std::atoi(value);
  }
  return otherwise;
}

/// Why this program, whose path is `path`, is not to run as one of several that a launcher started; empty if it may.
/// Each would be the whole run, in the same folder.
inline std::string why_not_launched([[maybe_unused]] const std::string& path) {
  const int launched = left_by_launcher("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", 1);
  if (launched <= 1 || processes.count > 1) return {};
#if defined(DEM_ON_RANKS)
  const std::string what = "does not know of the others: it was linked with another MPI than that of mpirun";
#else
  const std::string target = path.substr(path.rfind('/') + 1) + "_on_ranks";
  const std::string what = can_have_ranks
                               ? "was built without ranks; build and run the target " + target
                               : "runs on one process, as its processes would not share their work; leave out mpirun";
#endif
  return text("mpirun started {} processes, but this program {}", launched, what);
}

/// Of processes that were launched, but do not know of each other, one speaks.
inline bool is_first_launched() { return left_by_launcher("OMPI_COMM_WORLD_RANK", "PMI_RANK", 0) == 0; }

}  // namespace detail

/// Whether this program, whose path is `path`, may run; says why where it may not.
inline bool may_run(const std::string& name, const std::string& path) {
  const std::string why = detail::why_not_launched(path);
  if (!why.empty() && detail::is_first_launched()) tell(stderr, "{}: {}\n", name, why);
  return why.empty();
}

}  // namespace dem::rig
