#pragma once

#include "settings.hpp"

#include <CLI/CLI.hpp>

#include <string>

// The command line: every option with the value that it sets, in the groups that --help shows.

namespace direct_shear {

inline void add_specimen_options(CLI::App& app, Settings& s) {
  const std::string group = "Specimen and box";
  const auto add = [&](const char* name, auto& value, const char* text) {
    return app.add_option(name, value, text)->group(group)->capture_default_str();
  };
  add("--shape", s.shape,
      "of the cubes: cube8 (eight spheres), polyhedron (sharp edges) or superquadric (rounded); the last two with "
      "--integrator verlet")
      ->check(CLI::IsMember({"cube8", "polyhedron", "superquadric"}));
  add("--half-edge", s.half_edge, "half edge of a cube [m]; 0: by size (full: 0.0009)");
  add("--grains", s.grains, "number of grains; 0: the fill of 14256 of half-edge 0.0009");
  add("--box-length", s.box_length, "inner length along the shearing direction [m]");
  add("--box-width", s.box_width, "inner width [m]");
  add("--box-height", s.box_height, "inner height [m]");
  add("--seam-height", s.seam_height, "where the halves meet [m]; 0: half the specimen");
  add("--wall-thickness", s.wall_thickness, "[m], at least the travel; 0: 15 mm or twice the travel");
  add("--lid-clearance", s.lid_clearance, "lid to wall, in radii of a grain's sphere");
  add("--packing", s.packing, "random or poured")->check(CLI::IsMember({"random", "poured"}));
  add("--relative-density", s.relative_density,
      "of a random packing, 0 (as it settles) to 1 (the densest of the shape); negative: by shape (cube8: 0.18, "
      "others: "
      "0.5)");
  add("--tilt", s.tilt_deg, "of the poured block about each axis [deg]");
  add("--shake-amplitude", s.shake_amplitude, "[m]");
  add("--shake-frequency", s.shake_frequency, "[Hz]");
  add("--shake-time", s.shake_time, "for a poured packing [s]");
  add("--densify-time", s.densify_time, "for a random packing: friction goes to zero in this time [s]");
  add("--strike-off", s.strike_off,
      "share of the grains, the highest ones, that are taken off before the test, as a straight edge levels a "
      "specimen; "
      "negative: by shape (polyhedron: 0.18, for columns of sharp cubes would carry the lid; others: 0)");
  add("--settle-limit", s.settle_limit, "a packing must be at rest by then [s]");
  add("--packing-file", s.packing_file, "read the packing from this file instead of making one");
  add("--save-packing", s.save_packing, "file for the packing; empty: packing.txt in the output folder");
  app.add_flag("--packing-only", s.packing_only, "make, measure and save the packing; no test")
      ->group(group)
      ->default_str("false");
}

inline void add_contact_options(CLI::App& app, Settings& s) {
  const std::string group = "Contacts";
  const auto add = [&](const char* name, auto& value, const char* text) {
    app.add_option(name, value, text)->group(group)->capture_default_str();
  };
  add("--stiffness", s.stiffness, "K [N/m]; 0: by shape (cube8: 20000, a sphere; others: 80000, as four of them)");
  add("--damping", s.damping, "C [N s/m]; negative: by shape (cube8: 0.015, others: 0.06)");
  add("--separation-factor", s.separation_factor, "Sp, share of C while separating");
  add("--friction", s.friction, "mu, grain on grain");
  add("--wall-friction", s.wall_friction, "mu, grain on wall; negative: as grain on grain");
  add("--friction-stiffness", s.friction_stiffness, "kt [N/m]; negative: as K");
  add("--velocity-stiffness", s.velocity_stiffness, "cv [N s/m]; negative: by shape, as C");
  add("--breaking-factor", s.breaking_factor, "friction kept by a broken asperity");
  add("--density", s.density, "of a grain [kg/m^3]");
  add("--constants-for", s.constants_for, "half-edge that K, kt, C and cv are given for [m]");
  add("--scale-contacts", s.scale_contacts, "scale them to other sizes: K, kt ~ size, C, cv ~ size^2");
}

inline void add_test_options(CLI::App& app, Settings& s) {
  std::string group = "Test";
  const auto add = [&](const char* name, auto& value, const char* text) {
    return app.add_option(name, value, text)->group(group)->capture_default_str();
  };
  add("--loads", s.loads, "masses on the lid [kg], e.g. 6.2,16.2,26.2")->delimiter(',');
  add("--lid-speed", s.lid_speed, "[m/s]");
  add("--rest-speed", s.rest_speed, "the lid is at rest below it [m/s]");
  add("--consolidation-limit", s.consolidation_limit, "[s]");
  add("--shear-speed", s.shear_speed, "[m/s]; 0: by size");
  add("--travel", s.travel, "[m]; 0: by size");
  add("--ramp-time", s.ramp_time, "smooth start of the shearing [s]");
  add("--smoothing", s.smoothing, "the maximum is that of the stress averaged over this travel [m]");
  add("--residual-share", s.residual_share, "last share of the travel that the residual is the mean of");
  add("--area-correction", s.area_correction, "divide by the area that shrinks as the halves slide apart");
  group = "Numerics";
  add("--integrator", s.integrator, "predictor-corrector, verlet or euler")
      ->check(CLI::IsMember({"predictor-corrector", "verlet", "euler"}));
  add("--time-step", s.time_step, "[s], at most the largest stable one; 0: a share of that");
  add("--stable-share", s.stable_share, "the share; grains are poured at 0.8 in any case");
  app.add_flag("--allow-unstable-time-step", s.allow_unstable_time_step, "take a --time-step above the stable one")
      ->group(group)
      ->default_str("false");
  add("--overlap-limit", s.overlap_limit,
      "overlap that ends the run, in effective diameters 2 Ri Rj/(Ri + Rj): the radius of two equal spheres, the "
      "diameter of a sphere on a wall; other shapes count as spheres of their volume");
  add("--seed", s.seed, "of a random packing");
  add("--threads", s.threads, "0: all, at least 1000 grains for each");
  group = "Output";
  add("--output", s.output, "folder; results of an earlier run in it are replaced");
  // The name with the plain meaning comes first: it is the one that settings.toml gets.
  app.add_flag("--vtk,!--no-vtk", s.vtk, "files for ParaView (--vtk=true) or none (--no-vtk)")
      ->group(group)
      ->default_str("true");
  app.add_flag("--vtk-spheres", s.vtk_spheres, "ParaView files also with the eight spheres of each grain")
      ->group(group)
      ->default_str("false");
  add("--vtk-interval", s.vtk_interval, "travel between two frames [m]; 0: a twentieth of the travel");
}

}  // namespace direct_shear
