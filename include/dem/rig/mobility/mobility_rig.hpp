#pragma once

#include <dem/io/csv.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/rig/mobility/run.hpp>
#include <dem/rig/mobility/tables.hpp>
#include <dem/rig/old_results.hpp>
#include <dem/rig/rig.hpp>
#include <dem/terramechanics/rut_files.hpp>
#include <dem/terramechanics/rut_vtk.hpp>

#include <optional>

namespace dem::rig::mobility {

/// The Humvee on columns of soil as a program: single drives, slopes, side slopes, drawbar pull, passes, and maps of
/// where it goes.
class MobilityRig : public Rig {
 public:
  explicit MobilityRig(FindSoil* find_soil) : find_soil_(find_soil) {}

  void declare(Options& options) override { mobility::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { mobility::find_idle(idle, settings); }
  void resolve() override {
    require_not_own(settings.inputs, "--inputs", output(), results());
    mobility::resolve(settings, find_soil_);
  }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    return {.files = {"results.csv", "telemetry.csv", "pull.csv", "rut.csv", "rut.pgm", "rut.vtp"},
            .plots = {"speed", "slip", "sinkage", "load", "pull", "energy", "drift", "resistance", "ruts", "map"},
            .frames = {}};
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::vector<OwnWord> words() const override { return {}; }
  void run(Session& session) override { run_campaign(settings, campaign, replay, session); }

  bool report(Report& report) const override {
    const Campaign& c = campaign;
    report.part("results.csv", [&] { write_results(report.folder() / "results.csv"); });
    if (!c.shown.samples.empty()) {
      report.part("telemetry.csv", [&] {
        io::CsvWriter csv(report.folder() / "telemetry.csv", Sample{}.columns(), {.digits = 7});
        for (const Sample& x : c.shown.samples) csv.row(x.row());
        csv.flush();
      });
      report.part("the rut", [&] {
        terramechanics::write_rut_csv(report.folder() / "rut.csv", c.shown.field);
        terramechanics::write_rut_pgm(report.folder() / "rut.pgm", c.shown.field);
        terramechanics::write_rut_vtk(report.folder() / "rut.vtp", c.shown.field);
      });
    }
    std::vector<io::Table> tables{drive_table(c)};
    if (is_held()) {
      tables.push_back(pull_table(c.results[0]));
      report.part("pull.csv", [&] { write_pulls(report.folder() / "pull.csv"); });
    }
    report.part("the printed report", [&] {
      fmt::print("\n{}\n\n", words_text);
      for (const auto& table : tables) io::print(table), fmt::print("\n");
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(), [&](io::HtmlReport& page) {
      page.paragraph(words_text);
      for (const auto& table : tables) page.table(table);
      add_plots(report, page);
      if (replay && replay->frames().size() > 1) {
        page.heading("Replay").replay(*replay, "The car from above its lane until the end of the drive.");
      }
    });
    return false;
  }

  Settings settings;
  Campaign campaign;
  std::optional<report::Replay> replay;

 private:
  [[nodiscard]] bool is_held() const { return settings.study == "drawbar" && !campaign.results.empty(); }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> list_settings() const {
    const Settings& s = settings;
    return {{"size", s.size},
            {"study", s.study},
            {"ground", campaign.cases.empty() || s.study == "loads" ? s.study : ground_of(campaign.cases[0])},
            {"engine", s.engine},
            {"speed", s.open_loop.empty() ? text("{:g} m/s, reached at {:g} m/s²", s.speed, s.acceleration)
                                          : "by the inputs " + s.inputs},
            {"path", text("{:g} m", s.path)},
            {"tyres", s.tyre + (s.tyre == "ring" ? text(", {:g} kPa", 1e-3 * s.tyre_pressure) : "")},
            {"columns", text("{:g} mm, damping {:g} Pa s/m", 1e3 * s.spacing, s.damping)},
            {"time step of the car", text("{:g} s", s.time_step)}};
  }

  void add_plots(Report& report, io::HtmlReport& page) const {
    const Settings& s = settings;
    page.heading("Plots");
    const auto sweep = [&](const char* x_label, auto&& x) { add_sweep(report, page, x_label, x); };
    if (s.study == "slopes") sweep("slope [%]", [](const Case& of, std::size_t) { return of.slope; });
    if (s.study == "side-slopes") sweep("side slope [%]", [](const Case& of, std::size_t) { return of.side_slope; });
    if (s.study == "passes") sweep("pass", [](const Case&, std::size_t k) { return static_cast<double>(k + 1); });
    if (is_held()) {
      const Case& of = campaign.cases[0];
      report.plot(page, pull_plot(of, campaign.results[0], wheel_of(s, of)), "pull",
                  "Pull on the load cell over slip, and of single wheels where their soil carries them.");
    }
    if (s.study == "map") add_slope_map(report, page);
    if (s.study == "loads") add_load_map(report, page);
    if (campaign.shown.samples.size() > 2) add_shown(report, page);
  }

  /// What the drives found, over what differs between them: x(case, number).
  template <class X>
  void add_sweep(Report& report, io::HtmlReport& page, const char* x_label, X&& x) const {
    const auto add = [&](const char* title, const char* y_label, const char* name, const char* caption, auto&& y) {
      report.plot(page, plot_over(campaign, title, x_label, y_label, x, y), name, caption);
    };
    add("Speed", "speed [m/s]", "speed",
        "Mean speed over the second half of the way; words where the car did not arrive.",
        [](const Result& r) { return r.speed; });
    add("Slip", "slip", "slip", "Mean slip.", [](const Result& r) { return r.slip; });
    add("Sinkage", "sinkage [mm]", "sinkage", "Mean sinkage of the wheels.",
        [](const Result& r) { return 1e3 * r.sinkage; });
    add("Energy", "energy [kJ/m]", "energy", "Energy of the engine for a metre.",
        [](const Result& r) { return 1e-3 * r.energy_per_metre; });
    add("Resistance", "resistance [kN]", "resistance", "What the soil takes of the thrust.",
        [](const Result& r) { return 1e-3 * r.resistance; });
    add("Drift", "to the left [mm]", "drift", "Drift of the car at the end of its way.",
        [](const Result& r) { return 1e3 * r.drift; });
  }

  void add_slope_map(Report& report, io::HtmlReport& page) const {
    const Settings& s = settings;
    auto map = map_of(
        campaign, "Where the car goes on " + ground_of(campaign.cases[0]), numbers_to(s.slopes.size()),
        numbers_to(s.side_slopes.size()), [](const Result& r) { return r.speed; }, words_of);
    map.x_label = "slope", map.y_label = "side slope", map.c_label = "speed [m/s]";
    for (const double slope : s.slopes) map.x_ticks.push_back(text("{:g} %", slope));
    for (const double side : s.side_slopes) map.y_ticks.push_back(text("{:g} %", side));
    map.range = {0.0, s.speed};
    add_map(report, page, std::move(map),
            "Speed and energy for a metre over slope and side slope; grey: it does not go.");
  }

  void add_load_map(Report& report, io::HtmlReport& page) const {
    const Settings& s = settings;
    auto map = map_of(
        campaign, "Energy for a metre over load and soil", numbers_to(s.loads.size()),
        numbers_to(s.soils_of_loads_.size()), [](const Result& r) { return 1e-3 * r.energy_per_metre; }, words_of);
    map.x_label = "sprung mass", map.y_label = "soil", map.c_label = "energy [kJ/m]";
    for (const double mass : s.loads) map.x_ticks.push_back(text("{:g} kg", mass));
    for (const auto& soil : s.soils_of_loads_) map.y_ticks.push_back(soil.name);
    add_map(report, page, std::move(map), "Energy for a metre and speed over soil and load; grey: it does not go.");
  }

  /// The drive that is shown, and the ruts that it leaves.
  void add_shown(Report& report, io::HtmlReport& page) const {
    const Driven& d = campaign.shown;
    using W = vehicle::WheelSample;
    if (settings.is_drive()) {
      io::Plot speed{.title = "Speed", .x_label = "way [m]", .y_label = "speed [m/s]"};
      speed.series = {line_of(d, "car", 0, [](const Sample& x) { return x.car.speed; })};
      report.plot(page, speed, "speed", "Speed of the car.");
      const auto add = [&](double W::*value, double scale, const char* title, const char* label, const char* name,
                           const char* caption) {
        report.plot(page, wheel_plot(d, value, scale, title, label), name, caption);
      };
      add(&W::slip, 1.0, "Slip", "slip", "slip", "Slip of the wheels.");
      add(&W::sinkage, 1e3, "Sinkage", "sinkage [mm]", "sinkage", "Sinkage of the wheels.");
      add(&W::load, 1e-3, "Load", "load [kN]", "load", "Load of the wheels.");
      add(&W::pull, 1e-3, "Pull", "pull [kN]", "pull", "Net forward force on the wheels.");
    }
    report.map(page, rut_map(d.field), "ruts", "Height of the soil at the end.");
  }

  /// Cells of one size, whatever the steps of their axes are.
  static void add_map(Report& report, io::HtmlReport& page, io::HeatMap map, const char* caption) {
    map.width = 240 + 130 * static_cast<int>(map.x.size());
    map.height = 140 + 80 * static_cast<int>(map.y.size());
    report.map(page, map, "map", caption);
  }
  static std::string words_of(const Result& r) {
    return text("{:.1f} m/s\n{:.1f} kJ/m", r.speed, 1e-3 * r.energy_per_metre);
  }
  static std::vector<double> numbers_to(std::size_t n) {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < n; ++k) numbers.push_back(static_cast<double>(k));
    return numbers;
  }

  void write_results(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"soil",
                             "slope_percent",
                             "side_slope_percent",
                             "sprung_mass_kg",
                             "ended",
                             "way_m",
                             "time_s",
                             "speed_m_per_s",
                             vehicle::slip_column,
                             "sinkage_m",
                             "pull_N",
                             "torque_Nm",
                             "resistance_N",
                             "power_W",
                             "energy_per_metre_J_per_m",
                             "cost_of_transport",
                             "drift_m",
                             "rut_left_m",
                             "rut_right_m",
                             "weight_N",
                             "widest_joint_m"});
    for (std::size_t k = 0; k < campaign.results.size(); ++k) {
      const Case& of = campaign.cases[k];
      const Result& r = campaign.results[k];
      csv.row(ground_of(of), of.slope, of.side_slope, of.sprung_mass, r.ended, cell(r.way), cell(r.time), cell(r.speed),
              cell(r.slip), cell(r.sinkage), cell(r.pull), cell(r.torque), cell(r.resistance), cell(r.power),
              cell(r.energy_per_metre), cell(r.cost_of_transport), cell(r.drift), cell(r.rut_left), cell(r.rut_right),
              cell(r.weight), cell(r.widest_joint));
    }
    csv.flush();
  }

  void write_pulls(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"slip_1-v/(omega*r)", "pull_N", "torque_Nm", "sinkage_m", "power_W", "efficiency"});
    for (const PullPoint& p : campaign.results[0].pulls) {
      csv.row(p.slip, p.pull, p.torque, p.sinkage, p.power, p.efficiency);
    }
    csv.flush();
  }

  FindSoil* find_soil_;
};

}  // namespace dem::rig::mobility
