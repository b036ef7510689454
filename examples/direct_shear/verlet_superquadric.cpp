#include "campaign_impl.hpp"

#include <dem/integrator/velocity_verlet.hpp>

template void direct_shear::run_campaign<dem::integrator::VelocityVerlet, dem::shape::Superquadric>(
    const Settings&, Campaign&, const std::function<void()>&);
