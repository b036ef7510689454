#pragma once

#include "scenes.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>

namespace scenes {

struct CubesAlone : dem::Model {
  using Shape = dem::shape::SphereCluster<8>;
  using Integrator = dem::integrator::VelocityVerlet;
};
struct CubesShared : CubesAlone {
  using Domain = dem::domain::Ranks;
};

}  // namespace scenes
