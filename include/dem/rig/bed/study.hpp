#pragma once
// Studies of a rig with a bed: the same in a larger box, at half the speed, or with other grains.

#include <dem/rig/bed/bed_settings.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// Seeds after that of the run itself, as files are named after them.
inline constexpr const char* more_seeds[] = {"second", "third",   "fourth", "fifth",
                                             "sixth",  "seventh", "eighth", "ninth"};
/// What a study changes, as files are named after it.
inline constexpr const char* study_changes[] = {"wide", "deep", "slow"};

/// The run itself, or one of its study.
template <class Settings>
struct Variant {
  std::string change = {};  ///< one of study_changes; empty: box and speed as set
  std::string seed = {};    ///< one of more_seeds; empty: as set
  std::string text = "as set";
  Settings settings = {};

  [[nodiscard]] bool is_run_itself() const { return change.empty() && seed.empty(); }
  /// The run itself, or one that differs in the grains alone.
  [[nodiscard]] bool is_of_seed() const { return change.empty(); }
  /// It is made in the bed of the run before it.
  [[nodiscard]] bool shares_bed() const { return change == "slow"; }
  /// What names of its files begin with.
  [[nodiscard]] std::string prefix() const {
    return (change.empty() ? "" : change + "_") + (seed.empty() ? "" : seed + "_");
  }
};

/// What the names of files of all studies begin with.
inline std::vector<std::string> variant_prefixes() {
  std::vector<std::string> list;
  for (const char* change : study_changes) list.push_back(std::string(change) + "_");
  for (const char* seed : more_seeds) {
    list.push_back(std::string(seed) + "_");
    for (const char* change : study_changes) list.push_back(std::string(change) + "_" + seed + "_");
  }
  return list;
}

inline void add_study_option(Options& options, std::string& study, const std::string& more = "") {
  const char* const what = "also: a bed twice as wide and one twice as deep (box), half the speed, or other seeds";
  options.add("--study", study, what + more).one_of({"none", "box", "speed", "seeds"});
}

/// Throws Error for a study that needs other beds than that of --bed-file.
inline void check_study(const std::string& study, const BedSettings& bed) {
  if (study == "none" || study == "speed" || bed.file.empty()) return;
  fail("--study {} needs other beds than the one of --bed-file; leave --bed-file out", study);
}

/// Of how many seeds the runs of a study are.
struct StudySeeds {
  std::uint64_t as_set = 1;   ///< box and speed as set
  std::uint64_t changed = 1;  ///< another box or speed
};

/// The run itself, and those of Settings::study. `slow_down` halves the speed of the settings that it is given. All
/// runs of one seed follow each other.
template <class Settings, class SlowDown>
std::vector<Variant<Settings>> variants_of(const Settings& s, const StudySeeds& seeds, SlowDown&& slow_down) {
  std::vector<Variant<Settings>> list;
  for (std::uint64_t k = 0; k < std::max<std::uint64_t>(1, seeds.as_set); ++k) {
    Variant<Settings> as_set{.settings = s};
    as_set.settings.bed.seed += k;
    if (k > 0) as_set.seed = more_seeds[k - 1], as_set.text = text("seed {}", as_set.settings.bed.seed);
    list.push_back(as_set);
    if (k >= seeds.changed) continue;
    const auto add = [&](const char* name, const char* what, auto&& change) {
      Variant<Settings> v = as_set;
      v.change = name;
      v.text = k > 0 ? text("{}, {}", what, as_set.text) : what;
      change(v.settings);
      list.push_back(std::move(v));
    };
    if (s.study == "box") {
      add("wide", "bed twice as wide", [](Settings& x) { x.bed.width *= 2.0; });
      add("deep", "bed twice as deep", [](Settings& x) { x.bed.depth *= 2.0; });
    } else if (s.study == "speed") {
      add("slow", "half the speed", slow_down);
    }
  }
  return list;
}

}  // namespace dem::rig
