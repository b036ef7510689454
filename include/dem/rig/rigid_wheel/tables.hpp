#pragma once

#include <dem/io/duration.hpp>
#include <dem/report/heat_map.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/bed.hpp>
#include <dem/rig/rigid_wheel/references.hpp>
#include <dem/rig/rigid_wheel/results.hpp>

#include <span>

// What was found, as tables and plots, beside the semi-empirical soils.

namespace dem::rig::rigid_wheel {

inline io::Table slip_table(const Campaign& c) {
  io::Table t{.caption = "Means over the steady window, slip s = 1 - v/(omega r) (± standard deviation in time)",
              .header = {"slip", "pull [N]", "±", "torque [N m]", "±", "sinkage [mm]", "±", "efficiency", "±",
                         "carried [N]", "steady from [s]", "steady", "done"}};
  for (const SlipResult& r : c.slips) {
    t.row(number(r.slip), number(r.pull.mean), number(r.pull.deviation), number(r.torque.mean),
          number(r.torque.deviation), number(1e3 * r.sinkage.mean), number(1e3 * r.sinkage.deviation),
          number(r.efficiency.mean), number(r.efficiency.deviation), number(r.carried.mean, "{:.1f}"),
          number(r.window_from), r.is_steady, r.finished);
  }
  return t;
}

/// Calls row(name, forces) for what each soil has at slip number k.
template <class Row>
void for_each_reference(const Settings& s, double slip, std::size_t k, std::span<const Reference> soils, Row&& row) {
  for (const Reference& soil : soils) {
    if (const auto f = reference_at(soil.soil, slip, s)) row(soil.name, *f);
    if (k < soil.on_columns.size() && soil.on_columns[k]) row(soil.name + ", dynamic Bekker", *soil.on_columns[k]);
  }
}

inline io::Table reference_table(const Settings& s, const Campaign& c, std::span<const Reference> soils) {
  io::Table t{
      .caption = "Beside Bekker and Wong (eqs. 2-11) and dynamic Bekker (soil columns), slip s = 1 - v/(omega r)",
      .header = {"slip", "soil", "pull [N]", "torque [N m]", "sinkage [mm]"}};
  const auto row = [&](const std::string& name, const terramechanics::WheelForces& f) {
    t.row("", name, number(f.pull), number(f.torque), number(1e3 * f.sinkage));
  };
  for (std::size_t k = 0; k < c.slips.size(); ++k) {
    const SlipResult& r = c.slips[k];
    t.row(number(r.slip), "grains", number(r.pull.mean), number(r.torque.mean), number(1e3 * r.sinkage.mean));
    for_each_reference(s, r.slip, k, soils, row);
  }
  return t;
}

inline io::Table rut_table(const Campaign& c) {
  io::Table t{.caption =
                  "Ruts and checks, slip s = 1 - v/(omega r). A rut's depth is a mean over the middle half of the "
                  "wheel's width; it is as wide as the surface sank by more than half of that",
              .header = {"slip", "rut depth [mm]", "rut width [mm]", "drive against grains [N]",
                         "motor against grains [N m]", "slip as it was"}};
  for (const SlipResult& r : c.slips) {
    double force = 0.0, torque = 0.0, slip = 0.0, count = 0.0;
    for (const Sample& x : r.samples) {
      if (!(x.time >= r.window_from)) continue;
      force += x.drive_force - x.pull, torque += x.motor_torque - x.torque, slip += x.slip, count += 1.0;
    }
    t.row(number(r.slip), number(1e3 * r.rut.depth), number(1e3 * r.rut.width, "{:.0f}"), number(force / count),
          number(torque / count, "{:.3f}"), number(slip / count, "{:.3f}"));
  }
  return t;
}

/// A mean over slip, beside the semi-empirical soils: `of_forces(forces, slip)` is theirs, NaN where they have none.
template <class OfForces>
io::Plot slip_plot(const Settings& s, const Campaign& c, std::span<const Reference> soils,
                   MeanAndDeviation SlipResult::*value, double scale, OfForces&& of_forces, const char* title,
                   const char* label) {
  io::Plot plot{.title = title, .x_label = "slip s = 1 - v/(ω r)", .y_label = label};
  io::Series points{.name = "grains", .style = io::SeriesStyle::LinePoints, .color = 0};
  io::Series low{.name = "± standard deviation", .style = io::SeriesStyle::Dotted, .color = 0}, high = low;
  high.name = "";
  for (const SlipResult& r : c.slips) {
    const MeanAndDeviation& m = r.*value;
    if (!std::isfinite(m.mean)) continue;
    for (io::Series* series : {&points, &low, &high}) series->x.push_back(r.slip);
    points.y.push_back(scale * m.mean);
    low.y.push_back(scale * (m.mean - m.deviation));
    high.y.push_back(scale * (m.mean + m.deviation));
  }
  for (auto* series : {&points, &low, &high}) plot.series.push_back(*series);
  int color = 1;
  for (const Reference& soil : soils) {
    io::Series line{.name = soil.name + ", Bekker and Wong", .style = io::SeriesStyle::Dashed, .color = color};
    io::Series columns{.name = soil.name + ", dynamic Bekker", .style = io::SeriesStyle::Points, .color = color++};
    const auto add = [&](io::Series& to, double slip, const std::optional<terramechanics::WheelForces>& f) {
      const double y = f ? scale * of_forces(*f, slip) : not_known;
      if (std::isfinite(y)) to.x.push_back(slip), to.y.push_back(y);
    };
    for (int k = -14; k <= 16; ++k) add(line, 0.05 * k, reference_at(soil.soil, 0.05 * k, s));
    for (std::size_t k = 0; k < soil.on_columns.size(); ++k) add(columns, c.slips[k].slip, soil.on_columns[k]);
    for (auto* series : {&line, &columns}) plot.series.push_back(std::move(*series));
  }
  double lowest = 0.0, highest = 0.0;  // with room around points, so that none lies on the frame
  for (const io::Series& series : plot.series) {
    for (const double y : series.y) lowest = std::fmin(lowest, y), highest = std::fmax(highest, y);
  }
  const double room = 0.05 * (highest - lowest);
  if (room > 0.0) plot.y_range = {lowest < 0.0 ? lowest - room : 0.0, highest + room};
  return plot;
}

/// Efficiency over slip, where a wheel drives and pulls.
inline io::Plot efficiency_plot(const Settings& s, const Campaign& c, std::span<const Reference> soils) {
  const auto of_forces = [&](const terramechanics::WheelForces& f, double slip) {
    return f.pull > 0.0 && f.torque > 0.0 ? f.pull * (1.0 - slip) * s.radius / f.torque : not_known;
  };
  return slip_plot(s, c, soils, &SlipResult::efficiency, 1.0, of_forces, "Efficiency", "pull v/(torque ω) [-]");
}

/// The title of a plot of one run.
inline std::string title_of_run(const char* title, const SlipResult& r) {
  return text("{}, slip 1 - v/(ω r) = {:g}", title, r.slip);
}
/// The title of a plot of all runs: where there is one run alone, with its slip.
inline std::string title_of_runs(const char* title, const Campaign& c) {
  return c.slips.size() == 1 ? title_of_run(title, c.slips.front()) : text("{}, slip s = 1 - v/(ω r)", title);
}
/// What tells a run from the others in a plot of all runs; empty where there is one alone.
inline std::string name_of_run(const SlipResult& r, const Campaign& c) {
  return c.slips.size() == 1 ? "" : text("s = {:g}", r.slip);
}

/// A value over the time of every run: what the steady windows were found in.
inline io::Plot time_plot(const Campaign& c, double Sample::*value, double scale, const char* title,
                          const char* label) {
  io::Plot plot{.title = title_of_runs(title, c), .x_label = "time [s]", .y_label = label};
  int color = 0;
  for (const SlipResult& r : c.slips) {
    io::Series line{.name = name_of_run(r, c), .color = color++};
    const double window = r.samples.empty() ? 0.0 : 0.02 * r.samples.back().time;
    const auto y = smoothed<Sample>(r.samples, &Sample::time, value, window);
    for (std::size_t i = 0; i < y.size(); ++i) {
      line.x.push_back(r.samples[i].time);
      line.y.push_back(scale * y[i]);
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

inline io::Plot rut_plot(const Campaign& c) {
  io::Plot plot{.title = title_of_runs("Surface behind the wheel", c),
                .x_label = "across [mm]",
                .y_label = "above the level [mm]"};
  int color = 0;
  for (const SlipResult& r : c.slips) {
    io::Series line{.name = name_of_run(r, c), .style = io::SeriesStyle::LinePoints, .color = color++};
    for (std::size_t k = 0; k < r.rut_y.size(); ++k) {
      line.x.push_back(1e3 * r.rut_y[k]);
      line.y.push_back(1e3 * (r.rut_z[k] - c.level));
    }
    if (!line.x.empty()) plot.series.push_back(std::move(line));
  }
  return plot;
}

inline io::Table print_table(const Campaign& c) {
  io::Table t{.caption = "Under the wheel, means over the second half of each run, slip s = 1 - v/(omega r)",
              .header = {"slip", "contact area [cm²]", "mean pressure on it [kPa]", "largest pressure [kPa]",
                         "at [deg]", "shear stress at that angle [kPa]"}};
  for (const SlipResult& r : c.slips) {
    const ContactPrint& p = r.print;
    if (p.empty()) continue;
    const std::size_t a = p.peak();
    t.row(number(r.slip), number(1e4 * p.area(), "{:.0f}"), number(1e-3 * p.mean_pressure()),
          number(1e-3 * p.pressure(a)), number(p.angle(a) * 180.0 / std::numbers::pi, "{:.1f}"),
          number(1e-3 * p.shear(a)));
  }
  return t;
}
inline constexpr const char* print_text =
    "Under the wheel: cells of 5 degrees along the rim and of some grain's edge across it. The contact area is that of "
    "the cells of most pressure that carry 95 % of the radial force. The largest pressure is a mean across the wheel's "
    "width. Angles count from the lowest point, forward.";

/// Pressure and shear stress along the rim of a run, beside the soils by Bekker and Wong at this slip.
inline io::Plot print_plot(const Settings& s, std::span<const Reference> soils, const SlipResult& r) {
  io::Plot plot{.title = title_of_run("Stress under the wheel", r),
                .x_label = "angle from the lowest point, forward [deg]",
                .y_label = "stress [kPa]"};
  const double degree = std::numbers::pi / 180.0;
  double back = 0.0, front = 0.0;  // deg, of the cells that bear at least a hundredth of the largest pressure
  for (std::size_t a = 0; a < ContactPrint::along; ++a) {
    if (r.print.pressure(a) < 0.01 * r.print.pressure(r.print.peak())) continue;
    back = std::min(back, r.print.angle(a) / degree), front = std::max(front, r.print.angle(a) / degree);
  }
  io::Series pressure{.name = "pressure of the grains", .style = io::SeriesStyle::LinePoints, .color = 0};
  io::Series shear{.name = "shear stress of the grains", .style = io::SeriesStyle::LinePoints, .color = 5};
  for (std::size_t a = 0; a < ContactPrint::along; ++a) {
    for (auto* series : {&pressure, &shear}) series->x.push_back(r.print.angle(a) / degree);
    pressure.y.push_back(1e-3 * r.print.pressure(a));
    shear.y.push_back(1e-3 * r.print.shear(a));
  }
  plot.series = {pressure, shear};
  int color = 1;  // the soils' colours over slip
  for (const auto& [name, soil, on_columns, no_columns] : soils) {
    const auto f = reference_at(soil, r.slip, s);
    if (!f) continue;
    using namespace terramechanics;
    const WheelContact contact(reference_wheel(s), soil, {r.slip, SlipDefinition::wheel_speed}, f->sinkage);
    back = std::min(back, f->exit / degree), front = std::max(front, f->entry / degree);
    io::Series p{.name = name + ", pressure", .style = io::SeriesStyle::Dashed, .color = color};
    io::Series t{.name = name + ", shear stress", .style = io::SeriesStyle::Dotted, .color = color++};
    for (int k = 0; k <= 60; ++k) {
      const double angle = f->exit + (f->entry - f->exit) * k / 60.0, sigma = contact.pressure(angle);
      p.x.push_back(angle / degree), p.y.push_back(1e-3 * sigma);
      t.x.push_back(angle / degree), t.y.push_back(1e-3 * contact.shear(angle, sigma));
    }
    plot.series.push_back(std::move(p));
    plot.series.push_back(std::move(t));
  }
  plot.x_range = {.min = back - 10.0, .max = front + 10.0};
  return plot;
}

/// A stress under the wheel of a run: seen from above, unrolled.
inline io::HeatMap print_map(const SlipResult& r, double (ContactPrint::*stress)(std::size_t, std::size_t) const,
                             const char* title, const char* label) {
  io::HeatMap map{.title = title_of_run(title, r),
                  .x_label = "angle from the lowest point, forward [deg]",
                  .y_label = "across [mm]",
                  .c_label = label};
  for (std::size_t a = 0; a < ContactPrint::along; ++a) {
    map.x.push_back(std::round(10.0 * r.print.angle(a) * 180.0 / std::numbers::pi) / 10.0);
  }
  for (std::size_t w = 0; w < r.print.across; ++w) {
    map.y.push_back(1e3 * r.print.place(w));
    for (std::size_t a = 0; a < ContactPrint::along; ++a) map.value.push_back(1e-3 * (r.print.*stress)(a, w));
  }
  return map;
}

inline std::string bed_text(const Settings& s, const Campaign& c) {
  const double fraction = c.solid_fraction;
  const bool is_small = std::isfinite(c.level) && !std::isfinite(fraction);
  const std::string density = is_small ? "too small to tell its density"
                                       : text("solid fraction {} (relative density {})", number(fraction, "{:.3f}"),
                                              number(s.grains.relative_density(fraction)));
  return text(
      "Bed: {} grains of half-edge {:g} mm, {} mm deep to its mean surface, from which sinkages and ruts are measured; "
      "{}. Time step {} s. The wheel, set down by the load servo, rests {} mm deep.{}",
      c.grains, 1e3 * s.grains.half_edge, number(1e3 * c.level, "{:.1f}"), density, number(c.time_step, "{:.3g}"),
      number(1e3 * c.set_down_sinkage),
      c.set_down_sinkage < 0.0 ? " Below zero it stands on the highest grains, or on its grousers." : "");
}

inline constexpr const char* window_text =
    "The steady window of a run begins where both pull and sinkage are steady by the marginal standard error rule "
    "MSER-5: as much of the start is left out as makes the standard error of the mean of the rest least, at most half "
    "of the run. A run is not called steady if the halves of that window differ by more than it swings: its mean is "
    "that of "
    "a wheel that still digs itself in or out.";

inline constexpr const char* reference_text =
    "Bekker and Wong's equations jump where the slip changes its sign. From a slip of -0.05 to 0 their shear stress is "
    "bridged by a straight line here.";

}  // namespace dem::rig::rigid_wheel
