#pragma once
// Where a bed is kept: with the other parts of its run, and in files of its own that other runs start from.

#include <dem/rig/bed/bed_file.hpp>
#include <dem/rig/option_text.hpp>
#include <dem/rig/session.hpp>

#include <algorithm>
#include <optional>
#include <string>

namespace dem::rig {

/// Keeps the part of a run that makes its bed. A file that ends in .h5 (--save-bed) gets the bed's world with all
/// contact histories, and the settings that it was made with. A run that starts from it (--bed-file) has these
/// settings, and passes over all stages of the bed: it is the same bed to the last bit.
class BedStore final : public PartStore {
 public:
  /// How the box is built: beds of one kind are no beds of another.
  static constexpr const char *fixed_box = "a fixed box", *halves = "a box of two halves",
                              *repeating = "a box that repeats itself along x";

  /// To be made before Session::begin_run(): what does not fit is refused here. Reads the state, if the bed is one.
  /// Throws Error.
  BedStore(Session& session, const BedSettings& bed, const GrainSettings& grains, const char* box)
      : session_(session),
        run_(session.parts()),
        files_(session.checkpoints().files),
        save_(bed.file.empty() ? bed.save : "") {
    for (const std::string& file : {bed.file, save_}) {
      if (BedSettings::is_state(file)) check_place(file, session);
    }
    if (!save_.empty()) session.require_writable(save_, "--save-bed");
    settings_ = settings_of(bed, grains, box);
    if (!BedSettings::is_state(bed.file)) return;
    state_ = files_.read(bed.file);
    check(bed.file);
  }

  /// What a run says that it will replace besides its results: an older file of a bed.
  [[nodiscard]] std::string also_replaced() const {
    std::error_code ignored;
    return save_.empty() || !std::filesystem::exists(save_, ignored) ? "" : text("{} once there is a new bed", save_);
  }
  [[nodiscard]] bool is_on() const override { return !state_.empty() || saves() || run_.is_on(); }
  [[nodiscard]] bool writes() const override { return run_.writes(); }
  bool is_due(double& last) override { return run_.is_due(last); }
  io::StateColumns read(const std::string& part) override { return state_.empty() ? run_.read(part) : state_; }
  std::string write(const std::string& part, io::StateColumns& columns) override {
    const auto done = columns.find("rig/part/done");
    const bool is_done = done != columns.end() && done->second.bytes()[0] != std::byte{0};
    if (is_done && saves() && process_writes_files) {
      io::StateColumns own;
      io::Fields v(io::Fields::Task::collect, own);
      v(settings_name, settings_);
      io::StateColumns all = columns;
      all.merge(own);
      try {
        files_.write(save_, all);
      } catch (const Error& problem) {
        say_unsaved(problem);
      }
    }
    return run_.is_on() ? run_.write(part, columns) : "";
  }

  /// Saves a bed that was made as places of grains, unless its state is saved.
  template <class Model>
  void save_places(const Bed<Model>& bed) const {
    if (save_.empty() || saves()) return;
    try {
      soil::save_packing(packing_of(bed), save_);
    } catch (const Error& problem) {
      say_unsaved(problem);
    }
  }

 private:
  static constexpr const char* settings_name = "rig/bed_settings";

  [[nodiscard]] bool saves() const { return BedSettings::is_state(save_); }
  /// The bed took long to make: the run goes on with it.
  void say_unsaved(const Error& problem) const {
    session_.message(text("warning: the bed could not be saved, and the run goes on: {}", problem.what()));
  }

  /// Throws Error for a state that this program cannot have, or that the run would remove.
  void check_place(const std::string& file, const Session& session) const {
    namespace fs = std::filesystem;
    if (files_.read == nullptr) {
      fail("'{}' is to be the state of a bed, but this program was built without HDF5; give a file that ends in .txt",
           file);
    }
    std::error_code ignored;
    const auto folder_of = [&](const fs::path& path) {
      return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
    };
    if (folder_of(fs::path(file)).parent_path() == folder_of(session.folder() / CheckpointFolder::folder_name)) {
      fail("'{}' is where the run keeps what it can go on from, and removes it at its end; give another place", file);
    }
  }

  /// All that the bed depends on: the options with their values, and how the box is built.
  static NamesAndValues settings_of(BedSettings bed, GrainSettings grains, const char* box) {
    Options options;
    add_grain_options(options, grains);
    add_bed_options(options, bed);
    NamesAndValues list{{"box", box}};
    for (const Option& o : options.all()) {
      const bool counts = o.changes_results && o.name != "--sleep" && o.name != "--bed-file" && o.name != "--save-bed";
      if (counts) list.emplace_back(o.name, text_of(o));
    }
    return list;
  }

  /// Throws Error unless the bed was made with these settings.
  void check(const std::string& file) {
    NamesAndValues made;
    try {
      io::Fields v(io::Fields::Task::restore, state_);
      v(settings_name, made);
    } catch (const Error&) {
      fail("'{}' is no bed: it was not written by --save-bed; give another --bed-file", file);
    }
    std::erase_if(state_, [](const auto& column) { return column.first.starts_with(settings_name); });
    const auto value_of = [](const NamesAndValues& list, const std::string& name) -> std::optional<std::string> {
      const auto at = std::find_if(list.begin(), list.end(), [&](const auto& m) { return m.first == name; });
      if (at == list.end()) return {};
      return at->second;
    };
    const NamesAndValues defaults = settings_of({}, {}, "");
    for (const auto& [name, value] : settings_) {
      // An option that the program which made it did not have yet counts as left alone.
      const auto given = value_of(made, name), then = given ? given : value_of(defaults, name);
      if (then == value) continue;
      fail(
          "the bed '{}' was made with {} {}, but here it is {}; give the settings that it was made with, or another "
          "bed",
          file, name, then.value_or("not given"), value);
    }
  }

  Session& session_;
  PartStore& run_;
  CheckpointFiles files_;
  std::string save_;
  NamesAndValues settings_;
  io::StateColumns state_;  ///< of the file that the bed is taken from
};

}  // namespace dem::rig
