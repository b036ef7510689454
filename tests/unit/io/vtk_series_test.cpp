// What runs that follow each other leave of a series.

#include "catch.hpp"
#include "files.hpp"
#include "io/xml.hpp"

#include <dem/io/checkpoint/fields.hpp>
#include <dem/io/vtk.hpp>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;
using dem::io::read_file;
using dem::io::VtkSeries;
using dem::io::write_file;
using dem::io::write_vtk_points;

TEST_CASE("an older collection stays until there is something new, or until a state of it is restored") {
  const TempFolder folder;
  const auto pvd = folder / "run.pvd";
  const auto add = [](VtkSeries& series, double time) {
    const auto path = series.next_path("grains");
    write_vtk_points(path, std::vector<double>{0, 0, 0});
    series.add(time, path, "grains");
  };
  const auto numbers = [&] {
    std::string list;
    for (std::size_t k = 0; k < 10; ++k) {
      if (std::filesystem::exists(folder.path() / fmt::format("run/grains_{:06}.vtp", k))) list += std::to_string(k);
    }
    return list;
  };
  const auto age = [&] {  // as if some time went by between two runs
    for (const auto& entry : std::filesystem::directory_iterator(folder / "run")) {
      std::filesystem::last_write_time(entry, entry.last_write_time() - std::chrono::seconds(10));
    }
  };
  dem::io::StateColumns kept;
  {
    VtkSeries first(pvd);
    for (int k = 0; k < 3; ++k) add(first, k);
    dem::io::Fields collect(dem::io::Fields::Task::collect, kept);
    collect("series", first);
    for (int k = 3; k < 5; ++k) add(first, k);
  }
  age();
  const std::string whole = read_file(pvd);
  { const VtkSeries refused(pvd); }
  CHECK(read_file(pvd) == whole);
  CHECK(numbers() == "01234");

  // A run that goes on after the third frame, and ends sooner.
  {
    VtkSeries resumed(pvd);
    dem::io::Fields restore(dem::io::Fields::Task::restore, kept);
    restore("series", resumed);
    CHECK(XmlReader::tags(read_file(pvd)).size() == 2 + 3);
    CHECK(resumed.next_path("grains").filename() == "grains_000003.vtp");
    add(resumed, 2.5);
    CHECK(numbers() == "0123");
    CHECK_THAT(error_of([&] { add(resumed, 2.0); }), ContainsSubstring("add in the order of time"));
  }
  age();

  // A run that begins anew: what another part, other programs and other folders have stays.
  std::filesystem::remove(folder / "run/grains_000004.vtp");
  for (const char* other : {"run/walls_000002.vtp", "run/grains_000002.vti", "run/grains_2.vtp",
                            "run/grains_00000x.vtp", "run/more_grains_000002.vtp", "grains_000002.vtp"}) {
    write_file(folder / other, "mine");
  }
  age();
  VtkSeries anew(pvd);
  add(anew, 0.0);
  CHECK(numbers() == "0");
  CHECK(XmlReader::tags(read_file(pvd)).size() == 2 + 1);
  for (const char* other : {"run/walls_000002.vtp", "run/grains_000002.vti", "run/grains_2.vtp",
                            "run/grains_00000x.vtp", "run/more_grains_000002.vtp", "grains_000002.vtp"}) {
    CHECK(std::filesystem::exists(folder / other));
  }
  for (int k = 1; k < 4; ++k) add(anew, k);
  CHECK(numbers() == "0123");
  age();

  // A collection made again of frames that are there keeps them all.
  std::filesystem::remove(pvd);
  VtkSeries again(pvd);
  for (int k = 0; k < 4; ++k) again.add(k, again.next_path("grains"), "grains");
  CHECK(numbers() == "0123");
  CHECK(XmlReader::tags(read_file(pvd)).size() == 2 + 4);
}

TEST_CASE("a series takes times that go on, and a numbered file once") {
  const TempFolder folder;
  const std::string pvd = (folder / "a.pvd").string();
  VtkSeries series(pvd);
  const auto path = series.next_path("grains");
  series.add(0.25, path, "grains");
  CHECK(error_of([&] { series.add(0.5, path, "grains"); }) ==
        "vtk series '" + pvd + "': 'a/grains_000000.vtp' is in it already; ask next_path() for each file");
  CHECK(error_of([&] { series.add(0.125, series.next_path("grains"), "grains"); }) ==
        "vtk series '" + pvd +
            "': 'a/grains_000001.vtp' is of 0.125 s, but part 'grains' has one of 0.25 s; add in the order of time");
  series.add(0.125, series.next_path("walls"), "walls");  // of another part
  series.add(0.25, series.next_path("grains"), "grains");
  CHECK(XmlReader::tags(read_file(pvd)).size() == 2 + 3);
}
