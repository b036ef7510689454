#include "worlds.hpp"

#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/rig/direct_shear/campaign.hpp>

void superquadric_verlet(const shear::Settings& s, shear::Campaign& campaign, dem::rig::Session& session) {
  using Sand = shear::Sand<dem::shape::Superquadric, dem::integrator::VelocityVerlet>;
  // Rounded: exponents of 8 leave 94 % of the cube's volume.
  const dem::shape::Superquadric cube(dem::Vec3::Constant(s.half_edge), dem::Vec3::Constant(8.0));
  shear::run_campaign<Sand>({s, shear::grains_of<Sand>(s, cube)}, campaign, session);
}
