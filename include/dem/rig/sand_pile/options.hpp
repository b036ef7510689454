#pragma once

#include <dem/rig/contact_options.hpp>
#include <dem/rig/own_words.hpp>
#include <dem/rig/sand_pile/settings.hpp>

// Every option with the value that it sets, in the groups that --help shows.

namespace dem::rig::sand_pile {

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size,
      "smoke (seconds), quick (minutes; polyhedron half an hour and superquadric an hour a pile) or full (12000 "
      "grains, "
      "three seeds, 10 s of creep: two hours for a pile of cubes, days for all kinds; choose by --kinds and --seeds)");
  add("--method", s.method,
      "lift (a cylinder), funnel, or drain (a box, through a slot in its floor); a drum that turns is the example drum")
      .one_of({"lift", "funnel", "drain"});
  add("--kinds", s.kinds,
      "of grains, a pile of each: cube8 (eight spheres), polyhedron (sharp cubes), superquadric (rounded cubes), "
      "sphere; any of them with -viscous behind it (friction without springs); sphere-rolling (springs resist "
      "rolling); "
      "sphere-braked (a constant torque does); empty: by size");
  add("--seed", s.seed, "of the first pile of each kind; with --fill-file its number alone, in the names of files");
  add("--seeds", s.seeds, "piles of each kind; 0: by size");
  options.group("Grains");
  add("--half-edge", s.half_edge, "half edge of a cube; spheres have its volume [m]; 0: by size");
  add("--grains", s.grains, "number of grains; 0: by size");
  add("--density", s.density, "of a grain [kg/m^3]");
  add("--fill-file", s.fill_file,
      "start from grains at rest in their container: the KIND_SEED_filled.txt of an earlier run (of this shape, in "
      "this container), in place of raining them in");
  options.group("Apparatus");
  add("--plate", s.plate, "flat, or ridged: rings or bars a half-edge high").one_of({"flat", "ridged"});
  add("--plate-radius", s.plate_radius, "[m]; 0: three times the cylinder's");
  add("--plate-friction", s.plate_friction, "mu of grains on plate or floor; negative: as grain on grain");
  add("--cylinder-radius", s.cylinder_radius, "of the cylinder, and of the funnel's [m]; 0: half the fill's height");
  add("--lift-speed", s.lift_speed, "the largest one [m/s]");
  add("--orifice-radius", s.orifice_radius, "of the funnel [m]; 0: seven half-edges");
  add("--orifice-height", s.orifice_height, "above the plate [m]; 0: above a cone of 40 deg");
  add("--funnel-angle", s.funnel_angle_deg, "of the funnel's wall from the vertical [deg]");
  add("--box-length", s.box_length, "of the floor that grains stay on [m]; 0: from the number of grains");
  add("--box-width", s.box_width, "[m]; 0: sixteen half-edges");
  add("--slot-width", s.slot_width, "[m]; 0: twelve half-edges");
  add("--container-friction", s.container_friction,
      "mu of grains on cylinder or funnel (negative: 0), or a box's walls (negative: as the floor's)");
  options.group("Contacts");
  add("--stiffness", s.stiffness, "K [N/m], of a sphere of cube8; grains that touch once have four times this");
  add("--damping", s.damping, "C [N s/m], likewise");
  add_contact_options(options, s);
  add("--rolling-length", s.rolling_length,
      "of sphere-rolling and sphere-braked: rolling resists by this times the normal force [m]; 0: a fifth of the "
      "half-edge");
  add("--plate-rolling-length", s.plate_rolling_length, "the same on plate, floor and walls; negative: the same");
  add("--rolling-damping", s.rolling_damping, "of sphere-rolling: damping ratio of the springs that resist rolling");
  options.group("Stages");
  add("--settle-limit", s.settle_limit, "grains must be at rest in their container by then [s]");
  add("--flow-limit", s.flow_limit,
      "a funnel must have emptied by then; a box that still flows is measured as it is [s]");
  add("--rest-limit", s.rest_limit, "a pile that still moves is measured then [s]; 0: by size");
  add("--creep-time", s.creep_time, "for which the pile is watched [s]; 0: by size");
  add("--sample-time", s.sample_time, "between two samples [s]");
  options.group("Fit");
  add("--flank-low", s.flank_low, "share of the height at which the flank ends");
  add("--flank-high", s.flank_high, "share of the height at which the flank begins");
  add("--directions", s.directions, "lines through the flank of a heap; a drained box has a third as many");
  options.group("Numerics");
  add("--stable-share", s.stable_share, "time step as a share of the largest stable one");
  add("--threads", s.threads, "of all piles, which go side by side; 0: all, at least 1000 grains of a pile for each")
      .changes_no_result();
  add_sleep_option(options, s.sleep);
  add_output_options(options, s, "the first pile");
  add("--frame-time", s.frame_time, "between two frames for ParaView, or of the replay [s]");
}

/// Those that change nothing with these settings, which need not be resolved.
inline void find_idle(IdleOptions& idle, const Settings& s) {
  const bool lift = s.method == "lift", funnel = s.method == "funnel", drain = s.method == "drain";
  idle.unless(!drain, "with --method lift or funnel", {"--plate-radius", "--cylinder-radius"});
  idle.unless(lift, "with --method lift", {"--lift-speed"});
  idle.unless(funnel, "with --method funnel", {"--orifice-radius", "--orifice-height", "--funnel-angle"});
  idle.unless(drain, "with --method drain", {"--box-length", "--box-width", "--slot-width"});
  idle.unless(!lift, "with --method funnel or drain", {"--flow-limit"});
  const auto piles = [&](const char* kind) { return s.kinds.find(kind) != std::string::npos; };
  idle.unless(s.kinds.empty() || piles("sphere-rolling") || piles("sphere-braked"),
              "with --kinds sphere-rolling or sphere-braked", {"--rolling-length", "--plate-rolling-length"});
  idle.unless(s.kinds.empty() || piles("sphere-rolling"), "with --kinds sphere-rolling", {"--rolling-damping"});
  find_idle_replay(idle, s);
  idle.unless(s.scale_contacts, "with --scale-contacts true", {"--constants-for"});
  idle.unless(s.vtk || s.replay, "with files for ParaView or a replay, not with both --no-vtk and --no-replay",
              {"--frame-time"});
}

/// What the library calls otherwise than these options.
inline constexpr OwnWord own_words[] = {{"time_step_safety", "--stable-share"},
                                        {"raise the normal stiffness", "raise --stiffness"},
                                        {"the stiffness, or raise the damping", "--stiffness, or raise --damping"},
                                        {"raise machine().substeps", "lower --stiffness"}};

}  // namespace dem::rig::sand_pile
