// Direct shear test of cubical sand grains (chapter 3 of the thesis): packs grains into a box of two halves, loads a
// lid, shears one half over the other, and fits the angle of friction. See --help.
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense, before the results of an earlier run are touched; 3 when direct_shear_all has what was asked
// for; 130 after Ctrl-C or SIGTERM. What was found by then is saved and reported. Plots are drawn if gnuplot is there:
// a run without is as complete, and says so.

#include "worlds.hpp"

#include <dem/rig/direct_shear/shear_rig.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  const dem::rig::ProgramText text = {
      .name = "direct_shear",
      .title = "Direct shear test",
      .about = "Direct shear test of cubical sand grains: shear strength at several normal stresses",
      .footer = dem::rig::exit_codes};
#if defined(DEM_ON_RANKS)
  const char* others = "direct_shear_all has them: cmake --build build/release --target direct_shear_all_on_ranks";
#else
  const char* others = "direct_shear_all has them: cmake --build build/release --target direct_shear_all";
#endif
  dem::rig::direct_shear::ShearRig rig(worlds(), others);
  return dem::rig::run_program(text, rig, argc, argv);
}
