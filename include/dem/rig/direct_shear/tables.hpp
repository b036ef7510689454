#pragma once

#include <dem/io/duration.hpp>
#include <dem/report/table.hpp>
#include <dem/rig/direct_shear/evaluate.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

// What was found, as tables and in words.

namespace dem::rig::direct_shear {

inline constexpr double degrees = 180.0 / std::numbers::pi;

/// Pa, the normal stress that belongs to the maximum; before there is one, the nominal stress.
inline double stress_at_maximum(const LoadResult& r) {
  return std::isfinite(r.normal_at_maximum) ? r.normal_at_maximum : r.normal_stress;
}

inline io::Table strength_table(const Settings& s, const Campaign& c) {
  io::Table t{.caption = "Shear strength beside table 3.3 of the thesis",
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
inline std::string coarseness_text(const Settings& s, const Campaign& c) {
  constexpr double of_thesis = 0.9e-3;
  const bool any = std::any_of(c.loads.begin(), c.loads.end(), [](const LoadResult& r) { return r.finished; });
  if (!any || kind_of(s).name != "cube8" || s.half_edge <= 1.01 * of_thesis) return {};
  return text(
      "The grains are of half-edge {:g} mm, those of table 3.3 of {:g} mm (--size full). Coarse grains in a small box "
      "read otherwise: --size quick, as it is set, up to 15 % less than --size full at each load, and more when it is "
      "sheared further.",
      1e3 * s.half_edge, 1e3 * of_thesis);
}

inline io::Table check_table(const Campaign& c) {
  io::Table t{.caption = "Checks",
              .header = {"normal [kPa]", "on the plane of shear [kPa]", "drive against sensor [%]",
                         "on the lid [% of its weight]", "inertial number", "consolidation [s]", "height [mm]"}};
  for (const LoadResult& r : c.loads) {
    t.row(number(1e-3 * r.normal_stress, "{:.3f}"), number(1e-3 * r.plane_stress),
          number(100.0 * r.drive_mismatch, "{:.1f}"), number(100.0 * r.lid_share, "{:.1f}"),
          number(r.inertial_number, "{:.1e}"), number(r.consolidation_time, "{:.3f}"), number(1e3 * r.height));
  }
  return t;
}

inline io::Table angle_table(const Fits& f) {
  io::Table t{.caption = "Angle of friction and cohesion (Mohr-Coulomb)",
              .header = {"from", "phi [deg]", "± [deg]", "c [kPa]", "± [kPa]", "R²"}};
  const auto add = [&](const char* name, const std::optional<terramechanics::MohrCoulomb>& m) {
    if (!m) return;
    t.row(name, number(degrees * m->friction_angle), number(degrees * m->friction_angle_error),
          number(1e-3 * m->cohesion), number(1e-3 * m->cohesion_error), number(m->r_squared, "{:.4f}"));
  };
  add("maximum shear", f.free);
  add("maximum shear, through the origin", f.origin);
  add("residual shear, through the origin", f.residual);
  t.row("thesis, simulated", number(thesis_angle_deg), "-", "0", "-", "-");
  t.row("experiment, low to high density", text("{:.1f} to {:.1f}", experiment_low_deg, experiment_high_deg), "-", "-",
        "-", "-");
  t.align.assign(t.header.size(), io::Align::Right);
  t.align.front() = io::Align::Left;
  return t;
}

inline std::string packing_text(const Settings& s, const Campaign& c) {
  const PackingResult& p = c.packing;
  if (!std::isfinite(p.height)) return "The packing was not finished.";
  const auto& limits = density_limits(s);
  std::string words = text(
      "Packing before loading: {} grains, bulk density {} kg/m³ (solid fraction {}), relative density {}{}, "
      "height {:.1f} mm",
      p.packing.grains.size(), number(s.density * p.solid_fraction, "{:.0f}"), number(p.solid_fraction, "{:.3f}"),
      number(relative_density(s, p.solid_fraction)),
      std::isfinite(p.asked_density) ? text(" ({:g} asked for)", p.asked_density) : "", 1e3 * p.height);
  if (std::isfinite(p.coordination)) words += text(", {:.2f} neighbours a grain", p.coordination);
  return words +
         text(
             ". Relative density counts from solid fraction {:.3f}, the loosest of this shape, to {:.3f}, the densest.",
             limits.loosest, limits.densest);
}

/// Time step and wall time (s) of the run.
inline std::string speed_text(const Campaign& c, double wall_time) {
  const std::string wall = io::format_duration(wall_time) + " of wall time.";
  if (c.loads.empty() || !(c.loads.back().time_step > 0.0)) return wall;
  const LoadResult& last = c.loads.back();
  return text("Time step {:.3g} s{}. {}", last.time_step,
              last.time_step_limit.empty() ? "" : " (the stable one is limited by " + last.time_step_limit + ")", wall);
}

/// Whether there is anything to draw.
inline bool any_sheared(const Campaign& c) {
  return std::any_of(c.loads.begin(), c.loads.end(), [](const LoadResult& r) { return !r.samples.empty(); });
}

}  // namespace dem::rig::direct_shear
