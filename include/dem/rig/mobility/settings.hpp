#pragma once

#include <dem/rig/options.hpp>
#include <dem/rig/sizes.hpp>
#include <dem/terramechanics/named_soils.hpp>
#include <dem/vehicle/column_car.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/open_loop.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace dem::rig::mobility {

/// Everything that can be chosen, in SI units. Empty lists and values of 0 where it says "by size" are filled in by
/// resolve().
struct Settings {
  std::string size = "quick";       ///< smoke, quick or full
  std::string study = "drive";      ///< drive, slopes, side-slopes, drawbar, passes, map or loads
  std::string soil = "dry-sand";    ///< name of a soil
  std::string lane;                 ///< stretches, "hard:8,dry-sand:12"; empty: one of the soil
  std::vector<double> slopes;       ///< percent, of slopes and map; one of the other studies
  std::vector<double> side_slopes;  ///< percent, of side-slopes and map; likewise
  std::vector<double> loads;        ///< kg, sprung masses of loads
  std::string soils;                ///< of loads: names, with commas
  int passes = 3;                   ///< of passes, one in the ruts of the other

  std::string engine = "motor";  ///< one of vehicle::engine_names
  double sprung_mass = 4430.0;   ///< kg
  std::string tyre = "rigid";    ///< rigid, or ring: a pneumatic tyre
  double tyre_pressure = 2e5;    ///< Pa, of a ring
  double tyre_friction = 0.8;    ///< mu of the tyres on the soil
  double speed = 0.0;            ///< m/s, that the driver holds; 0: by study
  double acceleration = 2.0;     ///< m/s^2, at which the driver reaches it
  double spin_limit = 2.0;       ///< m/s, by which rims are faster where the driver eases off the throttle
  std::string inputs;            ///< CSV file that drives in place of the driver (vehicle/open_loop.hpp)
  vehicle::OpenLoop open_loop;   ///< the same as a table; resolve() reads it from the file
  double path = 0.0;             ///< m; 0: by size

  double spacing = 0.05;    ///< m, of the columns
  double damping = 2e3;     ///< Pa s/m, of the columns
  double bulldozing = 0.3;  ///< share of the soil that is pushed aside
  double half_width = 3.0;  ///< m, of the soil on either side of the middle
  double time_step = 5e-5;  ///< s
  int threads = 0;          ///< cells side by side; 0: as many as there are processors
  std::string output = "humvee_columns_output";
  bool replay = true;

  [[nodiscard]] bool is_drive() const { return study == "drive"; }

  std::vector<vehicle::LaneStretch> stretches_;  ///< by resolve()
  std::vector<terramechanics::NamedSoil> soils_of_loads_;
};

inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size, "smoke (seconds), quick (minutes) or full");
  add("--study", s.study,
      "drive (one drive with its telemetry), slopes, side-slopes, drawbar (held on a load cell), passes, map (slopes x "
      "side slopes) or loads (soils x loads)")
      .one_of({"drive", "slopes", "side-slopes", "drawbar", "passes", "map", "loads"});
  options.group("Ground");
  add("--soil", s.soil,
      "dry-sand, sandy-loam, lete-sand, clayey, snow, hard, p1 or p3, or a soil's file (TOML), as the bevameter writes "
      "it");
  add("--lane", s.lane,
      "stretches of soils (names or files) with their lengths [m], e.g. hard:8,dry-sand:12; instead of --soil");
  add("--slopes", s.slopes, "percent, up the lane: several of slopes and map, one elsewhere");
  add("--side-slopes", s.side_slopes, "percent, the left side is high: several of side-slopes and map, one elsewhere");
  add("--soils", s.soils, "of loads, by names or files, e.g. dry-sand,clayey; empty: five soils");
  add("--loads", s.loads, "sprung masses of the study of that name [kg]; empty: by size");
  add("--passes", s.passes, "of the study of that name: each in the ruts of the one before");
  add("--spacing", s.spacing, "of the columns of soil [m]");
  add("--soil-damping", s.damping, "of the columns [Pa s/m]");
  add("--bulldozing", s.bulldozing, "share of the soil that is pushed out of the rut");
  add("--half-width", s.half_width, "of the soil on either side of the middle [m]");
  options.group("Car");
  add("--engine", s.engine, vehicle::engine_words).one_of(vehicle::engine_names());
  add("--sprung-mass", s.sprung_mass, "of the car [kg]");
  add("--tyre", s.tyre, "rigid, or ring: pneumatic, a ring of small bodies, three times as dear")
      .one_of({"rigid", "ring"});
  add("--tyre-pressure", s.tyre_pressure, "of a ring [Pa]");
  add("--tyre-friction", s.tyre_friction, "mu, tyre on soil");
  add("--speed", s.speed, "that the driver holds [m/s]; 0: 5, and of the sled of drawbar 1");
  add("--acceleration", s.acceleration, "at which the driver reaches it [m/s^2]");
  add("--spin-limit", s.spin_limit,
      "the driver eases off the throttle where rims are faster than the car by this [m/s]");
  add("--inputs", s.inputs,
      "CSV file that drives in place of the driver: time_s, throttle, brake (0 to 1), steer_rad (to the left); the "
      "drive ends with its last row");
  add("--path", s.path, "that the car drives [m]; 0: by size");
  add("--machine-step", s.time_step, "time step of the car, a whole number of times in 0.01 s [s]");
  options.group("Output");
  add("--threads", s.threads, "drives side by side; 0: as many as there are processors").changes_no_result();
  add("--output", s.output, "folder; results of an earlier run in it are replaced").changes_no_result();
  options.flag("--replay", s.replay, "replay of a drive in the report").off("--no-replay");
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  const bool loads = s.study == "loads";
  idle.unless(s.study == "passes", "with --study passes", {"--passes"});
  idle.unless(loads, "with --study loads", {"--soils", "--loads"});
  idle.unless(!loads, "with another study than loads, which has --soils and --loads",
              {"--soil", "--lane", "--sprung-mass"});
  idle.unless(s.lane.empty() || loads, "without --lane", {"--soil"});
  idle.unless(s.study == "drive", "with --study drive", {"--replay"});
  idle.unless(s.tyre == "ring", "with --tyre ring", {"--tyre-pressure"});
  idle.unless(s.study != "drawbar", "with another study than drawbar",
              {"--path", "--spin-limit", "--acceleration", "--inputs"});
  idle.unless(s.inputs.empty(), "without --inputs", {"--speed", "--acceleration"});
}

namespace detail {

inline std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts = {""};
  for (const char c : text) {
    if (c == at) parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

}  // namespace detail

/// Finds a soil by its name or in a file: the program's, so that this header needs no files.
using FindSoil = terramechanics::NamedSoil(const std::string& name_or_path);
/// One that knows names alone.
inline terramechanics::NamedSoil soil_by_name(const std::string& name) { return terramechanics::known_soil(name); }

/// Throws Error for a text that is no list of stretches.
inline std::vector<vehicle::LaneStretch> stretches_of(const std::string& lane, FindSoil* find = soil_by_name) {
  std::vector<vehicle::LaneStretch> all;
  for (const std::string& part : detail::split(lane, ',')) {
    const auto pair = detail::split(part, ':');
    char* end = nullptr;
    const double length = pair.size() == 2 ? std::strtod(pair[1].c_str(), &end) : 0.0;
    if (!(length > 0.0 && length < 1e4) || *end != '\0') {
      fail("--lane has the stretch '{}', but must be soils with lengths in m, as hard:8,dry-sand:12", part);
    }
    all.push_back({find(pair[0]), length});
  }
  return all;
}

/// Fills in what depends on the size, and checks every option against its range. Throws Error.
inline void resolve(Settings& s, FindSoil* find = soil_by_name) {
  const Size size = size_named(s.size);
  using List = std::vector<double>;
  if (s.slopes.empty()) {
    s.slopes = s.study == "slopes" ? BySize<List>{.smoke = {0, 30},
                                                  .quick = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50},
                                                  .full = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60}}[size]
               : s.study == "map"  ? BySize<List>{.smoke = {0, 20},
                                                  .quick = {-20, -10, 0, 10, 20, 25, 30, 35, 40},
                                                  .full = {-30, -20, -10, 0, 5, 10, 15, 20, 25, 30, 35, 40, 45}}[size]
                                   : List{0.0};
  }
  if (s.side_slopes.empty()) {
    s.side_slopes =
        s.study == "side-slopes"
            ? BySize<List>{.smoke = {20}, .quick = {0, 10, 20, 30, 40, 50}, .full = {0, 10, 20, 30, 40, 50, 60}}[size]
        : s.study == "map"
            ? BySize<List>{.smoke = {0}, .quick = {0, 10, 20, 30, 40, 50}, .full = {0, 10, 20, 30, 40, 50, 60}}[size]
            : List{0.0};
  }
  for (List* list : {&s.slopes, &s.side_slopes}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
    for (const double percent : *list) require_within(percent, -100.0, 100.0, "a slope (percent)");
  }
  const auto require_one = [&](const List& list, const char* option, const char* study) {
    if (list.size() == 1 || s.study == study || s.study == "map") return;
    fail("{} has {} values, but the study {} drives on one; give one, or --study {} or map", option, list.size(),
         s.study, study);
  };
  require_one(s.slopes, "--slopes", "slopes");
  require_one(s.side_slopes, "--side-slopes", "side-slopes");
  if (s.loads.empty())
    s.loads = BySize<List>{.smoke = {4430},
                           .quick = {2500, 3500, 4430, 6000, 8000},
                           .full = {2500, 3000, 3500, 4430, 5000, 6000, 7000, 8000}}[size];
  std::sort(s.loads.begin(), s.loads.end());
  for (const double mass : s.loads) require_within(mass, 500.0, 2e4, "a sprung mass of --loads (kg)");
  fill(s.speed, s.study == "drawbar" ? 1.0 : 5.0);
  double room = 0.0;
  if (!s.lane.empty()) s.stretches_ = stretches_of(s.lane, find);
  for (const auto& stretch : s.stretches_) room += stretch.length;
  fill(s.path, room > 0.0 ? room : BySize<double>{.smoke = 4.0, .quick = 25.0, .full = 50.0}[size]);
  if (!s.lane.empty() && !(s.path <= room * (1.0 + 1e-9)))
    fail("a --path of {:g} m is longer than the --lane of {:g} m; give a longer last stretch", s.path, room);
  if (!s.inputs.empty() && s.study != "drawbar") s.open_loop = vehicle::read_inputs(s.inputs);
  require_within(s.passes, 1, 20, "--passes");
  require_within(s.sprung_mass, 500.0, 2e4, "--sprung-mass (kg)");
  require_non_negative(s.tyre_friction, "--tyre-friction", "(no unit)");
  require_within(s.speed, 0.1, 20.0, "--speed (m/s)");
  require_within(s.acceleration, 0.05, 10.0, "--acceleration (m/s^2)");
  require_within(s.tyre_pressure, 2e4, 5e5, "--tyre-pressure (Pa)");
  require_within(s.spin_limit, 0.01, 100.0, "--spin-limit (m/s)");
  require_within(s.path, 1.0, 500.0, "--path (m)");
  require_within(s.spacing, 0.005, 0.1, "--spacing (m; the print of a wheel is 0.3 m long)");
  require_within(s.damping, 0.0, 1e5, "--soil-damping (Pa s/m)");
  require_within(s.bulldozing, 0.0, 2.0, "--bulldozing");
  require_within(s.half_width, 1.6, 10.0,
                 "--half-width (m; the wheels stand at 0.9 m, soil ends 0.5 m beyond the lane)");
  require_within(s.time_step, 1e-6, 1e-4, "--machine-step (s)");
  vehicle::ColumnCar::steps_of(s.time_step, "--machine-step");
  require_within(s.threads, 0, 1000, "--threads");
  if (s.lane.empty()) s.stretches_ = {{find(s.soil), s.path}};
  const std::string soils = s.soils.empty() ? "sandy-loam,lete-sand,dry-sand,clayey,snow" : s.soils;
  s.soils_of_loads_.clear();
  if (s.study == "loads") {
    for (const std::string& name : detail::split(soils, ',')) {
      s.soils_of_loads_.push_back(find(name));
      // Drives are named after their soils: one from a file after that, as files may say the same name.
      if (std::string& own = s.soils_of_loads_.back().name; own != name)
        own = std::filesystem::path(name).stem().string();
    }
  }
}

}  // namespace dem::rig::mobility
