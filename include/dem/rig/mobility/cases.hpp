#pragma once

#include <dem/rig/mobility/drive.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace dem::rig::mobility {

/// The drives of a study, in the order of its table. Those of `passes` follow each other in one lane, all others start
/// on soil of their own. Throws Error for two of one name: their results could not be told from each other.
inline std::vector<Case> cases_of(const Settings& s) {
  const Case plain = {.name = "drive",
                      .slope = s.slopes.front(),
                      .side_slope = s.side_slopes.front(),
                      .sprung_mass = s.sprung_mass,
                      .lane = s.stretches_};
  std::vector<Case> cases;
  const auto add = [&](std::string name) -> Case& {
    cases.push_back(plain);
    cases.back().name = std::move(name);
    return cases.back();
  };
  const auto signed_name = [](double x) { return text("{}{:g}", x < 0.0 ? "m" : "", std::abs(x)); };
  if (s.study == "slopes") {
    for (const double slope : s.slopes) add("slope_" + signed_name(slope)).slope = slope;
  } else if (s.study == "side-slopes") {
    for (const double side : s.side_slopes) add("side_" + signed_name(side)).side_slope = side;
  } else if (s.study == "drawbar") {
    add("drawbar").is_held = true;
  } else if (s.study == "passes") {
    for (int k = 1; k <= s.passes; ++k) add(text("pass_{}", k));
  } else if (s.study == "map") {
    for (const double side : s.side_slopes) {
      for (const double slope : s.slopes) {
        Case& c = add("slope_" + signed_name(slope) + "_side_" + signed_name(side));
        c.slope = slope, c.side_slope = side;
      }
    }
  } else if (s.study == "loads") {
    for (const auto& soil : s.soils_of_loads_) {
      for (const double mass : s.loads) {
        Case& c = add(text("{}_{:g}_kg", soil.name, mass));
        c.sprung_mass = mass;
        c.lane = {{soil, s.path}};
      }
    }
  } else {
    add("drive");
  }
  for (auto c = cases.begin(); c != cases.end(); ++c) {
    if (std::none_of(cases.begin(), c, [&](const Case& other) { return other.name == c->name; })) continue;
    fail(
        "the study {} has two drives of the name '{}'; give each slope, mass and soil once, and numbers that differ in "
        "their first six digits",
        s.study, c->name);
  }
  return cases;
}

/// Everything that a run finds.
struct Campaign {
  std::vector<Case> cases;
  std::vector<Result> results;  ///< of the cases
  Driven shown;                 ///< the only drive, or the last pass; empty where a study has many
};

/// The soil of a drive, as text: a run that goes on has the one that it began with, whatever its file says now.
struct SameSoil {
  std::string now;
  template <class V>
  void fields(V& v) {
    std::string then = now;
    v("soil", then);
    if (then != now) fail("the soil of a drive is another one than that which the run began with; give that one again");
  }
};
inline SameSoil soil_of(const Case& c) {
  SameSoil soil;
  for (const vehicle::LaneStretch& stretch : c.lane) soil.now += terramechanics::to_text(stretch.soil);
  return soil;
}

}  // namespace dem::rig::mobility
