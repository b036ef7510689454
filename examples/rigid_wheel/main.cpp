// Rigid wheel on soil (chapter 5 of the thesis): a wheel under a load is set down on a levelled bed of cubical sand
// grains and rolled at several slips, s = 1 - v/(omega r). Drawbar pull, torque, sinkage and efficiency over slip stand
// beside Bekker's and Wong's. See --help.
//
//   rigid_wheel --size smoke            seconds, to see that all works
//   rigid_wheel                         five slips on coarse grains, minutes
//   rigid_wheel --size full --stiffness 2000 --sleep    the thesis's grains, nine slips: some 7 hours on two cores
//   rigid_wheel --wheel grousers        also smooth; rough is the default
//   rigid_wheel --study box             also in beds twice as wide, as deep and as long, each of three seeds
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense; 130 after Ctrl-C or SIGTERM.

#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>
#include <dem/rig/rigid_wheel/wheel_rig.hpp>

namespace wheels = dem::rig::rigid_wheel;

wheels::WheelRig::Run roll_wheel;  // world.cpp

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  wheels::WheelRig rig(roll_wheel);
  return dem::rig::run_program({.name = "rigid_wheel",
                                .title = "Rigid wheel on soil",
                                .about = "A wheel rolled on a bed of cubical sand grains: drawbar pull over slip",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
