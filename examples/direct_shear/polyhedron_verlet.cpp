#include "worlds.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/rig/direct_shear/campaign.hpp>

void polyhedron_verlet(const shear::Settings& s, shear::Campaign& campaign, dem::rig::Session& session) {
  using Sand = shear::Sand<dem::shape::Polyhedron, dem::integrator::VelocityVerlet>;
  shear::run_campaign<Sand>({s, shear::grains_of<Sand>(s, dem::shape::cube(s.half_edge))}, campaign, session);
}
