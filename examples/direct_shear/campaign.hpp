#pragma once

#include "results.hpp"

#include <functional>

namespace direct_shear {

/// Checks what the run starts from; makes (or reads) the packing, and tests it at each load: the same grains, in a new
/// rig each time. What can be refused is refused first, with dem::Error; then `begin` is called, once, and from there
/// on nothing is thrown but what `begin` throws: `campaign` is filled as it goes, and a problem, of whatever kind, or
/// Ctrl-C ends it early and is noted there, so that what was found by then can be reported. One for each integrator
/// with cubes of eight spheres: predictor_corrector.cpp, verlet.cpp, euler.cpp; other grains with velocity Verlet only:
/// verlet_polyhedron.cpp, verlet_superquadric.cpp.
template <class Integrator, class Shape>
void run_campaign(const Settings& settings, Campaign& campaign, const std::function<void()>& begin);

}  // namespace direct_shear
