#include <dem/terramechanics/rut_files.hpp>
#include <dem/terramechanics/rut_vtk.hpp>

#include "catch.hpp"
#include "io/files.hpp"
#include "io/vtk_reader.hpp"

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

/// 3 x 2 columns: the surface is 0.1 m high, but for a rut of 0.04 m at (2, 0) and a heap of 0.01 m at (0, 1).
ColumnField small() {
  ColumnField f;
  f.grid = {1.0, 2.0, 0.5, 3, 2};
  f.resize(0.1);
  f.sunk[f.grid.row(2, 0)] = 0.04;
  f.pressure[f.grid.row(2, 0)] = 5e4;
  f.shear[f.grid.row(2, 0)].mobilised = {0.3, 0.4, 0.0};
  f.heap[f.grid.row(0, 1)] += 0.01;
  return f;
}

}  // namespace

TEST_CASE("a rut is written as a table") {
  const TempFolder folder;
  write_rut_csv(folder / "rut.csv", small());
  CHECK(io::read_file(folder / "rut.csv") ==
        "x_m,y_m,height_m,sunk_m,heap_m,pressure_Pa,shear_share\n"
        "1.25,2.25,0.1,0,0,0,0\n"
        "1.75,2.25,0.1,0,0,0,0\n"
        "2.25,2.25,0.06,0.04,0,50000,0.5\n"
        "1.25,2.75,0.11,0,0.01,0,0\n"
        "1.75,2.75,0.1,0,0,0,0\n"
        "2.25,2.75,0.1,0,0,0,0\n");
}

TEST_CASE("a rut is written as a grey picture, y upwards") {
  const TempFolder folder;
  write_rut_pgm(folder / "rut.pgm", small());
  const std::string text = io::read_file(folder / "rut.pgm");
  CHECK_THAT(text, ContainsSubstring("P5\n# height in m: black 0.06, white 0.11; 0.5 m a pixel\n3 2\n65535\n"));
  REQUIRE(text.size() > 12);
  const auto pixel = [&](std::size_t k) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(text.data()) + text.size() - 12 + 2 * k;
    return 256 * bytes[0] + bytes[1];
  };
  CHECK(pixel(0) == 65535);  // the heap, in the upper row
  CHECK(pixel(1) == 52428);  // level: four fifths
  CHECK(pixel(5) == 0);      // the rut
  ColumnField flat = small();
  flat.resize(0.2);
  CHECK_NOTHROW(write_rut_pgm(folder / "flat.pgm", flat));
}

TEST_CASE("a rut is written for ParaView") {
  const TempFolder folder;
  const ColumnField f = small();
  write_rut_vtk(folder / "rut.vtp", f, {.single_precision = false});
  const std::string text = io::read_file(folder / "rut.vtp");
  CHECK_THAT(text, ContainsSubstring("NumberOfPoints=\"6\""));
  CHECK_THAT(text, ContainsSubstring("NumberOfPolys=\"2\""));
  const VtkContent file = read_vtk(folder / "rut.vtp");
  CHECK(file.values<double>("sunk_m").at(2) == 0.04);                  // of (2, 0)
  CHECK(file.values<double>("heap_m").at(3) == Approx(0.01));          // of (0, 1)
  CHECK(file.values<double>("Points").at(3 * 2 + 2) == Approx(0.06));  // z of (2, 0)
  ColumnField line;
  line.grid = {0.0, 0.0, 1.0, 5, 1};
  line.resize(0.0);
  CHECK_THROWS_WITH(write_rut_vtk(folder / "line.vtp", line), ContainsSubstring("make no surface"));
  io::VtkSeries series(folder / "drive.pvd");
  add_vtk_frame(series, 0.5, f);
  add_vtk_frame(series, 1.0, f);
  CHECK(std::filesystem::exists(folder / "drive" / "soil_000001.vtp"));
  CHECK_THAT(io::read_file(series.path()), ContainsSubstring("timestep=\"1\""));
}
