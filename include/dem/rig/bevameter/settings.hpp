#pragma once

#include <dem/rig/bed/grain_settings.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace dem::rig::bevameter {

/// Everything that can be chosen, in SI units. A value of 0 where it says "0: by size" is filled in by resolve(). All
/// apparatus have the same grains, of the same constants, as dense as each other.
struct Settings {
  std::string size = "quick";  ///< smoke, quick or full
  GrainSettings grains{.constants_for = 1.86e-3};
  double fall_speed = 0.0;        ///< m/s, at which the grains of the beds fall at most; 0: freely
  double relative_density = 0.0;  ///< of the beds; 0: as they settle. The sheared specimen is made as dense as the bed
                                  ///< of the plates has come out
  double stage_limit = 3.0;       ///< s; a stage of a bed that has not come to rest by then ends the run
  double stable_share = 0.8;      ///< time step, in largest stable ones
  bool sleep = false;             ///< grains at rest of the beds may sleep
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all, at least 1000 grains for each

  // Plates
  std::vector<double> widths;                                 ///< m, the smaller sides; empty: by size
  double plate_length = 0.0;                                  ///< m; 0: by size
  double plate_speed = 0.0;                                   ///< m/s; 0: by size
  double sinkage = 0.0;                                       ///< m; 0: by size
  double plate_friction = 0.0;                                ///< mu, grain on plate
  double bed_length = 0.0, bed_width = 0.0, bed_depth = 0.0;  ///< m, of the plates' bed; 0: by size
  std::uint64_t pieces = 5;                                   ///< that a curve is cut into for the errors

  // Shear
  std::vector<double> normal_stresses;  ///< Pa; empty: by size
  double shear_speed = 0.0;             ///< m/s; 0: by size
  double shear_travel = 0.0;            ///< m; 0: by size
  double shear_smoothing = 0.0375;      ///< of the travel, over which stresses are averaged

  // Wheel, in a bed of its own of the same soil
  std::string wheel;             ///< none, smooth, rough or grousers; empty: by size
  double wheel_friction = -1.0;  ///< mu, grain on wheel; negative: by the kind of wheel
  std::vector<double> slips;     ///< 1 - v/(omega r); empty: by size
  double load = 130.0;           ///< N
  double spin_deg = 0.0;         ///< deg/s; 0: by size
  double wheel_travel = 0.0;     ///< m, of the wheel in a run, its rim at most four times as far; 0: by size
  double path = 0.0;             ///< m, that the rim turns in each run; 0: as `wheel_travel` says
  double wheel_bed_length = 0.0, wheel_bed_width = 0.0, wheel_bed_depth = 0.0;  ///< m; 0: by size

  double confidence = 0.95;  ///< of the intervals
  std::string output = "bevameter_output";
  bool replay = true;
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of a replay, the largest; 0: none
  bool vtk = true;

  [[nodiscard]] bool has_wheel() const { return wheel != "none"; }
};

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size, "smoke (seconds, without a wheel), quick (a quarter of an hour) or full (many hours)");
  add("--fall-speed", s.fall_speed, "at which grains of the beds fall at most while they are rained [m/s]; 0: freely");
  add("--relative-density", s.relative_density, "of the beds, 0 (as they settle) to 1");
  add("--stage-limit", s.stage_limit, "a bed must be at rest by then [s]");
  add("--stable-share", s.stable_share, "time step, as a share of the largest stable one");
  add("--seed", s.seed, "of the rain");
  add_sleep_option(options, s.sleep);
  add("--confidence", s.confidence, "of the intervals");
  add("--threads", s.threads, "0: all, at least 1000 grains for each").changes_no_result();
  options.group("Plates");
  add("--plates", s.widths, "widths [m], at least two; empty: by size");
  add("--plate-length", s.plate_length, "[m]; 0: by size");
  add("--plate-speed", s.plate_speed, "[m/s]; 0: by size");
  add("--sinkage", s.sinkage, "[m]; 0: by size");
  add("--plate-friction", s.plate_friction, "mu, grain on plate");
  add("--bed-length", s.bed_length, "[m]; 0: by size");
  add("--bed-width", s.bed_width, "[m]; 0: by size");
  add("--bed-depth", s.bed_depth, "[m]; 0: by size");
  add("--pieces", s.pieces, "that the curve of a plate is cut into: the fits are made anew without each");
  options.group("Shear");
  add("--normal-stresses", s.normal_stresses,
      "that the shear box is loaded with [Pa], at least two, for a cohesion three; empty: by size");
  add("--shear-speed", s.shear_speed, "[m/s]; 0: by size");
  add("--shear-travel", s.shear_travel, "[m]; 0: by size");
  add("--shear-smoothing", s.shear_smoothing, "share of the travel over which stresses are averaged");
  options.group("Wheel");
  add("--wheel", s.wheel, "that the constants are tried on: none, smooth, rough or grousers; empty: by size")
      .one_of({"", "none", "smooth", "rough", "grousers"});
  add("--wheel-friction", s.wheel_friction, "mu, grain on wheel; negative: smooth 0.2, rough 0.8, grousers as grains");
  add("--slips", s.slips, "1 - v/(omega r); empty: by size");
  add("--load", s.load, "weight of wheel and shaft [N]");
  add("--spin", s.spin_deg, "[deg/s]; 0: by size");
  add("--wheel-travel", s.wheel_travel, "of the wheel in a run [m], its rim at most four times as far; 0: by size");
  add("--path", s.path, "that the rim turns in each run [m]; 0: as --wheel-travel says");
  add("--wheel-bed-length", s.wheel_bed_length, "[m]; 0: by size");
  add("--wheel-bed-width", s.wheel_bed_width, "[m]; 0: by size");
  add("--wheel-bed-depth", s.wheel_bed_depth, "[m]; 0: by size");
  add_grain_options(options, s.grains);
  add_output_options(options, s, "a plate, a load and a slip");
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  rig::find_idle(idle, s.grains);
  find_idle_replay(idle, s);
  const bool rolls = s.has_wheel() && !(s.wheel.empty() && s.size == "smoke");
  idle.unless(rolls, "with a --wheel",
              {"--wheel-friction", "--slips", "--load", "--spin", "--wheel-travel", "--path", "--wheel-bed-length",
               "--wheel-bed-width", "--wheel-bed-depth"});
  idle.unless(s.path == 0.0, "without --path", {"--wheel-travel"});
}

}  // namespace dem::rig::bevameter
