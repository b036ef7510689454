#pragma once
// What makes the program of a rig one that several processes share: the same sources, compiled with DEM_ON_RANKS.

#if defined(DEM_ON_RANKS)
#include <dem/domain/periodic_ranks.hpp>
#include <dem/domain/ranks.hpp>
#else
#include <dem/domain/open.hpp>
#include <dem/domain/periodic.hpp>
#include <dem/rig/launcher.hpp>
#endif

namespace dem::rig {

/// Models of a rig's worlds have `using Domain = dem::rig::Domain`, or PeriodicDomain where they repeat themselves, and
/// its main() begins with a Session:
///
///     const dem::rig::MpiSession mpi(argc, argv);
///
/// Compiled with DEM_ON_RANKS (link dem::mpi) the program is run by mpirun, and all processes share each of its worlds.
/// Results are those of one process, to the last digit. Compiled without, it refuses to be run by mpirun.
#if defined(DEM_ON_RANKS)
using Domain = domain::Ranks;
using PeriodicDomain = domain::PeriodicRanks;
using MpiSession = domain::Session;
#else
using Domain = domain::Open;
using PeriodicDomain = domain::Periodic;
struct MpiSession {
  MpiSession(int&, char**&) { can_have_ranks = true; }
};
#endif

}  // namespace dem::rig
