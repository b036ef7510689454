#pragma once

#include <dem/io/duration.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/bed.hpp>
#include <dem/rig/rigid_wheel/results.hpp>
#include <dem/terramechanics/soil_reader.hpp>
#include <dem/terramechanics/wheel_load.hpp>

#include <utility>

// What was found, as tables and plots, beside the semi-empirical soils.

namespace dem::rig::rigid_wheel {

inline std::string number(double value, const char* format = "{:.2f}") {
  return std::isfinite(value) ? dem::text_of(format, {value}) : "-";
}

/// A soil that curves are drawn of by Bekker and Wong.
using Reference = std::pair<std::string, terramechanics::Soil>;
inline std::vector<Reference> references(const Settings& s) {
  std::vector<Reference> list{{"P1", terramechanics::melanz_sand}, {"P3", terramechanics::mojave_martian_simulant}};
  if (!s.soil.empty()) list.emplace_back(s.soil.substr(s.soil.rfind('/') + 1), terramechanics::load_soil(s.soil).soil);
  return list;
}

/// The wheel on a soil by eqs. 2-11; none where the soil does not carry it.
inline std::optional<terramechanics::WheelForces> reference_at(const terramechanics::Soil& soil, double slip,
                                                               const Settings& s) {
  const bool grousers = s.wheel == "grousers";
  const terramechanics::Wheel wheel{
      .radius = s.radius, .width = s.width, .grouser_height = grousers ? s.grouser_height : 0.0};
  try {
    return wheel_under_load(wheel, soil, {slip, terramechanics::SlipDefinition::wheel_speed}, s.load);
  } catch (const Error&) {
    return {};
  }
}

inline io::Table slip_table(const Settings& s, const Campaign& c) {
  io::Table t{.caption = "Means over the steady window, slip s = 1 - v/(omega r) (± standard deviation in time)",
              .header = {"slip", "pull [N]", "±", "torque [N m]", "±", "sinkage [mm]", "±", "efficiency", "carried [N]",
                         "steady from [s]", "steady", "done"}};
  for (const SlipResult& r : c.slips) {
    t.row(number(r.slip), number(r.pull.mean), number(r.pull.deviation), number(r.torque.mean),
          number(r.torque.deviation), number(1e3 * r.sinkage.mean), number(1e3 * r.sinkage.deviation),
          number(r.efficiency), number(r.carried.mean, "{:.1f}"), number(r.window_from), r.is_steady, r.finished);
  }
  (void)s;
  return t;
}

inline io::Table reference_table(const Settings& s, const Campaign& c) {
  io::Table t{.caption = "Beside Bekker and Wong (eqs. 2-11) with published soils, slip s = 1 - v/(omega r)",
              .header = {"slip", "soil", "pull [N]", "torque [N m]", "sinkage [mm]"}};
  for (const SlipResult& r : c.slips) {
    t.row(number(r.slip), "grains", number(r.pull.mean), number(r.torque.mean), number(1e3 * r.sinkage.mean));
    for (const auto& [name, soil] : references(s)) {
      const auto f = reference_at(soil, r.slip, s);
      if (f) t.row("", name, number(f->pull), number(f->torque), number(1e3 * f->sinkage));
    }
  }
  return t;
}

inline io::Table rut_table(const Campaign& c) {
  io::Table t{.caption = "Ruts and checks",
              .header = {"slip", "rut depth [mm]", "rut width [mm]", "drive against grains [N]",
                         "motor against grains [N m]", "slip as it was"}};
  for (const SlipResult& r : c.slips) {
    double force = 0.0, torque = 0.0, slip = 0.0, count = 0.0;
    for (const Sample& x : r.samples) {
      if (!(x.time >= r.window_from)) continue;
      force += x.drive_force - x.pull, torque += x.motor_torque - x.torque, slip += x.slip, count += 1.0;
    }
    t.row(number(r.slip), number(1e3 * r.rut_depth), number(1e3 * r.rut_width, "{:.0f}"), number(force / count),
          number(torque / count, "{:.3f}"), number(slip / count, "{:.3f}"));
  }
  return t;
}

/// A mean over slip, beside the semi-empirical soils.
template <class OfForces>
io::Plot slip_plot(const Settings& s, const Campaign& c, MeanAndDeviation SlipResult::*value, double scale,
                   OfForces&& of_forces, const char* title, const char* label) {
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
  for (const auto& [name, soil] : references(s)) {
    io::Series line{.name = name + ", Bekker and Wong", .style = io::SeriesStyle::Dashed, .color = color++};
    for (int k = -14; k <= 16; ++k) {
      const double slip = 0.05 * k;
      const auto f = reference_at(soil, slip, s);
      if (!f) continue;
      line.x.push_back(slip);
      line.y.push_back(scale * of_forces(*f));
    }
    plot.series.push_back(std::move(line));
  }
  return plot;
}

/// A value over the time of every run: what the steady windows were found in.
inline io::Plot time_plot(const Campaign& c, double Sample::*value, double scale, const char* title,
                          const char* label) {
  io::Plot plot{.title = title, .x_label = "time [s]", .y_label = label};
  int color = 0;
  for (const SlipResult& r : c.slips) {
    io::Series line{.name = text("s = {:g}", r.slip), .color = color++};
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
  io::Plot plot{.title = "Surface behind the wheel", .x_label = "across [mm]", .y_label = "above the level [mm]"};
  int color = 0;
  for (const SlipResult& r : c.slips) {
    io::Series line{.name = text("s = {:g}", r.slip), .style = io::SeriesStyle::LinePoints, .color = color++};
    for (std::size_t k = 0; k < r.rut_y.size(); ++k) {
      line.x.push_back(1e3 * r.rut_y[k]);
      line.y.push_back(1e3 * (r.rut_z[k] - c.level));
    }
    if (!line.x.empty()) plot.series.push_back(std::move(line));
  }
  return plot;
}

inline std::string bed_text(const Settings& s, const Campaign& c) {
  const double fraction = c.solid_fraction;
  const double density = std::isfinite(fraction) ? soil::relative_density(fraction, soil::cube8_limits) : not_known;
  return text(
      "Bed: {} grains of half-edge {:g} mm, {} mm deep, solid fraction {} (relative density {}). Time step {:.3g} s. "
      "The "
      "wheel, set down by the load servo, rests {} mm deep.",
      c.grains, 1e3 * s.grains.half_edge, number(1e3 * c.level, "{:.1f}"), number(fraction, "{:.3f}"), number(density),
      c.time_step, number(1e3 * c.set_down_sinkage));
}

inline constexpr const char* window_text =
    "The steady window of a run begins where both pull and sinkage are steady by the marginal standard error rule "
    "MSER-5: as "
    "much of the start is left out as makes the standard error of the mean of the rest least, at most half of the run.";

}  // namespace dem::rig::rigid_wheel
