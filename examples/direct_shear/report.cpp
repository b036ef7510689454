#include "report.hpp"

#include <dem/report/report.hpp>

#include <algorithm>
#include <exception>
#include <numbers>
#include <optional>

namespace direct_shear {

namespace {

using dem::io::Plot;
using dem::io::Series;
using dem::io::SeriesStyle;
using dem::terramechanics::MohrCoulomb;

constexpr double degrees = 180.0 / std::numbers::pi;

std::string number(double value, const char* format = "{:.2f}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

/// Pa, the normal stress that belongs to the maximum; before there is one, the nominal stress.
double stress_at_maximum(const LoadResult& r) {
  return std::isfinite(r.normal_at_maximum) ? r.normal_at_maximum : r.normal_stress;
}

dem::io::Table strength_table(const Settings& s, const Campaign& c) {
  dem::io::Table t{.caption = "Shear strength beside table 3.3 of the thesis",
                   .header = {"normal [kPa]", "max. shear [kPa]", "thesis [kPa]", "difference [%]", "at [mm]",
                              "residual [kPa]", "bulk density [kg/m³]", "rel. density", "dilation [mm]", "done"}};
  for (const LoadResult& r : c.loads) {
    const double normal = stress_at_maximum(r), reference = thesis_maximum(normal);
    t.row(number(1e-3 * normal, "{:.3f}"), number(1e-3 * r.maximum), number(1e-3 * reference),
          number(100.0 * (r.maximum / reference - 1.0), "{:+.1f}"), number(1e3 * r.at_maximum),
          number(1e-3 * r.residual), number(r.solid_fraction * s.density, "{:.0f}"),
          number(relative_density(s, r.solid_fraction)), number(1e3 * r.dilation, "{:+.2f}"), r.finished);
  }
  return t;
}

/// What to know of the comparison with table 3.3; empty if there is nothing to say.
std::string coarseness_text(const Settings& s, const Campaign& c) {
  constexpr double of_thesis = 0.9e-3;
  const bool any = std::any_of(c.loads.begin(), c.loads.end(), [](const LoadResult& r) { return r.finished; });
  if (!any || s.shape != "cube8" || s.half_edge <= 1.01 * of_thesis) return {};
  return fmt::format(
      "The grains are of half-edge {:g} mm. Those of table 3.3, of {:g} mm (--size full), are weaker in the same box, "
      "most of all at light loads.",
      1e3 * s.half_edge, 1e3 * of_thesis);
}

dem::io::Table check_table(const Campaign& c) {
  dem::io::Table t{.caption = "Checks",
                   .header = {"normal [kPa]", "on the plane of shear [kPa]", "drive against sensor [%]",
                              "on the lid [% of its weight]", "inertial number", "consolidation [s]", "height [mm]"}};
  for (const LoadResult& r : c.loads) {
    t.row(number(1e-3 * r.normal_stress, "{:.3f}"), number(1e-3 * r.plane_stress),
          number(100.0 * r.drive_mismatch, "{:.1f}"), number(100.0 * r.lid_share, "{:.1f}"),
          number(r.inertial_number, "{:.1e}"), number(r.consolidation_time, "{:.3f}"), number(1e3 * r.height));
  }
  return t;
}

dem::io::Table angle_table(const Fits& f) {
  dem::io::Table t{.caption = "Angle of friction and cohesion (Mohr-Coulomb)",
                   .header = {"from", "phi [deg]", "± [deg]", "c [kPa]", "± [kPa]", "R²"}};
  const auto add = [&](const char* name, const std::optional<MohrCoulomb>& m) {
    if (!m) return;
    t.row(name, number(degrees * m->friction_angle), number(degrees * m->friction_angle_error),
          number(1e-3 * m->cohesion), number(1e-3 * m->cohesion_error), number(m->r_squared, "{:.4f}"));
  };
  add("maximum shear", f.free);
  add("maximum shear, through the origin", f.origin);
  add("residual shear, through the origin", f.residual);
  t.row("thesis, simulated", number(thesis_angle_deg), "-", "0", "-", "-");
  t.row("experiment, low to high density", fmt::format("{:.1f} to {:.1f}", experiment_low_deg, experiment_high_deg),
        "-", "-", "-", "-");
  t.align.assign(t.header.size(), dem::io::Align::Right);
  t.align.front() = dem::io::Align::Left;
  return t;
}

std::string packing_text(const Settings& s, const Campaign& c) {
  const PackingResult& p = c.packing;
  if (!std::isfinite(p.height)) return "The packing was not finished.";
  const auto& limits = density_limits(s);
  std::string text = fmt::format(
      "Packing before loading: {} grains, bulk density {} kg/m³ (solid fraction {}), relative density {}{}, "
      "height {:.1f} mm",
      p.packing.grains.size(), number(s.density * p.solid_fraction, "{:.0f}"), number(p.solid_fraction, "{:.3f}"),
      number(relative_density(s, p.solid_fraction)),
      std::isfinite(p.asked_density) ? fmt::format(" ({:g} asked for)", p.asked_density) : "", 1e3 * p.height);
  if (std::isfinite(p.coordination)) text += fmt::format(", {:.2f} neighbours a grain", p.coordination);
  return text +
         fmt::format(
             ". Relative density counts from solid fraction {:.3f}, the loosest of this shape, to {:.3f}, the densest.",
             limits.loosest, limits.densest);
}

std::string frames_text(const Campaign& c) { return "Files for ParaView are missing: " + c.frames_problem; }

std::string status_text(const Campaign& c) {
  if (!c.problem.empty()) return "The run ended early: " + c.problem;
  if (c.interrupted) return "The run was interrupted; this is what was there by then.";
  if (!c.frames_problem.empty()) return frames_text(c);
  return {};
}

Plot curves(const Settings& s, const Campaign& c, double Sample::*values, double scale, const char* title,
            const char* label) {
  Plot plot{.title = title,
            .x_label = "shear displacement [mm]",
            .y_label = label,
            .x_range = {.min = 0.0, .max = 1e3 * s.travel}};
  int color = 0;
  for (const LoadResult& r : c.loads) {
    Series line{.name = fmt::format("{:.1f} kPa", 1e-3 * r.normal_stress), .color = color};
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

Plot stress_plot(const Settings& s, const Campaign& c) {
  Plot plot = curves(s, c, &Sample::stress, 1e-3, "Shear stress over displacement", "shear stress [kPa]");
  plot.y_range.min = 0.0;
  int color = 0;
  for (const LoadResult& r : c.loads) {
    const double y = 1e-3 * thesis_maximum(stress_at_maximum(r));
    if (std::isfinite(y) && !r.samples.empty()) {
      plot.series.push_back({.name = color == 0 ? "thesis, maximum" : "",
                             .x = {0.0, 1e3 * s.travel},
                             .y = {y, y},
                             .style = SeriesStyle::Dashed,
                             .color = color});
    }
    ++color;
  }
  return plot;
}

Plot mohr_coulomb_plot(const Campaign& c, const Fits& f) {
  Plot plot{.title = "Mohr-Coulomb line",
            .x_label = "normal stress [kPa]",
            .y_label = "maximum shear stress [kPa]",
            .x_range = {.min = 0.0},
            .y_range = {.min = 0.0}};
  double end = 80.0;
  Series points{.name = "this run", .style = SeriesStyle::Points, .color = 0};
  for (const LoadResult& r : c.loads) {
    if (!r.finished) continue;
    points.x.push_back(1e-3 * r.normal_at_maximum);
    points.y.push_back(1e-3 * r.maximum);
    end = std::fmax(end, 1.1e-3 * r.normal_at_maximum);
  }
  const auto line = [&](std::string name, double angle_deg, double c_kPa, SeriesStyle style, int color) {
    plot.series.push_back({.name = std::move(name),
                           .x = {0.0, end},
                           .y = {c_kPa, c_kPa + end * std::tan(angle_deg / degrees)},
                           .style = style,
                           .color = color});
  };
  const auto& best = f.free ? f.free : f.origin;
  if (best) {
    line(fmt::format("fit: {:.1f}°, c = {:.2f} kPa", degrees * best->friction_angle, 1e-3 * best->cohesion),
         degrees * best->friction_angle, 1e-3 * best->cohesion, SeriesStyle::Line, 0);
  }
  plot.series.push_back(std::move(points));
  Series table{.name = "thesis, table 3.3", .style = SeriesStyle::Points, .color = 1};
  for (const Reference& r : thesis) {
    table.x.push_back(1e-3 * r.normal_stress);
    table.y.push_back(1e-3 * r.maximum);
  }
  plot.series.push_back(std::move(table));
  line("experiment, loose", experiment_low_deg, 0.0, SeriesStyle::Dotted, 6);
  line("experiment, dense", experiment_high_deg, 0.0, SeriesStyle::Dashed, 6);
  return plot;
}

void write_results_csv(const Settings& s, const Campaign& c) {
  dem::io::CsvWriter csv(s.output / "results.csv",
                         {"load_kg", "normal_stress_Pa", "maximum_shear_Pa", "displacement_at_maximum_m",
                          "residual_shear_Pa", "solid_fraction", "bulk_density_kg_m3", "dilation_m",
                          "plane_normal_stress_Pa", "normal_stress_at_maximum_Pa", "inertial_number", "finished"});
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; };
  for (const LoadResult& r : c.loads) {
    csv.row(r.load, r.normal_stress, cell(r.maximum), cell(r.at_maximum), cell(r.residual), cell(r.solid_fraction),
            cell(s.density * r.solid_fraction), cell(r.dilation), cell(r.plane_stress), cell(r.normal_at_maximum),
            cell(r.inertial_number), r.finished);
  }
  csv.flush();  // so that a full disk is noticed
}

std::string speed_text(const Campaign& c) {
  const std::string wall = dem::io::format_duration(c.wall_time) + " of wall time.";
  if (!(c.time_step > 0.0)) return wall;
  return fmt::format("Time step {:.3g} s{}. {}", c.time_step,
                     c.time_step_limit.empty() ? "" : " (the stable one is limited by " + c.time_step_limit + ")",
                     wall);
}

void print_report(const Settings& s, const Campaign& c) {
  fmt::print("\n{}\n\n", packing_text(s, c));
  dem::io::print(strength_table(s, c));
  if (const auto text = coarseness_text(s, c); !text.empty()) fmt::print("{}\n", text);
  fmt::print("\n");
  dem::io::print(check_table(c));
  fmt::print("\n");
  dem::io::print(angle_table(fit(c)));
  fmt::print("\n{}\n", speed_text(c));
}

/// Whether there is anything to draw.
bool any_sheared(const Campaign& c) {
  return std::any_of(c.loads.begin(), c.loads.end(), [](const LoadResult& r) { return !r.samples.empty(); });
}

/// Writes report.html. Returns why plots could not be drawn, or nothing.
std::string write_page(const Settings& s, const Campaign& c, const std::string& config) {
  std::string not_drawn;
  const Fits fits = fit(c);
  dem::io::HtmlReport page("Direct shear test");
  if (const auto status = status_text(c); !status.empty()) page.paragraph(status);
  page.paragraph(packing_text(s, c)).table(strength_table(s, c));
  if (const auto text = coarseness_text(s, c); !text.empty()) page.paragraph(text);
  page.table(angle_table(fits));
  const auto add_plot = [&](const Plot& plot, const char* name, const char* caption) {
    const auto drawn = dem::io::render_plot(plot, s.output / name);
    if (drawn) {
      page.picture(drawn.svg, caption);
    } else {
      not_drawn = drawn.reason;
      page.paragraph(fmt::format("{}: not drawn ({})", caption, drawn.reason));
    }
  };
  if (any_sheared(c)) {
    page.heading("Plots");
    add_plot(stress_plot(s, c), "shear_stress", "Shear stress on the bottom box over the displacement of the top box.");
    add_plot(curves(s, c, &Sample::lid_rise, 1e3, "Dilation", "lid rise [mm]"), "dilation",
             "Rise of the lid while shearing.");
    add_plot(mohr_coulomb_plot(c, fits), "mohr_coulomb", "Maximum shear stress over normal stress.");
  }
  page.heading("Checks").table(check_table(c)).paragraph(speed_text(c));
  page.heading("Settings").settings(list_settings(s));
  page.heading("settings.toml", 3).paragraph("What repeats the run: direct_shear --config settings.toml");
  page.preformatted(config);
  page.save(s.output / "report.html");
  return not_drawn;
}

}  // namespace

bool report(const Settings& s, const Campaign& c, const std::string& config) {
  bool complete = true;
  // What was computed for hours is worth saving in whatever ways still work.
  const auto part = [&](const char* name, auto&& make) {
    try {
      make();
    } catch (const std::exception& error) {
      fmt::print(stderr, "direct_shear: {} could not be made: {}\n", name, error.what());
      complete = false;
    }
  };
  part("results.csv", [&] { write_results_csv(s, c); });
  part("the printed report", [&] { print_report(s, c); });
  std::string not_drawn;
  part("report.html", [&] { not_drawn = write_page(s, c, config); });
  if (!not_drawn.empty()) {
    fmt::print(stderr, "direct_shear: the plots were not drawn ({}); their data and gnuplot scripts are there\n",
               not_drawn);
  }
  if (!c.frames_problem.empty()) {
    fmt::print(stderr, "direct_shear: {}\n", frames_text(c));
    complete = false;
  }
  if (complete) {
    const bool sheared = any_sheared(c);
    fmt::print("Report, {}tables{}: {}\n", sheared && not_drawn.empty() ? "plots, " : "",
               sheared && s.vtk ? " and ParaView files" : "", s.output.string());
  }
  return complete;
}

}  // namespace direct_shear
