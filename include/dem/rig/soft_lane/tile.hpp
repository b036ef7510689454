#pragma once
// A tile of a lane that goes along with the car.

#include <dem/rig/part_of.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/soft_lane.hpp>

namespace dem::rig::soft_lane {

/// The same grains in a world that repeats itself.
template <class Model>
struct Repeating : Model {
  using Domain = PeriodicDomain;
};

/// The levelled bed of one trough, which repeats itself, under both tracks, as they lie when they are at rest again; a
/// part of the run that is kept by itself.
template <class Model>
soil::Tile make_kept_tile(const Settings& s, const typename Model::Shape& shape, const Bed<Repeating<Model>>& bed,
                          double time_step, Session& session) {
  PartOf<Repeating<Model>> part(session, session, "tile");
  const auto grains = lane_grains(s, soil::placements(bed.world));
  auto cell = make_lane<Repeating<Model>>(s, shape, grains, bed.level, time_step);
  session.begin("settle tile");
  settle(cell, s.grains.edge(), s.bed.stage_limit, "--stage-limit", session, [] { return 0.0; });
  session.complete(cell);
  return soil::take_tile(cell);
}

}  // namespace dem::rig::soft_lane
