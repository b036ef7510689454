#pragma once

#include <dem/io/csv.hpp>
#include <dem/report/replay_page.hpp>
#include <dem/rig/bed/small_bed.hpp>
#include <dem/rig/plate_sinkage/study.hpp>
#include <dem/rig/plate_sinkage/tables.hpp>
#include <dem/rig/rig.hpp>

namespace dem::rig::plate_sinkage {

/// The plate pressure-sinkage test as a program. `campaign_run` is run_campaign() with a world, compiled beside it.
class PlateRig : public Rig {
 public:
  using Run = void(const Settings&, Campaign&, Session&);
  explicit PlateRig(Run* campaign_run) : run_(campaign_run) {}

  void declare(Options& options) override { plate_sinkage::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { plate_sinkage::find_idle(idle, settings); }
  void resolve() override { plate_sinkage::resolve(settings); }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    ResultNames names{.files = {"results.csv", "constants.csv", "study.csv", "plate_#+mm.pvd", "plate_#+mm.csv",
                                "plate_#+mm_unloading.csv"},
                      .plots = {"pressure", "fits"},
                      .frames = {"grains", "surfaces"}};
    for (const std::string& variant : variant_prefixes()) {
      names.files.push_back(variant + "plate_#+mm.csv");
      names.files.push_back(variant + "plate_#+mm_unloading.csv");
    }
    return names;
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::vector<OwnWord> words() const override { return bed_words(); }
  void run(Session& session) override {
    if (auto note = small_bed(); !note.empty()) session.say_when_begun(std::move(note));
    run_(settings, campaign, session);
  }

  bool report(Report& report) const override {
    if (campaign.variants.empty()) {
      report.page(list_settings(settings), [](io::HtmlReport&) {});
      return false;
    }
    const VariantResult& v = campaign.variants.front();
    std::vector<std::string> words{bed_text(v), finding_text(v)};
    if (auto constants = constants_text(v); !constants.empty()) words.push_back(std::move(constants));
    if (!small_bed().empty()) words.push_back(small_bed());
    if (campaign.variants.size() > 1) {
      const StudiedValue of = studied_pressure(settings);
      const std::vector<StudyRow> rows = study_rows(campaign);
      const std::size_t last = of.places.size() - 1;  // the mean of all plates
      for (auto& line : study_findings(of, rows, last)) words.push_back(std::move(line));
      words.emplace_back(text("{} {}", study_text, study_note));
      report.part("study.csv", [&] { write_study(report.folder() / "study.csv", of, rows); });
    }
    report.part("results.csv", [&] { write_results(report.folder() / "results.csv"); });
    report.part("constants.csv", [&] { write_constants(report.folder() / "constants.csv"); });
    report.part("the printed report", [&] {
      fmt::print("\n");
      for (const auto& line : words) fmt::print("{}\n", line);
      fmt::print("\n");
      for (const auto& table : tables()) {
        io::print(table);
        fmt::print("\n");
      }
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(settings), [&](io::HtmlReport& page) {
      for (const auto& line : words) page.paragraph(line);
      for (const auto& table : tables()) page.table(table);
      page.heading("Plots");
      report.plot(page, pressure_plot(v), "pressure",
                  "Pressure on the plates over their sinkage; dashed: P3, Mojave Martian Simulant.");
      report.plot(page, fit_plot(v), "fits", "The same in logarithms; dotted: p = k z^n of each plate.");
      if (campaign.replay && campaign.replay->frames().size() > 1) {
        page.heading("Replay").replay(*campaign.replay, "The plate in the middle.");
      }
    });
    return settings.vtk && !v.plates.empty();
  }

  /// What is said of a bed that is too small for the plates; how deep one from a file is, is known once it is read.
  [[nodiscard]] std::string small_bed() const {
    const double level = campaign.variants.empty() ? not_known : campaign.variants.front().level;
    return small_bed_note(settings.widths.back(), settings.bed.width,
                          settings.bed.file.empty() ? settings.bed.depth : level, !settings.bed.file.empty());
  }

  Settings settings;
  Campaign campaign;

 private:
  [[nodiscard]] std::vector<io::Table> tables() const {
    const VariantResult& v = campaign.variants.front();
    std::vector<io::Table> list{pressure_table(v), fit_table(v)};
    if (auto constants = constants_table(v); !constants.rows.empty()) list.push_back(std::move(constants));
    list.push_back(runs_table(campaign));
    if (campaign.variants.size() > 1) {
      list.push_back(study_table(studied_pressure(settings), study_rows(campaign), study_caption));
    }
    return list;
  }

  void write_results(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"run", "plate_m", "k_Pa_per_m^n", "k_error", "n", "n_error", "mean_pressure_Pa",
                             "unloading_Pa_per_m", "solid_fraction", "grains", "finished"});
    for (const VariantResult& v : campaign.variants) {
      for (const PlateResult& r : v.plates) {
        const bool f = r.fit.has_value();
        csv.row(v.variant.text, r.width, cell(f ? r.fit->curve.modulus : not_known),
                cell(f ? r.fit->modulus_error : not_known), cell(f ? r.fit->curve.exponent : not_known),
                cell(f ? r.fit->exponent_error : not_known), cell(mean_pressure(r, v.variant.settings)),
                cell(r.unloading_stiffness), cell(v.solid_fraction), v.grains, r.finished);
      }
    }
    csv.flush();
  }

  /// Of the forms over all plates, beside each other; the form says the units.
  void write_constants(const std::filesystem::path& path) const {
    io::CsvWriter csv(path, {"run", "form", "kc", "kc_error", "kphi", "kphi_error", "n", "n_error", "r_squared"});
    for (const VariantResult& v : campaign.variants) {
      const OverPlates fits = fit_over_plates(v);
      if (const auto& b = fits.bekker) {
        csv.row(v.variant.text, "Bekker [Pa/m^(n-1), Pa/m^n]", cell(b->law.k_c), cell(b->error.k_c), cell(b->law.k_phi),
                cell(b->error.k_phi), cell(b->law.n), cell(b->error.n), cell(b->r_squared));
      }
      if (const auto& r = fits.reece) {
        csv.row(v.variant.text, "Reece, c = 0 [-]", cell(not_known), cell(not_known), cell(r->law.k_phi),
                cell(r->k_phi_error), cell(r->law.n), cell(r->n_error), cell(r->r_squared));
      }
    }
    csv.flush();
  }

  Run* run_;
};

}  // namespace dem::rig::plate_sinkage
