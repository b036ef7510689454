// The world of the plates: in a source of its own, as it takes a while to compile.

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/rig/direct_shear/sand.hpp>
#include <dem/rig/plate_sinkage/campaign.hpp>

namespace plates = dem::rig::plate_sinkage;

void press_plates(const plates::Settings& settings, plates::Campaign& campaign, dem::rig::Session& session) {
  using Sand = dem::rig::direct_shear::Sand<>;  // the thesis's laws, cubes of eight spheres, boxes
  plates::run_campaign<Sand>(
      settings, [](double half_edge) { return dem::shape::cube8(half_edge); }, campaign, session);
}
