#pragma once

#include "results.hpp"

namespace direct_shear {

/// Makes (or reads) the packing, and tests it at each load: the same grains, in a new rig each time. Fills `campaign`
/// as it goes; a problem, of whatever kind, or Ctrl-C ends it early and is noted there, so that what was found by then
/// can be reported. One for each integrator with cubes of eight spheres: predictor_corrector.cpp, verlet.cpp,
/// euler.cpp; other grains with velocity Verlet only: verlet_polyhedron.cpp, verlet_superquadric.cpp.
template <class Integrator, class Shape>
void run_campaign(const Settings& settings, Campaign& campaign);

}  // namespace direct_shear
