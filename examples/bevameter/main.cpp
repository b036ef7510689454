// A bevameter in grains: plates of several widths are pressed into a bed, a specimen of the same grains is sheared, and
// the soil's constants of Bekker, Reece, Janosi and Hanamoto, and Mohr and Coulomb are found, with confidence
// intervals. A wheel in the same soil shows what they predict well, and what not. See --help.
//
//   bevameter --size smoke              seconds, to see that all works
//   bevameter                           plates, shear and four slips of a wheel on coarse grains, minutes
//   bevameter --wheel none              the constants only
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense; 130 after Ctrl-C or SIGTERM.

#include <dem/rig/bevameter/bevameter_rig.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/program.hpp>

// The worlds of the examples plate_sinkage, direct_shear and rigid_wheel.
dem::rig::bevameter::BevameterRig::PlateRun press_plates;
dem::rig::bevameter::BevameterRig::ShearRun cube8_verlet;
dem::rig::bevameter::BevameterRig::WheelRun roll_wheel;

int main(int argc, char** argv) {
  const dem::rig::MpiSession mpi(argc, argv);
  dem::rig::bevameter::BevameterRig rig(press_plates, cube8_verlet, roll_wheel);
  return dem::rig::run_program({.name = "bevameter",
                                .title = "Bevameter",
                                .about = "The constants of a soil of cubical sand grains, by plates and shear tests",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
