#pragma once

#include <dem/report/replay_recorder.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/samples.hpp>
#include <dem/rig/sand_pile/settings.hpp>
#include <dem/soil/angle_of_repose.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::sand_pile {

/// A pile at one time.
struct Sample {
  double time;    ///< s
  double angle;   ///< deg, of the flank; NaN while there is none, and while the container holds grains up
  double height;  ///< m, of the mean profile's top
  double speed;   ///< m/s, root mean square of the grains'
  double grains;  ///< that are still there
};
inline constexpr Column<Sample> sample_columns[] = {{"time_s", &Sample::time},
                                                    {"angle_deg", &Sample::angle},
                                                    {"height_m", &Sample::height},
                                                    {"rms_speed_m_s", &Sample::speed},
                                                    {"grains", &Sample::grains}};

/// What became of one pile.
struct PileResult {
  Kind kind = {};
  std::uint64_t seed = 0;
  bool finished = false;
  std::size_t poured = 0;             ///< grains
  std::vector<soil::Placement> fill;  ///< these, at rest in their container
  std::vector<soil::Placement> pile;  ///< as it was measured
  soil::Flank flank = {};             ///< of it
  bool at_rest = false;               ///< it stood still when it was measured
  std::size_t lost = 0;               ///< grains that fell off the plate or out of the box
  double creep_time = not_known;      ///< s
  double creep = not_known;           ///< sizes (cube root of the volume), r.m.s. way of the grains in that time
  double creep_median = not_known;    ///< sizes, median way
  double angle_after = not_known;     ///< rad, of the flank after that time
  double time_step = not_known;       ///< s
  std::string time_step_limit = {};
  std::vector<Sample> samples = {};

  /// What a run that goes on takes over.
  template <class V>
  void fields(V& v) {
    v("finished", finished), v("poured", poured), v("fill", fill), v("pile", pile), v("flank", flank),
        v("at_rest", at_rest);
    v("lost", lost), v("creep_time", creep_time, "s"), v("creep", creep), v("creep_median", creep_median);
    v("angle_after", angle_after, "rad"), v("time_step", time_step, "s"), v("time_step_limit", time_step_limit);
    v.numbers("samples", samples);
  }
};

/// All piles of a run.
struct Campaign {
  std::vector<PileResult> piles = {};
  std::optional<report::Replay> replay = {};  ///< of the first
};

inline constexpr double degrees = 180.0 / std::numbers::pi;

/// m, three grains: that is how high a heap must be for an angle. Of a lower one the flank, six tenths of the height as
/// it is set, is less than two grains high.
inline double least_height(const Settings& s) { return 6.0 * s.half_edge; }

/// Why a pile that was measured has no angle, and what to change; empty of one that has.
inline std::string no_angle_note(const Settings& s, const PileResult& r) {
  if (r.pile.empty() || std::isfinite(r.flank.angle)) return {};
  const bool drain = s.method == "drain";
  std::string why, change;
  if (r.flank.height < least_height(s)) {
    why = text("it is {:.1f} mm high, but must be {:g} mm, three grains", 1e3 * r.flank.height, 1e3 * least_height(s));
    change = text("more --grains{}", drain                ? " or a shorter --box-length"
                                     : s.method == "lift" ? " or a smaller --cylinder-radius"
                                                          : "");
  } else if (r.flank.angles.empty()) {
    why = text("its flank, from {:.1f} to {:.1f} mm, has fewer than 5 places in every {}", 1e3 * r.flank.from,
               1e3 * r.flank.to, drain ? "strip" : "sector");
    change = "fewer --directions, a lower --flank-low, or more --grains";
  } else {
    double sum = 0.0;
    for (const double angle : r.flank.angles) sum += angle;
    why = text("the lines through its flank fall by {:.1f} deg in the mean, but must fall by more than 0 deg",
               degrees * sum / static_cast<double>(r.flank.angles.size()));
    change = "more --grains";
  }
  return text("Note: the pile {} of seed {} has no angle: {}. Give {}.", r.kind.name, r.seed, why, change);
}

/// The piles of one kind, in the order in which they were made.
inline std::vector<std::vector<const PileResult*>> by_kind(const Campaign& c) {
  std::vector<std::vector<const PileResult*>> kinds;
  for (const PileResult& r : c.piles) {
    if (kinds.empty() || kinds.back().front()->kind.name != r.kind.name) kinds.emplace_back();
    kinds.back().push_back(&r);
  }
  return kinds;
}

/// The pile of a kind that plots show: the first that was measured, if there is one.
inline const PileResult& shown_of(const std::vector<const PileResult*>& piles) {
  for (const PileResult* r : piles) {
    if (!r->pile.empty()) return *r;
  }
  return *piles.front();
}

}  // namespace dem::rig::sand_pile
