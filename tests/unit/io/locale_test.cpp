#include "catch.hpp"
#include "comma_locale.hpp"
#include "files.hpp"

#include <dem/io/csv.hpp>
#include <dem/io/obj.hpp>
#include <dem/io/stl.hpp>
#include <dem/io/vtk.hpp>
#include <dem/report/replay_encode.hpp>
#include <dem/report/report.hpp>
#include <dem/soil/packing_file.hpp>

#include <string>
#include <utility>
#include <vector>

// Files and messages are the same in every locale: 0.5 is never 0,5, and a million never 1.000.000.

using namespace dem::io;
using dem::Vec3;

namespace {

dem::IndexedMesh tetrahedron() {
  return {{{0, 0, 0}, {0.5, 0, 0}, {0, 1234.5, 0}, {0, 0, 1e-7}}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}};
}

dem::soil::Packing packing() {
  return {0.5e-3, 1234.5, 0.06, "note 0.5", {{Vec3(0.25, -1e-3, 12345.5), dem::Mat3::Identity()}}};
}

/// All files that the library writes, and the texts that it shows, one after the other.
std::vector<std::pair<std::string, std::string>> written() {
  const TempFolder folder;
  std::vector<std::pair<std::string, std::string>> all;
  const auto keep = [&](const char* name) { all.emplace_back(name, read_file(folder / name)); };

  CsvWriter csv(folder / "a.csv", {"x", "y", "n"});
  csv.row(0.5, 1234567.25, 1234567);
  csv.row(std::vector<double>{1e-9, -0.125, 1e15});
  csv.flush();
  keep("a.csv");

  write_stl(folder / "a.stl", tetrahedron());
  keep("a.stl");
  dem::soil::save_packing(packing(), folder / "packing.txt");
  keep("packing.txt");

  const std::vector<double> places = {0.5, 1.5, 2.5, 1e6, 0, 0};
  write_vtk_points(folder / "a.vtp", places, {}, {.single_precision = false, .time_s = 1234.5});
  keep("a.vtp");
  const SurfaceMesh box = box_mesh({0.5, 0.5, 0.5});
  write_vtk_bodies(folder / "b.vtp", {{&box}}, {}, {.single_precision = true, .time_s = 0.25});
  keep("b.vtp");
  VtkSeries series(folder / "a.pvd");
  series.add(1234.5, series.next_path("grains"), "grains");
  keep("a.pvd");

  const Plot plot = {.title = "t",
                     .series = {{.name = "s", .x = {0.5, 1234567.5}, .y = {1e-3, 2.5}}},
                     .x_range = {.min = 0.25, .max = 2e6},
                     .annotations = {{0.5, 1.5, "here", true}}};
  all.emplace_back("script", gnuplot_script(plot, "plot"));

  Table table{.header = {"number", "count"}};
  table.row(1234.5, 1234567);
  all.emplace_back("table", to_text(table));
  HtmlReport report("r");
  report.table(table).settings({{"a", format_number(0.125)}});
  all.emplace_back("html", report.html());

  dem::report::Replay replay({.frames = 3, .force_lines = 5});
  for (const double t : {0.0, 0.25}) {
    const std::vector<dem::report::ReplayForce> forces = {
        {3, 7, true, Vec3(0.5 + t, -20.25, 1234.5), Vec3(0.5, -20.5, 1234), 1234.5 + t}};
    replay.record(t, {}, {}, forces);
  }
  const dem::report::EncodedReplay encoded = dem::report::encode(replay);
  all.emplace_back("replay", encoded.head + encoded.bytes);

  Captured out;
  double now = 0;
  Progress progress({.out = out.file(), .terminal = false, .clock = [&] { return now; }});
  progress.begin("run", 2.5);
  now = 61.5;
  progress.update(1.25);
  all.emplace_back("progress", out.take());
  all.emplace_back("error", error_of([] { dem::fail("{:g} m of {} grains, {}", 0.5, 1234567, 1e6 + 0.25); }));
  all.emplace_back("duration", format_duration(9.5));
  return all;
}

}  // namespace

TEST_CASE("what is written and shown is the same under a locale with commas") {
  const auto expected = written();
  const CommaLocale commas;
  const auto found = written();
  REQUIRE(found.size() == expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    INFO(expected[k].first);
    CHECK(found[k].second == expected[k].second);
  }
}

TEST_CASE("what was written is read back under a locale with commas") {
  const CommaLocale commas;
  const TempFolder folder;
  dem::soil::save_packing(packing(), folder / "packing.txt");
  const dem::soil::Packing p = dem::soil::load_packing(folder / "packing.txt");
  CHECK(p.half_edge == 0.5e-3);
  CHECK(p.length_x == 1234.5);
  CHECK(p.note == "note 0.5");
  REQUIRE(p.grains.size() == 1);
  CHECK(p.grains[0].position == Vec3(0.25, -1e-3, 12345.5));

  write_stl(folder / "a.stl", tetrahedron());
  CHECK(read_stl(folder / "a.stl").corner(0, 1) == Vec3(0, 1234.5, 0));
  const std::string facet =
      "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0.5 1234.5 -1e-3\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid s\n";
  CHECK(parse_stl(facet, "f").vertices[0] == Vec3(0.5, 1234.5, -1e-3));
  CHECK(parse_obj("v 0.5 1234.5 -1e-3\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "f").vertices[0] == Vec3(0.5, 1234.5, -1e-3));
  // Numbers with commas are no numbers, here as elsewhere.
  CHECK(error_of([] { (void)parse_obj("v 0,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "f"); }).find("'0,5'") !=
        std::string::npos);
}
