#include "worlds.hpp"

#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/rig/sand_pile/campaign.hpp>

void superquadric(const pile::Settings& s, pile::PileResult& result, dem::report::Replay* replay,
                  dem::rig::Session& session, dem::rig::Stages& stages) {
  using Sand = pile::Sand<dem::shape::Superquadric>;
  // Rounded: exponents of 8 leave 94 % of the cube's volume.
  const dem::shape::Superquadric cube(dem::Vec3::Constant(s.half_edge), dem::Vec3::Constant(8.0));
  pile::make_pile<Sand>({s, pile::grains_of<Sand>(s, result.kind, cube)}, result, replay, session, stages);
}
