#pragma once
// Line plots as gnuplot scripts.

#include <dem/core/error.hpp>
#include <dem/io/text.hpp>
#include <dem/report/plot_data.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dem::io {

/// `text` as a gnuplot string expression that means exactly these characters. Single quotes: gnuplot runs commands
/// in backticks inside double quotes, and nothing inside single ones. Bytes that are no UTF-8 stay, as in names of
/// files.
[[nodiscard]] inline std::string gnuplot_quote(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'.\"'\".'";  // the doubling '' is misread by gnuplot at the start of a text
    } else if (c == '\n') {
      quoted += "'.\"\\n\".'";
    } else {
      const auto byte = static_cast<unsigned char>(c);
      quoted += byte < 0x20U || byte == 0x7FU ? ' ' : c;
    }
  }
  return quoted + "'";
}

namespace detail {

/// Okabe and Ito's colours, which colour-blind readers can tell apart; the yellow, too pale for a line, comes last.
inline constexpr std::array<std::string_view, 8> kPlotColors = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                                "#E69F00", "#56B4E9", "#000000", "#B8A800"};
inline constexpr std::array<int, 6> kPlotPoints = {7, 5, 9, 13, 11, 6};  // filled shapes first

[[nodiscard]] inline bool is_shown(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0) && (!plot.log_y || y > 0);
}

[[nodiscard]] inline bool has_points(const Plot& plot, const Series& s) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    if (is_shown(plot, s.x[i], s.y[i])) return true;
  }
  return false;
}

[[nodiscard]] inline std::string gnuplot_data(const Plot& plot, const Series& s, std::size_t number) {
  std::string text = fmt::format("$data{} << END\n", number);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    text += is_shown(plot, s.x[i], s.y[i]) ? fmt::format("{} {}\n", s.x[i], s.y[i]) : "NaN NaN\n";
  }
  return text + "END\n";
}

[[nodiscard]] inline std::string gnuplot_range(std::string_view axis, const Range& range) {
  const auto side = [](const std::optional<double>& limit) { return limit ? fmt::format("{}", *limit) : "*"; };
  return fmt::format("set {}range [{}:{}]\n", axis, side(range.min), side(range.max));
}

[[nodiscard]] inline std::string gnuplot_ticks(const std::vector<Tick>& ticks) {
  std::string list;
  for (const Tick& t : ticks) {
    list += fmt::format("{}{} {}", list.empty() ? "set xtics (" : ", ", gnuplot_quote(to_utf8(t.text)), t.at);
  }
  return list.empty() ? list : list + ")\n";
}

[[nodiscard]] inline std::string_view gnuplot_key(Legend legend) {
  switch (legend) {
    case Legend::TopLeft: return "set key inside top left Left reverse opaque\n";
    case Legend::TopRight: return "set key inside top right Right opaque\n";
    case Legend::BottomLeft: return "set key inside bottom left Left reverse opaque\n";
    case Legend::BottomRight: return "set key inside bottom right Right opaque\n";
    case Legend::Right: return "set key outside right top Left reverse\n";
    case Legend::None: return "unset key\n";
    case Legend::Below: break;
  }
  return "set key outside below center horizontal Left reverse height 0.8\n";
}

[[nodiscard]] inline std::string gnuplot_curve(const Series& s, std::size_t number) {
  const std::size_t color = s.color >= 0 ? static_cast<std::size_t>(s.color) : number;
  const std::size_t turn = s.color >= 0 ? 0 : number / kPlotColors.size();  // colours used up: next dash pattern
  const int point = kPlotPoints[color % kPlotPoints.size()];
  std::string with;
  switch (s.style) {
    case SeriesStyle::Line: with = fmt::format("lines lw 2 dt {}", 1 + turn % 5); break;
    case SeriesStyle::Dashed: with = "lines lw 2 dt (10,6)"; break;
    case SeriesStyle::Dotted: with = "lines lw 2 dt (2,4)"; break;
    case SeriesStyle::Points: with = fmt::format("points pt {} ps 0.8", point); break;
    case SeriesStyle::LinePoints: with = fmt::format("linespoints lw 2 pt {} ps 0.8", point); break;
  }
  return fmt::format("$data{} using 1:2 with {} lc rgb '{}' {}", number, with, kPlotColors[color % kPlotColors.size()],
                     s.name.empty() ? "notitle" : "title " + gnuplot_quote(to_utf8(s.name)));
}

inline void check_range(const Plot& plot, std::string_view axis, const Range& range, bool log) {
  for (const auto& limit : {range.min, range.max}) {
    if (limit && (!std::isfinite(*limit) || (log && *limit <= 0))) {
      fail("plot '{}': the {} range has the limit {}; it must be finite{}", plot.title, axis, *limit,
           log ? " and > 0 on a logarithmic axis" : "");
    }
  }
  if (range.min && range.max && !(*range.min < *range.max)) {
    fail("plot '{}': the {} range goes from {} to {}; its min must be below its max", plot.title, axis, *range.min,
         *range.max);
  }
}

}  // namespace detail

/// Throws dem::Error when a series has not as many y as x, a range is empty or (on a logarithmic axis) not positive,
/// the place of an annotation or a tick is not finite, or the size lies outside 100 to 10000 px.
inline void check_plot(const Plot& plot) {
  for (const Series& s : plot.series) {
    if (s.x.size() != s.y.size()) {
      fail("plot '{}': series '{}' has {} x and {} y values; give as many of both", plot.title, s.name, s.x.size(),
           s.y.size());
    }
  }
  for (const Annotation& a : plot.annotations) {
    if (!std::isfinite(a.x) || !std::isfinite(a.y)) {
      fail("plot '{}': annotation '{}' stands at ({}, {}); give finite values", plot.title, a.text, a.x, a.y);
    }
  }
  for (const Tick& t : plot.x_ticks) {
    if (!std::isfinite(t.at)) fail("plot '{}': tick '{}' stands at {}; give a finite value", plot.title, t.text, t.at);
  }
  for (const int size : {plot.width, plot.height}) {
    if (size < 100 || size > 10000) {
      fail("plot '{}': size {} x {} px; each side must be 100 to 10000 px", plot.title, plot.width, plot.height);
    }
  }
  detail::check_range(plot, "x", plot.x_range, plot.log_x);
  detail::check_range(plot, "y", plot.y_range, plot.log_y);
}

/// The gnuplot script, with the data in it, that draws `plot` into "<name>.svg" and "<name>.png" of the folder it is
/// run in. Throws dem::Error as check_plot() does.
[[nodiscard]] inline std::string gnuplot_script(const Plot& plot, std::string_view name) {
  check_plot(plot);
  std::string script =
      "# Draws the plot anew when run in this folder: gnuplot <this file>\nreset\nset encoding utf8\n\n";
  std::string curves;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    if (!detail::has_points(plot, plot.series[i])) continue;
    script += detail::gnuplot_data(plot, plot.series[i], i);
    curves += (curves.empty() ? "plot " : ", \\\n     ") + detail::gnuplot_curve(plot.series[i], i);
  }
  if (curves.empty()) curves = "plot NaN notitle";

  script += "\nset border 3 lw 1 lc rgb '#444444'\nset tics nomirror out textcolor rgb '#222222'\n";
  script += "set grid lt 1 lw 0.7 lc rgb '#D4D4D4' dt solid\nset style textbox opaque noborder\n";
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", gnuplot_quote(to_utf8(plot.title)),
                        gnuplot_quote(to_utf8(plot.x_label)), gnuplot_quote(to_utf8(plot.y_label)));
  if (plot.log_x) script += "set logscale x\n";
  if (plot.log_y) script += "set logscale y\n";
  script += detail::gnuplot_ticks(plot.x_ticks);
  script += detail::gnuplot_range("x", plot.x_range) + detail::gnuplot_range("y", plot.y_range);
  script += detail::gnuplot_key(plot.legend);
  for (const Annotation& a : plot.annotations) {
    script += fmt::format("set label {} at {},{} left front boxed{}\n", gnuplot_quote(to_utf8(a.text)), a.x, a.y,
                          a.point ? " point pt 7 ps 0.6 offset 0.8,0.4" : "");
  }

  // "./" keeps gnuplot from taking a name that starts with '|' for a command to pipe into.
  const std::string file = "./" + std::string(name);
  script += fmt::format(
      "\nset terminal svg size {},{} noenhanced background '#FFFFFF' font 'sans-serif,15'\n"
      "set title font ',18'\nset output {}\n{}\n",
      plot.width, plot.height, gnuplot_quote(file + ".svg"), curves);
  script += fmt::format(
      "\nset terminal pngcairo size {},{} noenhanced background '#FFFFFF' font 'Sans,11' fontscale 2 lw 2 ps 2\n"
      "set title font ',13'\nset output {}\nreplot\nunset output\n",
      2 * plot.width, 2 * plot.height, gnuplot_quote(file + ".png"));
  return script;
}

}  // namespace dem::io
