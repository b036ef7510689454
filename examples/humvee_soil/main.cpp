// The Humvee on soft soil (chapter 6 of the thesis): the car of 34 bodies drives on a lane of cubical sand grains, on
// the level, up, down and along slopes, brakes, coasts and turns. See --help.
//
//   humvee_soil --size smoke                      seconds, to see that all works
//   humvee_soil                                   some 10,000 coarse grains in two troughs, minutes
//   humvee_soil --scene slope --slope 20          up a slope of 20 %
//   humvee_soil --bed-file humvee_soil_output/bed.txt --output again      from the levelled bed of an earlier run
//   humvee_soil --size full --checkpoint-every 1800       hours; with --resume it goes on where it was stopped
//
// Ends with 0 when all was done, also when the car digs in or rolls over, which is what was found; 1 when the run ended
// early or a part of the report could not be made; 2 when the settings make no sense; 130 after Ctrl-C or SIGTERM.

#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/soft_lane/lane_rig.hpp>

namespace lanes = dem::rig::soft_lane;

lanes::LaneRig::Run drive_lane;  // world.cpp

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  lanes::LaneRig rig(drive_lane);
  return dem::rig::run_program({.name = "humvee_soil",
                                .title = "Humvee on soft soil",
                                .about = "A Humvee drives on a lane of cubical sand grains",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
