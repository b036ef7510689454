#pragma once

#include <dem/io/csv.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/rig/rig.hpp>
#include <dem/rig/rigid_wheel/columns.hpp>
#include <dem/rig/rigid_wheel/study.hpp>
#include <dem/rig/rigid_wheel/tables.hpp>

#include <algorithm>

namespace dem::rig::rigid_wheel {

/// The rigid wheel as a program. `campaign_run` is run_campaign() with a world, compiled beside it.
class WheelRig : public Rig {
 public:
  using Run = void(const Settings&, Campaign&, Session&);
  explicit WheelRig(Run* campaign_run) : run_(campaign_run) {}

  void declare(Options& options) override { rigid_wheel::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { rigid_wheel::find_idle(idle, settings); }
  void resolve() override { rigid_wheel::resolve(settings); }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    ResultNames names{.files = {"results.csv", "references.csv", "rut.csv", "under_wheel.csv", "print.csv", "study.csv",
                                "study_runs.csv", "slip_#+.csv", "slip_m#+.csv", "slip_#+.pvd", "slip_m#+.pvd"},
                      .plots = {"pull", "torque", "sinkage", "efficiency", "pull_over_time", "sinkage_over_time", "rut",
                                "stress", "print", "print_shear"},
                      .frames = {"grains", "surfaces"}};
    for (const std::string& variant : variant_prefixes()) {
      names.files.push_back(variant + "slip_#+.csv");
      names.files.push_back(variant + "slip_m#+.csv");
    }
    return names;
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::vector<OwnWord> words() const override { return bed_words(); }
  void run(Session& session) override {
    soils_ = references(settings);
    run_(settings, campaign, session);
  }

  bool report(Report& report) const override {
    const Settings& s = settings;
    report.part("results.csv", [&] { write_results(report.folder() / "results.csv"); });
    std::vector<Reference> soils = soils_;
    report.part("the wheel on soil columns", [&] { roll_on_columns(soils, campaign, s); });
    std::vector<io::Table> tables{slip_table(campaign), reference_table(s, campaign, soils), rut_table(campaign),
                                  print_table(campaign)};
    report.part("references.csv", [&] { write_references(report.folder() / "references.csv", soils); });
    report.part("rut.csv", [&] { write_ruts(report.folder() / "rut.csv"); });
    report.part("under_wheel.csv", [&] { write_print(report.folder() / "under_wheel.csv"); });
    report.part("print.csv", [&] { write_map(report.folder() / "print.csv"); });
    std::vector<std::string> words{bed_text(s, campaign), window_text, reference_text, print_text};
    if (!grips(s)) words.emplace_back(smooth_text);
    for (const Reference& soil : soils) {
      if (!soil.no_columns.empty())
        words.push_back(text("On columns of {} some runs have no result: {}.", soil.name, soil.no_columns));
    }
    if (!campaign.study.empty()) {
      const StudiedValue of = studied_pull(s);
      const std::vector<StudyRow> rows = study_rows(campaign);
      for (auto& line : study_findings(of, rows)) words.push_back(std::move(line));
      words.emplace_back(text("{} {}", study_text, runs_text));
      tables.push_back(study_table(of, rows, study_caption));
      tables.push_back(runs_table(campaign));
      report.part("study.csv", [&] { write_study(report.folder() / "study.csv", of, rows); });
      report.part("study_runs.csv", [&] { write_runs(report.folder() / "study_runs.csv", campaign); });
    }
    report.part("the printed report", [&] {
      fmt::print("\n");
      for (const auto& line : words) fmt::print("{}\n", line);
      fmt::print("\n");
      for (const auto& table : tables) {
        io::print(table);
        fmt::print("\n");
      }
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(s), [&](io::HtmlReport& page) {
      for (const auto& line : words) page.paragraph(line);
      for (const auto& table : tables) page.table(table);
      if (any_rolled()) add_plots(report, page, soils);
      if (campaign.replay && campaign.replay->frames().size() > 1) {
        page.heading("Replay").replay(*campaign.replay,
                                      text("The wheel at a slip of {:g}.", s.slips[shown_slip(s.slips)]));
      }
    });
    return s.vtk && any_rolled();
  }

  Settings settings;
  Campaign campaign;

 private:
  [[nodiscard]] bool any_rolled() const {
    return std::any_of(campaign.slips.begin(), campaign.slips.end(),
                       [](const SlipResult& r) { return r.samples.size() > 1; });
  }

  void add_plots(Report& report, io::HtmlReport& page, std::span<const Reference> soils) const {
    using terramechanics::WheelForces;
    const Settings& s = settings;
    const Campaign& c = campaign;
    page.heading("Plots");
    report.plot(page,
                slip_plot(
                    s, c, soils, &SlipResult::pull, 1.0, [](const WheelForces& f, double) { return f.pull; },
                    "Drawbar pull", "drawbar pull [N]"),
                "pull", "Drawbar pull over slip.");
    report.plot(page,
                slip_plot(
                    s, c, soils, &SlipResult::torque, 1.0, [](const WheelForces& f, double) { return f.torque; },
                    "Torque", "torque [N m]"),
                "torque", "Torque that drives the wheel over slip.");
    report.plot(page,
                slip_plot(
                    s, c, soils, &SlipResult::sinkage, 1e3, [](const WheelForces& f, double) { return f.sinkage; },
                    "Sinkage", "sinkage [mm]"),
                "sinkage", "Sinkage over slip.");
    if (std::any_of(c.slips.begin(), c.slips.end(), [](const SlipResult& r) { return r.efficiency.mean > 0.0; })) {
      report.plot(page, efficiency_plot(s, c, soils), "efficiency",
                  "Power of the pull over that of the motor, where a wheel drives and pulls.");
    }
    report.plot(page, time_plot(c, &Sample::pull, 1.0, "Drawbar pull over time", "drawbar pull [N]"), "pull_over_time",
                "Drawbar pull of every run.");
    report.plot(page, time_plot(c, &Sample::sinkage, 1e3, "Sinkage over time", "sinkage [mm]"), "sinkage_over_time",
                "Sinkage of every run.");
    if (auto rut = rut_plot(c); !rut.series.empty()) {
      report.plot(page, rut, "rut", "Height of the surface behind the wheel, across its way.");
    }
    const SlipResult& shown = c.slips[std::min(shown_slip(s.slips), c.slips.size() - 1)];
    if (shown.print.empty()) return;
    report.plot(page, print_plot(s, soils, shown), "stress", "Stress along the rim, a mean across the wheel's width.");
    report.map(page, print_map(shown, &ContactPrint::pressure, "Pressure under the wheel", "pressure [kPa]"), "print",
               "Pressure under the wheel, unrolled.");
    report.map(page, print_map(shown, &ContactPrint::shear, "Shear stress under the wheel", "shear stress [kPa]"),
               "print_shear", "Shear stress under the wheel, unrolled: positive where it brakes a driven wheel.");
  }

  void write_results(const std::filesystem::path& path) const {
    io::CsvWriter csv(
        path,
        {"slip_1-v/(omega*r)", "drawbar_pull_N", "pull_deviation_N", "torque_Nm", "torque_deviation_Nm", "sinkage_m",
         "sinkage_deviation_m", "efficiency", "efficiency_deviation", "carried_N", "steady_from_s", "steady",
         "rut_depth_m", "rut_width_m", "contact_area_m2", "contact_pressure_Pa", "largest_mean_across_Pa", "finished"});
    for (const SlipResult& r : campaign.slips) {
      const ContactPrint& p = r.print;
      const bool is_known = !p.empty();
      csv.row(r.slip, cell(r.pull.mean), cell(r.pull.deviation), cell(r.torque.mean), cell(r.torque.deviation),
              cell(r.sinkage.mean), cell(r.sinkage.deviation), cell(r.efficiency.mean), cell(r.efficiency.deviation),
              cell(r.carried.mean), cell(r.window_from), r.is_steady, cell(r.rut.depth), cell(r.rut.width),
              cell(is_known ? p.area() : not_known), cell(is_known ? p.mean_pressure() : not_known),
              cell(is_known ? p.pressure(p.peak()) : not_known), r.finished);
    }
    csv.flush();
  }

  void write_references(const std::filesystem::path& path, std::span<const Reference> soils) const {
    io::CsvWriter csv(path, {"slip_1-v/(omega*r)", "soil", "drawbar_pull_N", "torque_Nm", "sinkage_m"});
    for (std::size_t k = 0; k < campaign.slips.size(); ++k) {
      const double slip = campaign.slips[k].slip;
      for_each_reference(settings, slip, k, soils, [&](const std::string& name, const terramechanics::WheelForces& f) {
        csv.row(slip, name, cell(f.pull), cell(f.torque), cell(f.sinkage));
      });
    }
    csv.flush();
  }

  void write_ruts(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"slip_1-v/(omega*r)", "across_m", "above_level_m"});
    for (const SlipResult& r : campaign.slips) {
      for (std::size_t k = 0; k < r.rut_y.size(); ++k) csv.row(r.slip, r.rut_y[k], r.rut_z[k] - campaign.level);
    }
    csv.flush();
  }

  void write_print(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"slip_1-v/(omega*r)", "angle_rad", "pressure_Pa", "shear_stress_Pa"});
    for (const SlipResult& r : campaign.slips) {
      for (std::size_t a = 0; a < ContactPrint::along && !r.print.empty(); ++a)
        csv.row(r.slip, r.print.angle(a), r.print.pressure(a), r.print.shear(a));
    }
    csv.flush();
  }

  /// The same in cells across the wheel: what the pictures of the print show.
  void write_map(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"slip_1-v/(omega*r)", "angle_rad", "across_m", "pressure_Pa", "shear_stress_Pa"});
    for (const SlipResult& r : campaign.slips) {
      for (std::size_t w = 0; w < r.print.across && !r.print.empty(); ++w) {
        for (std::size_t a = 0; a < ContactPrint::along; ++a)
          csv.row(r.slip, r.print.angle(a), r.print.place(w), r.print.pressure(a, w), r.print.shear(a, w));
      }
    }
    csv.flush();
  }

  Run* run_;
  std::vector<Reference> soils_ = {};
};

}  // namespace dem::rig::rigid_wheel
