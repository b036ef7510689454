#pragma once

#include <dem/report/plot_data.hpp>
#include <dem/rig/direct_shear/tables.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace dem::rig::direct_shear {

inline io::Plot curves(const Settings& s, const Campaign& c, double Sample::*values, double scale, const char* title,
                       const char* label) {
  io::Plot plot{.title = title,
                .x_label = "shear displacement [mm]",
                .y_label = label,
                .x_range = {.min = 0.0, .max = 1e3 * s.travel}};
  int color = 0;
  for (const LoadResult& r : c.loads) {
    io::Series line{.name = text("{:.1f} kPa", 1e-3 * r.normal_stress), .color = color};
    const auto y = smoothed(r.samples, values, s.smoothing);
    for (std::size_t i = 0; i < y.size(); ++i) {
      line.x.push_back(1e3 * r.samples[i].displacement);
      line.y.push_back(scale * y[i]);
    }
    plot.series.push_back(std::move(line));
    ++color;
  }
  return plot;
}

inline io::Plot stress_plot(const Settings& s, const Campaign& c) {
  io::Plot plot = curves(s, c, &Sample::stress, 1e-3, "Shear stress over displacement", "shear stress [kPa]");
  plot.y_range.min = 0.0;
  int color = 0;
  for (const LoadResult& r : c.loads) {
    const double y = 1e-3 * thesis_maximum(stress_at_maximum(r));
    if (std::isfinite(y) && !r.samples.empty()) {
      plot.series.push_back({.name = color == 0 ? "thesis, maximum" : "",
                             .x = {0.0, 1e3 * s.travel},
                             .y = {y, y},
                             .style = io::SeriesStyle::Dashed,
                             .color = color});
    }
    ++color;
  }
  return plot;
}

inline io::Plot mohr_coulomb_plot(const Campaign& c, const Fits& f) {
  io::Plot plot{.title = "Mohr-Coulomb line",
                .x_label = "normal stress [kPa]",
                .y_label = "maximum shear stress [kPa]",
                .x_range = {.min = 0.0},
                .y_range = {.min = 0.0}};
  double end = 80.0;
  io::Series points{.name = "this run", .style = io::SeriesStyle::Points, .color = 0};
  for (const LoadResult& r : c.loads) {
    if (!r.finished) continue;
    points.x.push_back(1e-3 * r.normal_at_maximum);
    points.y.push_back(1e-3 * r.maximum);
    end = std::fmax(end, 1.1e-3 * r.normal_at_maximum);
  }
  const auto line = [&](std::string name, double angle_deg, double c_kPa, io::SeriesStyle style, int color) {
    plot.series.push_back({.name = std::move(name),
                           .x = {0.0, end},
                           .y = {c_kPa, c_kPa + end * std::tan(angle_deg / degrees)},
                           .style = style,
                           .color = color});
  };
  const auto& best = f.free ? f.free : f.origin;
  if (best) {
    line(text("fit: {:.1f}°, c = {:.2f} kPa", degrees * best->friction_angle, 1e-3 * best->cohesion),
         degrees * best->friction_angle, 1e-3 * best->cohesion, io::SeriesStyle::Line, 0);
  }
  plot.series.push_back(std::move(points));
  io::Series table{.name = "thesis, table 3.3", .style = io::SeriesStyle::Points, .color = 1};
  for (const Reference& r : thesis) {
    table.x.push_back(1e-3 * r.normal_stress);
    table.y.push_back(1e-3 * r.maximum);
  }
  plot.series.push_back(std::move(table));
  line("experiment, loose", experiment_low_deg, 0.0, io::SeriesStyle::Dotted, 6);
  line("experiment, dense", experiment_high_deg, 0.0, io::SeriesStyle::Dashed, 6);
  return plot;
}

}  // namespace dem::rig::direct_shear
