#pragma once

#include <dem/io/csv.hpp>
#include <dem/io/duration.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/rig/old_results.hpp>
#include <dem/rig/rig.hpp>
#include <dem/rig/soft_lane/tables.hpp>

namespace dem::rig::soft_lane {

/// The car on a soft lane as a program. `campaign_run` is run_campaign() with a world, compiled beside it.
class LaneRig : public Rig {
 public:
  using Run = void(const Settings&, Campaign&, Session&);
  explicit LaneRig(Run* campaign_run) : run_(campaign_run) {}

  void declare(Options& options) override { soft_lane::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { soft_lane::find_idle(idle, settings); }
  void resolve() override {
    require_not_own(settings.inputs, "--inputs", output(), results());
    soft_lane::resolve(settings);
  }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    return {.files = {"results.csv", "telemetry.csv", "rut.csv", "along.csv", "pull.csv", "soft_lane.pvd"},
            .plots = {"speed", "slip", "sinkage", "load", "pull", "torque", "travel", "engine", "work", "joints",
                      "driver", "attitude", "rut", "along", "section", "drawbar"},
            .frames = {"grains", "surfaces"}};
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::vector<OwnWord> words() const override { return bed_words(); }
  void run(Session& session) override { run_(settings, campaign, session); }

  bool report(Report& report) const override {
    const Settings& s = settings;
    const Campaign& c = campaign;
    report.part("results.csv", [&] { write_results(report.folder() / "results.csv"); });
    if (s.scene == "drawbar") report.part("pull.csv", [&] { write_pulls(report.folder() / "pull.csv"); });
    report.part("rut.csv", [&] { write_ruts(report.folder() / "rut.csv"); });
    if (s.goes_along()) report.part("along.csv", [&] { write_along(report.folder() / "along.csv"); });
    std::vector<io::Table> tables{drive_table(s, c), wheel_table(c), cost_table(s, c)};
    if (s.has_border()) tables.push_back(stretch_table(c));
    if (s.scene == "drawbar") tables.push_back(pull_table(c));
    if (s.passes > 1) tables.push_back(pass_table(c));
    report.part("the printed report", [&] {
      fmt::print("\n{}\n{}\n\n", lane_text(s, c), words_text);
      for (const auto& table : tables) {
        io::print(table);
        fmt::print("\n");
      }
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(s), [&](io::HtmlReport& page) {
      page.paragraph(lane_text(s, c)).paragraph(words_text);
      for (const auto& table : tables) page.table(table);
      if (c.samples.size() > 1) add_plots(report, page);
      if (c.replay && c.replay->frames().size() > 1) {
        page.heading("Replay").replay(*c.replay, "The car from the moment it stands on the lane.");
      }
    });
    return s.vtk && !c.samples.empty();
  }

  Settings settings;
  Campaign campaign;

 private:
  void add_plots(Report& report, io::HtmlReport& page) const {
    const Campaign& c = campaign;
    const auto wheels = [&](double WheelSample::*value, double scale, const char* name, const char* title,
                            const char* label, const char* caption) {
      report.plot(page, wheel_plot(c, value, scale, title, label), name, caption);
    };
    page.heading("Plots");
    if (!c.section.empty()) {
      report.plot(page, section_plot(settings, c), "section", "Grains and tyres in the plane of the left wheels.");
    }
    if (!c.pulls.empty()) {
      report.plot(page, pull_plot(c), "drawbar", "What a sled behind the car measures that goes ever slower.");
    }
    report.plot(page, speed_plot(c), "speed", "Speed of the car along its own axis.");
    wheels(&WheelSample::slip, 1.0, "slip", "Slip", "slip (omega r - v)/max", "Slip of each wheel.");
    wheels(&WheelSample::sinkage, 1e3, "sinkage", "Sinkage", "sinkage [mm]",
           "Depth of each tyre's lowest point below the level.");
    wheels(&WheelSample::load, 1e-3, "load", "Load", "load [kN]", "Load of each wheel.");
    wheels(&WheelSample::pull, 1e-3, "pull", "Pull", "pull [kN]", "Net forward force of the grains on each wheel.");
    wheels(&WheelSample::torque, 1e-3, "torque", "Torque", "torque [kN m]",
           "Torque that drives each wheel against the grains.");
    wheels(&WheelSample::travel, 1e3, "travel", "Suspension travel", "travel [mm]", "Travel of each wheel, up.");
    report.plot(page, engine_plot(c), "engine", "Power of the engine.");
    report.plot(page, energy_plot(c), "work", "What the engine gave and the brakes took so far.");
    report.plot(
        page, joint_plot(c), "joints",
        "Size of the force in the lower ball joint of each wheel. telemetry.csv has the forces of all joints of "
        "the knuckles.");
    report.plot(page, driver_plot(c), "driver", "What the driver does; steering: mean angle of the front wheels.");
    report.plot(page, pose_plot(c), "attitude", "Attitude of the chassis.");
    if (auto rut = rut_plot(c); !rut.series.empty()) {
      report.plot(page, rut, "rut", "Height of the surface across both tracks, behind the rear wheels.");
    }
    if (!c.along.empty()) {
      report.plot(
          page, along_plot(c), "along",
          "Height of the surface along both tracks, over half a tyre's width, above the mean of untouched tiles.");
    }
  }

  void write_results(const std::filesystem::path& path) const {
    const Settings& s = settings;
    const Campaign& c = campaign;
    const Means& m = c.means;
    io::CsvWriter csv(path, {"scene",
                             "slope_percent",
                             "ended",
                             "way_m",
                             "time_s",
                             "speed_m_per_s",
                             vehicle::slip_column,
                             "sinkage_m",
                             "load_N",
                             "pull_N",
                             "torque_Nm",
                             "resistance_N",
                             "power_W",
                             "energy_per_metre_J_per_m",
                             "cost_of_transport",
                             "rut_depth_left_m",
                             "rut_depth_right_m",
                             "rut_width_m",
                             "drift_m",
                             "brake_way_m",
                             "deceleration_m_per_s2",
                             "radius_m",
                             "ackermann_radius_m",
                             "deepest_overlap_of_edge",
                             "weight_N",
                             "grains",
                             "grains_lost",
                             "computing_s_per_s"});
    const bool any = !c.samples.empty();
    csv.row(s.scene, s.slope_angle() != 0.0 ? s.slope : 0.0, c.ended, cell(any ? c.samples.back().way : not_known),
            cell(any ? c.samples.back().car.time : not_known), cell(m.speed), cell(m.slip), cell(m.sinkage),
            cell(m.load), cell(m.pull), cell(m.torque), cell(m.resistance), cell(m.power), cell(m.energy_per_metre),
            cell(m.cost_of_transport), cell(c.rut_depth[0]), cell(c.rut_depth[1]), cell(c.rut_width), cell(c.drift),
            cell(c.brake_way), cell(c.deceleration), cell(c.radius), cell(c.ackermann), cell(c.deepest), cell(c.weight),
            c.grains, c.lost, cell(c.computing));
    csv.flush();
  }

  void write_pulls(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {vehicle::slip_column, "pull_N", "torque_Nm", "sinkage_m", "efficiency"});
    for (const PullPoint& p : campaign.pulls) csv.row(p.slip, p.pull, p.torque, p.sinkage, cell(p.efficiency));
    csv.flush();
  }

  void write_ruts(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"y_m", "before_m", "after_m"});
    for (std::size_t side : {1, 0}) {
      const SurfaceProfile &before = campaign.before[side], &after = campaign.after[side];
      for (std::size_t k = 0; k < std::min(before.y.size(), after.y.size()); ++k) {
        csv.row(before.y[k], before.z[k], after.z[k]);
      }
    }
    csv.flush();
  }

  void write_along(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"x_m", "left_m", "right_m", "left_untouched_m", "right_untouched_m"}, {.digits = 6});
    for (const LanePlace& p : campaign.along) {
      csv.row(p.x, cell(p.z[0]), cell(p.z[1]), cell(campaign.untouched_along[0]), cell(campaign.untouched_along[1]));
    }
    csv.flush();
  }

  Run* run_;
};

}  // namespace dem::rig::soft_lane
