#include "catch.hpp"
#include "io/files.hpp"
#include "io/xml.hpp"

#include <dem/report/plot.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace plot_test {

using namespace dem::io;
using Catch::Matchers::ContainsSubstring;

namespace {

Plot small_plot() {
  Plot plot{.title = "Shear", .x_label = "u [mm]", .y_label = "τ [kPa]"};
  plot.series.push_back({.name = "dense", .x = {0, 1, 2}, .y = {0, 3, 2.5}});
  return plot;
}

bool gnuplot_is_there() {
  if (find_program("gnuplot")) return true;
  WARN("no gnuplot along PATH: drawing is not tested");
  return false;
}

}  // namespace

TEST_CASE("text in a gnuplot script stays text") {
  CHECK(gnuplot_quote("plain") == "'plain'");
  CHECK(gnuplot_quote("it's \"so\" `rm` \\n $x @m") == "'it'.\"'\".'s \"so\" `rm` \\n $x @m'");
  CHECK(gnuplot_quote("two\nlines") == "'two'.\"\\n\".'lines'");
  CHECK(gnuplot_quote("a\tb\x01\x7f") == "'a b  '");
}

TEST_CASE("a gnuplot script holds data, styles and output names") {
  Plot plot = small_plot();
  plot.series.push_back(
      {.name = "it's", .x = {1, 2, 3}, .y = {1, std::nan(""), 0.1}, .style = SeriesStyle::Dashed, .color = 0});
  plot.series.push_back({.name = "all gaps", .x = {1}, .y = {std::nan("")}});
  plot.series.push_back({.x = {1}, .y = {1}, .style = SeriesStyle::Points});
  plot.x_range = {0, 2.5};
  plot.y_range = {.max = 4};
  plot.annotations = {{1, 3, "peak", true}};
  CHECK_THAT(gnuplot_script(plot, "shear"), !ContainsSubstring("set xtics"));
  plot.x_ticks = {{1, "one's"}, {2, "two"}};
  const std::string script = gnuplot_script(plot, "shear");
  CHECK_THAT(script, ContainsSubstring("set xtics ('one'.\"'\".'s' 1, 'two' 2)\n"));
  CHECK_THAT(script, ContainsSubstring("$data0 << END\n0 0\n1 3\n2 2.5\nEND\n"));
  CHECK_THAT(script, ContainsSubstring("$data1 << END\n1 1\nNaN NaN\n3 0.1\nEND\n"));
  CHECK_THAT(script, !ContainsSubstring("$data2"));
  CHECK_THAT(script, ContainsSubstring("set title 'Shear'\nset xlabel 'u [mm]'\nset ylabel 'τ [kPa]'\n"));
  CHECK_THAT(script, ContainsSubstring("set xrange [0:2.5]\nset yrange [*:4]\n"));
  CHECK_THAT(script, ContainsSubstring("set label 'peak' at 1,3 left front boxed point"));
  CHECK_THAT(script, ContainsSubstring(
                         "plot $data0 using 1:2 with lines lw 2 dt 1 lc rgb '#0072B2' title 'dense', \\\n"
                         "     $data1 using 1:2 with lines lw 2 dt (10,6) lc rgb '#0072B2' title 'it'.\"'\".'s', \\\n"
                         "     $data3 using 1:2 with points pt 13 ps 0.8 lc rgb '#CC79A7' notitle\n"));
  CHECK_THAT(script,
             ContainsSubstring("set output './shear.svg'\n") && ContainsSubstring("set output './shear.png'\n"));
}

TEST_CASE("a logarithmic axis leaves out what it cannot show") {
  Plot plot = small_plot();
  plot.log_x = true;
  const std::string script = gnuplot_script(plot, "a");
  CHECK_THAT(script, ContainsSubstring("set logscale x\n") && ContainsSubstring("$data0 << END\nNaN NaN\n1 3\n"));
}

TEST_CASE("a wrong plot is refused") {
  const auto error_with = [](auto&& change) {
    Plot plot = small_plot();
    change(plot);
    return error_of([&] { check_plot(plot); });
  };
  CHECK(error_with([](Plot& p) { p.series[0].x.pop_back(); }) ==
        "plot 'Shear': series 'dense' has 2 x and 3 y values; give as many of both");
  CHECK(error_with([](Plot& p) {
          p.x_range = {1, 1};
        }) == "plot 'Shear': the x range goes from 1 to 1; its min must be below its max");
  CHECK(error_with([](Plot& p) {
          p.y_range = {0, 1};
          p.log_y = true;
        }) == "plot 'Shear': the y range has the limit 0; it must be finite and > 0 on a logarithmic axis");
  CHECK(error_with([](Plot& p) { p.y_range.min = -1.0 / 0.0; }) ==
        "plot 'Shear': the y range has the limit -inf; it must be finite");
  CHECK(error_with([](Plot& p) {
          p.annotations = {{0, 1.0 / 0.0, "here"}};
        }) == "plot 'Shear': annotation 'here' stands at (0, inf); give finite values");
  CHECK(error_with([](Plot& p) { p.width = 50; }) ==
        "plot 'Shear': size 50 x 500 px; each side must be 100 to 10000 px");
  const TempFolder folder;
  CHECK(error_of([&] { render_plot(small_plot(), folder / "two\nlines"); }) ==
        "plot 'Shear': 'two lines' cannot name its files; give a name without control characters");
}

TEST_CASE("without gnuplot the script is written and the reason told") {
  const TempFolder folder;
  write_file(folder / "a.svg", "an older plot");
  const PlotResult result = render_plot(small_plot(), folder / "a", "no-such-program");
  CHECK(!result);
  CHECK(result.reason ==
        "no program 'no-such-program' along PATH; install gnuplot and run it on " + (folder / "a.gp").string());
  CHECK(result.svg.empty());
  CHECK(read_file(result.script) == gnuplot_script(small_plot(), "a"));
  CHECK(!std::filesystem::exists(folder / "a.svg"));
}

TEST_CASE("a plot without data is not drawn") {
  const TempFolder folder;
  const PlotResult result = render_plot(Plot{.title = "empty"}, folder / "a");
  CHECK(!result);
  CHECK(result.reason == "the plot has no finite data");
}

TEST_CASE("a plot program that fails is told with its last words") {
  const TempFolder folder;
  const auto script = folder / "fake";
  write_file(script, "#!/bin/sh\necho first >&2\necho ' last words' >&2\nexit 3\n");
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
  const PlotResult result = render_plot(small_plot(), folder / "a", "fake");
  ::setenv("PATH", path.c_str(), 1);
  CHECK(result.reason == "gnuplot ended with code 3:  last words");
}

TEST_CASE("a picture that is empty or cut off, as on a full disk, does not count as drawn") {
  const TempFolder folder;
  const auto program = folder / "fake";
  const std::string path = std::getenv("PATH");
  const std::string svg = "<svg></svg>\n", png = "\\211PNG IEND\\256B\\140\\202";
  const auto drawn_by = [&](const std::string& svg_bytes, const std::string& png_bytes) {
    write_file(program, "#!/bin/sh\nprintf '" + svg_bytes + "' > a.svg\nprintf '" + png_bytes + "' > a.png\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("PATH", (folder.path().string() + ":" + path).c_str(), 1);
    const PlotResult result = render_plot(small_plot(), folder / "a", "fake");
    ::setenv("PATH", path.c_str(), 1);
    CHECK(result.rendered == std::filesystem::exists(folder / "a.svg"));
    CHECK(result.rendered == std::filesystem::exists(folder / "a.png"));
    return result;
  };
  CHECK(drawn_by(svg, png));
  for (const auto& [s, p] : {std::pair{std::string(), png}, {svg, std::string()}, {"<svg><path", png}, {svg, "PNG"}}) {
    CHECK(drawn_by(s, p).reason == "gnuplot left no whole pictures; check that the disk is not full");
  }
}

TEST_CASE("names that are no UTF-8 leave a script and a picture that are") {
  Plot plot = small_plot();
  plot.title = plot.x_label = plot.y_label = plot.series[0].name = "a\xFF\xE9t";
  plot.annotations = {{1, 1, "\xC0\xAF"}};
  const std::string script = gnuplot_script(plot, "a");
  CHECK(script == to_utf8(script));
  CHECK_THAT(script, ContainsSubstring("set title 'a\xEF\xBF\xBD\xEF\xBF\xBDt'"));
  if (!gnuplot_is_there()) return;
  const TempFolder folder;
  const PlotResult result = render_plot(plot, folder / "b\xFF");  // a name of a file may be any bytes
  INFO(result.reason);
  REQUIRE(result);
  const std::string svg = read_file(result.svg);
  CHECK(svg == to_utf8(svg));
}

TEST_CASE("gnuplot draws svg and png") {
  if (!gnuplot_is_there()) return;
  const TempFolder folder;
  const PlotResult result = render_plot(small_plot(), folder / "new/shear");
  INFO(result.reason);
  REQUIRE(result);
  CHECK(result.reason.empty());
  CHECK(read_file(result.png).substr(0, 8) == "\x89PNG\r\n\x1a\n");
  CHECK_THAT(read_file(result.svg),
             ContainsSubstring("<svg") && ContainsSubstring("</svg>") && ContainsSubstring("τ [kPa]"));
}

TEST_CASE("neither texts nor file names can make gnuplot run anything") {
  if (!gnuplot_is_there()) return;
  const TempFolder folder;
  const std::string command = "touch " + (folder / "ran").string();
  Plot plot = small_plot();
  plot.title = "a' . system('" + command + "') . '`" + command + "` <&> \"";
  plot.x_label = "`" + command + "`\n`" + command + "`";
  plot.series[0].name = "', 0 `" + command + "` {x}^2_3 $(" + command + ") \\";
  plot.annotations = {{1, 1, "END\n`" + command + "`"}};
  plot.legend = Legend::TopLeft;
  for (const auto* name : {"plain", "|touch ran", "`touch ran`", "a'b\"c", "-e", "$x; touch ran", "~", "@a", "#b"}) {
    const PlotResult result = render_plot(plot, folder / name);
    INFO(name << ": " << result.reason);
    CHECK(result.rendered);
    CHECK(std::filesystem::exists(result.svg));
  }
  CHECK(!std::filesystem::exists(folder / "ran"));
  CHECK_THAT(read_file(folder / "plain.svg"), ContainsSubstring("{x}^2_3"));
}

}  // namespace plot_test
