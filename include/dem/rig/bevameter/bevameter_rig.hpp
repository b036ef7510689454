#pragma once

#include <dem/rig/bevameter/circle.hpp>
#include <dem/rig/bevameter/resolve.hpp>
#include <dem/rig/bevameter/tables.hpp>
#include <dem/rig/direct_shear/shear_rig.hpp>
#include <dem/rig/old_results.hpp>
#include <dem/rig/plate_sinkage/plate_rig.hpp>
#include <dem/rig/rigid_wheel/wheel_rig.hpp>
#include <dem/rig/run_within.hpp>
#include <dem/terramechanics/chrono_scm.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::bevameter {

/// A bevameter as a program: plates, shear tests and a wheel in beds of the same grains, each a run of its own rig in a
/// folder of its own, and the constants of the soil. The worlds are compiled beside it.
class BevameterRig : public Rig {
 public:
  using PlateRun = plate_sinkage::PlateRig::Run;
  using WheelRun = rigid_wheel::WheelRig::Run;
  using ShearRun = void(const direct_shear::Settings&, direct_shear::Campaign&, Session&);

  BevameterRig(PlateRun* press, ShearRun* shear, WheelRun* roll)
      : shear_world_{{{"cube8", "verlet", shear}}}, plates_(press), shear_(shear_world_, ""), wheel_(roll) {}

  void declare(Options& options) override { bevameter::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { bevameter::find_idle(idle, settings); }
  void resolve() override { bevameter::resolve(settings); }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    return {.files = {"constants.csv", "soil_bekker.toml", "soil_reece.toml", "chrono_scm.txt", "predicted.csv"},
            .plots = {"plates", "shear", "mohr_coulomb", "pull", "torque", "sinkage"}};
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::vector<OwnWord> words() const override { return bed_words(); }

  void run(Session& session) override {
    const Settings& s = settings;
    plates_.settings = plates_of(s);
    session.begin_run(s.has_wheel() ? 3 : 2);
    if (!session.checkpoints().resume) clear_apparatus(session);
    keep_begun(session, "bevameter");
    session.begin("plates", 1.0);
    run_in(plate_words, session, plates_, "plate_sinkage", "Plates of the bevameter");
    session.begin("shear", 1.0);
    shear_.settings = shear_of(s, bed_density(plates()).relative_density);
    run_in(shear_words, session, shear_, "direct_shear", "Shear test of the bevameter");
    constants = find_constants(plates(), shear_.campaign, shear_.settings, s.pieces, s.confidence);
    save_soils(session.folder());
    if (s.has_wheel()) {
      session.begin("wheel", 1.0);
      wheel_.settings = wheel_of(s, (session.folder() / "soil_bekker.toml").string());
      run_in(wheel_words, session, wheel_, "rigid_wheel", "Wheel in a bed of the bevameter's grains");
    }
    if (!session.outcome.report_problem.empty()) return;  // a run that goes on makes what is missing
    for (const auto& [folder, rig] : apparatus()) forget_run_within(folder);
    session.parts().clear();  // without those of the runs within there is nothing to go on with
  }

  bool report(Report& report) const override {
    std::vector<io::Table> tables;
    std::string words = "The run ended before the constants could be found.";
    Predictions predictions;
    const std::string note = plates_.small_bed();
    if (constants) {
      words = constants_text(*constants, settings.confidence);
      tables = {constants_table(*constants, settings.confidence), shear_table(*constants)};
      if (has_rolled()) {
        predictions = predict(*constants, wheel_.campaign, wheel_.settings);
        words += text(" {}", beds_text(plates(), wheel_.campaign));
        if (!rigid_wheel::grips(wheel_.settings)) words += text(" {}", rigid_wheel::smooth_text);
        tables.push_back(circle_table(predictions, wheel_.campaign));
        report.part("predicted.csv",
                    [&] { write_predicted(report.folder() / "predicted.csv", predictions, wheel_.campaign); });
      }
      report.part("constants.csv",
                  [&] { write_constants(report.folder() / "constants.csv", *constants, settings.confidence); });
    }
    report.part("the printed report", [&] {
      fmt::print("\n{}\n", words);
      if (!note.empty()) fmt::print("{}\n", note);
      fmt::print("\n");
      for (const auto& table : tables) {
        io::print(table);
        fmt::print("\n");
      }
      if (!chrono_problem_.empty()) fmt::print("No chrono_scm.txt: {}\n", chrono_problem_);
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(settings), [&](io::HtmlReport& page) {
      page.paragraph(words);
      if (!note.empty()) page.paragraph(note);
      page.paragraph(
          text("The folders {} have the reports of these runs. soil_bekker.toml and soil_reece.toml are the soil for "
               "terramechanics, chrono_scm.txt is the call that gives Bekker's to Project Chrono's SCM terrain.",
               settings.has_wheel() ? "plates, shear and wheel" : "plates and shear"));
      for (const auto& table : tables) page.table(table);
      add_plots(report, page, predictions);
    });
    return false;
  }

  Settings settings;
  std::optional<Constants> constants = {};

 private:
  /// The folders of all apparatus, also of a wheel that does not roll: an earlier run may have left one.
  [[nodiscard]] std::array<std::pair<std::filesystem::path, const Rig*>, 3> apparatus() const {
    return {{{folder_in(settings, "plates"), &plates_},
             {folder_in(settings, "shear"), &shear_},
             {folder_in(settings, "wheel"), &wheel_}}};
  }
  /// Removes what an earlier run has left of them, which come in turn: until then their results would stand beside
  /// another soil, and their checkpoints would be gone on from.
  void clear_apparatus(Session& session) const {
    if (!process_writes_files) return;
    for (const auto& [own, rig] : apparatus()) {
      const std::size_t results = find_old_results(own, rig->results()).size();
      if (results > 0) session.message(text("Replacing {} results of an earlier run in '{}'.", results, own.string()));
      forget_run_within(own);
      remove_old_results(own, rig->results());
    }
  }

  static void run_in(std::span<const OwnWord> words, Session& session, Rig& rig, const char* program,
                     const char* title) {
    in_words(words, [&] { run_within(session, rig, program, title, words); });
  }
  [[nodiscard]] const plate_sinkage::VariantResult& plates() const { return plates_.campaign.variants.front(); }
  [[nodiscard]] bool has_rolled() const {
    for (const auto& r : wheel_.campaign.slips) {
      if (std::isfinite(r.pull.mean)) return true;
    }
    return false;
  }

  void save_soils(const std::filesystem::path& folder) {
    const std::string name = text("DEM sand, cubes of half-edge {:g} mm", 1e3 * settings.grains.half_edge);
    const std::string source = "bevameter in grains, settings.toml beside this file";
    const auto save = [&](const char* file, const terramechanics::Soil& soil, const char* other) {
      io::write_file(folder / file, interval_comments(*constants, settings.confidence, other) +
                                        terramechanics::to_text(terramechanics::NamedSoil{name, source, soil}));
    };
    save("soil_bekker.toml", constants->bekker_soil, "Reece");
    save("soil_reece.toml", constants->reece_soil, "Bekker");
    try {
      io::write_file(
          folder / "chrono_scm.txt",
          left_out_comments(*constants) + terramechanics::to_text(terramechanics::to_chrono(constants->bekker_soil)));
    } catch (const Error& problem) {  // as of a soil that gives way when it is unloaded
      chrono_problem_ = problem.what();
    }
  }

  void add_plots(Report& report, io::HtmlReport& page, const Predictions& predictions) const {
    if (plates_.campaign.variants.empty()) return;
    page.heading("Plots");
    report.plot(page, plates_plot(plates(), constants), "plates",
                "Pressure on the plates; dashed: Bekker, dotted: Reece, each one law for all plates.");
    if (shear_.campaign.loads.empty()) return;
    report.plot(page, shear_plot(shear_.campaign, shear_.settings, constants), "shear",
                "Shear stress; dashed: Janosi and Hanamoto with the soil's K and strength.");
    report.plot(
        page, strength_plot(shear_.campaign, constants), "mohr_coulomb",
        "Strength over the stress on the plane of shear; the line is that of the soil in the table and the files.");
    if (!has_rolled() || !constants) return;
    for (const Compared& q : compared) {
      report.plot(page, circle_plot(*constants, predictions, wheel_.campaign, wheel_.settings, q), q.name,
                  "The wheel in the grains, and predicted from the constants.");
    }
  }

  std::array<direct_shear::ShearWorld, 1> shear_world_;
  plate_sinkage::PlateRig plates_;
  direct_shear::ShearRig shear_;
  rigid_wheel::WheelRig wheel_;
  std::string chrono_problem_ = {};
};

}  // namespace dem::rig::bevameter
