#include "worlds.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/integrator/predictor_corrector.hpp>
#include <dem/rig/direct_shear/campaign.hpp>

void cube8_predictor_corrector(const shear::Settings& s, shear::Campaign& campaign, dem::rig::Session& session) {
  using Sand = shear::Sand<dem::shape::SphereCluster<8>, dem::integrator::PredictorCorrector>;
  shear::run_campaign<Sand>({s, shear::grains_of<Sand>(s, dem::shape::cube8(s.half_edge))}, campaign, session);
}
