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
inline constexpr const char* study_changes[] = {"wide", "deep", "long", "slow"};
/// The same in words.
inline std::string change_text(const std::string& change) {
  if (change.empty()) return "as set";
  return change == "slow" ? "half the speed" : "bed twice as " + change;
}

/// The run itself, or one of its study.
template <class Settings>
struct Variant {
  std::string change = {};  ///< one of study_changes; empty: box and speed as set
  std::string seed = {};    ///< one of more_seeds; empty: as set
  std::string text = "as set";
  Settings settings = {};

  [[nodiscard]] bool is_run_itself() const { return change.empty() && seed.empty(); }
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

inline void add_study_options(Options& options, std::string& study, std::uint64_t& seeds) {
  options.add("--study", study, "also: beds twice as wide, as deep and as long (box), half the speed, or other seeds")
      .one_of({"none", "box", "speed", "seeds"});
  options.add("--study-seeds", seeds,
              "seeds of each run of the study, for its errors (0: three; with --bed-file one): a change is that of two "
              "runs of one seed");
}

inline void find_idle_study(IdleOptions& idle, const std::string& study) {
  idle.unless(study != "none", "with a --study", {"--study-seeds"});
}

/// Fills in of how many seeds each run of a study is. Throws Error for a study that needs other beds than that of
/// --bed-file.
inline void resolve_study(const std::string& study, std::uint64_t& seeds, const BedSettings& bed) {
  const bool has_file = !bed.file.empty();
  if (has_file && (study == "box" || study == "seeds")) {
    fail("--study {} needs other beds than the one of --bed-file; leave --bed-file out", study);
  }
  if (seeds == 0) seeds = has_file ? 1 : 3;
  require_within(static_cast<double>(seeds), study == "seeds" ? 2.0 : 1.0, 9.0, "--study-seeds");
  if (has_file && study == "speed" && seeds > 1) {
    fail("--study-seeds {} needs other beds than the one of --bed-file; leave one of them out", seeds);
  }
}

/// What is said of the study beside other settings.
inline std::string study_setting(const std::string& study, std::uint64_t seeds) {
  return study == "none" ? study : text("{}, {} seed{}", study, seeds, seeds == 1 ? "" : "s");
}

/// The run itself, and those of Settings::study, each of Settings::study_seeds seeds. `slow_down` halves the speed of
/// the settings that it is given. All runs of one seed follow each other.
template <class Settings, class SlowDown>
std::vector<Variant<Settings>> variants_of(const Settings& s, SlowDown&& slow_down) {
  std::vector<Variant<Settings>> list;
  const std::uint64_t seeds = s.study == "none" ? 1 : std::max<std::uint64_t>(1, s.study_seeds);
  for (std::uint64_t k = 0; k < seeds; ++k) {
    Variant<Settings> as_set{.settings = s};
    as_set.settings.bed.seed += k;
    if (k > 0) as_set.seed = more_seeds[k - 1], as_set.text = text("seed {}", as_set.settings.bed.seed);
    list.push_back(as_set);
    const auto add = [&](const char* name, auto&& change) {
      Variant<Settings> v = as_set;
      v.change = name;
      v.text = k > 0 ? text("{}, {}", change_text(name), as_set.text) : change_text(name);
      change(v.settings);
      list.push_back(std::move(v));
    };
    if (s.study == "box") {
      add("wide", [](Settings& x) { x.bed.width *= 2.0; });
      add("deep", [](Settings& x) { x.bed.depth *= 2.0; });
      add("long", [](Settings& x) { x.bed.length *= 2.0; });
    } else if (s.study == "speed") {
      add("slow", slow_down);
    }
  }
  return list;
}

}  // namespace dem::rig
