#include "worlds.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/rig/sand_pile/campaign.hpp>

void polyhedron(const pile::Settings& s, pile::PileResult& result, dem::report::Replay* replay,
                dem::rig::Session& session, dem::rig::Stages& stages) {
  using Sand = pile::Sand<dem::shape::Polyhedron>;
  pile::make_pile<Sand>({s, pile::grains_of<Sand>(s, result.kind, dem::shape::cube(s.half_edge))}, result, replay,
                        session, stages);
}
