#pragma once
// Where a bed is kept: with the other parts of its run, and in files of its own that other runs start from.

#include <dem/rig/bed/bed_file.hpp>
#include <dem/rig/session.hpp>

#include <string>
#include <utility>

namespace dem::rig {

/// Keeps the part of a run that makes its bed. A file that ends in .h5 (--save-bed) gets the bed's world with all
/// contact histories, and the settings that it was made with. A run that starts from it (--bed-file) has these
/// settings, and passes over all stages of the bed: it is the same bed to the last bit.
class BedStore final : public PartStore {
 public:
  /// To be made before Session::begin_run(): what does not fit is refused here. Reads the state, if the bed is one.
  /// `repeats`: the bed repeats itself along x. Throws Error.
  BedStore(Session& session, const BedSettings& bed, const GrainSettings& grains, bool repeats = false)
      : run_(session.parts()), files_(session.checkpoints().files), save_(bed.file.empty() ? bed.save : "") {
    for (const std::string& file : {bed.file, save_}) {
      if (!BedSettings::is_state(file) || files_.read != nullptr) continue;
      fail("'{}' is to be the state of a bed, but this program was built without HDF5; give a file that ends in .txt",
           file);
    }
    if (!save_.empty()) session.require_writable(save_, "--save-bed");
    BedSettings made = bed;
    made.file.clear();
    list_settings(settings_, grains);
    list_settings(settings_, made);
    settings_.emplace_back("repeats itself", repeats ? "yes" : "no");
    if (!BedSettings::is_state(bed.file)) return;
    state_ = files_.read(bed.file);
    check(bed.file);
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
        return problem.what();
      }
    }
    return run_.is_on() ? run_.write(part, columns) : "";
  }

  /// Saves a bed that was made as places of grains, unless its state is saved.
  template <class Model>
  void save_places(const Bed<Model>& bed) const {
    if (!save_.empty() && !saves()) soil::save_packing(packing_of(bed), save_);
  }

 private:
  static constexpr const char* settings_name = "rig/bed_settings";

  [[nodiscard]] bool saves() const { return BedSettings::is_state(save_); }

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
    for (std::size_t k = 0; k < std::max(made.size(), settings_.size()); ++k) {
      const auto of = [&](const NamesAndValues& list) {
        return k < list.size() ? list[k] : NamesAndValues::value_type{};
      };
      const auto [name, value] = of(settings_);
      if (of(made) == of(settings_)) continue;
      fail("the bed '{}' was made with {}: {}, but the settings say {}: {}; give those that it was made with", file,
           of(made).first, of(made).second, name, value);
    }
  }

  PartStore& run_;
  CheckpointFiles files_;
  std::string save_;
  NamesAndValues settings_;
  io::StateColumns state_;  ///< of the file that the bed is taken from
};

}  // namespace dem::rig
