#include "campaign_impl.hpp"

#include <dem/integrator/symplectic_euler.hpp>

template void direct_shear::run_campaign<dem::integrator::SymplecticEuler, dem::shape::SphereCluster<8>>(
    const Settings&, Campaign&, const std::function<void()>&);
