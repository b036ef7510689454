#include "worlds.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/rig/sand_pile/campaign.hpp>

void cube8(const pile::Settings& s, pile::PileResult& result, dem::report::Replay* replay, dem::rig::Session& session,
           dem::rig::Stages& stages) {
  using Sand = pile::Sand<dem::shape::SphereCluster<8>>;
  pile::make_pile<Sand>({s, pile::grains_of<Sand>(s, result.kind, dem::shape::cube8(s.half_edge))}, result, replay,
                        session, stages);
}
