#pragma once
// Line plots drawn by gnuplot, where it is installed.

#include <dem/core/error.hpp>
#include <dem/io/file.hpp>
#include <dem/io/process.hpp>
#include <dem/io/text.hpp>
#include <dem/report/gnuplot_script.hpp>
#include <dem/report/plot_data.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

namespace dem::io {

/// What render_plot() did.
struct PlotResult {
  bool rendered = false, is_empty = false;  ///< is_empty: there are no points, not even such as are not finite
  std::string reason = {};                  ///< one line that says why nothing was drawn
  std::filesystem::path script = {};        ///< written in any case
  std::filesystem::path svg = {};           ///< empty when not rendered
  std::filesystem::path png = {};           ///< empty when not rendered

  explicit operator bool() const { return rendered; }
};

namespace detail {

/// gnuplot repeats the line it stumbled over and marks the place; the last line says what is wrong.
[[nodiscard]] inline std::string last_line_of_errors(std::string_view errors) {
  while (!errors.empty() && (errors.back() == '\n' || errors.back() == ' ')) errors.remove_suffix(1);
  const auto start = errors.rfind('\n');
  return one_line(start == std::string_view::npos ? errors : errors.substr(start + 1));
}

/// Whether the file at `path` is there and ends as a picture of its kind does: on a full disk it would be cut off, or
/// empty, and gnuplot may say nothing of it.
[[nodiscard]] inline bool is_whole(const std::filesystem::path& path, std::string_view end) {
  if (!std::filesystem::exists(path)) return false;
  const std::string bytes = read_file(path);
  const auto last = bytes.find_last_not_of(" \r\n");
  return last != std::string::npos && std::string_view(bytes).substr(0, last + 1).ends_with(end);
}

/// The base name of a plot's files. Throws Error for one that cannot name them.
inline std::string checked_name(const std::string& title, const std::filesystem::path& base) {
  std::string name = base.filename().string();
  if (name.empty() || name != one_line(name)) {
    fail("plot '{}': '{}' cannot name its files; give a name without control characters", title, one_line(name));
  }
  return name;
}

/// Writes a script that draws `<base>.svg` and `<base>.png`, and runs it if there is anything to draw.
inline PlotResult render_script(const std::string& script, bool any_data, const std::filesystem::path& base,
                                std::string_view gnuplot) {
  const std::string name = base.filename().string();
  const auto with_ending = [&](const char* ending) { return base.parent_path() / (name + ending); };
  PlotResult result{.script = with_ending(".gp")};
  write_file(result.script, script);
  if (!process_writes_files) {
    result.reason = "another process draws it";
    return result;
  }
  const auto svg = with_ending(".svg"), png = with_ending(".png");
  std::error_code ignored;
  std::filesystem::remove(svg, ignored);  // no plot is better than that of an earlier run
  std::filesystem::remove(png, ignored);

  if (!any_data) {
    result.reason = "the plot has no finite data";
    return result;
  }
  const auto program = find_program(gnuplot);
  if (!program) {
    result.reason =
        fmt::format("no program '{}' along PATH; install gnuplot and run it on {}", gnuplot, result.script.string());
    return result;
  }
  // --default-settings: no start-up file of the user's may change the plot.
  const auto run = run_program(*program, {"--default-settings", "./" + name + ".gp"}, base.parent_path());
  const bool drawn = detail::is_whole(svg, "</svg>") && detail::is_whole(png, "IEND\xAE\x42\x60\x82");
  if (run.exit_code != 0 || !drawn) {
    const std::string words = detail::last_line_of_errors(run.errors);
    result.reason = run.exit_code != 0 || !words.empty()
                        ? fmt::format("gnuplot ended with code {}: {}", run.exit_code, words)
                        : "gnuplot left no whole pictures; check that the disk is not full";
    std::filesystem::remove(svg, ignored);
    std::filesystem::remove(png, ignored);
    return result;
  }
  result.rendered = true;
  result.svg = svg;
  result.png = png;
  return result;
}

}  // namespace detail

/// Draws `plot` to `<base>.svg` and `<base>.png`, and writes `<base>.gp`: the script, data included, to draw or change
/// the plot by hand. `gnuplot` is the name of the program, searched for along PATH.
///
/// A plot that cannot be drawn (no gnuplot, no finite data) is no error: the result says why, and the script is there.
/// Throws dem::Error for a wrong plot (check_plot), a file that cannot be written, and a base name with control
/// characters.
inline PlotResult render_plot(const Plot& plot, const std::filesystem::path& base,
                              std::string_view gnuplot = "gnuplot") {
  const std::string name = detail::checked_name(plot.title, base);
  const bool any_data =
      std::any_of(plot.series.begin(), plot.series.end(), [&](const Series& s) { return detail::has_points(plot, s); });
  PlotResult result = detail::render_script(gnuplot_script(plot, name), any_data, base, gnuplot);
  result.is_empty = std::all_of(plot.series.begin(), plot.series.end(), [](const Series& s) { return s.x.empty(); });
  return result;
}

}  // namespace dem::io
