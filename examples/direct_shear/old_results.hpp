#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

namespace direct_shear {

namespace detail {

/// What is called so in a folder, sorted; links are not followed.
inline std::vector<std::filesystem::path> matches(const std::filesystem::path& folder, const std::regex& names,
                                                  std::filesystem::file_type type) {
  std::vector<std::filesystem::path> found;
  if (!std::filesystem::is_directory(folder)) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.symlink_status().type() != type) continue;
    if (std::regex_match(entry.path().filename().string(), names)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline void remove(const std::vector<std::filesystem::path>& files) {
  for (const auto& path : files) {
    std::error_code error;
    if (!std::filesystem::remove(path, error)) {
      dem::fail("cannot remove '{}', which an earlier run left ({}); choose another --output", path.string(),
                error.message());
    }
  }
}

inline const std::string load = "load_[0-9]+\\.[0-9]kPa";

}  // namespace detail

/// The files that a run names and leaves in its output folder, but for frames, which are in folders of their own.
inline std::vector<std::filesystem::path> find_old_results(const std::filesystem::path& folder) {
  static const std::regex results("results\\.csv|report\\.html|" + detail::load + "\\.(csv|pvd)|" +
                                  "(shear_stress|dilation|mohr_coulomb)\\.(gp|svg|png)");
  return detail::matches(folder, results, std::filesystem::file_type::regular);
}

/// Removes the results that an earlier run has left in its output folder, so that they are not taken for those of the
/// next one: the files that runs name, and their folders of frames once these are empty. All else stays, also packings
/// and settings.toml, which a run may be given. Throws dem::Error.
inline void remove_old_results(const std::filesystem::path& folder) {
  using std::filesystem::file_type;
  static const std::regex frames("(grains|boxes|spheres|superquadrics|polyhedra)_[0-9]{6,}\\.vtp");
  detail::remove(find_old_results(folder));
  for (const auto& path : detail::matches(folder, std::regex(detail::load), file_type::directory)) {
    detail::remove(detail::matches(path, frames, file_type::regular));
    std::error_code ignored;
    if (std::filesystem::is_empty(path, ignored)) std::filesystem::remove(path, ignored);
  }
}

}  // namespace direct_shear
