#pragma once
// The settings of a bevameter, and what they make of those of its apparatus.

#include <dem/rig/bevameter/apparatus_words.hpp>
#include <dem/rig/direct_shear/resolve.hpp>
#include <dem/rig/plate_sinkage/settings.hpp>
#include <dem/rig/rigid_wheel/settings.hpp>

#include <cstdint>
#include <filesystem>
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
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all, at least 1000 grains for each

  // Plates
  std::vector<double> widths;                                 ///< m, the smaller sides; empty: by size
  double plate_length = 0.0;                                  ///< m; 0: by size
  double plate_speed = 0.0;                                   ///< m/s; 0: by size
  double sinkage = 0.0;                                       ///< m; 0: by size
  double bed_length = 0.0, bed_width = 0.0, bed_depth = 0.0;  ///< m, of the plates' bed; 0: by size
  double pieces = 5.0;                                        ///< that a curve is cut into for the errors

  // Shear
  std::vector<double> normal_stresses;  ///< Pa; empty: by size
  double shear_speed = 0.0;             ///< m/s; 0: by size
  double shear_travel = 0.0;            ///< m; 0: by size
  double shear_smoothing = 0.0375;      ///< of the travel, over which stresses are averaged

  // Wheel, in a bed of its own of the same soil
  std::string wheel;          ///< none, smooth, rough or grousers; empty: by size
  std::vector<double> slips;  ///< 1 - v/(omega r); empty: by size
  double load = 130.0;        ///< N
  double spin_deg = 0.0;      ///< deg/s; 0: by size
  double path = 0.0;          ///< m; 0: by size
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
  add("--size", s.size, "smoke (seconds, without a wheel), quick (minutes) or full (many hours)");
  add("--fall-speed", s.fall_speed, "at which grains of the beds fall at most while they are rained [m/s]; 0: freely");
  add("--relative-density", s.relative_density, "of the beds, 0 (as they settle) to 1");
  add("--seed", s.seed, "of the rain");
  add("--confidence", s.confidence, "of the intervals");
  add("--threads", s.threads, "0: all, at least 1000 grains for each").changes_no_result();
  options.group("Plates");
  add("--plates", s.widths, "widths [m], at least two; empty: by size");
  add("--plate-length", s.plate_length, "[m]; 0: by size");
  add("--plate-speed", s.plate_speed, "[m/s]; 0: by size");
  add("--sinkage", s.sinkage, "[m]; 0: by size");
  add("--bed-length", s.bed_length, "[m]; 0: by size");
  add("--bed-width", s.bed_width, "[m]; 0: by size");
  add("--bed-depth", s.bed_depth, "[m]; 0: by size");
  add("--pieces", s.pieces, "that the curve of a plate is cut into: the fits are made anew without each");
  options.group("Shear");
  add("--normal-stresses", s.normal_stresses, "[Pa], at least two, for a cohesion three; empty: by size");
  add("--shear-speed", s.shear_speed, "[m/s]; 0: by size");
  add("--shear-travel", s.shear_travel, "[m]; 0: by size");
  add("--shear-smoothing", s.shear_smoothing, "share of the travel over which stresses are averaged");
  options.group("Wheel");
  add("--wheel", s.wheel, "that the constants are tried on: none, smooth, rough or grousers; empty: by size")
      .one_of({"", "none", "smooth", "rough", "grousers"});
  add("--slips", s.slips, "1 - v/(omega r); empty: by size");
  add("--load", s.load, "weight of wheel and shaft [N]");
  add("--spin", s.spin_deg, "[deg/s]; 0: by size");
  add("--path", s.path, "that the rim turns [m]; 0: by size");
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
  idle.unless(
      rolls, "with a --wheel",
      {"--slips", "--load", "--spin", "--path", "--wheel-bed-length", "--wheel-bed-width", "--wheel-bed-depth"});
}

/// Throws Error where a way (m) ends before its smooth start (s) does.
inline void require_start(double way, double speed, double start, const char* way_option, const char* speed_option) {
  if (!(way > 0.0 && speed > 0.0 && way < start * speed)) return;
  fail("{} is {:g} m, which takes {:.3g} s, but the smooth start takes {:g} s; raise it to {:.3g} m, or lower {}",
       way_option, way, way / speed, start, 1.01 * start * speed, speed_option);
}

/// The bed of an apparatus.
inline BedSettings bed_of(const Settings& s, double length, double width, double depth) {
  BedSettings bed;
  bed.length = length, bed.width = width, bed.depth = depth;
  bed.relative_density = s.relative_density;
  bed.fall_speed = s.fall_speed;
  bed.seed = s.seed;
  bed.threads = s.threads;
  return bed;
}

/// The folder of an apparatus.
inline std::string folder_in(const Settings& s, const char* apparatus) {
  return (std::filesystem::path(s.output) / apparatus).string();
}

/// The plates, drawn up again at the end.
inline plate_sinkage::Settings plates_of(const Settings& s) {
  plate_sinkage::Settings p;
  p.size = s.size;
  p.grains = s.grains;
  p.bed = bed_of(s, s.bed_length, s.bed_width, s.bed_depth);
  p.widths = s.widths;
  p.length = s.plate_length;
  p.speed = s.plate_speed;
  p.sinkage = s.sinkage;
  p.unload = true;
  p.output = folder_in(s, "plates");
  p.replay = s.replay;
  p.replay_forces = s.replay_forces;
  p.vtk = s.vtk;
  plate_sinkage::resolve(p);
  return p;
}

/// The shear test. The box has as many grains along each edge as that of the direct shear rig's quick size (smoke: its
/// smoke size), whatever their size.
inline direct_shear::Settings shear_of(const Settings& s, double relative_density) {
  const double scale = s.grains.half_edge / (s.size == "smoke" ? 3e-3 : 1.6e-3);
  direct_shear::Settings d;
  d.size = s.size;
  d.half_edge = s.grains.half_edge;
  d.box_length = d.box_width = 0.06 * scale;
  d.box_height = 0.05 * scale;
  d.grains = s.size == "smoke" ? 385 : 2537;
  d.stiffness = s.grains.stiffness;
  d.damping = s.grains.damping;
  d.separation_factor = s.grains.separation_factor;
  d.friction = s.grains.friction;
  d.wall_friction = s.grains.wall_friction;
  d.friction_stiffness = s.grains.friction_stiffness;
  d.velocity_stiffness = s.grains.velocity_stiffness;
  d.breaking_factor = s.grains.breaking_factor;
  d.density = s.grains.density;
  d.constants_for = s.grains.constants_for;
  d.scale_contacts = s.grains.scale_contacts;
  d.relative_density = std::clamp(relative_density, 0.0, 1.0);
  d.shear_speed = s.shear_speed;
  d.travel = s.shear_travel;
  d.smoothing = s.shear_smoothing * s.shear_travel;
  for (const double sigma : s.normal_stresses) d.loads.push_back(sigma * d.area() / 9.81);
  d.seed = s.seed;
  d.threads = s.threads;
  d.output = folder_in(s, "shear");
  d.replay = s.replay;
  d.replay_forces = s.replay_forces;
  d.vtk = s.vtk;
  direct_shear::resolve(d);
  return d;
}

/// The wheel; `soil` is the file of the soil that was found, empty before.
inline rigid_wheel::Settings wheel_of(const Settings& s, const std::string& soil) {
  rigid_wheel::Settings w;
  w.size = s.size;
  w.grains = s.grains;
  w.bed = bed_of(s, s.wheel_bed_length, s.wheel_bed_width, s.wheel_bed_depth);
  w.wheel = s.wheel;
  w.load = s.load;
  w.spin_deg = s.spin_deg;
  w.slips = s.slips;
  w.path = s.path;
  w.soil = soil;
  w.output = folder_in(s, "wheel");
  w.replay = s.replay;
  w.replay_forces = s.replay_forces;
  w.vtk = s.vtk;
  rigid_wheel::resolve(w);
  return w;
}

/// Fills in what depends on the size, and checks every option against its range, also those of the apparatus. Throws
/// Error.
inline void resolve(Settings& s) {
  struct Defaults {
    double half_edge;
    BedBySize bed;
    double plate_length, plate_speed, sinkage;
    std::vector<double> widths, stresses;
    double shear_speed, shear_travel;
    const char* wheel;
    BedBySize wheel_bed;
    double spin_deg, path;
    std::vector<double> slips;
  };
  const auto by_size = BySize<Defaults>{.smoke = {4e-3,
                                                  {0.10, 0.06, 0.04},
                                                  0.05,
                                                  0.10,
                                                  5e-3,
                                                  {0.02, 0.03, 0.04},
                                                  {5e3, 15e3, 30e3},
                                                  0.04,
                                                  2.6e-3,
                                                  "none",
                                                  {0.30, 0.18, 0.03},
                                                  90.0,
                                                  0.03,
                                                  {0.3}},
                                        .quick = {4e-3,
                                                  {0.17, 0.30, 0.12},
                                                  0.10,
                                                  0.05,
                                                  0.02,
                                                  {0.03, 0.045, 0.06},
                                                  {5e3, 10e3, 20e3, 40e3},
                                                  0.02,
                                                  10e-3,
                                                  "rough",
                                                  {0.46, 0.40, 0.055},
                                                  90.0,
                                                  0.15,
                                                  {-0.3, 0.1, 0.3, 0.6}},
                                        .full = {1.86e-3,
                                                 {0.25, 0.20, 0.2833},
                                                 0.13,
                                                 0.01,
                                                 0.03,
                                                 {0.03, 0.05, 0.07},
                                                 {5e3, 10e3, 20e3, 40e3},
                                                 0.01,
                                                 5e-3,
                                                 "rough",
                                                 {0.50, 0.40, 0.05},
                                                 17.0,
                                                 0.20,
                                                 {-0.5, -0.3, -0.1, 0.0, 0.1, 0.3, 0.5}}}[size_named(s.size)];
  rig::resolve(s.grains, by_size.half_edge);
  const auto fill_all = [](std::initializer_list<std::pair<double*, double>> all) {
    for (const auto& [value, by] : all) fill(*value, by);
  };
  fill_all({{&s.plate_length, by_size.plate_length},
            {&s.plate_speed, by_size.plate_speed},
            {&s.sinkage, by_size.sinkage},
            {&s.bed_length, by_size.bed.length},
            {&s.bed_width, by_size.bed.width},
            {&s.bed_depth, by_size.bed.depth},
            {&s.shear_speed, by_size.shear_speed},
            {&s.shear_travel, by_size.shear_travel},
            {&s.spin_deg, by_size.spin_deg},
            {&s.path, by_size.path},
            {&s.wheel_bed_length, by_size.wheel_bed.length},
            {&s.wheel_bed_width, by_size.wheel_bed.width},
            {&s.wheel_bed_depth, by_size.wheel_bed.depth}});
  if (s.widths.empty()) s.widths = by_size.widths;
  if (s.normal_stresses.empty()) s.normal_stresses = by_size.stresses;
  if (s.wheel.empty()) s.wheel = by_size.wheel;
  if (s.slips.empty()) s.slips = by_size.slips;
  require_within(s.confidence, 0.5, 0.999, "--confidence");
  require_within(s.pieces, 2.0, 50.0, "--pieces");
  require_within(s.shear_smoothing, 0.0, 0.5, "--shear-smoothing");
  if (s.widths.size() < 2) {
    fail("--plates has {} width, but k_c and k_phi need plates of at least two; three are usual", s.widths.size());
  }
  if (s.normal_stresses.size() < 2) {
    fail(
        "--normal-stresses has {} stress, but the error of the friction angle needs at least two, and a cohesion "
        "three; "
        "four are usual",
        s.normal_stresses.size());
  }
  for (std::size_t k = 0; k < s.normal_stresses.size(); ++k) {
    const double sigma = require_within(s.normal_stresses[k], 10.0, 1e7, "a stress of --normal-stresses (Pa)");
    for (std::size_t other = 0; other < k; ++other) {
      if (text("{:.1f}", 1e-3 * s.normal_stresses[other]) != text("{:.1f}", 1e-3 * sigma)) continue;
      fail("{:g} and {:g} Pa of --normal-stresses are the same to 0.1 kPa; leave one out", s.normal_stresses[other],
           sigma);
    }
  }
  require_start(s.sinkage, s.plate_speed, plate_sinkage::Settings{}.ramp_time, "--sinkage", "--plate-speed");
  require_start(s.shear_travel, s.shear_speed, direct_shear::Settings{}.ramp_time, "--shear-travel", "--shear-speed");
  in_words(plate_words, [&] { plates_of(s); });
  in_words(shear_words, [&] { shear_of(s, s.relative_density); });
  if (!s.has_wheel()) return;
  rigid_wheel::Settings wheel;
  wheel.spin_deg = s.spin_deg;
  require_start(s.path, wheel.rim_speed(), wheel.ramp_time, "--path", "--spin");
  in_words(wheel_words, [&] { wheel_of(s, ""); });
}

/// Names and values for the report.
inline NamesAndValues list_settings(const Settings& s) {
  NamesAndValues list{{"size", s.size}};
  rig::list_settings(list, s.grains);
  const auto all = [](const std::vector<double>& values, double scale) {
    std::string line;
    for (const double v : values) line += (line.empty() ? "" : ", ") + text("{:g}", scale * v);
    return line;
  };
  list.insert(list.end(),
              {{"relative density asked for", text("{:g}", s.relative_density)},
               {"seed", text("{}", s.seed)},
               {"plates", text("{:g} mm x {} mm, {:g} mm deep at {:g} mm/s", 1e3 * s.plate_length, all(s.widths, 1e3),
                               1e3 * s.sinkage, 1e3 * s.plate_speed)},
               {"normal stresses", all(s.normal_stresses, 1e-3) + " kPa"},
               {"wheel", s.has_wheel() ? text("{}, {:g} N, slips {}", s.wheel, s.load, all(s.slips, 1.0)) : "none"},
               {"intervals", text("{:g} % confidence", 100.0 * s.confidence)}});
  return list;
}

}  // namespace dem::rig::bevameter
