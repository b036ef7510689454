#pragma once

#include <dem/rig/bed/bed_settings.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/open_loop.hpp>
#include <dem/vehicle/ring_tyre.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace dem::rig::soft_lane {

/// Everything that can be chosen, in SI units. A value of 0 where it says "0: by size" is filled in by resolve().
///
/// The stiffness of the grains follows from how deep they overlap under a tyre. The thesis's K = 2,000 N/m for any size
/// cannot carry a car. Here K grows with the size of the grains, as 4e4 N/m at a half-edge of 0.9 mm, which is 22.2 MPa
/// times the edge d. A wheel that carries F on a print of b x l presses with p = F/(b l). If four tenths of the grains
/// in the print carry it, each by one contact, the overlap is p d^2/(0.4 K), as a share of d p/(0.4 K/d): 1.8 % for the
/// Humvee's 12 kN on 0.25 m x 0.3 m, whatever the size of the grains. The report has the overlaps that there were.
struct Settings {
  std::string size = "quick";   ///< smoke, quick or full
  std::string scene = "level";  ///< level, slope, side-slope, brake, turn, coast, step, soils or drawbar
  double slope = 20.0;  ///< percent, of slope (positive: uphill) and side-slope (positive: the left side is high)

  vehicle::VehicleSpec car = vehicle::humvee({.rubber_rear = false});
  std::string engine = "motor";  ///< one of vehicle::engine_names
  std::string tyre = "mesh";     ///< mesh, cylinder or ring (pneumatic, vehicle/ring_tyre.hpp)
  int tyre_triangles = 6662;     ///< of a mesh (thesis)
  double tyre_pressure = 2e5;    ///< Pa, of a ring, above the air around
  double tread_stiffness = 8e4;  ///< N/m, of a ring's rubber under a grain: its light segments bear no stiffer contact
  double tyre_friction = 0.8;    ///< mu, grain on tyre, and hard ground on tyre
  double machine_step = 5e-5;    ///< s, the largest step of the car
  double set_down_speed = 0.5;   ///< m/s
  double speed = 0.0;            ///< m/s, that the driver holds; 0: by size
  double acceleration = 1.0;     ///< m/s^2, at which the driver reaches it
  double spin_limit = 1.0;       ///< m/s, by which rims are faster than the car where the driver eases off the throttle
  std::string inputs;            ///< CSV file that drives in place of the driver (vehicle/open_loop.hpp)
  vehicle::OpenLoop open_loop;   ///< the same as a table; resolve() reads it from the file
  double path = 0.0;             ///< m, that the car drives; 0: as far as the lane goes
  int passes = 1;                ///< drives, one after the other, each from the start in the ruts of those before
  double steer_deg = 12.0;       ///< of the front wheels in a turn
  double steer_deg_per_s = 30.0;  ///< at which they turn there

  /// m, way after which the front wheels come from hard ground into the soil (step), or into the second soil (soils);
  /// 0: 0.3 m (step), or so that the wheels drive as far on the first soil as on the second.
  double border = 0.0;
  double second_friction = 0.2;  ///< mu, grain on grain of the second soil
  double second_cohesion = 0.0;  ///< pull of its contact points, in weights of a grain
  double second_share = 1.0;     ///< of its grains: the others are of the first soil

  GrainSettings grains{.stiffness = 4e4, .damping = 0.1};
  /// Of one trough: length along x, width, depth. There are two of them, one under each track, with the same grains,
  /// turned by half a turn; or one bed under the whole car. The lid presses with 5 kPa, on one wide bed with 1 kPa:
  /// while it comes down few grains carry all of it.
  BedSettings bed{.lid_pressure = 0.0, .stage_limit = 6.0, .sleep = true, .file = {}, .save = {}};
  std::string layout;  ///< troughs or bed; empty: troughs, but a bed for a turn
  /// A lane of any length: the bed is a tile that repeats itself, and so many of them go along with the car
  /// (soil/moving_patch.hpp). 0: the bed is the lane.
  int tiles = 0;
  double ahead = 1.0;  ///< m, that there is at least of tiles before the front tyres

  std::string output = "humvee_soil_output";
  bool replay = true;
  std::uint64_t replay_forces = 2000;  ///< force chains of a frame of the replay, the largest; 0: none
  bool vtk = false;

  [[nodiscard]] vehicle::RingTyreSpec ring() const {
    return {.radius = car.tyre.radius, .width = car.tyre.width, .pressure = tyre_pressure};
  }
  [[nodiscard]] bool has_border() const { return scene == "step" || scene == "soils"; }
  /// m, along x, where the other ground begins.
  [[nodiscard]] double border_at() const { return start() + car.front.points.wheel.x() + border; }
  [[nodiscard]] bool is_bed() const { return layout == "bed"; }
  [[nodiscard]] int troughs() const { return is_bed() ? 1 : 2; }
  /// m, between the middle of a wheel and the end of the lane.
  [[nodiscard]] double margin() const { return car.tyre.radius + 0.1 + rim(); }
  [[nodiscard]] bool goes_along() const { return tiles > 0; }
  /// m, of the lane at the start: from -length/2 to length/2.
  [[nodiscard]] double length() const { return goes_along() ? tiles * bed.length : bed.length; }
  /// m, along x, as far as there may be grains.
  [[nodiscard]] double ground_end() const { return 0.5 * length() + (goes_along() ? path + 2.0 * bed.length : 0.0); }
  /// m, at both ends of a lane that goes along, whose grains are held: two grains from corner to corner.
  [[nodiscard]] double rim() const { return goes_along() ? 2.0 * std::sqrt(3.0) * grains.edge() : 0.0; }
  /// m, of a lane that goes along: from behind the rear tyres to a tile more than what is ahead of the front ones.
  [[nodiscard]] double shortest_patch() const {
    return margin() + car.wheelbase() + car.tyre.radius + ahead + bed.length;
  }
  [[nodiscard]] double longest_path() const {
    return goes_along() ? 1e4 : bed.length - car.wheelbase() - 2.0 * margin();
  }
  /// m, along x, of the vehicle's origin at the start: the rear wheels stand at the lane's end.
  [[nodiscard]] double start() const { return -0.5 * length() + margin() - car.rear.points.wheel.x(); }
  /// rad, by which gravity is tilted.
  [[nodiscard]] double slope_angle() const {
    return scene == "slope" || scene == "side-slope" ? std::atan(0.01 * slope) : 0.0;
  }
  /// Pa, of a wheel of a car with this weight (N) on a print 0.3 m long.
  [[nodiscard]] double pressure(double weight) const { return 0.25 * weight / (0.3 * car.tyre.width); }
  /// Overlap of grains under that pressure, as a share of their edge.
  [[nodiscard]] double overlap(double weight) const {
    return pressure(weight) * grains.edge() / (0.4 * grains.scale() * grains.stiffness);
  }
};

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size, "smoke (seconds), quick (minutes) or full (the thesis's 331,890 grains: hours)");
  add("--scene", s.scene, "what is driven")
      .one_of({"level", "slope", "side-slope", "brake", "turn", "coast", "step", "soils", "drawbar"});
  add("--slope", s.slope, "percent: of slope (below 0: downhill) and of side-slope (above 0: its left side is high)");
  options.group("Car");
  add("--engine", s.engine, vehicle::engine_words).one_of(vehicle::engine_names());
  add("--tyre", s.tyre, "mesh of triangles, as in the thesis, cylinder, or ring: pneumatic")
      .one_of({"mesh", "cylinder", "ring"});
  add("--tyre-triangles", s.tyre_triangles, "of a mesh");
  add("--tyre-pressure", s.tyre_pressure, "of a ring [Pa]");
  add("--tread-stiffness", s.tread_stiffness, "of a ring's rubber under a grain [N/m]");
  add("--tyre-friction", s.tyre_friction, "mu, grain on tyre");
  add("--speed", s.speed, "that the driver holds, of the rims on a drawbar [m/s]; 0: by size");
  add("--acceleration", s.acceleration, "at which the driver reaches it [m/s^2]");
  add("--spin-limit", s.spin_limit,
      "the driver eases off the throttle where rims are faster than the car by this [m/s]");
  add("--inputs", s.inputs,
      "CSV file that drives in place of the driver: time_s, throttle, brake (0 to 1), steer_rad (to the left); the "
      "drive ends with its last row");
  add("--path", s.path, "that the car drives [m]; 0: as far as the lane goes, or 10 m on tiles");
  add("--passes", s.passes,
      "drives, each from the start in the ruts of those before; telemetry is of the last, pictures of the first");
  add("--steer", s.steer_deg, "of the front wheels in a turn, to the left [deg]");
  add("--steer-rate", s.steer_deg_per_s, "at which they turn there [deg/s]");
  add("--set-down-speed", s.set_down_speed, "of the crane that sets the car down [m/s]");
  add("--machine-step", s.machine_step, "largest time step of the car, which sub-steps keep [s]");
  options.group("Ground that changes");
  add("--border", s.border,
      "way after which the front wheels come to the soil (step) or the second soil [m]; 0: chosen");
  add("--second-friction", s.second_friction, "mu of the second soil, grain on grain");
  add("--second-cohesion", s.second_cohesion, "pull of its contact points, in weights of a grain");
  add("--second-share", s.second_share, "of its grains; the others are of the first soil");
  add_grain_options(options, s.grains);
  add_bed_options(options, s.bed);
  add("--layout", s.layout, "troughs (two, one a track) or bed (one under the car); empty: by scene");
  add("--tiles", s.tiles,
      "a lane without end: the bed is a tile that repeats itself, and so many go along with the car; 0: the bed is the "
      "lane");
  add("--ahead", s.ahead, "that there is at least of tiles before the front tyres [m]");
  add_output_options(options, s, "the drive");
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  rig::find_idle(idle, s.grains);
  rig::find_idle(idle, s.bed);
  find_idle_replay(idle, s);
  idle.unless(s.tyre == "mesh", "with --tyre mesh", {"--tyre-triangles"});
  idle.unless(s.tyre == "ring", "with --tyre ring", {"--tyre-pressure", "--tread-stiffness"});
  idle.unless(s.has_border(), "with --scene step or soils", {"--border"});
  idle.unless(s.goes_along(), "with --tiles above 0", {"--ahead"});
  idle.unless(s.scene == "level" || s.scene == "slope" || s.scene == "side-slope" || s.scene == "step",
              "with --scene level, slope, side-slope or step", {"--passes"});
  idle.unless(s.scene == "soils", "with --scene soils", {"--second-friction", "--second-cohesion", "--second-share"});
  idle.unless(s.scene != "drawbar", "without --scene drawbar", {"--acceleration", "--spin-limit"});
  idle.unless(s.inputs.empty(), "without --inputs", {"--speed", "--acceleration"});
  idle.unless(s.scene == "slope" || s.scene == "side-slope", "with --scene slope or side-slope", {"--slope"});
  idle.unless(s.scene == "turn", "with --scene turn", {"--steer", "--steer-rate"});
}

/// Depth (m) of a trough that so many grains fill as they settle, when `strike_off` of them is taken off.
inline double depth_of(double count, double strike_off, const GrainSettings& grains, double length, double width) {
  const double rained = std::ceil(count / (1.0 - strike_off)), h = grains.half_edge;
  return rained * 8.0 * h * h * h / soil::solid_fraction_at(0.0, grains.limits) / (length * width);
}

/// Throws Error unless the lane holds the car and its path.
inline void require_room(const Settings& s) {
  const double shortest = s.car.wheelbase() + 2.0 * s.margin() + 0.1;
  if (s.goes_along() && !(s.length() >= s.shortest_patch())) {
    fail(
        "{} tiles of {:g} m are {:.3g} m long, but must be at least {:.3g} m, for the car, {:g} m ahead and a tile "
        "more; "
        "give --tiles {:.0f}, or a smaller --ahead",
        s.tiles, s.bed.length, s.length(), s.shortest_patch(), s.ahead, std::ceil(s.shortest_patch() / s.bed.length));
  }
  if (s.goes_along() && !(s.rim() <= 0.5 * s.bed.length)) {
    fail(
        "a tile is {:g} m long, but must be at least {:.3g} m, so that its grains are held at the ends of the lane; "
        "give --bed-length {:.3g} or a smaller --half-edge",
        s.bed.length, 2.0 * s.rim(), 2.0 * s.rim());
  }
  if (!s.goes_along() && !(s.bed.length > shortest)) {
    fail(
        "the lane is {:g} m long, but the car's wheels stand {:.3g} m apart and need {:.3g} m before and behind them; "
        "give --bed-length at least {:.3g}",
        s.bed.length, s.car.wheelbase(), s.margin(), shortest + 0.01);
  }
  if (!(s.path <= s.longest_path() * (1.0 + 1e-9))) {
    fail(
        "a --path of {:g} m is longer than the lane: {:.3g} m of its {:g} m are left for driving; give --bed-length "
        "{:.4g} or a shorter --path",
        s.path, s.longest_path(), s.bed.length, s.path + s.bed.length - s.longest_path());
  }
  const double tyre = s.car.tyre.width, narrowest = tyre + 4.0 * s.grains.edge(), track = s.car.track();
  if (s.is_bed() && !(s.bed.width >= track + narrowest)) {
    fail(
        "the bed is {:g} m wide, but the car needs {:.3g} m: its track, a tyre and two grains on either side; give a "
        "larger --bed-width",
        s.bed.width, track + narrowest);
  }
  if (!s.is_bed() && !(s.bed.width >= narrowest && s.bed.width + 2.0 * s.bed.wall_thickness <= track)) {
    fail(
        "a trough is {:g} m wide, but must hold a tyre and two grains on either side, {:.3g} m, and no more than the "
        "track, {:.3g} m, lets two troughs have; change --bed-width or --half-edge, or give --layout bed",
        s.bed.width, narrowest, track - 2.0 * s.bed.wall_thickness);
  }
}

/// Fills in what depends on the size, and checks every option against its range. Throws Error.
inline void resolve(Settings& s) {
  struct Defaults {
    double length, trough_width, bed_width, depth, half_edge, speed;
  };
  const auto by_size = BySize<Defaults>{.smoke = {4.8, 0.58, 2.6, 0.14, 40e-3, 0.8},
                                        .quick = {7.5, 0.55, 3.0, 0.20, 25e-3, 1.5},
                                        .full = {15.0, 0.90, 4.0, 0.0, 13.3e-3, 2.0}}[size_named(s.size)];
  if (s.layout.empty()) s.layout = s.scene == "turn" ? "bed" : "troughs";
  if (s.layout != "troughs" && s.layout != "bed") {
    fail("--layout is '{}', but must be troughs, bed, or empty: by scene", s.layout);
  }
  rig::resolve(s.grains, by_size.half_edge);
  require_within(s.bed.strike_off, 0.0, 0.9, "--strike-off");
  // Longer where the rear wheels are to come to other ground as well, and where pulls are measured.
  const bool is_held = s.scene == "drawbar";
  require_within(s.tiles, 0, 1000, "--tiles (0: the bed is the lane)");
  require_positive(s.ahead, "--ahead", "m");
  if (s.goes_along()) {
    if (s.has_border() || s.scene == "turn" || s.passes > 1) {
      fail("--tiles is {}, for a lane that goes along, but {} needs a lane that stays; give --tiles 0", s.tiles,
           s.passes > 1 ? text("--passes {}", s.passes) : "--scene " + s.scene);
    }
    fill(s.bed.length, 0.25 * by_size.length);
    fill(s.path, 10.0);
  }
  fill(s.bed.length, by_size.length + (s.has_border() ? s.car.wheelbase() + 0.5 : is_held ? 1.0 : 0.0));
  fill(s.bed.width, s.is_bed() ? by_size.bed_width : by_size.trough_width);
  fill(s.bed.lid_pressure, s.is_bed() ? 1000.0 : 5000.0);
  require_positive(s.bed.length, "--bed-length", "m (0: by size)");
  require_positive(s.bed.width, "--bed-width", "m (0: by size)");
  const double full_depth = depth_of(331'890.0 / s.troughs(), s.bed.strike_off, s.grains,
                                     s.goes_along() ? by_size.length : s.bed.length, s.bed.width);
  rig::resolve(s.bed, {s.bed.length, s.bed.width, by_size.depth > 0.0 ? by_size.depth : full_depth}, s.output);
  fill(s.speed, is_held ? 0.5 * by_size.speed : by_size.speed);
  if (s.engine != "motor") s.car = vehicle::humvee(vehicle::with_engine({.rubber_rear = false}, s.engine));
  if (!s.inputs.empty()) {
    if (s.scene == "brake" || s.scene == "coast" || s.scene == "turn" || is_held) {
      fail("--inputs drive in place of the driver, but --scene {} is what a driver does; give another scene", s.scene);
    }
    s.open_loop = vehicle::read_inputs(s.inputs);
  }
  require_within(s.slope, -100.0, 100.0, "--slope (percent)");
  require_within(s.tyre_pressure, 0.0, 1e6, "--tyre-pressure (Pa)");
  if (s.tyre == "ring" && !(s.machine_step <= s.ring().stable_time_step())) {
    fail("--machine-step is {:g} s, but the belts of ring tyres bear {:.2g} s at most", s.machine_step,
         s.ring().stable_time_step());
  }
  require_positive(s.tread_stiffness, "--tread-stiffness", "N/m");
  require_non_negative(s.second_friction, "--second-friction", "(no unit)");
  require_within(s.second_cohesion, 0.0, 100.0, "--second-cohesion (weights of a grain)");
  require_within(s.second_share, 0.0, 1.0, "--second-share");
  require_within(s.tyre_triangles, 60, 200'000, "--tyre-triangles");
  require_non_negative(s.tyre_friction, "--tyre-friction", "(no unit)");
  require_within(s.speed, 0.05, 20.0, "--speed (m/s)");
  require_within(s.acceleration, 0.05, 10.0, "--acceleration (m/s^2)");
  require_within(s.spin_limit, 0.01, 100.0, "--spin-limit (m/s)");
  require_within(s.path, 0.0, 1e4, "--path (m; 0: as far as the lane goes)");
  require_within(s.passes, 1, 20, "--passes");
  require_within(s.steer_deg, -40.0, 40.0, "--steer (deg)");
  require_within(s.steer_deg_per_s, 1.0, 90.0, "--steer-rate (deg/s)");
  require_within(s.set_down_speed, 0.01, 1.0, "--set-down-speed (m/s)");
  require_within(s.machine_step, 1e-6, 2e-4, "--machine-step (s)");
  require_room(s);
  if (s.path == 0.0) s.path = s.longest_path();
  if (is_held && !(s.path >= 2.0 * s.speed)) {
    fail(
        "a --path of {:.3g} m is too short for a drawbar at {:g} m/s, which takes at least two seconds of way; give at "
        "least {:.3g} m, or a lower --speed",
        s.path, s.speed, 2.0 * s.speed);
  }
  if (!s.has_border()) return;
  const double rest = s.path - s.car.wheelbase();
  if (s.border == 0.0) s.border = s.scene == "step" ? 0.3 : 0.5 * rest;
  if (!(s.border > 0.0 && s.border < rest)) {
    fail(
        "--border is {:.3g} m, but must be above 0 and below {:.3g} m: the rear wheels, {:.3g} m behind the front "
        "ones, "
        "are to come to the other ground within the --path of {:.3g} m; change it, or --path and --bed-length",
        s.border, std::max(0.0, rest), s.car.wheelbase(), s.path);
  }
}

/// Names and values for the report.
inline NamesAndValues list_settings(const Settings& s) {
  const bool sloped = s.slope_angle() != 0.0;
  NamesAndValues list{{"size", s.size}, {"scene", s.scene + (sloped ? text(" of {:g} %", s.slope) : "")}};
  list.insert(list.end(),
              {{"speed", !s.open_loop.empty()   ? "by the inputs " + s.inputs
                         : s.scene == "drawbar" ? text("{:g} m/s, of the rims", s.speed)
                                                : text("{:g} m/s, reached at {:g} m/s²", s.speed, s.acceleration)},
               {"path", text("{:.2f} m", s.path)},
               {"engine", s.engine},
               {"tyre", s.tyre + text(", {:g} m x {:g} m, friction on grains {:g}", 2.0 * s.car.tyre.radius,
                                      s.car.tyre.width, s.tyre_friction)},
               {"lane", s.is_bed() ? "one bed under the car" : "two troughs, one under each track"}});
  if (s.tyre == "ring") list.push_back({"tyre pressure", text("{:g} bar", 1e-5 * s.tyre_pressure)});
  if (s.scene == "step") list.push_back({"hard ground", text("to {:g} m before the front wheels", s.border)});
  if (s.scene == "soils") {
    list.push_back(
        {"second soil", text("from {:g} m before the front wheels on: friction {:g}, cohesion of {:g} weights "
                             "of a grain, {:g} % of the grains",
                             s.border, s.second_friction, s.second_cohesion, 100.0 * s.second_share)});
  }
  if (s.passes > 1) list.push_back({"passes", text("{}", s.passes)});
  if (s.goes_along()) {
    list.push_back(
        {"goes along", text("{} tiles of {:g} m, at least {:g} m of them ahead", s.tiles, s.bed.length, s.ahead)});
  }
  rig::list_settings(list, s.grains);
  rig::list_settings(list, s.bed);
  return list;
}

}  // namespace dem::rig::soft_lane
