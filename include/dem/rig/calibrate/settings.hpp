#pragma once

#include <dem/rig/calibrate/held_constants.hpp>
#include <dem/rig/contact_options.hpp>
#include <dem/rig/names_in.hpp>
#include <dem/rig/own_words.hpp>
#include <dem/rig/plate_sinkage/settings.hpp>
#include <dem/rig/sand_pile/settings.hpp>
#include <dem/rig/sizes.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::calibrate {

/// A constant of the grains that can be looked for.
enum class Constant { friction, stiffness, density, rolling };

/// What a rig measures.
enum class Quantity { phi, repose, pressure, exponent };

inline constexpr const char* names_of_constants[] = {"friction", "stiffness", "relative-density", "rolling"};
inline constexpr const char* units_of_constants[] = {"", "N/m", "", "half-edges"};
inline constexpr const char* names_of_quantities[] = {"phi", "repose", "pressure", "exponent"};
inline constexpr const char* units_of_quantities[] = {"deg", "deg", "Pa", "-"};

/// Everything that can be chosen. A value of 0 where it says "0: by size" is filled in by resolve().
struct Settings {
  std::string size = "quick";     ///< of the rigs: smoke, quick or full
  std::string find = "friction";  ///< constants, with commas between them
  std::vector<double> known;      ///< of them, that the targets are made with; empty: targets are given
  std::string targets;            ///< made with `known`: quantities, with commas between them

  // Targets; 0: not one
  double phi = 0.0, phi_error = 0.5;             ///< deg, of direct shear, through the origin
  double repose = 0.0, repose_error = 1.0;       ///< deg, of a pile
  double pressure = 0.0, pressure_error = 0.0;   ///< Pa, of a plate: mean over the second half of the sinkage; 0: 5 %
  double exponent = 0.0, exponent_error = 0.05;  ///< n of p = k z^n, of the same plate

  // Ranges
  std::vector<double> friction_range = {0.1, 0.9};
  std::vector<double> stiffness_range = {5e3, 4e4};  ///< N/m, by its logarithm
  std::vector<double> density_range = {0.05, 0.6};
  std::vector<double> rolling_range = {0.02, 0.5};  ///< half-edges
  HeldConstants held;

  // Rigs
  std::vector<double> loads;                                  ///< kg, of the shear test; empty: by size
  std::vector<double> plates;                                 ///< m, width; empty: the rig's in the middle
  double plate_length = 0.0;                                  ///< m; 0: by size
  double plate_friction = 0.0;                                ///< mu, grain on plate
  double sinkage = 0.0;                                       ///< m, of the plate; 0: by size
  double fall_speed = 0.0;                                    ///< m/s, of the grains of its bed; 0: freely
  double bed_length = 0.0, bed_width = 0.0, bed_depth = 0.0;  ///< m, of its bed; 0: by size
  std::string kind = "sphere-rolling";                        ///< of the grains of the pile: that or cube8

  // Search
  std::uint64_t trials = 0;   ///< points; 0: by size
  std::uint64_t repeats = 2;  ///< seeds at each point
  std::uint64_t batch = 3;    ///< points that are chosen at once
  std::uint64_t seed = 1;     ///< the first
  bool go_on = false;         ///< read the table of the folder, and go on with it

  int threads = 0;  ///< runs side by side; 0: all
  std::string output = "calibrate_output";
};

/// The names in a text with commas as numbers of a list. Throws Error for another name, and for one twice.
template <class E, std::size_t n>
std::vector<E> named_in(const std::string& names, const char* const (&known)[n], const char* option) {
  std::vector<E> list;
  for (const std::string& name : names_in(names)) {
    const auto at = std::find(std::begin(known), std::end(known), name);
    if (at == std::end(known)) {
      std::string all;
      for (const char* k : known) all += (all.empty() ? "" : ", ") + std::string(k);
      fail("{} names '{}', but must be of {}, with commas between them", option, name, all);
    }
    list.push_back(static_cast<E>(at - std::begin(known)));
    if (std::count(list.begin(), list.end(), list.back()) > 1) fail("{} names '{}' twice; leave one out", option, name);
  }
  return list;
}

/// The constants that are looked for.
inline std::vector<Constant> constants_of(const Settings& s) {
  return named_in<Constant>(s.find, names_of_constants, "--find");
}
/// The quantities that are aimed at.
inline std::vector<Quantity> quantities_of(const Settings& s) {
  if (!s.known.empty()) return named_in<Quantity>(s.targets, names_of_quantities, "--targets");
  std::vector<Quantity> list;
  if (s.phi > 0.0) list.push_back(Quantity::phi);
  if (s.repose > 0.0) list.push_back(Quantity::repose);
  if (s.pressure > 0.0) list.push_back(Quantity::pressure);
  if (s.exponent > 0.0) list.push_back(Quantity::exponent);
  return list;
}
inline bool is_of_plate(Quantity q) { return q == Quantity::pressure || q == Quantity::exponent; }
/// Whether a plate is pressed.
inline bool presses(const Settings& s) {
  const auto list = quantities_of(s);
  return std::any_of(list.begin(), list.end(), is_of_plate);
}

inline const std::vector<double>& range_of(const Settings& s, Constant c) {
  return c == Constant::friction    ? s.friction_range
         : c == Constant::stiffness ? s.stiffness_range
         : c == Constant::density   ? s.density_range
                                    : s.rolling_range;
}
/// The value of a constant at a place from 0 to 1 of its range, and back. Stiffnesses go by their logarithm.
inline double value_at(const Settings& s, Constant c, double place) {
  const auto& range = range_of(s, c);
  if (c == Constant::stiffness) return range[0] * std::pow(range[1] / range[0], place);
  return range[0] + place * (range[1] - range[0]);
}
inline double place_of(const Settings& s, Constant c, double value) {
  const auto& range = range_of(s, c);
  if (c == Constant::stiffness) return std::log(value / range[0]) / std::log(range[1] / range[0]);
  return (value - range[0]) / (range[1] - range[0]);
}

/// Names every option and the place of its value.
inline void declare(Options& options, Settings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { return options.add(name, value, text); };
  add("--size", s.size,
      "of the rigs: smoke (seconds a run, minutes a search), quick (minutes a run, half an hour to two hours a search) "
      "or full (hours a run)");
  options.group("Targets");
  add("--phi", s.phi,
      "angle of friction of the shear strengths over the load, through the origin, as direct_shear prints it [deg]; 0: "
      "no "
      "target");
  add("--phi-error", s.phi_error, "its standard error [deg]");
  add("--repose", s.repose, "angle of repose of a pile that a lifted cylinder leaves [deg]; 0: no target");
  add("--repose-error", s.repose_error, "its standard error [deg]");
  add("--pressure", s.pressure, "on a plate, mean over the second half of its sinkage [Pa]; 0: no target");
  add("--pressure-error", s.pressure_error, "its standard error [Pa]; 0: 5 %");
  add("--exponent", s.exponent, "n of the plate's curve p = k z^n: with --pressure its course; 0: no target");
  add("--exponent-error", s.exponent_error, "its standard error");
  add("--known", s.known, "values of the constants that targets are made with by the rigs: to try the search out");
  add("--targets", s.targets, "that are made: of phi, repose, pressure, exponent, with commas between them");
  options.group("Constants");
  add("--find", s.find, "which: of friction, stiffness, relative-density, rolling, with commas between them");
  add("--friction-range", s.friction_range, "least and greatest, e.g. 0.1,0.9");
  add("--stiffness-range", s.stiffness_range, "[N/m]");
  add("--relative-density-range", s.density_range, "of the packing or bed");
  add("--rolling-range", s.rolling_range, "rolling length of the pile's grains [half-edges]");
  add_held_constants(options, s.held);
  options.group("Rigs");
  add("--loads", s.loads, "of the shear test [kg]; empty: by size");
  add("--plate", s.plates, "width of the plate [m]; empty: by size");
  add("--plate-length", s.plate_length, "[m]; 0: by size");
  add("--plate-friction", s.plate_friction, "mu, grain on the plate that is pressed");
  add("--sinkage", s.sinkage, "of the plate [m]; 0: by size");
  add("--fall-speed", s.fall_speed, "at which grains of its bed fall at most while they are rained [m/s]; 0: freely");
  add("--bed-length", s.bed_length, "of the plate's bed [m]; 0: by size");
  add("--bed-width", s.bed_width, "[m]; 0: by size");
  add("--bed-depth", s.bed_depth, "[m]; 0: by size");
  add("--pile-kind", s.kind, "grains of the pile").one_of({"sphere-rolling", "cube8"});
  options.group("Search");
  add("--trials", s.trials,
      "points that are tried; more may be asked for with --go-on of a search that has ended, and with --resume of one "
      "that was stopped; 0: by size")
      .changes_no_result();
  add("--repeats", s.repeats, "runs at each point, with other seeds");
  add("--batch", s.batch, "points that are chosen at once, from all that was found before");
  add("--seed", s.seed, "the first");
  options
      .flag("--go-on", s.go_on,
            "begin again with the table of tried points in the output folder, as of a search that has ended")
      .of_this_run();
  add("--threads", s.threads, "runs side by side; 0: as many as there are cores").changes_no_result();
  options.group("Output");
  add("--output", s.output, "folder").changes_no_result();
}

inline void find_idle(IdleOptions& idle, const Settings& s) {
  const auto has = [](const std::string& list, const char* name) {
    return ("," + list + ",").find(text(",{},", name)) != std::string::npos;
  };
  const bool made = !s.known.empty();
  idle.unless(!made, "without --known, by which targets are made",
              {"--phi", "--phi-error", "--repose", "--repose-error", "--pressure", "--pressure-error", "--exponent",
               "--exponent-error"});
  idle.unless(made, "with --known", {"--targets"});
  idle.unless(s.phi != 0.0, "with --phi", {"--phi-error"});
  idle.unless(s.repose != 0.0, "with --repose", {"--repose-error"});
  idle.unless(s.pressure != 0.0, "with --pressure", {"--pressure-error"});
  idle.unless(s.exponent != 0.0, "with --exponent", {"--exponent-error"});
  const auto aims = [&](double target, const char* name) {
    return made ? has(s.targets.empty() ? "phi" : s.targets, name) : target != 0.0;
  };
  idle.unless(aims(s.phi, "phi"), "with the target phi", {"--loads"});
  const bool by_plate = aims(s.pressure, "pressure") || aims(s.exponent, "exponent");
  idle.unless(by_plate, "with the target pressure or exponent",
              {"--plate", "--plate-length", "--plate-friction", "--sinkage", "--fall-speed", "--bed-length",
               "--bed-width", "--bed-depth"});
  idle.unless(aims(s.repose, "repose"), "with the target repose", {"--pile-kind"});
  idle.unless(has(s.find, "friction"), "with --find friction", {"--friction-range"});
  idle.unless(has(s.find, "stiffness"), "with --find stiffness", {"--stiffness-range"});
  idle.unless(has(s.find, "relative-density"), "with --find relative-density", {"--relative-density-range"});
  idle.unless(has(s.find, "rolling"), "with --find rolling", {"--rolling-range"});
  idle.unless(!has(s.find, "friction"), "where --find does not name friction", {"--friction"});
  idle.unless(!has(s.find, "stiffness"), "where --find does not name stiffness", {"--stiffness"});
  const bool packs = aims(s.phi, "phi") || by_plate;
  idle.unless(packs && !has(s.find, "relative-density"),
              "with the target phi, pressure or exponent, where --find does not name relative-density",
              {"--relative-density"});
  idle.unless(aims(s.repose, "repose") && s.kind == "sphere-rolling" && !has(s.find, "rolling"),
              "with the target repose of sphere-rolling, where --find does not name rolling", {"--rolling"});
}

/// What the rigs call otherwise than these options: a constant that is looked for has a range.
inline std::vector<OwnWord> own_words(const Settings& s) {
  std::vector<OwnWord> words = {
      {"; change --relative-density, --densify-time or --seed if that matters", ""},
      {"; take more --grains or a smaller --half-edge if that matters",
       "; take another --size or a smaller --half-edge if that matters"},
      {"lower --shear-speed to", "it would be slow below"},
      {"raise --consolidation-limit, --rest-speed or --damping", "change the ranges of the constants, or --damping"},
      {"raise --settle-limit or --damping", "change the ranges of the constants, or --damping"},
      {"raise --stage-limit or --damping", "change the ranges of the constants, or --damping"},
      {"take more --grains or a smaller --half-edge, or let", "take another --size or a smaller --half-edge, or let"},
      {"take fewer --grains, or a higher box", "take a smaller --half-edge"},
      {"take fewer --grains, or larger ones (--half-edge)", "take a larger --half-edge"},
      {"change --half-edge, or give --grains", "change --half-edge"},
      {"lower --threshold or --sinkage", "lower --sinkage"},
      {"--ramp-time (s, at most what the sinkage takes)",
       "raise --sinkage: the plate's smooth start (s, at most what the sinkage takes)"},
      {"--plates", "--plate"},
      {"--rolling-length", "--rolling"}};
  for (const Constant c : constants_of(s)) {
    if (c == Constant::friction) words.push_back({"--friction", "--friction-range"});
    if (c == Constant::stiffness) words.push_back({"--stiffness", "--stiffness-range"});
    if (c == Constant::density) words.push_back({"--relative-density", "--relative-density-range"});
  }
  return words;
}

/// m, the half-edge that K, kt, C and cv are given for: that of the rigs, which `held.constants_for` overrides.
inline double size_of_constants(const Settings& s) {
  if (s.held.constants_for > 0.0) return s.held.constants_for;
  return presses(s) ? plate_sinkage::Settings{}.grains.constants_for : sand_pile::Settings{}.constants_for;
}

/// Fills in what depends on the size, and checks every option. Throws Error.
inline void resolve(Settings& s) {
  const Size size = size_named(s.size);
  if (!s.known.empty() && s.targets.empty()) s.targets = "phi";
  if (s.trials == 0) s.trials = BySize<std::uint64_t>{.smoke = 9, .quick = 12, .full = 15}[size];
  require_within(s.phi, 0.0, 89.0, "--phi (deg)");
  require_within(s.repose, 0.0, 89.0, "--repose (deg)");
  require_non_negative(s.pressure, "--pressure", "Pa");
  require_within(s.exponent, 0.0, 10.0, "--exponent");
  const auto constants = constants_of(s);
  const auto quantities = quantities_of(s);
  if (quantities.empty()) {
    fail(
        "there is no target; give --phi, --repose, --pressure or --exponent, or make one with --known; to go on with a "
        "search, "
        "give those that it had (or --config with its settings.toml)");
  }
  if (quantities.size() < constants.size()) {
    fail("{} constants cannot be told from {} target{}; give as many targets as constants", constants.size(),
         quantities.size(), quantities.size() == 1 ? "" : "s");
  }
  const bool by_plates = presses(s), by_others = !std::all_of(quantities.begin(), quantities.end(), is_of_plate);
  const bool has_size = std::count(constants.begin(), constants.end(), Constant::stiffness) > 0 || scales(s.held);
  if (has_size && by_plates && by_others && !(s.held.constants_for > 0.0)) {
    fail(
        "K, kt, C and cv are those of grains of one half-edge, but the plate has them for {:g} mm, shear test and pile "
        "for "
        "{:g} "
        "mm; give one for all by --constants-for (m)",
        1e3 * plate_sinkage::Settings{}.grains.constants_for, 1e3 * sand_pile::Settings{}.constants_for);
  }
  for (const Constant c : constants) {
    const auto& range = range_of(s, c);
    const char* name = names_of_constants[static_cast<int>(c)];
    if (range.size() != 2 || !(range[0] < range[1]) || !(range[0] >= 0.0) ||
        (c == Constant::stiffness && range[0] <= 0.0)) {
      fail("--{}-range must be two numbers, none negative, the least first, as 0.1,0.9", name);
    }
    const auto measures = [&](Quantity q) { return std::count(quantities.begin(), quantities.end(), q) > 0; };
    if (c == Constant::rolling && !(measures(Quantity::repose) && s.kind == "sphere-rolling")) {
      fail("no target depends on the rolling length; aim at --repose, with --pile-kind sphere-rolling");
    }
    if (c == Constant::rolling) {
      require_within(range[1], 0.0, sand_pile::sphere_radius(1.0),
                     "the greatest of --rolling-range (half-edges, at most the radius of a sphere)");
    }
    if (c == Constant::density && !measures(Quantity::phi) && !by_plates) {
      fail("no target depends on the relative density; aim at --phi, --pressure or --exponent");
    }
  }
  if (range_of(s, Constant::density).size() == 2)
    require_within(s.density_range.back(), 0.0, 1.0, "--relative-density-range");
  if (!s.known.empty() && s.known.size() != constants.size()) {
    fail("--known has {} values, but --find names {} constants; give one for each", s.known.size(), constants.size());
  }
  for (std::size_t k = 0; k < s.known.size(); ++k) {
    const auto& range = range_of(s, constants[k]);
    require_within(s.known[k], range[0], range[1], "a value of --known (within the range of its constant)");
  }
  require_non_negative(s.phi_error, "--phi-error", "deg");
  require_non_negative(s.repose_error, "--repose-error", "deg");
  require_non_negative(s.pressure_error, "--pressure-error", "Pa");
  require_non_negative(s.exponent_error, "--exponent-error", "(no unit)");
  fill(s.pressure_error, 0.05 * s.pressure);
  require_within(static_cast<double>(s.trials), 3.0, 1e4, "--trials (0: by size)");
  require_within(static_cast<double>(s.repeats), 1.0, 1e3, "--repeats");
  const std::uint64_t points = constants.size() + 1;  // of a plane; a run more tells what runs scatter by
  if (s.trials < points || s.trials * s.repeats < points + 1) {
    fail("{} points of {} runs each cannot tell {} constants; raise --trials to {}, or --repeats", s.trials, s.repeats,
         constants.size(), std::max(points, (points + s.repeats) / s.repeats));
  }
  require_within(static_cast<double>(s.batch), 1.0, 1e3, "--batch");
  require_within(s.threads, 0.0, 4096.0, "--threads (0: all)");
  if (s.held.rolling > 0.0) {
    require_within(s.held.rolling, 0.0, sand_pile::sphere_radius(1.0),
                   "--rolling (half-edges, at most the radius of a sphere)");
  }
  for_each_held(s.held, [](const char* name, const double& value, const char*, const char*) {
    if (!(value <= 1e12)) fail("{} is {:g}, but must be at most 1e12 (negative: as each rig has it)", name, value);
  });
  if (s.plates.size() > 1) fail("--plate has {} widths, but one plate is pressed; give one", s.plates.size());
}

}  // namespace dem::rig::calibrate
