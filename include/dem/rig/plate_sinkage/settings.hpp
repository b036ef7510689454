#pragma once

#include <dem/rig/bed/study.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace dem::rig::plate_sinkage {

/// Everything that can be chosen, in SI units. A value of 0 where it says "0: by size" is filled in by resolve().
struct Settings {
  std::string size = "quick";                      ///< smoke, quick or full
  GrainSettings grains{.constants_for = 1.86e-3};  ///< of thesis table 4.2
  BedSettings bed;

  // Plates (thesis section 4.2: 130 mm x 30, 50, 70 mm x 10 mm, at 10 mm/s). Those of its experiment are of aluminium,
  // so that sand hardly rubs on them. It gives no mass of the simulated ones: here they have the density of steel,
  // three times that of aluminium. The drive carries their weight, and the sensor feels the grains alone.
  std::vector<double> widths;     ///< m, the smaller sides; empty: by size
  double length = 0.0;            ///< m; 0: by size
  double thickness = 0.01;        ///< m
  double plate_density = 7800.0;  ///< kg/m^3
  double plate_friction = 0.0;    ///< mu, grain on plate
  double drive_stiffness = 1e7;   ///< N/m, of the plate's actuator, which is damped critically
  double speed = 0.0;             ///< m/s; 0: by size
  double ramp_time = 0.01;        ///< s, of the smooth start
  double sinkage = 0.0;           ///< m, from where the pressure first is `threshold`; 0: by size
  double threshold = 1000.0;      ///< Pa, at which sinkage begins
  double smoothing = 0.02;        ///< of the sinkage, over which pressures are averaged
  double fit_from = 0.1;          ///< of the sinkage: points before are not fitted

  bool unload = false;        ///< draw the plate up again, for the slope of unloading
  double unload_speed = 0.0;  ///< m/s; 0: a tenth of the speed

  std::string study = "none";     ///< none, box, speed or seeds
  std::uint64_t study_seeds = 0;  ///< of each run of the study; 0: three, but one with a bed from a file
  std::string output = "plate_sinkage_output";
  bool replay = true;
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of the replay, the largest; 0: none
  bool vtk = true;

  [[nodiscard]] double sample_interval() const { return sinkage / 400.0 / speed; }  ///< s
};

/// Throws Error where a levelled bed is shallower (m) than twice the sinkage.
inline void require_depth(const Settings& s, double level) {
  if (s.sinkage <= 0.5 * level || s.bed.is_rained()) return;
  fail(
      "--sinkage is {:g} m, but must be at most half of the bed's depth, which came out as {:.4g} m; lower it, or take "
      "a deeper bed",
      s.sinkage, level);
}

using Variant = rig::Variant<Settings>;

/// What the files of a plate of a width (m) are called.
inline std::string plate_name(double width) { return text("plate_{:.0f}mm", 1e3 * width); }

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size, "smoke (seconds), quick (minutes) or full (the thesis's 209664 grains: many hours)");
  options.group("Plates");
  add("--plates", s.widths, "widths of the plates [m], e.g. 0.03,0.05,0.07");
  add("--plate-length", s.length, "[m]; 0: by size");
  add("--plate-thickness", s.thickness, "[m]");
  add("--plate-density", s.plate_density, "[kg/m^3]");
  add("--plate-friction", s.plate_friction, "mu, grain on plate");
  add("--drive-stiffness", s.drive_stiffness, "of the actuator that presses a plate [N/m]");
  add("--speed", s.speed, "[m/s]; 0: by size");
  add("--ramp-time", s.ramp_time, "smooth start of a plate [s]");
  add("--sinkage", s.sinkage, "[m], from where it begins; 0: by size");
  add("--threshold", s.threshold, "pressure at which sinkage begins [Pa]");
  add("--smoothing", s.smoothing, "share of the sinkage over which pressures are averaged");
  add("--fit-from", s.fit_from, "share of the sinkage from which points are fitted");
  options.flag("--unload", s.unload, "then draw the plate up again: the slope of unloading");
  add("--unload-speed", s.unload_speed, "at which it is drawn up [m/s]; 0: a tenth of the speed");
  add_study_options(options, s.study, s.study_seeds);
  add_grain_options(options, s.grains);
  add_bed_options(options, s.bed);
  add_output_options(options, s, "a plate");
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  rig::find_idle(idle, s.grains);
  rig::find_idle(idle, s.bed);
  find_idle_replay(idle, s);
  find_idle_study(idle, s.study);
  idle.unless(s.unload, "with --unload", {"--unload-speed"});
}

/// Fills in what depends on the size, and checks every option against its range. Throws Error.
inline void resolve(Settings& s) {
  struct Defaults {
    BedBySize bed;
    double half_edge, length, speed, sinkage;
    std::vector<double> widths;
  };
  // quick and smoke press faster, on coarser grains. The bed of quick is as large as its widest plate asks for
  // (small_bed.hpp); that of full is the thesis's.
  const auto by_size = BySize<Defaults>{
      .smoke = {{0.10, 0.06, 0.04}, 4e-3, 0.05, 0.10, 4e-3, {0.03}},
      .quick = {{0.20, 0.35, 0.14}, 4e-3, 0.13, 0.05, 0.015, {0.03, 0.05, 0.07}},
      .full = {{0.25, 0.20, 0.2833}, 1.86e-3, 0.13, 0.01, 0.03, {0.03, 0.05, 0.07}}}[size_named(s.size)];
  rig::resolve(s.grains, by_size.half_edge);
  rig::resolve(s.bed, by_size.bed, s.output);
  fill(s.length, by_size.length);
  fill(s.speed, by_size.speed);
  fill(s.sinkage, by_size.sinkage);
  fill(s.unload_speed, 0.1 * s.speed);
  if (s.widths.empty()) s.widths = by_size.widths;
  require_within(s.length, 1e-3, s.bed.length, "--plate-length (m, within the bed)");
  std::sort(s.widths.begin(), s.widths.end());
  for (const double w : s.widths) {
    require_within(w, 1e-3, std::min(s.bed.width, s.length),
                   "a width of --plates (m, within the bed; the smaller side of a plate)");
  }
  for (std::size_t k = 1; k < s.widths.size(); ++k) {
    if (plate_name(s.widths[k]) != plate_name(s.widths[k - 1])) continue;
    fail(
        "the widths {:g} and {:g} m of --plates are the same to a millimetre, and both would be called {}; leave one "
        "out",
        s.widths[k - 1], s.widths[k], plate_name(s.widths[k]));
  }
  require_within(s.thickness, 1e-3, 1.0, "--plate-thickness (m)");
  require_within(s.plate_density, 1.0, 1e5, "--plate-density (kg/m^3)");
  require_non_negative(s.plate_friction, "--plate-friction", "(no unit)");
  require_within(s.drive_stiffness, 1e3, 1e12, "--drive-stiffness (N/m)");
  require_within(s.speed, 1e-4, 1.0, "--speed (m/s)");
  require_within(s.unload_speed, 1e-5, 1.0, "--unload-speed (m/s)");
  // How deep a bed of grains from a file is, is known once it is level (require_depth).
  require_within(s.sinkage, 1e-4, s.bed.is_rained() ? 0.5 * s.bed.depth : 1e3,
                 "--sinkage (m, at most half the bed's depth)");
  require_within(s.ramp_time, 0.0, s.sinkage / s.speed, "--ramp-time (s, at most what the sinkage takes)");
  require_positive(s.threshold, "--threshold", "Pa");
  require_within(s.smoothing, 0.0, 0.5, "--smoothing");
  require_within(s.fit_from, 1e-3, 0.45, "--fit-from (a fit needs points over a factor of two)");
  resolve_study(s.study, s.study_seeds, s.bed);
}

/// The run itself, and those of the study.
inline std::vector<Variant> variants(const Settings& s) {
  return variants_of(s, [](Settings& x) { x.speed *= 0.5, x.unload_speed *= 0.5; });
}

/// Names and values for the report.
inline NamesAndValues list_settings(const Settings& s) {
  NamesAndValues list{{"size", s.size}};
  std::string widths;
  for (const double w : s.widths) widths += (widths.empty() ? "" : ", ") + text("{:g}", 1e3 * w);
  rig::list_settings(list, s.grains);
  rig::list_settings(list, s.bed);
  list.insert(
      list.end(),
      {{"plates",
        text("{:g} mm x {} mm x {:g} mm, {:g} kg/m³", 1e3 * s.length, widths, 1e3 * s.thickness, s.plate_density)},
       {"stiffness of a plate's drive", text("{:g} N/m", s.drive_stiffness)},
       {"friction, grain on plate", text("{:g}", s.plate_friction)},
       {"speed", text("{:g} mm/s", 1e3 * s.speed)},
       {"sinkage", text("{:g} mm, from where the pressure first is {:g} kPa", 1e3 * s.sinkage, 1e-3 * s.threshold)},
       {"study", study_setting(s.study, s.study_seeds)}});
  return list;
}

}  // namespace dem::rig::plate_sinkage
