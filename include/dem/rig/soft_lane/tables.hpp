#pragma once

#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/soft_lane/results.hpp>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

// What was found, as tables and plots.

namespace dem::rig::soft_lane {

inline io::Table drive_table(const Settings& s, const Campaign& c) {
  const char* caption = s.scene == "brake" || s.scene == "coast"
                            ? "The drive; means over the quarter of the path before the driver lets go"
                            : "The drive; means over the second half of the way";
  io::Table t{.caption = caption,
              .header = {"scene", "ended", "way [m]", "time [s]", "speed [m/s]", "slip", "sinkage [mm]", "pull [kN]",
                         "torque [kN m]", "resistance [kN]", "of the weight", "drift [mm]"}};
  const bool any = !c.samples.empty();
  const Means& m = c.means;
  t.row(list_settings(s)[1].second, c.ended.empty() ? "broken off" : c.ended,
        number(any ? c.samples.back().way : not_known), number(any ? c.samples.back().car.time : not_known),
        number(m.speed), number(m.slip, "{:.3f}"), number(1e3 * m.sinkage, "{:.1f}"), number(1e-3 * m.pull),
        number(1e-3 * m.torque), number(1e-3 * m.resistance), number(m.resistance / c.weight, "{:.3f}"),
        number(1e3 * c.drift, "{:.0f}"));
  return t;
}

/// Of a step or of two soils: what the car did on each of them.
inline io::Table stretch_table(const Campaign& c) {
  io::Table t{
      .caption = "Where the ground changes; means over the way on each",
      .header = {"wheels", "speed [m/s]", "slip", "sinkage [mm]", "resistance [kN]", "of the weight", "energy [kJ/m]"}};
  const char* where[] = {"all on the first ground", "front wheels on the other", "all on the other"};
  for (std::size_t k = 0; k < 3; ++k) {
    const Means& m = c.stretches[k];
    t.row(where[k], number(m.speed), number(m.slip, "{:.3f}"), number(1e3 * m.sinkage, "{:.1f}"),
          number(1e-3 * m.resistance), number(m.resistance / c.weight, "{:.3f}"), number(1e-3 * m.energy_per_metre));
  }
  return t;
}

/// Of several passes.
inline io::Table pass_table(const Campaign& c) {
  io::Table t{.caption = "Passes in the same ruts; means over the second half of the way; ruts from before the first",
              .header = {"pass", "ended", "way [m]", "speed [m/s]", "slip", "sinkage [mm]", "resistance [kN]",
                         "of the weight", "energy [kJ/m]", "ruts, left and right [mm]"}};
  for (std::size_t k = 0; k < c.passes.size(); ++k) {
    const Pass& p = c.passes[k];
    const Means& m = p.means;
    t.row(k + 1, p.ended, number(p.way), number(m.speed), number(m.slip, "{:.3f}"), number(1e3 * m.sinkage, "{:.1f}"),
          number(1e-3 * m.resistance), number(m.resistance / c.weight, "{:.3f}"), number(1e-3 * m.energy_per_metre),
          number(1e3 * p.rut_depth[0], "{:.0f}") + ", " + number(1e3 * p.rut_depth[1], "{:.0f}"));
  }
  return t;
}

/// Of a car on a load cell.
inline io::Table pull_table(const Campaign& c) {
  io::Table t{.caption = "On the load cell; means over a tenth of slip",
              .header = {"slip", "pull [kN]", "of the weight", "torque [kN m]", "sinkage [mm]", "efficiency"}};
  for (const PullPoint& p : c.pulls) {
    t.row(number(p.slip), number(1e-3 * p.pull), number(p.pull / c.weight, "{:.3f}"), number(1e-3 * p.torque),
          number(1e3 * p.sinkage, "{:.0f}"), number(p.efficiency));
  }
  return t;
}

inline io::Table wheel_table(const Campaign& c) {
  io::Table t{.caption = "Wheels at rest on the level lane", .header = {"wheel", "load [kN]", "sinkage [mm]"}};
  for (std::size_t k = 0; k < 4; ++k) {
    t.row(vehicle::corner_names[k], number(1e-3 * c.rest_load[k]), number(1e3 * c.rest_sinkage[k], "{:.1f}"));
  }
  return t;
}

inline io::Table cost_table(const Settings& s, const Campaign& c) {
  io::Table t{.caption = "Energy, ruts and checks", .header = {"what", "value", "unit"}};
  const Means& m = c.means;
  t.row("power of the engine", number(1e-3 * m.power), "kW");
  t.row("energy of the engine for a metre", number(1e-3 * m.energy_per_metre), "kJ/m");
  t.row("cost of transport, energy over weight and way", number(m.cost_of_transport, "{:.3f}"), "");
  t.row("depth of the left rut", number(1e3 * c.rut_depth[0], "{:.1f}"), "mm");
  t.row("depth of the right rut", number(1e3 * c.rut_depth[1], "{:.1f}"), "mm");
  t.row("width of the left rut", number(1e3 * c.rut_width, "{:.0f}"), "mm");
  if (s.scene == "brake" || s.scene == "coast") {
    t.row("way from there to a tenth of the speed", number(c.brake_way), "m");
    t.row("mean deceleration", number(c.deceleration), "m/s²");
    t.row("force that slows the car, mass times deceleration", number(1e-3 * c.weight / 9.81 * c.deceleration), "kN");
  }
  if (s.slope_angle() != 0.0)
    t.row("way on its brakes while gravity was tilted", number(1e3 * c.held_way, "{:.0f}"), "mm");
  if (s.scene == "turn") {
    t.row("radius of the turn", number(c.radius), "m");
    t.row("radius by the angle of the front wheels", number(c.ackermann), "m");
  }
  double widest = 0.0, asleep = 0.0;
  for (const Sample& x : c.samples) widest = std::max(widest, x.widest_joint), asleep += x.asleep;
  const bool is_on_grains = std::isfinite(c.deep_share);
  t.row("overlap of grains under the tyres at rest, mean", number(is_on_grains ? 100.0 * c.overlap.mean : not_known),
        "% of the edge");
  t.row("of these contacts, deeper than 2 % of the edge", number(100.0 * c.deep_share, "{:.0f}"), "%");
  t.row("deepest overlap of any grain while driving", number(100.0 * c.deepest), "% of the edge");
  t.row("overlap under a tyre, as estimated for these grains", number(100.0 * s.overlap(c.weight)), "% of the edge");
  t.row("widest joint", number(1e3 * widest), "mm");
  t.row("grains asleep while driving", number(100.0 * asleep / static_cast<double>(c.samples.size()), "{:.0f}"), "%");
  t.row("grains that left the lane", number(c.lost, "{:.0f}"), "");
  if (s.goes_along()) {
    t.row("tiles laid ahead", text("{}", c.tiles_laid), "");
    t.row("grains that lay where tiles came", number(c.strays, "{:.0f}"), "");
  }
  t.row("wall time for a second of driving", number(c.computing, "{:.1f}"), "s");
  return t;
}

inline std::string lane_text(const Settings& s, const Campaign& c) {
  return text(
      "Lane: {} grains of half-edge {:g} mm, {} mm deep, solid fraction {}; {}. Time step {} s, {} sub-steps of "
      "the car. The car weighs {} kN.",
      c.grains, 1e3 * s.grains.half_edge, number(1e3 * c.level, "{:.1f}"), number(c.solid_fraction, "{:.3f}"),
      s.is_bed() ? "one bed under the car" : "two troughs, one under each track", number(c.time_step, "{:.3g}"),
      c.substeps, number(1e-3 * c.weight));
}

inline constexpr const char* words_text =
    "Slip is (omega r - v)/max(|omega r|, |v|) with the unloaded radius r: positive drives, negative brakes. Sinkage "
    "is that of a tyre's lowest point below the level. Pull is the net forward force of the grains on the four "
    "wheels, "
    "torque what drives them against the grains, and resistance the sum of torque/r - pull: what the soil takes of the "
    "thrust.";

/// A value over time.
template <class Of>
io::Series line_of(const Campaign& c, std::string name, int color, Of&& of) {
  io::Series line{.name = std::move(name), .color = color};
  for (const Sample& x : c.samples) line.x.push_back(x.car.time), line.y.push_back(of(x));
  return line;
}

/// A value of all four wheels over time.
inline io::Plot wheel_plot(const Campaign& c, double WheelSample::*value, double scale, const char* title,
                           const char* label) {
  io::Plot plot{.title = title, .x_label = "time [s]", .y_label = label};
  for (std::size_t k = 0; k < 4; ++k) {
    plot.series.push_back(line_of(c, vehicle::corner_names[k], static_cast<int>(k),
                                  [&](const Sample& x) { return scale * x.wheels[k].*value; }));
  }
  return plot;
}

inline io::Plot speed_plot(const Campaign& c) {
  io::Plot plot{.title = "Speed", .x_label = "time [s]", .y_label = "speed [m/s]"};
  plot.series = {line_of(c, "car", 0, [](const Sample& x) { return x.car.speed; })};
  return plot;
}
inline io::Plot pull_plot(const Campaign& c) {
  io::Plot plot{.title = "Pull on the load cell", .x_label = "slip", .y_label = "pull, of the weight"};
  io::Series all{.name = "every 10 ms", .style = io::SeriesStyle::Points, .color = 1},
      means{.name = "means", .style = io::SeriesStyle::LinePoints, .color = 0};
  for (const Sample& x : c.samples) {
    if (x.car.time > held_start) all.x.push_back(x.mean(&WheelSample::slip)), all.y.push_back(x.hitch / c.weight);
  }
  for (const PullPoint& p : c.pulls) means.x.push_back(p.slip), means.y.push_back(p.pull / c.weight);
  plot.series = {std::move(all), std::move(means)};
  return plot;
}
inline io::Plot engine_plot(const Campaign& c) {
  io::Plot plot{.title = "Engine", .x_label = "time [s]", .y_label = "power [kW]"};
  plot.series = {line_of(c, "engine", 0, [](const Sample& x) { return 1e-3 * x.car.engine_power; })};
  return plot;
}
inline io::Plot energy_plot(const Campaign& c) {
  io::Plot plot{.title = "Work", .x_label = "time [s]", .y_label = "work [kJ]"};
  plot.series = {line_of(c, "engine", 0, [](const Sample& x) { return 1e-3 * x.car.engine_work; }),
                 line_of(c, "brakes", 1, [](const Sample& x) { return 1e-3 * x.car.brake_work; })};
  return plot;
}
inline io::Plot joint_plot(const Campaign& c) {
  io::Plot plot{.title = "Lower ball joints", .x_label = "time [s]", .y_label = "force [kN]"};
  for (std::size_t k = 0; k < 4; ++k) {
    plot.series.push_back(line_of(c, vehicle::corner_names[k], static_cast<int>(k),
                                  [&](const Sample& x) { return 1e-3 * x.suspension[k].lower_ball.norm(); }));
  }
  return plot;
}
inline io::Plot driver_plot(const Campaign& c) {
  io::Plot plot{.title = "Driver", .x_label = "time [s]", .y_label = "throttle, brake, steering [0.1 rad]"};
  plot.series = {line_of(c, "throttle", 0, [](const Sample& x) { return x.car.controls.throttle; }),
                 line_of(c, "brake", 1, [](const Sample& x) { return x.car.controls.brake; }),
                 line_of(c, "steering", 2, [](const Sample& x) { return 10.0 * x.car.steer; })};
  return plot;
}
inline io::Plot pose_plot(const Campaign& c) {
  io::Plot plot{.title = "Attitude", .x_label = "time [s]", .y_label = "angle [deg]"};
  const double degree = 180.0 / std::numbers::pi;
  plot.series = {line_of(c, "roll", 0, [&](const Sample& x) { return degree * x.car.roll; }),
                 line_of(c, "pitch", 1, [&](const Sample& x) { return degree * x.car.pitch; }),
                 line_of(c, "yaw", 2, [&](const Sample& x) { return degree * x.car.yaw; })};
  return plot;
}

inline io::Plot rut_plot(const Campaign& c) {
  io::Plot plot{.title = "Surface behind the wheels", .x_label = "across [mm]", .y_label = "above the level [mm]"};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto add = [&](const SurfaceProfile& p, const char* name, io::SeriesStyle style) {
      io::Series line{.name = name, .style = style, .color = static_cast<int>(side)};
      for (std::size_t k = 0; k < p.y.size(); ++k) {
        line.x.push_back(1e3 * p.y[k]);
        line.y.push_back(1e3 * (p.z[k] - c.level));
      }
      if (!line.x.empty()) plot.series.push_back(std::move(line));
    };
    add(c.before[side], side == 0 ? "left, before" : "right, before", io::SeriesStyle::Dashed);
    add(c.after[side], side == 0 ? "left, after" : "right, after", io::SeriesStyle::LinePoints);
  }
  return plot;
}

/// The surface of the tracks along a lane that goes along: of all that was driven over.
inline io::Plot along_plot(const Campaign& c) {
  io::Plot plot{
      .title = "Surface along the tracks", .x_label = "along the lane [m]", .y_label = "above untouched tiles [mm]"};
  for (std::size_t side = 0; side < 2; ++side) {
    io::Series line{.name = side == 0 ? "left" : "right", .color = static_cast<int>(side)};
    for (const LanePlace& p : c.along) {
      if (std::isfinite(p.z[side]))
        line.x.push_back(p.x), line.y.push_back(1e3 * (p.z[side] - c.untouched_along[side]));
    }
    plot.series.push_back(std::move(line));
  }
  plot.width = 1200;
  return plot;
}

/// A section of the lane at the end: grains in the plane of the left wheels, the wheels, and the level.
inline io::Plot section_plot(const Settings& s, const Campaign& c) {
  io::Plot plot{
      .title = "Section through the left wheels at the end", .x_label = "along the lane [m]", .y_label = "height [m]"};
  io::Series grains{.name = "grains", .style = io::SeriesStyle::Points, .color = 1};
  for (const Vec3& g : c.section) grains.x.push_back(g.x()), grains.y.push_back(g.z());
  plot.series.push_back(std::move(grains));
  for (const std::size_t k : {0, 2}) {
    io::Series wheel{.name = k != 0 ? "" : s.tyre == "ring" ? "tyres, not deformed" : "tyres", .color = 0};
    for (int i = 0; i <= 90; ++i) {
      const double angle = i * std::numbers::pi / 45.0;
      wheel.x.push_back(c.wheel_at[k].x() + s.car.tyre.radius * std::cos(angle));
      wheel.y.push_back(c.wheel_at[k].z() + s.car.tyre.radius * std::sin(angle));
    }
    plot.series.push_back(std::move(wheel));
  }
  plot.series.push_back({.name = "level",
                         .x = {c.ends[0], c.ends[1]},
                         .y = {c.level, c.level},
                         .style = io::SeriesStyle::Dashed,
                         .color = 2});
  // One scale for both axes, as far as the frame allows.
  plot.width = 1200;
  plot.height = 420;
  const double shown = 0.28 * s.length();
  plot.x_range = {c.ends[0], c.ends[1]};
  plot.y_range = {0.0, std::max(shown, c.level + 1.1)};
  return plot;
}

}  // namespace dem::rig::soft_lane
