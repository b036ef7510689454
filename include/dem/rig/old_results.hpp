#pragma once
// Results that an earlier run has left in its folder.

#include <dem/core/error.hpp>
#include <dem/rig/file_names.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace dem::rig {

/// What the files of a rig are called, as patterns (see matches()), besides report.html and settings.toml.
struct ResultNames {
  std::vector<std::string> files = {};   ///< "results.csv"; beside a "load_#+.pvd" frames may be in a folder "load_#+"
  std::vector<std::string> plots = {};   ///< "shear_stress", of which there may be .gp, .svg and .png
  std::vector<std::string> frames = {};  ///< parts of the frames: "grains"
};

namespace detail {

inline bool is_result(std::string_view name, const ResultNames& names) {
  if (name.ends_with(".tmp")) name.remove_suffix(4);  // of a run that was killed while it wrote
  const auto is_plot = [&](const std::string& plot) {
    return matches(name, plot + ".gp") || matches(name, plot + ".svg") || matches(name, plot + ".png");
  };
  return name == "report.html" || std::any_of(names.plots.begin(), names.plots.end(), is_plot) ||
         std::any_of(names.files.begin(), names.files.end(), [&](const auto& p) { return matches(name, p); });
}

inline bool is_frame_folder(std::string_view name, const ResultNames& names) {
  return std::any_of(names.files.begin(), names.files.end(), [&](const std::string& p) {
    return p.ends_with(".pvd") && matches(name, std::string_view(p).substr(0, p.size() - 4));
  });
}

inline bool is_frame(std::string_view name, const ResultNames& names) {
  if (name.ends_with(".tmp")) name.remove_suffix(4);
  return std::any_of(names.frames.begin(), names.frames.end(), [&](const std::string& part) {
    return matches(name, part + "_######.vtp") || matches(name, part + "_#######+.vtp");
  });
}

/// What is of this type and called so in a folder, sorted; links are not followed.
template <class Called>
std::vector<std::filesystem::path> find(const std::filesystem::path& folder, std::filesystem::file_type type,
                                        Called&& called) {
  std::vector<std::filesystem::path> found;
  if (!std::filesystem::is_directory(folder)) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.symlink_status().type() == type && called(entry.path().filename().string()))
      found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline void remove(const std::vector<std::filesystem::path>& files) {
  for (const auto& path : files) {
    std::error_code error;
    if (!std::filesystem::remove(path, error)) {
      fail("cannot remove '{}', which an earlier run left ({}); choose another --output", path.string(),
           error.message());
    }
  }
}

}  // namespace detail

/// The results in a folder, sorted, but for frames, which are in folders of their own.
inline std::vector<std::filesystem::path> find_old_results(const std::filesystem::path& folder,
                                                           const ResultNames& names) {
  return detail::find(folder, std::filesystem::file_type::regular,
                      [&](const std::string& name) { return detail::is_result(name, names); });
}

/// Removes the results that an earlier run has left in its output folder, so that they are not taken for those of the
/// next one: the files that runs name, and their folders of frames once these are empty. All else stays. Throws Error.
inline void remove_old_results(const std::filesystem::path& folder, const ResultNames& names) {
  using std::filesystem::file_type;
  detail::remove(find_old_results(folder, names));
  const auto folders = detail::find(folder, file_type::directory,
                                    [&](const std::string& name) { return detail::is_frame_folder(name, names); });
  for (const auto& path : folders) {
    detail::remove(
        detail::find(path, file_type::regular, [&](const std::string& name) { return detail::is_frame(name, names); }));
    std::error_code ignored;
    if (std::filesystem::is_empty(path, ignored)) std::filesystem::remove(path, ignored);
  }
}

/// Whether a run whose results lie in `folder` may write or remove a file at `path`, or keeps its settings or its lock
/// there. However the two paths are written.
inline bool is_own_file(const std::filesystem::path& path, const std::filesystem::path& folder,
                        const ResultNames& names) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path file = fs::weakly_canonical(fs::absolute(path, ignored), ignored),
                 home = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder, ignored), ignored) / "";
  const std::string name = file.filename().string();
  if (file.parent_path() / "" == home) {
    return detail::is_result(name, names) || matches(name, "settings.toml") || matches(name, "settings.toml.tmp") ||
           matches(name, "run.lock");
  }
  return file.parent_path().parent_path() / "" == home && detail::is_frame(name, names) &&
         detail::is_frame_folder(file.parent_path().filename().string(), names);
}

/// Throws Error if a file that a run starts from is one that it would remove. `option` is what names it.
inline void require_not_own(const std::filesystem::path& file, const char* option, const std::filesystem::path& folder,
                            const ResultNames& names) {
  if (file.empty() || !is_own_file(file, folder, names)) return;
  fail("{} is '{}', which the run replaces by a result of its own; copy it, or give another --output", option,
       file.string());
}

}  // namespace dem::rig
