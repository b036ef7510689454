#pragma once

#include <dem/io/csv.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/rig/direct_shear/list_settings.hpp>
#include <dem/rig/direct_shear/plots.hpp>
#include <dem/rig/report.hpp>

namespace dem::rig::direct_shear {

namespace detail {

inline void write_results_csv(const std::filesystem::path& path, const Settings& s, const Campaign& c) {
  io::CsvWriter csv(path, {"load_kg", "normal_stress_Pa", "maximum_shear_Pa", "displacement_at_maximum_m",
                           "residual_shear_Pa", "solid_fraction", "bulk_density_kg_m3", "dilation_m",
                           "plane_normal_stress_Pa", "normal_stress_at_maximum_Pa", "inertial_number", "finished"});
  for (const LoadResult& r : c.loads) {
    csv.row(r.load, r.normal_stress, cell(r.maximum), cell(r.at_maximum), cell(r.residual), cell(r.solid_fraction),
            cell(s.density * r.solid_fraction), cell(r.dilation), cell(r.plane_stress), cell(r.normal_at_maximum),
            cell(r.inertial_number), r.finished);
  }
  csv.flush();  // so that a full disk is noticed
}

inline void print_report(const Settings& s, const Campaign& c, double wall_time) {
  fmt::print("\n{}\n\n", packing_text(s, c));
  io::print(strength_table(s, c));
  if (const auto text = coarseness_text(s, c); !text.empty()) fmt::print("{}\n", text);
  fmt::print("\n");
  io::print(check_table(c));
  fmt::print("\n");
  io::print(angle_table(fit(c)));
  fmt::print("\n{}\n", speed_text(c, wall_time));
}

}  // namespace detail

/// Writes results.csv, prints the results, and makes the plots and report.html with all settings. Shows what there is
/// when the run ended early. Returns whether there are files for ParaView.
inline bool report(Report& report, const Settings& s, const Campaign& c) {
  report.part("results.csv", [&] { detail::write_results_csv(report.folder() / "results.csv", s, c); });
  report.part("the printed report", [&] { detail::print_report(s, c, report.outcome().wall_time); });
  report.page(list_settings(s), [&](io::HtmlReport& page) {
    const Fits fits = fit(c);
    page.paragraph(packing_text(s, c)).table(strength_table(s, c));
    if (const auto text = coarseness_text(s, c); !text.empty()) page.paragraph(text);
    page.table(angle_table(fits));
    if (any_sheared(c)) {
      page.heading("Plots");
      report.plot(page, stress_plot(s, c), "shear_stress",
                  "Shear stress on the bottom box over the displacement of the top box.");
      report.plot(page, curves(s, c, &Sample::lid_rise, 1e3, "Dilation", "lid rise [mm]"), "dilation",
                  "Rise of the lid while shearing.");
      report.plot(page, mohr_coulomb_plot(c, fits), "mohr_coulomb", "Maximum shear stress over normal stress.");
    }
    if (c.replay && c.replay->frames().size() > 1) {
      page.heading("Replay").replay(*c.replay, "The load in the middle, while it is sheared.");
    }
    page.heading("Checks").table(check_table(c)).paragraph(speed_text(c, report.outcome().wall_time));
  });
  return any_sheared(c) && s.vtk;
}

}  // namespace dem::rig::direct_shear
