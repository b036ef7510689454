// What no model changes, compiled once for a program: one of its sources, where all others are compiled with
// DEM_COMPILED defined (dem/core/compiled.hpp says what that does). CMake's target dem::compiled does both. It is
// compiled with the options of the others: the linker says so where their vectors are of another size.

#if !defined(DEM_COMPILED)
#define DEM_COMPILED
#endif
#define DEM_COMPILING

#include <dem/dem.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/mesh_sweeps.hpp>
#include <dem/mbd/load/terrain_part.hpp>
#include <dem/mbd/solver/projected.hpp>
#include <dem/mbd/solver/rest.hpp>
#include <dem/mbd/solver/rigid_rows.hpp>
