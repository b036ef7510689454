#pragma once

#include <dem/rig/sand_pile/results.hpp>

namespace dem::rig {
class Session;
class Stages;
}  // namespace dem::rig

namespace pile = dem::rig::sand_pile;

// Each is in a source of its own, as a world takes a while to compile.
using PileRun = void(const pile::Settings&, pile::PileResult&, dem::report::Replay*, dem::rig::Session&,
                     dem::rig::Stages&);
PileRun cube8, polyhedron, superquadric, sphere, sphere_braked;
