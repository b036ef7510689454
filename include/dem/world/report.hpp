#pragma once

#include <dem/core/compiled.hpp>
#include <dem/core/ids.hpp>

#include <cstdint>
#include <string>

namespace dem {

/// How a step or a run ended. Converts to true if all is well; otherwise `text` says which grain or body, when, and
/// which setting to change.
struct StepReport {
  enum class Problem { none, not_finite, lost, overlap, machine, joint };

  Problem problem = Problem::none;
  double time = 0.0;       ///< s, at which it was found
  std::uint64_t step = 0;  ///< steps done
  GrainId grain;           ///< the grain, if it is one
  std::string text;
  std::string note;  ///< what of what was given was changed, or could not be done, in words; empty if nothing

  explicit operator bool() const { return problem == Problem::none; }
  /// Says that, too; nothing where it is empty.
  void add_note(const std::string& more);
};

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE void StepReport::add_note(const std::string& more) {
  if (!note.empty() && !more.empty()) note += ' ';
  note += more;
}

}  // namespace dem

#endif
