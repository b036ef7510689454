#pragma once
// What a rig's program shows at its end: tables, files, plots and one page.

#include <dem/report/ascii_table.hpp>
#include <dem/report/heat_map.hpp>
#include <dem/report/html_report.hpp>
#include <dem/report/plot.hpp>
#include <dem/rig/session.hpp>
#include <dem/rig/tell.hpp>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig {

/// The report of a run, also of one that ended early. What was computed for hours is worth saving in whatever ways
/// still work: a part that fails is named on stderr and keeps no other from being made.
class Report {
 public:
  Report(const Session& session, std::string title) : session_(session), title_(std::move(title)) {}

  [[nodiscard]] std::filesystem::path folder() const { return session_.folder(); }
  [[nodiscard]] const Outcome& outcome() const { return session_.outcome; }

  /// Makes a part: calls make(), which may throw.
  template <class Make>
  void part(const char* name, Make&& make) {
    try {
      make();
    } catch (const std::exception& error) {
      tell(stderr, "{}: {} could not be made: {}\n", session_.program(), name, error.what());
      has_failed_ = true;
    }
  }

  /// Makes report.html: the status of the run if it did not end well, what write(page) adds, the settings by name and
  /// value, and the settings file.
  template <class Write>
  void page(const std::vector<std::pair<std::string, std::string>>& settings, Write&& write) {
    part("report.html", [&] {
      io::HtmlReport html(title_);
      if (const auto status = status_text(); !status.empty()) html.paragraph(status);
      write(html);
      html.heading("Settings").settings(settings);
      html.heading("settings.toml", 3)
          .paragraph("What repeats the run: " + session_.program() + " --config settings.toml");
      html.preformatted(session_.config());
      html.save(folder() / "report.html");
    });
  }

  /// Draws a plot into the folder, as <name>.svg and <name>.png beside the script <name>.gp, and into the page.
  void plot(io::HtmlReport& html, const io::Plot& plot, const char* name, const char* caption) {
    show(html, io::render_plot(plot, folder() / name), caption);
  }

  /// The same with a map.
  void map(io::HtmlReport& html, const io::HeatMap& map, const char* name, const char* caption) {
    show(html, io::render_map(map, folder() / name), caption);
  }

  /// Whether no part failed, of the reports of runs within this one neither. Files for ParaView are no parts.
  [[nodiscard]] bool has_all_parts() const { return !has_failed_ && outcome().report_problem.empty(); }

  /// Says what there is and what is missing. `has_frames`: there are files for ParaView. Returns whether nothing is
  /// missing; that gnuplot is not there is no failure.
  bool finish(bool has_frames) {
    if (!not_drawn_.empty()) {
      tell(stderr, "{}: the plots were not drawn ({}); their data and gnuplot scripts are there\n", session_.program(),
           not_drawn_);
    }
    const Outcome& o = outcome();
    if (!o.frames_problem.empty()) tell(stderr, "{}: {}\n", session_.program(), frames_text());
    if (!o.report_problem.empty()) tell(stderr, "{}: {}\n", session_.program(), o.report_problem);
    const bool is_complete = has_all_parts() && o.frames_problem.empty();
    if (is_complete) {
      tell(stdout, "Report, {}tables{}: {}\n", has_plots_ && not_drawn_.empty() ? "plots, " : "",
           has_frames ? " and ParaView files" : "", folder().string());
    }
    return is_complete;
  }

 private:
  void show(io::HtmlReport& html, const io::PlotResult& drawn, const char* caption) {
    if (drawn) {
      has_plots_ = true;
      html.picture(drawn.svg, caption);
    } else if (drawn.is_empty) {
      const bool ended_early = outcome().interrupted || !outcome().problem.empty();
      html.paragraph(text("{} Nothing was measured{}.", caption, ended_early ? " by then" : ""));
    } else {
      has_plots_ = true;
      not_drawn_ = drawn.reason;
      html.paragraph(text("{}: not drawn ({})", caption, drawn.reason));
    }
  }

  [[nodiscard]] std::string frames_text() const {
    return "Files for ParaView are missing: " + outcome().frames_problem;
  }

  [[nodiscard]] std::string status_text() const {
    const Outcome& o = outcome();
    if (!o.problem.empty()) return "The run ended early: " + o.problem;
    if (o.interrupted) return "The run was interrupted; this is what was there by then.";
    if (!o.frames_problem.empty()) return frames_text();
    if (!o.report_problem.empty()) return o.report_problem + ".";
    return {};
  }

  const Session& session_;
  std::string title_;
  std::string not_drawn_;  // why; empty if all plots were
  bool has_plots_ = false, has_failed_ = false;
};

}  // namespace dem::rig
