#include "catch.hpp"
#include "files.hpp"
#include "sleeping_bed.hpp"
#include "vtk_reader.hpp"

#include <dem/io/vtk_contacts.hpp>

#include <cstdint>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;
using dem::ForceLine;
using dem::Vec3;

TEST_CASE("force chains are written as lines with their forces at both ends") {
  const TempFolder folder;
  ForceLine pair, wall;
  pair.from = {0, 0, 0};
  pair.to = {0, 0, 2};
  pair.grain = dem::GrainId(3);
  pair.other_grain = dem::GrainId(4);
  pair.force = {0, 3, -4};
  pair.normal_force = 4.0;
  pair.friction = {0, 3, 0};
  pair.overlap = 0.01;
  pair.points = 2;
  wall = pair;
  wall.other_grain = {};
  wall.surface = dem::SurfaceId(0);
  wall.to = {1, 0, 0};
  wall.force = {-7, 0, 0};
  dem::io::write_vtk_force_lines(folder / "chains.vtp", {pair, wall});

  const VtkContent file = read_vtk(folder / "chains.vtp");
  CHECK(file.tag("Piece").at("NumberOfPoints") == "4");
  CHECK(file.tag("Piece").at("NumberOfLines") == "2");
  CHECK(file.values<double>("force") == std::vector<double>{5, 5, 7, 7});
  CHECK(file.values<std::int32_t>("on_surface") == std::vector<std::int32_t>{0, 0, 1, 1});
  CHECK(file.values<double>("Points").at(5) == 2.0);
  CHECK(file.values<std::int32_t>("offsets") == std::vector<std::int32_t>{2, 4});
  std::string names;
  for (const auto& tag : file.tags) {
    if (tag.name == "DataArray") names += tag.at("Name") + " ";
  }
  CHECK(names == "force normal_force friction overlap points on_surface grain Points connectivity offsets ");
}

TEST_CASE("the force chains of a world are those of its contacts, by the numbers of its grains") {
  const TempFolder folder;
  const SleepingBed bed;
  dem::io::write_vtk_contacts(folder / "chains.vtp", bed.world);
  const auto lines = dem::force_lines(dem::contacts_of(bed.world));
  REQUIRE(lines.size() == 8);  // under each cube of the towers
  const VtkContent file = read_vtk(folder / "chains.vtp");
  const auto grain = file.values<std::uint32_t>("grain");
  const auto force = file.values<double>("force");
  REQUIRE(grain.size() == 2 * lines.size());
  for (std::size_t k = 0; k < grain.size(); ++k) {
    CHECK(grain[k] == lines[k / 2].grain.value);
    CHECK(force[k] == lines[k / 2].force.norm());
  }
}

TEST_CASE("lines that are none, and arrays that do not fit them, are refused") {
  const std::vector<double> five(5), twelve(12), three(3);
  CHECK_THAT(error_of([&] { dem::io::write_vtk_lines("x.vtp", five); }), ContainsSubstring("no multiple of 6"));
  CHECK_THAT(error_of([&] {
               dem::io::write_vtk_lines("x.vtp", twelve, {{"a", 1, std::span<const double>(three)}});
             }),
             ContainsSubstring("array 'a' has 3 values, but 2 lines"));
}
