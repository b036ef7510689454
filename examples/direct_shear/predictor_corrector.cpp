#include "campaign_impl.hpp"

#include <dem/integrator/predictor_corrector.hpp>

template void direct_shear::run_campaign<dem::integrator::PredictorCorrector, dem::shape::SphereCluster<8>>(
    const Settings&, Campaign&, const std::function<void()>&);
