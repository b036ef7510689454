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

  /// What names of its files begin with.
  [[nodiscard]] std::string prefix() const { return name.empty() ? "" : name + "_"; }
};

/// What the variants of all studies are called.
inline constexpr const char* variant_names[] = {"wide", "deep", "slow", "second", "third"};

inline void add_study_option(Options& options, std::string& study) {
  options
      .add("--study", study,
           "also: a bed twice as wide and one twice as deep (box), half the speed, or two other seeds")
      .one_of({"none", "box", "speed", "seeds"});
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
    add("second", "the next seed", [](Settings& x) { x.bed.seed += 1; });
    add("third", "the seed after it", [](Settings& x) { x.bed.seed += 2; });
  }
  return list;
}

}  // namespace dem::rig
