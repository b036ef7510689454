#pragma once
// Studies of a rig with a bed: the same in a larger box, at half the speed, or with other grains.

#include <dem/rig/bed/bed_settings.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// The run itself, or one of its study.
template <class Settings>
struct Variant {
  std::string name = {};  ///< of files; empty: the run itself
  std::string text = "as set";
  Settings settings = {};

  /// The run itself, or one that differs in the grains alone.
  [[nodiscard]] bool is_of_seed() const { return name.empty() || name == "second" || name == "third"; }
  /// What names of its files begin with.
  [[nodiscard]] std::string prefix() const { return name.empty() ? "" : name + "_"; }
};

/// What the variants of all studies are called.
inline constexpr const char* variant_names[] = {"wide", "deep", "slow", "second", "third"};

inline void add_study_option(Options& options, std::string& study, const std::string& more = "") {
  const char* const what = "also: a bed twice as wide and one twice as deep (box), half the speed, or two other seeds";
  options.add("--study", study, what + more).one_of({"none", "box", "speed", "seeds"});
}

/// Throws Error for a study that needs other beds than that of --bed-file.
inline void check_study(const std::string& study, const BedSettings& bed) {
  if (study == "none" || study == "speed" || bed.file.empty()) return;
  fail("--study {} needs other beds than the one of --bed-file; leave --bed-file out", study);
}

/// Adds the run itself, the first one, in two beds of other grains.
template <class Settings>
void add_seeds(std::vector<Variant<Settings>>& list) {
  const auto add = [&](const char* name, const char* text, std::uint64_t seeds_on) {
    Variant<Settings> v{name, text, list.front().settings};
    v.settings.bed.seed += seeds_on;
    list.push_back(std::move(v));
  };
  add("second", "the next seed", 1);
  add("third", "the seed after it", 2);
}

/// The run itself, and those of Settings::study. `slow_down` halves the speed of the settings that it is given.
template <class Settings, class SlowDown>
std::vector<Variant<Settings>> variants_of(const Settings& s, SlowDown&& slow_down) {
  std::vector<Variant<Settings>> list{{.settings = s}};
  const auto add = [&](const char* name, std::string text, auto&& change) {
    Variant<Settings> v{name, std::move(text), s};
    change(v.settings);
    list.push_back(std::move(v));
  };
  if (s.study == "box") {
    add("wide", "bed twice as wide", [](Settings& x) { x.bed.width *= 2.0; });
    add("deep", "bed twice as deep", [](Settings& x) { x.bed.depth *= 2.0; });
  } else if (s.study == "speed") {
    add("slow", "half the speed", slow_down);
  } else if (s.study == "seeds") {
    add_seeds(list);
  }
  return list;
}

}  // namespace dem::rig
