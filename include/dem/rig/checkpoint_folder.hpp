#pragma once
// The folder in which a run keeps what it can go on from: a file for each of its parts.

#include <dem/core/output.hpp>
#include <dem/core/version.hpp>
#include <dem/io/duration.hpp>
#include <dem/io/file.hpp>
#include <dem/rig/part.hpp>
#include <dem/rig/settings_file.hpp>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <vector>

namespace dem::rig {

/// Reading and writing columns in files. hdf5_checkpoints.hpp has them; programs without HDF5 have none.
struct CheckpointFiles {
  void (*write)(const std::filesystem::path&, const io::StateColumns&) = nullptr;
  io::StateColumns (*read)(const std::filesystem::path&) = nullptr;
  void (*check)(const std::filesystem::path&) = nullptr;  ///< throws Error for one that is damaged
};

/// How a run is kept and gone on with.
struct CheckpointOptions {
  double every = 0.0;   ///< s of wall time between two files of a part; 0: none are written
  bool resume = false;  ///< go on with the run in the output folder
  CheckpointFiles files = {};
  std::vector<std::string> free_settings = {};  ///< those that may change between stop and resume
  /// What to do in place of going on with a run that has ended.
  std::string when_ended = "leave out --resume to begin it anew, which replaces its results";
};

/// The parts of one run in `<output>/checkpoint`. Parts of several threads may be written at the same time.
class CheckpointFolder final : public PartStore {
 public:
  static constexpr const char* folder_name = "checkpoint";

  CheckpointFolder(std::string program, const std::filesystem::path& output, std::string settings,
                   CheckpointOptions options)
      : program_(std::move(program)),
        output_(output.string()),
        folder_(output / folder_name),
        settings_(std::move(settings)),
        options_(std::move(options)) {}

  [[nodiscard]] bool is_on() const override { return options_.every > 0.0 || options_.resume; }
  [[nodiscard]] bool writes() const override { return options_.every > 0.0; }
  [[nodiscard]] bool resumes() const { return options_.resume; }

  /// Throws Error unless a run has begun in the folder.
  void require_begun() const {
    if (!std::filesystem::exists(std::filesystem::path(output_) / "settings.toml")) {
      fail("there is no run in '{}' to go on with; leave out --resume to begin one", output_);
    }
  }

  /// Throws Error unless the run in the folder can be gone on with: it has the same settings, and its files are whole.
  /// A run that was killed before the first of them is begun anew.
  void check() const {
    require_begun();
    require_same_settings(io::read_file(std::filesystem::path(output_) / "settings.toml"), settings_,
                          options_.free_settings, output_);
    const auto files = parts();
    if (files.empty() && std::filesystem::exists(std::filesystem::path(output_) / "report.html")) {
      fail("the run in '{}' has ended, or kept nothing that it could go on from (see --checkpoint-every); {}", output_,
           options_.when_ended);
    }
    const std::lock_guard lock(mutex_);
    for (const auto& file : files) {
      try {
        options_.files.check(file);
      } catch (const Error& problem) {
        fail("{}, or remove it to begin that part of the run anew", problem.what());
      }
    }
  }

  /// Removes what an earlier run has left, or this one when it has ended. Other files in the folder stay.
  void clear() const {
    if (!process_writes_files) return;
    std::error_code ignored;
    for (const auto& file : parts(".h5.tmp")) std::filesystem::remove(file, ignored);
    for (const auto& file : parts()) {
      if (!std::filesystem::remove(file, ignored)) fail("cannot remove '{}'; choose another --output", file.string());
    }
    if (std::filesystem::is_empty(folder_, ignored)) std::filesystem::remove(folder_, ignored);
  }
  /// The files of parts, sorted.
  [[nodiscard]] std::vector<std::filesystem::path> parts(const char* ending = ".h5") const {
    std::vector<std::filesystem::path> found;
    if (!std::filesystem::is_directory(folder_)) return found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      if (entry.path().filename().string().ends_with(ending)) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  bool is_due(double& last) override {
    if (!writes()) return false;
    const double now = io::steady_seconds();
    if (processes.of_first(now - std::max(last, start_) < options_.every)) return false;
    last = now;
    return true;
  }

  io::StateColumns read(const std::string& part) override {
    const auto path = path_of(part);
    if (!options_.resume || !std::filesystem::exists(path)) return {};
    const std::lock_guard lock(mutex_);
    io::StateColumns columns = options_.files.read(path);
    std::string program, version, settings;
    double wall_time = 0.0;
    try {
      io::Fields v(io::Fields::Task::restore, columns);
      fields(v, program, version, settings, wall_time);
      if (program != program_) fail("it is of the program {}, not {}", program, program_);
      if (version != DEM_VERSION_STRING) {
        fail("it is of version {} of dem, but this is {}, whose results may differ", version, DEM_VERSION_STRING);
      }
      require_same_settings(settings, settings_, options_.free_settings, output_);
    } catch (const Error& problem) {
      fail("cannot go on from '{}': {}", path.string(), problem.what());
    }
    earlier_ = std::max(earlier_, wall_time);
    std::erase_if(columns, [](const auto& column) { return column.first.starts_with("rig/run/"); });
    return columns;
  }

  std::string write(const std::string& part, io::StateColumns& columns) override {
    if (!writes() || !process_writes_files) return "";  // nothing is to be kept of a run that just goes on
    const std::lock_guard lock(mutex_);
    io::StateColumns own;
    io::Fields v(io::Fields::Task::collect, own);
    std::string version = DEM_VERSION_STRING;
    double wall = wall_time();
    fields(v, program_, version, settings_, wall);
    columns.merge(own);
    try {
      options_.files.write(path_of(part), columns);
    } catch (const Error& problem) {
      return problem.what();
    }
    return "";
  }

  /// s, since the run began, without the time that it was stopped for.
  [[nodiscard]] double wall_time() const { return earlier_ + io::steady_seconds() - start_; }
  void start() { start_ = io::steady_seconds(); }

 private:
  [[nodiscard]] std::filesystem::path path_of(const std::string& part) const { return folder_ / (part + ".h5"); }
  static void fields(io::Fields& v, std::string& program, std::string& version, std::string& settings, double& wall) {
    v.group("rig/run",
            [&] { v("program", program), v("version", version), v("settings", settings), v("wall_time", wall, "s"); });
  }

  std::string program_, output_;
  std::filesystem::path folder_;
  std::string settings_;
  CheckpointOptions options_;
  double start_ = io::steady_seconds(), earlier_ = 0.0;
  static inline std::mutex mutex_;  // of all folders: HDF5 as Debian has it is not for several threads
};

}  // namespace dem::rig
