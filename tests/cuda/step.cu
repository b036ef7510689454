// Worlds whose grains a GPU moves compile, with each kind of grain, integrator and history. Nothing is run.

#include <dem/flat/cuda.hpp>
#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>

struct Cubes : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Executor = dem::exec::Cuda;
};
struct WetBalls : dem::Model {
  using Normal = dem::contact::LinearSpringDashpot;
  using Friction = dem::friction::CundallStrack;
  using Rolling = dem::rolling::ElasticPlastic;
  using Cohesion = dem::cohesion::LiquidBridge;
  using Integrator = dem::integrator::VelocityVerlet;
  using Executor = dem::exec::Cuda;
};

template struct dem::flat::Step<Cubes>;
template struct dem::flat::Step<WetBalls>;
template class dem::World<WetBalls>;
