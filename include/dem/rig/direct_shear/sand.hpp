#pragma once

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/rig/processes.hpp>
#include <dem/world/model.hpp>

namespace dem::rig::direct_shear {

/// The thesis's laws, penalty springs and springs of asperities, with a shape and an integrator. The only surfaces are
/// boxes.
template <class S = shape::SphereCluster<8>, class I = integrator::VelocityVerlet>
struct Sand : Model {
  using Shape = S;
  using Surfaces = surface::Set<surface::Box>;
  using Integrator = I;
  using Domain = rig::Domain;
};

}  // namespace dem::rig::direct_shear
