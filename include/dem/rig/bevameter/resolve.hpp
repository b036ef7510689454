#pragma once

#include <dem/rig/bevameter/apparatus_settings.hpp>
#include <dem/rig/bevameter/apparatus_words.hpp>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::bevameter {

/// Throws Error where a way (m) ends before its smooth start (s) does.
inline void require_start(double way, double speed, double start, const char* way_option, const char* speed_option) {
  if (!(way > 0.0 && speed > 0.0 && way < start * speed)) return;
  fail("{} is {:g} m, which takes {:.3g} s, but the smooth start takes {:g} s; raise it to {:.3g} m, or lower {}",
       way_option, way, way / speed, start, 1.01 * start * speed, speed_option);
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
    double spin_deg, wheel_travel;
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
                                                  0.021,
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
                                                  0.12,
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
                                                 0.12,
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
            {&s.wheel_travel, by_size.wheel_travel},
            {&s.wheel_bed_length, by_size.wheel_bed.length},
            {&s.wheel_bed_width, by_size.wheel_bed.width},
            {&s.wheel_bed_depth, by_size.wheel_bed.depth}});
  if (s.widths.empty()) s.widths = by_size.widths;
  if (s.normal_stresses.empty()) s.normal_stresses = by_size.stresses;
  if (s.wheel.empty()) s.wheel = by_size.wheel;
  if (s.slips.empty()) s.slips = by_size.slips;
  require_within(s.confidence, 0.5, 0.999, "--confidence");
  require_within(static_cast<double>(s.pieces), 2.0, 50.0, "--pieces");
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
  const double least = *std::min_element(s.slips.begin(), s.slips.end());
  if (s.path == 0.0 && least >= -5.0) {  // wheel_of() refuses others
    const double fastest = std::max(1.0 - least, 0.25) * wheel.rim_speed();
    require_start(s.wheel_travel, fastest, wheel.ramp_time, "--wheel-travel", "--spin");
  }
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
               {"friction, grain on plate", text("{:g}", s.plate_friction)},
               {"normal stresses", all(s.normal_stresses, 1e-3) + " kPa"},
               {"wheel", s.has_wheel() ? text("{}, {:g} N, slips {}", s.wheel, s.load, all(s.slips, 1.0)) : "none"},
               {"friction, grain on wheel", s.has_wheel() ? text("{:g}", wheel_of(s, "").wheel_friction) : "-"},
               {"grains at rest", s.sleep ? "may sleep in the beds" : "stay awake"},
               {"intervals", text("{:g} % confidence", 100.0 * s.confidence)}});
  return list;
}

}  // namespace dem::rig::bevameter
