#pragma once

#include <dem/core/error.hpp>

#include <filesystem>
#include <regex>
#include <string>
#include <system_error>
#include <vector>

namespace direct_shear {

namespace detail {

inline void remove_matches(const std::filesystem::path& folder, const std::regex& names) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool is_file = entry.is_regular_file() && !entry.is_symlink();
    if (is_file && std::regex_match(entry.path().filename().string(), names)) found.push_back(entry.path());
  }
  for (const auto& path : found) {
    std::error_code error;
    if (!std::filesystem::remove(path, error)) {
      dem::fail("cannot remove '{}', which an earlier run left ({}); choose another --output", path.string(),
                error.message());
    }
  }
}

}  // namespace detail

/// Removes the results that an earlier run has left in its output folder, so that they are not taken for those of the
/// next one: the files that runs name, and their folders of frames once these are empty. All else stays, also packings
/// and settings.toml, which a run may be given. Throws dem::Error.
inline void remove_old_results(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(folder)) return;
  static const std::string load = "load_[0-9]+\\.[0-9]kPa";
  static const std::regex results("results\\.csv|report\\.html|" + load + "\\.(csv|pvd)|" +
                                  "(shear_stress|dilation|mohr_coulomb)\\.(gp|svg|png)");
  static const std::regex frames("(grains|boxes|spheres|superquadrics|polyhedra)_[0-9]{6,}\\.vtp");
  static const std::regex frame_folder(load);
  detail::remove_matches(folder, results);
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const bool is_folder = entry.is_directory() && !entry.is_symlink();
    if (is_folder && std::regex_match(entry.path().filename().string(), frame_folder)) folders.push_back(entry.path());
  }
  for (const auto& path : folders) {
    detail::remove_matches(path, frames);
    std::error_code ignored;
    if (fs::is_empty(path, ignored)) fs::remove(path, ignored);
  }
}

}  // namespace direct_shear
