#pragma once
// What a bevameter found of the soil, as tables and plots.

#include <dem/io/csv.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bevameter/constants.hpp>
#include <dem/rig/direct_shear/plots.hpp>
#include <dem/rig/plate_sinkage/tables.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dem::rig::bevameter {

using terramechanics::degrees;

/// A constant under its name, in the unit that it is shown in.
struct NamedConstant {
  const char* name;
  const char* unit;
  Estimate estimate;
  double scale;
  /// One that was left out is 0, without an error: nothing measured that.
  [[nodiscard]] bool is_left_out() const { return estimate.error == 0.0 && estimate.value == 0.0; }
  [[nodiscard]] bool is_known() const { return std::isfinite(estimate.value); }
};
inline std::vector<NamedConstant> list(const Constants& c) {
  return {{"Bekker k_c", "kPa/m^(n-1)", c.bekker[0], 1e-3},
          {"Bekker k_phi", "kPa/m^n", c.bekker[1], 1e-3},
          {"Bekker n", "", c.bekker[2], 1.0},
          {"Reece k_c'", "", c.reece[0], 1.0},
          {"Reece k_phi'", "", c.reece[1], 1.0},
          {"Reece n", "", c.reece[2], 1.0},
          {"cohesion c", "kPa", c.cohesion, 1e-3},
          {"friction angle phi", "deg", c.friction_angle, degrees(1.0)},
          {"cohesion of the free line", "kPa", c.free_cohesion, 1e-3},
          {"phi of the free line", "deg", c.free_friction_angle, degrees(1.0)},
          {"shear displacement K", "mm", c.displacement, 1e3},
          {"unloading stiffness", "MPa/m", c.unloading, 1e-6}};
}

inline io::Table constants_table(const Constants& c, double confidence) {
  io::Table t{.caption = text("Constants of the soil, with intervals of {:g} % confidence", 100.0 * confidence),
              .header = {"constant", "value", "± interval", "standard error", "deg. of freedom", "unit"}};
  for (const NamedConstant& n : list(c)) {
    const bool is_left_out = n.is_left_out();
    const auto cell = [&](double value) { return is_left_out ? "left out" : number(n.scale * value, "{:.4g}"); };
    t.row(n.name, number(n.scale * n.estimate.value, "{:.4g}"), cell(n.estimate.half_width(confidence)),
          cell(n.estimate.error), is_left_out ? "-" : text("{}", n.estimate.freedom), n.unit);
  }
  return t;
}

/// The same as a file. What was left out has the value that the soil has, 0, and no error.
inline void write_constants(const std::filesystem::path& path, const Constants& c, double confidence) {
  io::CsvWriter csv(path,
                    {"constant", "value", "standard_error", "half_interval", "degrees_of_freedom", "unit", "state"});
  for (const NamedConstant& n : list(c)) {
    const Estimate e = n.is_left_out() ? Estimate{.value = 0.0} : n.estimate;
    csv.row(n.name, cell(n.scale * e.value), cell(n.scale * e.error), cell(n.scale * e.half_width(confidence)),
            e.freedom, n.unit,
            n.is_left_out() ? "left out"
            : n.is_known()  ? "measured"
                            : "not known");
  }
  csv.flush();
}

/// What Bekker's soil has as 0 because it was left out, as comments above the call that gives it to Project Chrono.
inline std::string left_out_comments(const Constants& c) {
  std::string lines;
  const auto add = [&](bool is_left_out, const char* name, const char* why) {
    if (is_left_out) lines += text("// {} is 0 because it was left out, as {}: it was not measured.\n", name, why);
  };
  add(c.bekker[0].value == 0.0, "Bekker_Kc", "it came out negative");
  add(c.bekker[1].value == 0.0, "Bekker_Kphi", "it came out negative");
  add(!c.has_cohesion, "Mohr_cohesion", "it could not be told from none");
  return lines;
}

/// What the table of the constants says of a soil's numbers, as comments above them in its file: their intervals, and
/// what was left out. Those whose names begin with `other` are of another form.
inline std::string interval_comments(const Constants& c, double confidence, std::string_view other) {
  std::string lines;
  for (const NamedConstant& n : list(c)) {
    const std::string_view name(n.name);
    if (name.starts_with(other) || name.ends_with("of the free line")) continue;
    if (!n.is_known()) {
      lines += text("# {} was not measured\n", name);
      continue;
    }
    lines += n.is_left_out()
                 ? text("# {} is 0 because it was left out\n", name)
                 : text("# {}: {:.4g} +- {} {} ({:g} %, this bed alone)\n", name, n.scale * n.estimate.value,
                        number(n.scale * n.estimate.half_width(confidence), "{:.2g}"), n.unit, 100.0 * confidence);
  }
  return lines;
}

/// That strengths were read where the shear stress may still have risen; empty where it had not.
inline std::string rising_text(const Constants& c) {
  if (c.rising.empty()) return "";
  std::string stresses;
  for (const double sigma : c.rising) stresses += (stresses.empty() ? "" : ", ") + number(1e-3 * sigma, "{:g}");
  return text(
      " Loaded with {} kPa the shear stress is largest in the last 5 % of the shear travel, and may still rise: the "
      "strength, "
      "phi and K depend on --shear-travel; make it longer.",
      stresses);
}

/// Which line the strengths have, and why.
inline std::string cohesion_text(const Constants& c, double confidence) {
  const Estimate& free = c.free_cohesion;
  if (c.loaded_with.size() < 2) {
    return "There is one strength alone: its line goes through the origin, and cohesion was not looked for. Give three "
           "--normal-stresses.";
  }
  if (free.freedom == 0) {
    return text(
        "The strengths are two. A line through two points is exact, and no error can be told: its cohesion, {} kPa, "
        "was "
        "not tested against none, and the line that is used goes through the origin. Give three --normal-stresses to "
        "test it.",
        number(1e-3 * free.value));
  }
  return text(
      "The line of the strengths over the stress on the plane of shear has the cohesion {} ± {} kPa ({:g} %){}.",
      number(1e-3 * free.value), number(1e-3 * free.half_width(confidence)), 100.0 * confidence,
      c.has_cohesion ? "" : ", which is no more than none: it goes through the origin");
}

/// Where a density comes from that was not measured; empty where it was.
inline std::string density_text(const Constants& c) {
  if (c.is_density_measured) return "";
  return text(", {}: the bed of the plates is too small to measure it",
              c.relative_density > 0.0 ? "as asked for" : "taken as the loosest");
}

/// Which modulus of Reece's a soil with cohesion has lost; empty where none.
inline std::string reece_text(const Constants& c) {
  if (!c.has_cohesion) return "";
  return c.reece[0].value == 0.0   ? " Reece's k_c' came out negative: it is left out."
         : c.reece[1].value == 0.0 ? " Reece's k_phi' came out negative: it is left out."
                                   : "";
}

/// Which shear curves have no K; empty where all have one.
inline std::string no_bend_text(const Constants& c) {
  std::string loads;
  for (std::size_t k = 0; k < c.shear_curves.size(); ++k) {
    if (std::isfinite(c.shear_curves[k].displacement)) continue;
    loads += (loads.empty() ? "" : ", ") + number(1e-3 * c.loaded_with[k], "{:g}");
  }
  return loads.empty() ? "" : text(" Loaded with {} kPa the curve has no bend to tell K by.", loads);
}

inline std::string constants_text(const Constants& c, double confidence) {
  return text(
      "Unit weight {:.2f} kN/m³, relative density {:.2f}{}. R² of Bekker's pressure {:.3f}, of Reece's {:.3f}. Errors "
      "of the moduli are those of the jackknife over pieces of the curves, as neighbouring points err alike; of phi, "
      "those of the line through the strengths; of K and of the unloading, the scatter between the curves. All are of "
      "this bed: run other --seed for how beds differ. {}{}{}{}{}",
      1e-3 * c.unit_weight, c.relative_density, density_text(c), c.bekker_r_squared, c.reece_r_squared,
      cohesion_text(c, confidence),
      c.bekker[0].value == 0.0   ? " Bekker's k_c came out negative, as the wider plates carried more: it is left out."
      : c.bekker[1].value == 0.0 ? " Bekker's k_phi came out negative: it is left out."
                                 : "",
      rising_text(c), reece_text(c), no_bend_text(c));
}

/// Janosi's fit of each load.
inline io::Table shear_table(const Constants& c) {
  io::Table t{
      .caption = "tau = tau_max (1 - exp(-j/K)) of each normal stress (on the plane of shear), up to the strength",
      .header = {"loaded with [kPa]", "on the plane [kPa]", "tau_max [kPa]", "K [mm]", "R²"}};
  for (std::size_t k = 0; k < c.shear_curves.size(); ++k) {
    const auto& f = c.shear_curves[k];
    t.row(number(1e-3 * c.loaded_with[k]), number(1e-3 * f.normal_stress), number(1e-3 * f.strength),
          number(1e3 * f.displacement, "{:.3f}"), number(f.r_squared, "{:.4f}"));
  }
  return t;
}

/// Curves of the plates beside Bekker's and Reece's.
inline io::Plot plates_plot(const plate_sinkage::VariantResult& v, const std::optional<Constants>& c) {
  const double deepest = v.variant.settings.sinkage;
  io::Plot plot{.title = "Pressure over sinkage",
                .x_label = "sinkage [mm]",
                .y_label = "pressure [kPa]",
                .x_range = {.min = 0.0, .max = 1e3 * deepest},
                .y_range = {.min = 0.0}};
  int color = 0;
  for (const auto& r : v.plates) {
    const auto add = [&](std::string name, io::SeriesStyle style, auto&& pressure) {
      io::Series line{.name = std::move(name), .style = style, .color = color};
      for (int k = 1; k <= 100; ++k) {
        const double z = 0.01 * k * deepest;
        line.x.push_back(1e3 * z);
        line.y.push_back(1e-3 * pressure(z));
      }
      plot.series.push_back(std::move(line));
    };
    const std::string width = text("{:.0f} mm", 1e3 * r.width);
    add(width, io::SeriesStyle::Line, [&](double z) { return plate_sinkage::pressure_at(r.curve, z); });
    if (c) {
      const auto bekker = under(c->bekker_soil.pressure, r.width), reece = under(c->reece_soil.pressure, r.width);
      add(color == 0 ? "Bekker" : "", io::SeriesStyle::Dashed, [&](double z) { return bekker.pressure(z); });
      add(color == 0 ? "Reece" : "", io::SeriesStyle::Dotted, [&](double z) { return reece.pressure(z); });
    }
    ++color;
  }
  return plot;
}

/// Shear curves beside Janosi's and Hanamoto's, with the constants of the soil.
inline io::Plot shear_plot(const direct_shear::Campaign& d, const direct_shear::Settings& s,
                           const std::optional<Constants>& c) {
  io::Plot plot{.title = "Shear stress over displacement",
                .x_label = "shear displacement [mm]",
                .y_label = "shear stress [kPa]",
                .x_range = {.min = 0.0, .max = 1e3 * s.travel},
                .y_range = {.min = 0.0}};
  int color = 0;
  for (const auto& r : d.loads) {
    io::Series line{.name = text("{:.1f} kPa", 1e-3 * r.normal_stress), .color = color};
    io::Series law{.name = color == 0 ? "Janosi and Hanamoto" : "", .style = io::SeriesStyle::Dashed, .color = color++};
    const auto stress = direct_shear::smoothed(r.samples, &direct_shear::Sample::stress, s.smoothing);
    for (std::size_t i = 0; i < stress.size(); ++i) {
      const double j = r.samples[i].displacement;
      line.x.push_back(1e3 * j);
      line.y.push_back(1e-3 * stress[i]);
      if (!c || j < 0.0) continue;
      law.x.push_back(1e3 * j);
      law.y.push_back(1e-3 * c->bekker_soil.shear.stress(r.plane_stress, j));
    }
    plot.series.push_back(std::move(line));
    if (c) plot.series.push_back(std::move(law));
  }
  return plot;
}

/// Strengths over the stress on the plane of shear, and the line that the soil has through them.
inline io::Plot strength_plot(const direct_shear::Campaign& d, const std::optional<Constants>& c) {
  io::Plot plot{.title = "Mohr-Coulomb line",
                .x_label = "normal stress on the plane of shear [kPa]",
                .y_label = "maximum shear stress [kPa]",
                .x_range = {.min = 0.0},
                .y_range = {.min = 0.0}};
  io::Series points{.name = "this run", .style = io::SeriesStyle::Points, .color = 0};
  double end = 0.0;
  for (const auto& r : d.loads) {
    if (!r.finished) continue;
    points.x.push_back(1e-3 * r.plane_stress);
    points.y.push_back(1e-3 * r.maximum);
    end = std::fmax(end, 1.1e-3 * r.plane_stress);
  }
  if (c) {
    const auto& soil = c->bekker_soil.shear;
    plot.series.push_back({.name = text("the soil: {:.1f}°, c = {:.2f} kPa{}", degrees(soil.friction_angle),
                                        1e-3 * soil.cohesion, c->has_cohesion ? "" : ", through the origin"),
                           .x = {0.0, end},
                           .y = {1e-3 * soil.strength(0.0), 1e-3 * soil.strength(1e3 * end)},
                           .color = 0});
  }
  plot.series.push_back(std::move(points));
  return plot;
}

}  // namespace dem::rig::bevameter
