#pragma once
// Maps of a quantity over two others, drawn by gnuplot, where it is installed.

#include <dem/report/plot.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace dem::io {

/// A quantity over two others on a regular grid: a coloured rectangle a cell. Cells that are not finite are grey.
struct HeatMap {
  std::string title = {};
  std::string x_label = {}, y_label = {}, c_label = {};
  std::vector<double> x = {}, y = {};                   ///< middles of the cells, ascending
  std::vector<double> value = {};                       ///< of the cell (i, k) at k * x.size() + i
  std::vector<std::string> texts = {};                  ///< in the cells, as many as values; or none
  std::vector<std::string> x_ticks = {}, y_ticks = {};  ///< at the middles of the cells, instead of numbers
  Range range = {};                                     ///< of the colours
  bool is_soil = false;           ///< colours of soil, for heights; else from dark violet to yellow
  bool same_scale = false;        ///< of both axes
  int width = 900, height = 560;  ///< [px] of the SVG; the PNG has twice as many
};

namespace detail {

/// Half of the way from a middle to the next one, or back.
inline double cell_edge(const std::vector<double>& x, std::size_t k, bool upper) {
  if (x.size() < 2) return x[k] + (upper ? 0.5 : -0.5);
  const std::size_t to = upper ? (k + 1 < x.size() ? k + 1 : k - 1) : (k > 0 ? k - 1 : 1);
  const double half = 0.5 * std::abs(x[to] - x[k]);
  return upper ? x[k] + half : x[k] - half;
}

/// Words instead of numbers along an axis, if there are any. gnuplot reads them as formats of the number.
inline std::string gnuplot_ticks(std::string_view axis, const std::vector<double>& at,
                                 const std::vector<std::string>& words) {
  if (words.empty()) return {};
  std::string ticks;
  for (std::size_t k = 0; k < std::min(at.size(), words.size()); ++k) {
    std::string word = to_utf8(words[k]);
    for (std::size_t i = word.find('%'); i != std::string::npos; i = word.find('%', i + 2)) word.insert(i, 1, '%');
    ticks += (ticks.empty() ? "" : ", ") + gnuplot_quote(word) + fmt::format(" {}", at[k]);
  }
  return fmt::format("set {}tics ({})\n", axis, ticks);
}

}  // namespace detail

/// Throws dem::Error unless there is a value for each cell, and texts for all or none.
inline void check_map(const HeatMap& map) {
  const std::size_t cells = map.x.size() * map.y.size();
  if (cells == 0 || map.value.size() != cells || !(map.texts.empty() || map.texts.size() == cells)) {
    fail("map '{}': {} x {} cells have {} values and {} texts; give one of each for each cell, or no texts", map.title,
         map.x.size(), map.y.size(), map.value.size(), map.texts.size());
  }
  for (const auto* axis : {&map.x, &map.y}) {
    for (std::size_t k = 1; k < axis->size(); ++k) {
      if (!((*axis)[k] > (*axis)[k - 1])) fail("map '{}': its cells do not ascend along an axis; sort them", map.title);
    }
  }
}

/// The gnuplot script, with the data in it, that draws a map into "<name>.svg" and "<name>.png" of the folder it is run
/// in. Throws dem::Error as check_map() does.
[[nodiscard]] inline std::string gnuplot_script(const HeatMap& map, std::string_view name) {
  check_map(map);
  std::string script =
      "# Draws the map anew when run in this folder: gnuplot <this file>\nreset\nset encoding utf8\n\n";
  script += "$cells << END\n";
  std::string empty = "$empty << END\n", labels;
  bool any = false, any_empty = false;
  for (std::size_t k = 0; k < map.y.size(); ++k) {
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      const double v = map.value[k * map.x.size() + i];
      const std::string box = fmt::format("{} {} {} {} {} {}", map.x[i], map.y[k], detail::cell_edge(map.x, i, false),
                                          detail::cell_edge(map.x, i, true), detail::cell_edge(map.y, k, false),
                                          detail::cell_edge(map.y, k, true));
      (std::isfinite(v) ? script : empty) += box + fmt::format(" {}\n", std::isfinite(v) ? v : 0.0);
      (std::isfinite(v) ? any : any_empty) = true;
      if (map.texts.empty()) continue;
      labels += fmt::format("set label {} at {},{} center front textcolor rgb '{}'\n",
                            gnuplot_quote(to_utf8(map.texts[k * map.x.size() + i])), map.x[i], map.y[k],
                            std::isfinite(v) ? "#FFFFFF" : "#444444");
    }
  }
  script +=
      "END\n" + empty + "END\n\nset border lw 1 lc rgb '#444444'\nset tics out textcolor rgb '#222222'\nunset key\n";
  script += map.is_soil ? "set palette defined (0 '#2a1c10', 0.5 '#a5895a', 0.8 '#d9bd86', 1 '#fff6d8')\n"
                        : "set palette defined (0 '#352a6b', 0.35 '#2a6f8f', 0.7 '#3c9a5f', 1 '#b58a00')\n";
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset cblabel {}\n",
                        gnuplot_quote(to_utf8(map.title)), gnuplot_quote(to_utf8(map.x_label)),
                        gnuplot_quote(to_utf8(map.y_label)), gnuplot_quote(to_utf8(map.c_label)));
  script += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", detail::cell_edge(map.x, 0, false),
                        detail::cell_edge(map.x, map.x.size() - 1, true), detail::cell_edge(map.y, 0, false),
                        detail::cell_edge(map.y, map.y.size() - 1, true));
  script += detail::gnuplot_ticks("x", map.x, map.x_ticks) + detail::gnuplot_ticks("y", map.y, map.y_ticks);
  script += detail::gnuplot_range("cb", map.range) + labels;
  if (map.same_scale) script += "set size ratio -1\n";
  std::string curves;
  // Rectangles that touch are drawn with seams between them: a map of many cells is an image.
  const bool is_image = !any_empty && map.texts.empty() && map.x.size() > 1 && map.y.size() > 1;
  if (is_image) curves = "$cells using 1:2:7 with image pixels";
  else if (any) curves = "$cells using 1:2:3:4:5:6:7 with boxxyerror fs solid noborder lc palette";
  if (any_empty) {
    curves += (any ? ", \\\n     " : "") +
              std::string("$empty using 1:2:3:4:5:6 with boxxyerror fs solid noborder lc rgb '#E3E3E3'");
  }
  curves = "plot " + curves;
  const std::string file = "./" + std::string(name);
  script += fmt::format(
      "\nset terminal svg size {},{} noenhanced background '#FFFFFF' font 'sans-serif,15'\nset output {}\n{}\n",
      map.width, map.height, gnuplot_quote(file + ".svg"), curves);
  script += fmt::format(
      "\nset terminal pngcairo size {},{} noenhanced background '#FFFFFF' font 'Sans,11' fontscale 2 lw 2\n"
      "set output {}\nreplot\nunset output\n",
      2 * map.width, 2 * map.height, gnuplot_quote(file + ".png"));
  return script;
}

/// Draws `map` to `<base>.svg` and `<base>.png`, and writes `<base>.gp`, as render_plot() does; likewise a map that
/// cannot be drawn is no error. Throws dem::Error for a wrong map, and what render_plot() throws.
inline PlotResult render_map(const HeatMap& map, const std::filesystem::path& base,
                             std::string_view gnuplot = "gnuplot") {
  return detail::render_script(gnuplot_script(map, detail::checked_name(map.title, base)), true, base, gnuplot);
}

}  // namespace dem::io
