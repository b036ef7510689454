// Sand piles: grains are left when a cylinder is lifted, poured through a funnel, or stay in a box that is emptied
// through a slot; and the angle of repose of cubes, rounded cubes and spheres, with different laws, is measured. See
// --help, and RESULTS.md for what came out.
//
//   sand_pile --output out/piles
//   sand_pile --method funnel --kinds sphere,sphere-rolling --output out/spheres

#include "worlds.hpp"

#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/sand_pile/pile_rig.hpp>

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  static constexpr pile::PileWorld worlds[] = {{"cube8", cube8},
                                               {"polyhedron", polyhedron},
                                               {"superquadric", superquadric},
                                               {"sphere", sphere},
                                               {"sphere-braked", sphere_braked}};
  pile::PileRig rig(worlds);
  return dem::rig::run_program({.name = "sand_pile",
                                .title = "Sand piles",
                                .about = "Sand piles and their angles of repose",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
