#pragma once

#include <dem/rig/calibrate/rig_words.hpp>
#include <dem/rig/calibrate/search.hpp>
#include <dem/rig/calibrate/tables.hpp>
#include <dem/rig/calibrate/tried.hpp>
#include <dem/rig/rig.hpp>
#include <dem/rig/scatter.hpp>
#include <dem/rig/settings_file.hpp>
#include <dem/rig/side_by_side.hpp>

#include <omp.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::calibrate {

/// The search for constants of grains as a program. Points are chosen in batches, each from all that was found before
/// it, so that what is found does not depend on the number of threads; the runs of a batch go side by side. A search
/// that was stopped goes on with its table of tried points, and with each run where that was kept last.
class CalibrateRig : public Rig {
 public:
  CalibrateRig(const Worlds& worlds, Minimise* minimise) : worlds_(worlds), minimise_(minimise) {}

  void declare(Options& options) override { calibrate::declare(options, settings); }
  void find_idle(IdleOptions& idle) const override { calibrate::find_idle(idle, settings); }
  void resolve() override {
    calibrate::resolve(settings);
    check_rigs(settings);
  }
  [[nodiscard]] std::string output() const override { return settings.output; }
  [[nodiscard]] ResultNames results() const override {
    ResultNames names{.files = {"found.csv"},
                      .plots = {"response_phi", "response_repose", "response_pressure", "response_exponent", "search"}};
    if (!settings.go_on) names.files.push_back("tried.csv");
    return names;
  }
  [[nodiscard]] bool can_resume() const override { return true; }
  [[nodiscard]] std::string when_ended() const override {
    return "give --go-on in place of --resume to go on with its table of tried points";
  }

  void run(Session& session) override {
    const Settings& s = settings;
    const std::size_t d = constants_of(s).size(), batch = s.batch;
    table_ = session.folder() / "tried.csv";
    const bool resumes = session.checkpoints().resume;
    if (s.go_on) {
      const auto earlier = session.folder() / "settings.toml";
      if (resumes) fail("--resume and --go-on both go on with a search; give --resume for one that was stopped");
      if (!std::filesystem::exists(earlier) || !std::filesystem::exists(table_)) {
        fail("there is no search in '{}' to go on with; leave out --go-on to begin one", s.output);
      }
      require_same_settings(io::read_file(earlier), session.config(), session.checkpoints().free_settings, s.output);
      tried = load_tried(table_, s);
    }
    const std::size_t batches = (s.trials + batch - 1) / batch;
    for (auto& note : notes_of_differences(s)) session.say_when_begun(std::move(note));
    session.begin_run(static_cast<int>(batches) + (s.known.empty() ? 0 : 1));
    if (!resumes) {
      forget_trials(session.folder() / "runs");
      if (!s.go_on) remove_trials(session.folder() / "runs", session);
    } else if (std::filesystem::exists(table_)) {
      tried = load_tried(table_, s);
      session.message(text("Going on with the {} run{} in tried.csv.", tried.size(), tried.size() == 1 ? "" : "s"));
    }
    keep_begun(session, "calibrate");
    if (!s.known.empty()) {
      std::vector<Trial> making;
      for (std::uint64_t k = 0; k < 2 * s.repeats; ++k) making.push_back({0, s.seed + 1000 + k, s.known, {}});
      run_all(session, "target", making);
    }
    goals = find_goals();
    for (std::size_t b = 0; b < batches; ++b) {
      std::vector<Trial> next;
      for (std::size_t k = b * batch; k < std::min<std::size_t>(s.trials, (b + 1) * batch); ++k) {
        std::vector<double> values;
        const auto place = next_place(k, d, known_before(k - k % batch));
        for (std::size_t i = 0; i < d; ++i) values.push_back(value_at(s, constants_of(s)[i], place[i]));
        for (std::uint64_t r = 0; r < s.repeats; ++r) next.push_back({k + 1, s.seed + r, values, {}});
      }
      run_all(session, text("points {} to {}", b * batch + 1, std::min<std::size_t>(s.trials, (b + 1) * batch)), next);
      found = known_before(s.trials);
      session.finish(found ? found_text(s, *found) : "");
    }
    if (!found) found = find_constants(measurements(s.trials), goals, minimise_);
    forget_trials(session.folder() / "runs");  // a kill may have come before those of its trial were removed
  }

  bool report(Report& report) const override {
    const Settings& s = settings;
    std::vector<io::Table> tables;
    if (found) tables = {found_table(s, *found), goals_table(s, *found, goals)};
    tables.push_back(tried_table(s, tried));
    if (found) report.part("found.csv", [&] { write_found(report.folder() / "found.csv", s, *found); });
    std::vector<std::string> rigs;
    for (auto& rig : rigs_of(s)) {
      rigs.push_back(std::move(rig.words));
      if (!rig.note.empty()) rigs.push_back(in_own_words(rig.note, own_words(s)));
    }
    for (auto& note : notes_of_differences(s)) rigs.push_back(std::move(note));
    report.part("the printed report", [&] {
      fmt::print("\n");
      for (const auto& line : rigs) fmt::print("{}\n", line);
      fmt::print("\n");
      for (const auto& table : tables) {
        io::print(table);
        fmt::print("\n");
      }
      if (found) fmt::print("{}\n", found_text(s, *found));
      fmt::print("{} of wall time.\n", io::format_duration(report.outcome().wall_time));
    });
    report.page(list_settings(s), [&](io::HtmlReport& page) {
      page.paragraph(method_text);
      for (const auto& line : rigs) page.paragraph(line);
      if (found) page.paragraph(found_text(s, *found));
      for (const auto& table : tables) page.table(table);
      if (!found) return;
      page.heading("Plots");
      const auto quantities = quantities_of(s);
      for (std::size_t q = 0; q < quantities.size(); ++q) {
        const std::string name = text("response_{}", names_of_quantities[static_cast<int>(quantities[q])]);
        report.plot(
            page, response_plot(s, tried, *found, goals, q), name.c_str(),
            "What was measured over the first constant; the fitted curve along it through what was found; the target.");
      }
      report.plot(page, search_plot(s, tried), "search", "Points in the order in which they were tried.");
    });
    return false;
  }

  Settings settings;
  std::vector<Trial> tried = {};  ///< in the order of points and seeds
  std::vector<Goal> goals = {};
  std::optional<Found> found = {};

 private:
  /// Runs those of the trials that were not tried yet, side by side, as a stage, and keeps the table.
  void run_all(Session& session, const std::string& stage, std::vector<Trial>& trials) {
    std::erase_if(trials, [&](const Trial& t) {
      return std::any_of(tried.begin(), tried.end(),
                         [&](const Trial& x) { return x.point == t.point && x.seed == t.seed; });
    });
    session.begin(stage, std::max(1.0, static_cast<double>(trials.size())));
    const int workers = settings.threads > 0 ? settings.threads : std::max(1, omp_get_max_threads());
    side_by_side(trials.size(), workers, session, [&](std::size_t k, SharedStages& shared) {
      StagesOfOne own(shared, k);
      run_trial(settings, trials[k], worlds_, session.folder() / "runs", session.checkpoints(), own);
      shared.alone([&] {
        tried.push_back(trials[k]);
        std::sort(tried.begin(), tried.end(), [](const Trial& a, const Trial& b) {
          return a.point != b.point ? a.point < b.point : a.seed < b.seed;
        });
        save_tried(table_, settings, tried);
        forget_trial(settings, trials[k], session.folder() / "runs");
      });
    });
  }

  /// Of points 1 to `points`.
  [[nodiscard]] Measurements measurements(std::size_t points) const {
    const auto constants = constants_of(settings);
    Measurements m;
    m.dimensions = constants.size();
    m.values.resize(quantities_of(settings).size());
    for (const Trial& t : tried) {
      if (t.point == 0 || t.point > points) continue;
      for (std::size_t i = 0; i < constants.size(); ++i) {
        m.places.push_back(place_of(settings, constants[i], t.values[i]));
      }
      for (std::size_t q = 0; q < m.values.size(); ++q) m.values[q].push_back(t.results[q]);
    }
    return m;
  }
  /// What the first points say; none while they are too few.
  [[nodiscard]] std::optional<Found> known_before(std::size_t points) const {
    const std::size_t least = Surrogate::terms(constants_of(settings).size(), false) + 1;
    if (points < least) return {};
    try {
      return find_constants(measurements(points), goals, minimise_);
    } catch (const Error&) {  // too many runs have failed
      return {};
    }
  }
  /// The targets: as given, or the means of what was made.
  [[nodiscard]] std::vector<Goal> find_goals() const {
    const Settings& s = settings;
    std::vector<Goal> list;
    const auto quantities = quantities_of(s);
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      if (s.known.empty()) {
        list.push_back(quantities[q] == Quantity::phi        ? Goal{s.phi, s.phi_error}
                       : quantities[q] == Quantity::repose   ? Goal{s.repose, s.repose_error}
                       : quantities[q] == Quantity::pressure ? Goal{s.pressure, s.pressure_error}
                                                             : Goal{s.exponent, s.exponent_error});
        continue;
      }
      std::vector<double> made;
      for (const Trial& t : tried) {
        if (t.point == 0) made.push_back(t.results[q]);
      }
      const Scatter all = scatter_of(made);
      if (all.count < 2) throw Stopped(text("{} runs have made a target, but two are needed", all.count));
      list.push_back({all.mean, all.error(), static_cast<double>(all.count)});
    }
    return list;
  }

  Worlds worlds_;
  Minimise* minimise_;
  std::filesystem::path table_;
};

}  // namespace dem::rig::calibrate
