#pragma once

#include <dem/rig/bed/bed_store.hpp>
#include <dem/rig/part_of.hpp>

#include <cmath>
#include <string>

namespace dem::rig {

/// What is told of a bed once it is level: its depth (m), and the solid fraction of its inside, NaN where it has none.
inline std::string level_text(double level, double solid_fraction) {
  return text("{:.1f} mm deep, {}", 1e3 * level,
              std::isfinite(solid_fraction) ? text("solid fraction {:.3f}", solid_fraction)
                                            : "too small to tell its solid fraction");
}

/// The bed of a test, as a part of the run that is kept by itself: a run that goes on takes it from its file, and so
/// does one that starts from the state of a bed. Whether its grains may sleep is as this run says.
template <class Test>
Bed<typename Test::Model> make_kept_bed(const Test& test, const soil::Packing& start, Session& session,
                                        PartStore& store, const std::string& name = "bed") {
  PartOf<typename Test::Model> part(store, session, name);
  Bed<typename Test::Model> bed = test.make_bed(start, session);
  const auto kept = session.keep("bed", bed);
  session.complete(bed.world);
  const bool sleep = bed.settings().sleep;
  if (bed.world.state().options.sleep.has_value() != sleep) {
    bed.world.set_sleep(sleep ? std::optional<SleepOptions>(SleepOptions{}) : std::nullopt);
  }
  return bed;
}

}  // namespace dem::rig
