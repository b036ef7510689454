// Which constants must grains have, to do in a test what a soil does? Friction, stiffness, packing and rolling
// resistance are looked for that reproduce an angle of friction, an angle of repose, or pressure and exponent of a
// plate's curve. See --help. Its runs are small and go side by side on the threads of one process.
//
//   calibrate --known 0.35                              a target of known friction is made, and found again
//   calibrate --phi 38.04 --loads 6.2,16.2,26.2         friction for table 3.3 of the thesis
//   calibrate --phi 32 --repose 25 --find friction,rolling
//   calibrate --phi 32 --checkpoint-every 60            --resume goes on after it was stopped
//   calibrate --config calibrate_output/settings.toml --go-on --trials 20
//
// Ends with 0 when all was done; 1 when the run ended early or a part of the report could not be made; 2 when the
// settings make no sense; 130 after Ctrl-C or SIGTERM.

#include "minimise.hpp"

#include <dem/rig/calibrate/calibrate_rig.hpp>
#include <dem/rig/program.hpp>

namespace rigs = dem::rig;

// The worlds of the examples direct_shear, plate_sinkage and sand_pile.
void cube8_verlet(const rigs::direct_shear::Settings&, rigs::direct_shear::Campaign&, rigs::Session&);
void press_plates(const rigs::plate_sinkage::Settings&, rigs::plate_sinkage::Campaign&, rigs::Session&);
void cube8(const rigs::sand_pile::Settings&, rigs::sand_pile::PileResult&, dem::report::Replay*, rigs::Session&,
           rigs::Stages&);
void sphere(const rigs::sand_pile::Settings&, rigs::sand_pile::PileResult&, dem::report::Replay*, rigs::Session&,
            rigs::Stages&);

int main(int argc, char** argv) {
  rigs::calibrate::CalibrateRig rig({cube8_verlet, press_plates, cube8, sphere}, minimise);
  return rigs::run_program({.name = "calibrate",
                            .title = "Calibration of grains",
                            .about = "Constants of grains that reproduce what a soil does in tests",
                            .footer = rigs::exit_codes},
                           rig, argc, argv);
}
