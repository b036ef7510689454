#pragma once

#include <dem/io/duration.hpp>
#include <dem/report/plot_data.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/bed/bed.hpp>
#include <dem/rig/plate_sinkage/results.hpp>
#include <dem/terramechanics/bevameter_fit.hpp>
#include <dem/terramechanics/soil.hpp>

#include <array>
#include <optional>

// What was found, as tables and plots.

namespace dem::rig::plate_sinkage {

/// P3 under a plate: it stands for the thesis's measured curves, of which only a picture is left.
inline terramechanics::PressureCurve reference(double width) {
  return under(terramechanics::mojave_martian_simulant.pressure, width);
}

inline io::Table pressure_table(const VariantResult& v) {
  const Settings& s = v.variant.settings;
  io::Table t{.caption = "Pressure beside P3 (Mojave Martian Simulant) at the same sinkage",
              .header = {"plate [mm]", "sinkage [mm]", "pressure [kPa]", "P3 [kPa]", "ratio"}};
  for (const PlateResult& r : v.plates) {
    for (const double share : {0.25, 0.5, 0.75, 0.99}) {
      const double z = share * s.sinkage, p = pressure_at(r.curve, z), p3 = reference(r.width).pressure(z);
      t.row(number(1e3 * r.width, "{:.0f}"), number(1e3 * z, "{:.2f}"), number(1e-3 * p), number(1e-3 * p3),
            number(p / p3));
    }
  }
  return t;
}

inline io::Table fit_table(const VariantResult& v) {
  io::Table t{.caption = "p = k z^n of each plate (weighted logarithms; standard errors of this fit, not of beds)",
              .header = {"plate [mm]", "k [kPa/m^n]", "± [kPa/m^n]", "n", "±", "R²", "unloading [MPa/m]",
                         "drive against sensor [%]", "done"}};
  for (const PlateResult& r : v.plates) {
    double driven = 0.0, felt = 0.0;
    for (const Sample& x : r.samples) driven += x.drive, felt += x.force;
    const Settings& s = v.variant.settings;
    const double weight =
        9.81 * s.plate_density * s.length * r.width * s.thickness * static_cast<double>(r.samples.size());
    const double mismatch = felt > 0.0 ? 100.0 * std::abs((driven + weight) / felt - 1.0) : not_known;
    const auto& f = r.fit;
    t.row(number(1e3 * r.width, "{:.0f}"), number(f ? 1e-3 * f->curve.modulus : not_known, "{:.4g}"),
          number(f ? 1e-3 * f->modulus_error : not_known, "{:.2g}"),
          number(f ? f->curve.exponent : not_known, "{:.3f}"), number(f ? f->exponent_error : not_known, "{:.3f}"),
          number(f ? f->r_squared : not_known, "{:.4f}"), number(1e-6 * r.unloading_stiffness), number(mismatch),
          r.finished);
  }
  return t;
}

/// Bekker's and Reece's constants over the plates of a bed, without cohesion; none where the plates do not tell them.
struct OverPlates {
  std::optional<terramechanics::BekkerFit> bekker = {};
  std::optional<terramechanics::ReeceFit> reece = {};
};

inline OverPlates fit_over_plates(const VariantResult& v) {
  OverPlates fits;
  const auto curves = fitted_curves(v);
  if (curves.size() < 2) return fits;
  const auto kind = terramechanics::PlateFit::weighted_logarithms;
  try {
    fits.bekker = terramechanics::fit_bekker(curves, kind);
  } catch (const Error&) {
  }
  try {
    fits.reece = terramechanics::fit_reece(curves, 0.0, v.unit_weight(), kind);
  } catch (const Error&) {
  }
  return fits;
}

/// Bekker's and Reece's constants over the plates; empty if there are not two plates.
inline io::Table constants_table(const VariantResult& v) {
  io::Table t{.caption = "Constants over all plates (weighted logarithms; standard errors of this fit, not of beds)",
              .header = {"form", "kc", "±", "kphi", "±", "n", "±", "R²"}};
  if (fitted_curves(v).size() < 2) return t;
  const auto g = [](double x) { return number(x, "{:.4g}"); };
  const OverPlates fits = fit_over_plates(v);
  if (const auto& b = fits.bekker) {
    t.row("Bekker [kPa/m^(n-1), kPa/m^n]", g(1e-3 * b->law.k_c), g(1e-3 * b->error.k_c), g(1e-3 * b->law.k_phi),
          g(1e-3 * b->error.k_phi), g(b->law.n), g(b->error.n), number(b->r_squared, "{:.4f}"));
  }
  if (const auto& r = fits.reece) {
    t.row("Reece, c = 0 [-]", "-", "-", g(r->law.k_phi), g(r->k_phi_error), g(r->law.n), g(r->n_error),
          number(r->r_squared, "{:.4f}"));
  }
  const auto& p3 = std::get<terramechanics::Bekker>(terramechanics::mojave_martian_simulant.pressure);
  t.row("P3, Bekker", g(1e-3 * p3.k_c), "-", g(1e-3 * p3.k_phi), "-", g(p3.n), "-", "-");
  return t;
}

/// The mean pressure (Pa) over the second half of the sinkage: less noisy than a pressure at one sinkage.
inline double mean_pressure(const PlateResult& r, const Settings& s) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < r.curve.sinkage.size(); ++i) {
    const double z = r.curve.sinkage[i];
    if (z >= 0.5 * s.sinkage && z <= s.sinkage) sum += r.curve.pressure[i], count += 1.0;
  }
  return r.finished && count > 0.0 ? sum / count : not_known;
}

/// The run and those of its study, below each other.
inline io::Table runs_table(const Campaign& c) {
  io::Table t{.caption = "Mean pressure over the second half of the sinkage",
              .header = {"run", "grains", "solid fraction", "rel. density", "plate [mm]", "pressure [kPa]"}};
  for (const VariantResult& v : c.variants) {
    const double density = v.variant.settings.grains.relative_density(v.solid_fraction);
    for (const PlateResult& r : v.plates) {
      t.row(v.variant.text, v.grains, number(v.solid_fraction, "{:.3f}"), number(density),
            number(1e3 * r.width, "{:.0f}"), number(1e-3 * mean_pressure(r, v.variant.settings)));
    }
  }
  return t;
}

inline std::string bed_text(const VariantResult& v) {
  return text(
      "Bed: {} grains of half-edge {:g} mm, {} mm deep, solid fraction {}, bulk density {} kg/m³. Time step {} s.",
      v.grains, 1e3 * v.variant.settings.grains.half_edge, number(1e3 * v.level, "{:.1f}"),
      number(v.solid_fraction, "{:.3f}"), number(v.variant.settings.grains.density * v.solid_fraction, "{:.0f}"),
      number(v.time_step, "{:.3g}"));
}

/// What is said openly of the scale, and of which plate carries more.
inline std::string finding_text(const VariantResult& v) {
  const Settings& s = v.variant.settings;
  std::string words = text("The narrowest plate is {:.1f} grain edges wide; its inertial number is {:.1e} at 10 kPa.",
                           s.widths.front() / s.grains.edge(),
                           s.speed / s.widths.front() * s.grains.edge() * std::sqrt(s.grains.density / 1e4));
  if (v.plates.size() < 2) return words;
  const double narrow = mean_pressure(v.plates.front(), s), wide = mean_pressure(v.plates.back(), s);
  if (!std::isfinite(narrow) || !std::isfinite(wide)) return words;
  return words +
         text(
             " The widest plate carries {:.2f} times the pressure of the narrowest one. The thesis expects more under "
             "the wider plate, but reports that its measured curve of the widest one lay lower and is probably not "
             "accurate; P3 has less under it.",
             wide / narrow);
}

/// What the constants' standard errors are, and what Bekker's form cannot take; empty where there are no constants.
inline std::string constants_text(const VariantResult& v) {
  const OverPlates fits = fit_over_plates(v);
  if (!fits.bekker && !fits.reece) return {};
  std::string words =
      "Neighbouring points of a curve err alike, so the standard errors of the constants are too small; beds of other "
      "seeds differ by more.";
  if (!fits.bekker || fits.bekker->law.k_c >= 0.0) return words;
  const auto plain =
      terramechanics::fit_bekker_not_negative(fitted_curves(v), terramechanics::PlateFit::weighted_logarithms);
  return words + text(
                     " Bekker's kc came out negative, as wider plates carry more; programs that take a soil refuse it. "
                     "Without kc, kphi is {:.4g} kPa/m^n and n {:.3f}.",
                     1e-3 * plain.law.k_phi, plain.law.n);
}

inline io::Plot pressure_plot(const VariantResult& v) {
  const Settings& s = v.variant.settings;
  io::Plot plot{.title = "Pressure over sinkage",
                .x_label = "sinkage [mm]",
                .y_label = "pressure [kPa]",
                .x_range = {.min = 0.0, .max = 1e3 * s.sinkage},
                .y_range = {.min = 0.0}};
  int color = 0;
  for (const PlateResult& r : v.plates) {
    const auto add = [&](std::string name, io::SeriesStyle style, auto&& pressure) {
      io::Series line{.name = std::move(name), .style = style, .color = color};
      for (int k = 1; k <= 100; ++k) {
        const double z = 0.01 * k * s.sinkage;
        line.x.push_back(1e3 * z);
        line.y.push_back(1e-3 * pressure(z));
      }
      plot.series.push_back(std::move(line));
    };
    const std::string width = text("{:.0f} mm", 1e3 * r.width);
    add(width, io::SeriesStyle::Line, [&](double z) { return pressure_at(r.curve, z); });
    add("P3, " + width, io::SeriesStyle::Dashed, [&](double z) { return reference(r.width).pressure(z); });
    ++color;
  }
  return plot;
}

/// Pressure over sinkage of all plates in both logarithms, with the fits where points were fitted.
inline io::Plot fit_plot(const VariantResult& v) {
  const Settings& s = v.variant.settings;
  io::Plot plot{
      .title = "Fits p = k z^n", .x_label = "sinkage [mm]", .y_label = "pressure [kPa]", .log_x = true, .log_y = true};
  int color = 0;
  for (const PlateResult& r : v.plates) {
    io::Series points{.name = text("{:.0f} mm", 1e3 * r.width), .style = io::SeriesStyle::Line, .color = color};
    io::Series line{.style = io::SeriesStyle::Dotted, .color = color++};
    for (std::size_t i = 0; i < r.curve.sinkage.size(); ++i) {
      const double z = r.curve.sinkage[i];
      if (!(z > 0.02 * s.sinkage && r.curve.pressure[i] > 0.0)) continue;
      points.x.push_back(1e3 * z);
      points.y.push_back(1e-3 * r.curve.pressure[i]);
      if (!r.fit || z < s.fit_from * s.sinkage || z > s.sinkage) continue;
      line.x.push_back(1e3 * z);
      line.y.push_back(1e-3 * r.fit->curve.pressure(z));
    }
    plot.series.push_back(std::move(points));
    plot.series.push_back(std::move(line));
  }
  return plot;
}

}  // namespace dem::rig::plate_sinkage
