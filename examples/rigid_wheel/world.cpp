// The world of the wheel: in a source of its own, as it takes a while to compile.

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/rigid_wheel/campaign.hpp>

namespace wheels = dem::rig::rigid_wheel;

/// The thesis's laws, cubes of eight spheres, boxes, round wheels and wheels of triangles.
struct Sand : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Surfaces = dem::surface::Set<dem::surface::Box, dem::surface::Cylinder, dem::surface::TriangleMesh>;
  using Integrator = dem::integrator::VelocityVerlet;
  using Domain = dem::rig::Domain;
};

void roll_wheel(const wheels::Settings& settings, wheels::Campaign& campaign, dem::rig::Session& session) {
  wheels::run_campaign<Sand>(
      settings, [](double half_edge) { return dem::shape::cube8(half_edge); }, campaign, session);
}
