#pragma once

#include <dem/rig/bed/study.hpp>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

namespace dem::rig::rigid_wheel {

/// Everything that can be chosen, in SI units. A value of 0 where it says "0: by size" is filled in by resolve(). Slip
/// is that of thesis table 5.3, s = 1 - v/(omega r): positive for a wheel that drives.
struct Settings {
  std::string size = "quick";                     ///< smoke, quick or full
  GrainSettings grains{.constants_for = 1.2e-3};  ///< of thesis table 5.1
  BedSettings bed;

  // Wheel (thesis chapter 5: 0.13 m x 0.16 m, 17 deg/s, 130 N)
  double radius = 0.13;              ///< r, m, without grousers
  double width = 0.16;               ///< m
  std::string wheel = "rough";       ///< smooth, rough or grousers
  double wheel_friction = -1.0;      ///< mu, grain on wheel; negative: by the kind of wheel
  int grousers = 16;                 ///< of a wheel with grousers
  double grouser_height = 0.01;      ///< m
  double grouser_thickness = 0.004;  ///< m
  double load = 130.0;               ///< N, the weight of wheel and shaft
  double wheel_share = 0.6;          ///< of their mass that is the wheel's, a solid cylinder; the thesis tells none
  double carriage_mass = 5.0;        ///< kg, of the carriage on its rail, which its drive moves
  double drive_stiffness = 1e6;  ///< N/m, of the carriage's actuator: gives by 0.1 mm under 100 N. Damped critically
  double motor_stiffness = 1e5;  ///< N m/rad, of the wheel's: gives by 0.2 mrad under 20 N m. Damped critically
  double spin_deg = 0.0;         ///< deg/s; 0: by size
  std::vector<double> slips;     ///< empty: by size
  double travel = 0.0;           ///< m, that the wheel travels in a run, its rim at most four times as far; 0: by size
  double path = 0.0;             ///< m, that the rim turns in each run; 0: as `travel` says
  double ramp_time = 0.05;       ///< s, of the smooth start
  double set_down_speed = 0.05;  ///< m/s

  std::string study = "none";     ///< none, box, speed or seeds
  std::uint64_t study_seeds = 0;  ///< of each run of the study; 0: three, but one with a bed from a file
  std::string soil;               ///< name or file of a soil, which the grains stand beside too
  std::string output = "rigid_wheel_output";
  bool replay = true;
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of the replay, the largest; 0: none
  bool vtk = true;

  [[nodiscard]] double spin() const { return spin_deg * std::numbers::pi / 180.0; }  ///< rad/s
  [[nodiscard]] double rim_speed() const { return spin() * radius; }                 ///< m/s
  /// m, that the rim turns at a slip.
  [[nodiscard]] double path_at(double slip) const { return path > 0.0 ? path : travel / std::max(1.0 - slip, 0.25); }
  /// m, that the carriage travels at a slip.
  [[nodiscard]] double travel_at(double slip) const { return (1.0 - slip) * path_at(slip); }
  /// s, of a run.
  [[nodiscard]] double duration_at(double slip) const { return path_at(slip) / rim_speed() + 0.5 * ramp_time; }
  /// m, where all runs start: the longest one ends as far from the middle of the bed.
  [[nodiscard]] double start() const { return -0.5 * travel_at(slips.front()); }
  /// s, of all runs: the shortest, which is that of the least slip, has 400 samples.
  [[nodiscard]] double sample_interval() const { return duration_at(slips.front()) / 400.0; }
  /// m, of the wheel with its grousers.
  [[nodiscard]] double outer_radius() const { return radius + (wheel == "grousers" ? grouser_height : 0.0); }
};

using Variant = rig::Variant<Settings>;

/// What the files of a slip are called: slip_30 or slip_m30, in percent.
inline std::string slip_name(double slip) {
  return text("slip_{}{:.0f}", slip < -0.005 ? "m" : "", std::abs(100.0 * slip));
}

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size,
      "smoke (seconds), quick (minutes) or full (the thesis's 231264 grains: with --stiffness 2000 --sleep some 7 "
      "hours on two cores, else days)");
  options.group("Wheel");
  add("--wheel", s.wheel, "smooth, rough (its surface has more friction) or grousers (a mesh)")
      .one_of({"smooth", "rough", "grousers"});
  add("--radius", s.radius, "without grousers [m]");
  add("--width", s.width, "[m]");
  add("--wheel-friction", s.wheel_friction, "mu, grain on wheel; negative: smooth 0.2, rough 0.8, grousers as grains");
  add("--grousers", s.grousers, "how many");
  add("--grouser-height", s.grouser_height, "[m]");
  add("--grouser-thickness", s.grouser_thickness, "[m]");
  add("--load", s.load, "weight of wheel and shaft [N]");
  add("--wheel-share", s.wheel_share, "of their mass that is the wheel's");
  add("--carriage-mass", s.carriage_mass, "[kg]");
  add("--drive-stiffness", s.drive_stiffness, "of the actuator that moves the carriage [N/m]");
  add("--motor-stiffness", s.motor_stiffness, "of the actuator that turns the wheel [N m/rad]");
  add("--spin", s.spin_deg, "[deg/s]; 0: by size");
  add("--slips", s.slips, "s = 1 - v/(omega r), e.g. -0.3,0,0.1,0.3; table 5.3 of the thesis has -0.7 to 0.7");
  add("--travel", s.travel, "of the wheel in a run [m], while its rim turns at most four times as far; 0: by size");
  add("--path", s.path, "that the rim turns in each run [m]; 0: as --travel says");
  add("--ramp-time", s.ramp_time, "smooth start of a run [s]");
  add("--set-down-speed", s.set_down_speed, "of the load servo [m/s]");
  add("--soil", s.soil,
      "a soil that the grains stand beside too, by Bekker-Wong and dynamic Bekker: its file as the bevameter writes "
      "it, or a name (dry-sand, sandy-loam, lete-sand, clayey, snow, hard)")
      .changes_no_result();
  add_study_options(options, s.study, s.study_seeds);
  add_grain_options(options, s.grains);
  add_bed_options(options, s.bed);
  add_output_options(options, s, "a slip");
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  rig::find_idle(idle, s.grains);
  rig::find_idle(idle, s.bed);
  find_idle_replay(idle, s);
  find_idle_study(idle, s.study);
  idle.unless(s.path == 0.0, "without --path", {"--travel"});
  idle.unless(s.wheel == "grousers", "with --wheel grousers",
              {"--grousers", "--grouser-height", "--grouser-thickness"});
}

/// Fills in what depends on the size, and checks every option against its range. Throws Error.
inline void resolve(Settings& s) {
  struct Defaults {
    BedBySize bed;
    double half_edge, spin_deg, travel;
    std::vector<double> slips;
  };
  // quick and smoke turn faster, on coarser grains and a shorter bed; that of quick is as wide as the thesis's, so that
  // its rut ends before the walls. full has the slips of table 5.3, the depth that the thesis's 231,264 grains fill,
  // and a shorter way, as a slip takes hours.
  const auto by_size =
      BySize<Defaults>{.smoke = {{0.30, 0.18, 0.03}, 6e-3, 90.0, 0.021, {0.3}},
                       .quick = {{0.36, 0.40, 0.055}, 5e-3, 90.0, 0.12, {-0.5, -0.1, 0.1, 0.3, 0.7}},
                       .full = {{0.50, 0.40, 0.02098},
                                1.2e-3,
                                17.0,
                                0.07,
                                {-0.7, -0.5, -0.3, -0.1, 0.0, 0.1, 0.3, 0.5, 0.7}}}[size_named(s.size)];
  rig::resolve(s.grains, by_size.half_edge);
  rig::resolve(s.bed, by_size.bed, s.output);
  fill(s.spin_deg, by_size.spin_deg);
  fill(s.travel, by_size.travel);
  if (s.slips.empty()) s.slips = by_size.slips;
  resolve_study(s.study, s.study_seeds, s.bed);
  if (s.wheel_friction < 0.0)
    s.wheel_friction = s.wheel == "smooth" ? 0.2 : s.wheel == "rough" ? 0.8 : s.grains.friction;
  require_within(s.wheel_friction, 0.0, 100.0, "--wheel-friction");
  std::sort(s.slips.begin(), s.slips.end());
  for (std::size_t k = 0; k < s.slips.size(); ++k) {
    require_within(s.slips[k], -5.0, 1.0, "a slip of --slips (1 - v/(omega r))");
    if (k == 0 || slip_name(s.slips[k]) != slip_name(s.slips[k - 1])) continue;
    fail("two --slips are {:g} and {:g}, but must differ by a hundredth; leave one out", s.slips[k - 1], s.slips[k]);
  }
  require_within(s.radius, 0.01, 10.0, "--radius (m)");
  require_within(s.width, 0.01, s.bed.width, "--width (m, within the bed)");
  require_within(s.grousers, 1, 400, "--grousers");
  require_within(s.grouser_height, 1e-3, 0.5 * s.radius, "--grouser-height (m)");
  require_within(s.grouser_thickness, 1e-3, 0.5 * s.radius, "--grouser-thickness (m)");
  const double half_pitch = std::numbers::pi / s.grousers;
  if (s.wheel == "grousers" && !(std::asin(0.5 * s.grouser_thickness / s.radius) < half_pitch)) {
    fail(
        "{} grousers {:g} m thick do not fit round a wheel of radius {:g} m; give fewer --grousers, or a "
        "--grouser-thickness below {:.2g} m",
        s.grousers, s.grouser_thickness, s.radius, 2.0 * s.radius * std::sin(half_pitch));
  }
  require_within(s.load, 0.1, 1e6, "--load (N)");
  require_within(s.wheel_share, 0.01, 0.99, "--wheel-share");
  require_within(s.carriage_mass, 1e-3, 1e6, "--carriage-mass (kg)");
  require_within(s.drive_stiffness, 1e3, 1e12, "--drive-stiffness (N/m)");
  require_within(s.motor_stiffness, 1.0, 1e12, "--motor-stiffness (N m/rad)");
  require_within(s.spin_deg, 0.1, 3600.0, "--spin (deg/s)");
  require_within(s.travel, 1e-3, 100.0, "--travel (m)");
  if (s.path != 0.0) require_within(s.path, 1e-3, 100.0, "--path (m)");
  require_within(s.ramp_time, 0.0, s.path_at(s.slips.front()) / s.rim_speed(),
                 "--ramp-time (s, at most what the shortest run takes)");
  require_within(s.set_down_speed, 1e-3, 1.0, "--set-down-speed (m/s)");
  const double needed = s.travel_at(s.slips.front()) + s.radius;
  if (!(s.bed.length > needed)) {
    fail(
        "a bed {:g} m long is too short for a wheel that travels {:g} m at slip {:g}, and needs half its radius before "
        "and behind it; give --bed-length {:.3g}, or a shorter --travel or --path",
        s.bed.length, s.travel_at(s.slips.front()), s.slips.front(), 1.01 * needed);
  }
}

/// The run itself, and those of the study.
inline std::vector<Variant> variants(const Settings& s) {
  return variants_of(s, [](Settings& x) { x.spin_deg *= 0.5; });
}

/// Names and values for the report.
inline NamesAndValues list_settings(const Settings& s) {
  NamesAndValues list{{"size", s.size}};
  rig::list_settings(list, s.grains);
  rig::list_settings(list, s.bed);
  list.insert(list.end(),
              {{"wheel", text("{}, {:g} m x {:g} m", s.wheel, s.radius, s.width) +
                             (s.wheel == "grousers" ? text(", {} grousers {:g} mm high and {:g} mm thick", s.grousers,
                                                           1e3 * s.grouser_height, 1e3 * s.grouser_thickness)
                                                    : "")},
               {"friction, grain on wheel", text("{:g}", s.wheel_friction)},
               {"load", text("{:g} N, of whose mass the wheel has {:g}", s.load, s.wheel_share)},
               {"carriage", text("{:g} kg", s.carriage_mass)},
               {"stiffness of drive and motor", text("{:g} N/m, {:g} N m/rad", s.drive_stiffness, s.motor_stiffness)},
               {"spin", text("{:g} deg/s: the rim at {:g} mm/s", s.spin_deg, 1e3 * s.rim_speed())},
               {"slip is", "s = 1 - v/(omega r), as in table 5.3"},
               {s.path > 0.0 ? "path of the rim" : "travel of the wheel",
                text("{:g} mm", 1e3 * (s.path > 0.0 ? s.path : s.travel))},
               {"study", study_setting(s.study, s.study_seeds)}});
  return list;
}

}  // namespace dem::rig::rigid_wheel
