#pragma once
// A levelled bed of grains in an open box, as options of a rig.

#include <dem/rig/bed/grain_settings.hpp>
#include <dem/rig/own_words.hpp>
#include <dem/soil/fall_speed.hpp>

#include <cstdint>
#include <string>

namespace dem::rig {

/// A bed that is rained into a box, made as dense as asked for, and levelled by a lid. SI units.
struct BedSettings {
  double length = 0.0;            ///< m, inner length of the box along x; 0: by size
  double width = 0.0;             ///< m, along y; 0: by size
  double depth = 0.0;             ///< m, of the bed as it settles at relative density 0; 0: by size
  double fall_speed = 0.0;        ///< m/s, at which grains fall at most while they are rained; 0: freely
  double relative_density = 0.0;  ///< 0: as it settles
  double densify_time = 0.5;      ///< s, in which friction goes to zero while the bed is shaken
  double shake_amplitude = 2e-4;  ///< m
  double shake_frequency = 25.0;  ///< Hz
  double strike_off = 0.02;       ///< share of the grains, the highest, that are taken off before the lid comes
  double lid_pressure = 1000.0;   ///< Pa, of the lid's weight
  double lid_speed = 0.05;        ///< m/s, at which the lid comes down
  double stage_limit = 3.0;       ///< s; a stage that has not come to rest by then ends the run
  double wall_thickness = 0.01;   ///< m
  double half_mass = 2.0;         ///< kg, of either half of a box on slides
  double half_stiffness = 1e7;    ///< N/m, of the actuators that hold the halves, which are damped critically
  double stable_share = 0.8;      ///< time step, in largest stable ones
  std::uint64_t seed = 1;         ///< of the rain
  int threads = 0;                ///< 0: all, at least 1000 grains for each
  bool sleep = false;             ///< grains at rest may sleep
  std::string file;               ///< .h5: a bed as it was saved; else grains that settle and are levelled anew
  std::string save;               ///< .h5: with all contacts; empty: <output>/bed.txt

  /// Whether the file is the state of a bed, or is to be one.
  static bool is_state(const std::string& file) { return file.ends_with(".h5"); }
  /// Whether grains are rained, in this run or in the one that saved the state of the bed.
  [[nodiscard]] bool is_rained() const { return file.empty() || is_state(file); }
};

/// What the sizes of a rig differ in.
struct BedBySize {
  double length, width, depth;  ///< m
};

/// Names the options of a bed, in a group of their own.
inline void add_bed_options(Options& options, BedSettings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  options.group("Bed");
  add("--bed-length", s.length, "inner length of the box, along x [m]; 0: by size");
  add("--bed-width", s.width, "inner width [m]; 0: by size");
  add("--bed-depth", s.depth, "of the bed as it settles [m]; 0: by size");
  add("--fall-speed", s.fall_speed, "at which grains fall at most while they are rained [m/s]; 0: freely");
  add("--relative-density", s.relative_density, "0 (as it settles) to 1 (the densest)");
  add("--densify-time", s.densify_time, "friction goes to zero in this time while the bed is shaken [s]");
  add("--shake-amplitude", s.shake_amplitude, "[m]");
  add("--shake-frequency", s.shake_frequency, "[Hz]");
  add("--strike-off", s.strike_off, "share of the grains, the highest, taken off before the lid comes");
  add("--lid-pressure", s.lid_pressure, "of the lid that levels the bed [Pa]");
  add("--lid-speed", s.lid_speed, "[m/s]");
  add("--stage-limit", s.stage_limit,
      "a bed, a lid or what is set down on the bed must be at rest by then [s]; with --fall-speed, after the fall")
      .changes_no_result();
  add("--stable-share", s.stable_share, "time step, as a share of the largest stable one");
  add("--seed", s.seed, "of the rain");
  add("--threads", s.threads, "0: all, at least 1000 grains for each").changes_no_result();
  add_sleep_option(options, s.sleep);
  add("--bed-file", s.file,
      ".h5: take the bed as it was saved, with the same settings; else read grains from this file instead of raining "
      "them");
  add("--save-bed", s.save,
      "file for the levelled bed; .h5: with all contacts, so that it needs no settling (needs HDF5); empty: bed.txt in "
      "the output folder");
}

/// Those that change nothing with a bed from a file, or one that is not shaken.
inline void find_idle(IdleOptions& idle, const BedSettings& s) {
  idle.unless(s.file.empty(), "without --bed-file: a bed that is read is not saved again", {"--save-bed"});
  idle.unless(s.is_rained(), "without --bed-file, which fixes the grains",
              {"--bed-depth", "--fall-speed", "--relative-density", "--densify-time", "--shake-amplitude",
               "--shake-frequency", "--strike-off", "--seed"});
  if (!s.is_rained()) return;
  idle.unless(s.relative_density != 0.0, "with a --relative-density above 0, for which a bed is shaken",
              {"--densify-time", "--shake-amplitude", "--shake-frequency"});
}

/// What the library calls otherwise than the options of grains and beds.
inline std::vector<OwnWord> bed_words() {
  return {{"time_step_safety", "--stable-share"},
          {"lower time_step (now", "lower --stable-share (the time step is now"},
          {"time_step", "--stable-share"},
          {"raise the normal stiffness", "raise --stiffness"},
          {"the stiffness, or raise the damping", "--stiffness, or raise --damping"},
          {"close the walls, ", ""},
          {", or enlarge domain", ""},
          {"raise machine().substeps", "lower --stiffness"}};
}

/// Fills in what was left open, and checks every option against its range. `output` is the folder of the run. Throws
/// Error.
inline void resolve(BedSettings& s, const BedBySize& by_size, const std::string& output) {
  fill(s.length, by_size.length);
  fill(s.width, by_size.width);
  fill(s.depth, by_size.depth);
  if (s.save.empty()) s.save = (output.empty() ? "" : output + "/") + "bed.txt";
  require_positive(s.length, "--bed-length", "m (0: by size)");
  require_positive(s.width, "--bed-width", "m (0: by size)");
  require_positive(s.depth, "--bed-depth", "m (0: by size)");
  soil::require_fall_speed(s.fall_speed, "--fall-speed");
  require_within(s.relative_density, 0.0, 1.0, "--relative-density");
  require_positive(s.densify_time, "--densify-time", "s");
  require_within(s.shake_amplitude, 0.0, 0.01, "--shake-amplitude (m)");
  require_within(s.shake_frequency, 0.1, 1000.0, "--shake-frequency (Hz)");
  require_within(s.strike_off, 0.0, 0.9, "--strike-off");
  require_positive(s.lid_pressure, "--lid-pressure", "Pa");
  require_positive(s.lid_speed, "--lid-speed", "m/s");
  require_positive(s.stage_limit, "--stage-limit", "s");
  require_within(s.stable_share, 1e-3, 1.0, "--stable-share");
  require_within(s.threads, 0.0, 4096.0, "--threads (0: all)");
}

/// How many grains of `volume` (m^3) fill the box to its depth as they settle. Throws Error for none, and for more than
/// 10^8, or a box in which the surface is less than two grains across.
inline std::uint64_t grains_in(const BedSettings& s, const GrainSettings& grains, double volume) {
  const double least = 2.0 * grains.edge();
  require_within(s.length, least, 1e3, "--bed-length (m, from two edges of a grain)");
  require_within(s.width, least, 1e3, "--bed-width (m, from two edges of a grain)");
  const double count = std::round(s.length * s.width * s.depth * soil::solid_fraction_at(0.0, grains.limits) / volume);
  if (count >= 1.0 && count <= 1e8) return static_cast<std::uint64_t>(count);
  fail(
      "{:.4g} grains fill a bed of {:g} x {:g} x {:g} m, but there must be 1 to 10^8; change --half-edge, "
      "--bed-length, "
      "--bed-width or --bed-depth",
      count, s.length, s.width, s.depth);
}

/// How the grains fall, for a report; empty where they fall freely.
inline std::string fall_text(const BedSettings& s) {
  return s.fall_speed > 0.0 ? text(" at {:g} m/s at most", s.fall_speed) : "";
}

/// Adds names and values for a report.
inline void list_settings(NamesAndValues& list, const BedSettings& s) {
  const std::string name = s.file.substr(s.file.rfind('/') + 1);
  list.insert(
      list.end(),
      {{"box", text("{:g} x {:g} mm", 1e3 * s.length, 1e3 * s.width)},
       {"bed", s.file.empty() ? text("{:g} mm deep as it settles, rained{}, seed {}, relative density {:g} asked "
                                     "for",
                                     1e3 * s.depth, fall_text(s), s.seed, s.relative_density)
                              : "from " + name},
       {"levelled by a lid of", text("{:g} kPa", 1e-3 * s.lid_pressure)}});
}

}  // namespace dem::rig
