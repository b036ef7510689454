#pragma once

#include <dem/rig/contact_options.hpp>
#include <dem/rig/direct_shear/settings.hpp>
#include <dem/rig/own_words.hpp>

// Every option with the value that it sets, in the groups that --help shows.

namespace dem::rig::direct_shear {

namespace detail {

inline void add_specimen_options(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  options.group("Specimen and box");
  add("--shape", s.shape,
      "of the cubes: cube8 (eight spheres), polyhedron (sharp edges) or superquadric (rounded); the last two with "
      "--integrator verlet")
      .one_of({"cube8", "polyhedron", "superquadric"});
  add("--half-edge", s.half_edge, "half edge of a cube [m]; 0: by size (full: 0.0009)");
  add("--grains", s.grains, "number of grains; 0: the fill of 14256 of half-edge 0.0009");
  add("--box-length", s.box_length, "inner length along the shearing direction [m]");
  add("--box-width", s.box_width, "inner width [m]");
  add("--box-height", s.box_height, "inner height [m]");
  add("--seam-height", s.seam_height, "where the halves meet [m]; 0: half the specimen");
  add("--wall-thickness", s.wall_thickness, "[m], at least the travel; 0: 15 mm or twice the travel");
  add("--lid-clearance", s.lid_clearance, "lid to wall, in radii of a grain's sphere");
  add("--packing", s.packing, "random or poured").one_of({"random", "poured"});
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
  options.flag("--packing-only", s.packing_only, "make, measure and save the packing; no test");
}

inline void add_contact_options(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { options.add(name, value, text); };
  options.group("Contacts");
  add("--stiffness", s.stiffness, "K [N/m]; 0: by shape (cube8: 20000, a sphere; others: 80000, as four of them)");
  add("--damping", s.damping, "C [N s/m]; negative: by shape (cube8: 0.015, others: 0.06)");
  add("--wall-friction", s.wall_friction, "mu, grain on wall; negative: as grain on grain");
  add("--density", s.density, "of a grain [kg/m^3]");
  rig::add_contact_options(options, s);
}

inline void add_test_options(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  options.group("Test");
  add("--loads", s.loads, "masses on the lid [kg], e.g. 6.2,16.2,26.2");
  add("--lid-speed", s.lid_speed, "[m/s]");
  add("--rest-speed", s.rest_speed, "the lid is at rest below it [m/s]");
  add("--consolidation-limit", s.consolidation_limit, "[s]");
  add("--shear-speed", s.shear_speed, "[m/s]; 0: by size");
  add("--travel", s.travel, "[m]; 0: by size");
  add("--ramp-time", s.ramp_time, "smooth start of the shearing [s]");
  add("--smoothing", s.smoothing, "the maximum is that of the stress averaged over this travel [m]");
  add("--residual-share", s.residual_share, "last share of the travel that the residual is the mean of");
  add("--area-correction", s.area_correction, "divide by the area that shrinks as the halves slide apart");
  options.group("Numerics");
  add("--integrator", s.integrator, "predictor-corrector, verlet or euler")
      .one_of({"predictor-corrector", "verlet", "euler"});
  add("--time-step", s.time_step, "[s], at most the largest stable one; 0: a share of that");
  add("--stable-share", s.stable_share, "the share; grains are poured at 0.8 in any case");
  options.flag("--allow-unstable-time-step", s.allow_unstable_time_step, "take a --time-step above the stable one");
  add("--overlap-limit", s.overlap_limit,
      "overlap that ends the run, in effective diameters 2 Ri Rj/(Ri + Rj): the radius of two equal spheres, the "
      "diameter of a sphere on a wall; other shapes count as spheres of their volume");
  add("--seed", s.seed, "of a random packing");
  add("--threads", s.threads, "0: all, at least 1000 grains for each").changes_no_result();
  add_output_options(options, s, "the load in the middle");
  options.flag("--vtk-spheres", s.vtk_spheres, "ParaView files also with the eight spheres of each grain");
  add("--vtk-interval", s.vtk_interval, "travel between two frames [m]; 0: a twentieth of the travel");
}

}  // namespace detail

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  options.add("--size", s.size, "smoke (seconds), quick (minutes) or full (14256 grains)");
  detail::add_specimen_options(options, s);
  detail::add_contact_options(options, s);
  detail::add_test_options(options, s);
}

/// Those that change nothing with these settings, which need not be resolved.
inline void find_idle(IdleOptions& idle, const Settings& s) {
  const bool made = s.packing_file.empty(), random = s.packing == "random";
  idle.unless(made, "without --packing-file, which fixes the packing",
              {"--grains", "--packing", "--relative-density", "--tilt", "--shake-amplitude", "--shake-frequency",
               "--shake-time", "--densify-time", "--settle-limit", "--seed", "--save-packing"});
  if (made) {
    idle.unless(random, "with --packing random", {"--relative-density", "--densify-time", "--seed"});
    idle.unless(!random, "with --packing poured", {"--tilt", "--shake-time"});
    idle.unless(!random || s.relative_density != 0.0,
                "with a --relative-density above 0, for which a packing is shaken",
                {"--densify-time", "--shake-amplitude", "--shake-frequency"});
  }
  idle.unless(!s.packing_only, "without --packing-only, for it is of the test",
              {"--stable-share", "--strike-off", "--loads", "--lid-speed", "--rest-speed", "--consolidation-limit",
               "--shear-speed", "--travel", "--ramp-time", "--smoothing", "--residual-share", "--area-correction",
               "--replay", "--replay-forces", "--vtk-spheres", "--vtk-interval"});
  find_idle_replay(idle, s);
  idle.unless(s.scale_contacts, "with --scale-contacts true", {"--constants-for"});
  idle.unless(s.time_step == 0.0, "without --time-step, which sets the step", {"--stable-share"});
  idle.unless(s.time_step != 0.0, "with --time-step", {"--allow-unstable-time-step"});
  idle.unless(s.shape == "cube8", "with --shape cube8", {"--vtk-spheres"});
  idle.unless(s.vtk, "with files for ParaView, without --no-vtk", {"--vtk-spheres", "--vtk-interval"});
}

/// What the library calls otherwise than these options.
inline constexpr OwnWord own_words[] = {
    {"allow_unstable_time_step", "--allow-unstable-time-step"},
    {"time_step_safety", "--stable-share"},
    {"time_step", "--time-step"},
    {"overlap_limit", "--overlap-limit"},
    {"save_packing", "--save-packing"},
    {"raise the normal stiffness", "raise --stiffness"},
    {"the stiffness, or raise the damping", "--stiffness, or raise --damping"},
    {"close the walls, ", ""},
    {", or enlarge domain", ""},
    {"raise machine().substeps", "lower --stiffness"},
};

}  // namespace dem::rig::direct_shear
