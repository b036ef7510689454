#pragma once

#include <dem/core/output.hpp>
#include <dem/rig/tell.hpp>

#include <cstdio>
#include <string>

namespace dem::rig {

/// Says what went wrong, and returns the code that main() returns. Of several processes one says it for all, if all
/// come here; else others wait for this one, and it ends them.
inline int fail_with(int code, const std::string& words) {
  const bool all = processes.all_come();
  if (!all) tell(stderr, "rank {} of {}: {}\n", processes.rank, processes.count, words);
  else if (processes.rank == 0) tell(stderr, "{}\n", words);
  if (!all) processes.end(code);
  return code;
}

}  // namespace dem::rig
