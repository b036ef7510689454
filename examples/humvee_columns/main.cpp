// The Humvee on columns of semi-empirical soil (dynamic Bekker): the car of chapter 6 of the thesis, without grains, so
// that it drives about as fast as in real time. It runs on one process, drives of a study on its threads. See --help.
//
//   humvee_columns                                     25 m of dry sand
//   humvee_columns --lane hard:8,dry-sand:12           from hard ground into sand
//   humvee_columns --study slopes                      speed over slope, until it no longer climbs
//   humvee_columns --study drawbar                     pull over slip, held on a load cell
//   humvee_columns --study map --checkpoint-every 60   slope x side slope, side by side; --resume goes on
//
// Ends with 0 when all was done, also when the car digs in or rolls over, which is what was found; 1 when the run ended
// early or a part of the report could not be made; 2 when the settings make no sense; 130 after Ctrl-C or SIGTERM.

#include <dem/rig/mobility/mobility_rig.hpp>
#include <dem/rig/program.hpp>
#include <dem/terramechanics/soil_reader.hpp>

int main(int argc, char** argv) {
  dem::rig::mobility::MobilityRig rig(dem::terramechanics::find_soil);
  return dem::rig::run_program({.name = "humvee_columns",
                                .title = "Humvee on columns of soil",
                                .about = "A Humvee drives on columns of semi-empirical soil",
                                .footer = dem::rig::exit_codes},
                               rig, argc, argv);
}
