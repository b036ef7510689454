// Plate pressure-sinkage test (chapter 4 of the thesis): plates of several widths are pressed into one levelled bed of
// cubical sand grains, and Bekker's and Reece's constants are fitted to what they carry. See --help.
//
//   plate_sinkage --size smoke          seconds, to see that all works
//   plate_sinkage                       all plates on coarse grains, minutes
//   plate_sinkage --study box           also in beds twice as wide, as deep and as long, each of three seeds
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense; 130 after Ctrl-C or SIGTERM.

#include <dem/rig/plate_sinkage/plate_rig.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>

namespace plates = dem::rig::plate_sinkage;

plates::PlateRig::Run press_plates;  // world.cpp

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  plates::PlateRig rig(press_plates);
  return dem::rig::run_program({.name = "plate_sinkage",
                                .title = "Plate pressure-sinkage test",
                                .about = "Plates pressed into a bed of cubical sand grains: pressure over sinkage",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
