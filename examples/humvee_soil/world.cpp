// The world of the lane: in a source of its own, as it takes a while to compile.

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/cohesion/constant.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/soft_lane/campaign.hpp>

namespace lanes = dem::rig::soft_lane;

/// The thesis's laws, cubes of eight spheres, boxes, round tyres and tyres of triangles.
struct Sand : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Surfaces = dem::surface::Set<dem::surface::Box, dem::surface::Cylinder, dem::surface::TriangleMesh>;
  using Cohesion = dem::cohesion::Constant;  // of a second soil
  using Integrator = dem::integrator::VelocityVerlet;
  using Domain = dem::rig::Domain;
};

void drive_lane(const lanes::Settings& settings, lanes::Campaign& campaign, dem::rig::Session& session) {
  lanes::run_campaign<Sand>(
      settings, [](double half_edge) { return dem::shape::cube8(half_edge); }, campaign, session);
}
