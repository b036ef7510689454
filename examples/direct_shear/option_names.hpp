#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace direct_shear {

/// What the library says, in the names that this program's user knows: the library speaks of fields that its caller
/// sets, which are options here or are not to be had.
inline std::string in_options(std::string text) {
  // A name that another one ends with comes after it.
  static constexpr std::pair<std::string_view, std::string_view> names[] = {
      {"allow_unstable_time_step", "--allow-unstable-time-step"},
      {"time_step_safety", "--stable-share"},
      {"time_step", "--time-step"},
      {"overlap_limit", "--overlap-limit"},
      {"save_packing", "--save-packing"},
      {"raise the normal stiffness", "raise --stiffness"},
      {"the stiffness, or raise the damping", "--stiffness, or raise --damping"},
      {"close the walls, ", ""},
      {", or enlarge domain", ""},
      {"raise machine().substeps", "lower --stiffness"},
  };
  for (const auto& [from, to] : names) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  }
  return text;
}

}  // namespace direct_shear
