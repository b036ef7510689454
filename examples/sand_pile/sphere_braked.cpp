#include "worlds.hpp"

#include <dem/geometry/sphere/sphere.hpp>
#include <dem/rig/sand_pile/campaign.hpp>

void sphere_braked(const pile::Settings& s, pile::PileResult& result, dem::report::Replay* replay,
                   dem::rig::Session& session, dem::rig::Stages& stages) {
  using Sand = pile::Sand<dem::shape::Sphere, dem::rolling::ConstantTorque>;
  pile::make_pile<Sand>(
      {s, pile::grains_of<Sand>(s, result.kind, dem::shape::Sphere(pile::sphere_radius(s.half_edge)))}, result, replay,
      session, stages);
}
