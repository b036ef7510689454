#include "catch.hpp"
#include "files.hpp"
#include "sleeping_bed.hpp"
#include "vtk_reader.hpp"

#include <dem/io/vtk_contacts.hpp>

#include <cstdint>
#include <map>
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
  CHECK(names ==
        "force normal_force friction overlap points on_surface grain other_grain surface force_on_grain_N Points "
        "connectivity offsets ");
  // Who touches whom, and with what force.
  CHECK(file.values<std::uint32_t>("grain") == std::vector<std::uint32_t>{3, 3, 3, 3});
  CHECK(file.values<std::int64_t>("other_grain") == std::vector<std::int64_t>{4, 4, -1, -1});
  CHECK(file.values<std::int32_t>("surface") == std::vector<std::int32_t>{-1, -1, 0, 0});
  CHECK(file.values<double>("force_on_grain_N") == std::vector<double>{0, 3, -4, 0, 3, -4, -7, 0, 0, -7, 0, 0});
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

TEST_CASE("contacts go into a series, a file each frame, and what grains bear is rebuilt from them") {
  const TempFolder folder;
  SleepingBed bed;
  dem::io::VtkSeries series(folder / "bed.pvd");
  dem::io::add_vtk_contacts(series, bed.world);
  REQUIRE(bed.world.run_for(1e-3));
  dem::io::add_vtk_contacts(series, bed.world);
  CHECK_THAT(dem::io::read_file(folder / "bed.pvd"),
             ContainsSubstring("bed/contacts_000000.vtp") && ContainsSubstring("bed/contacts_000001.vtp"));

  dem::io::write_vtk_contacts(folder / "chains.vtp", bed.world);
  const VtkContent file = read_vtk(folder / "chains.vtp");
  const auto grain = file.values<std::uint32_t>("grain");
  const auto other = file.values<std::int64_t>("other_grain");
  const auto surface = file.values<std::int32_t>("surface");
  const auto force = file.values<double>("force_on_grain_N");
  REQUIRE(force.size() == 3 * grain.size());
  Vec3 on_plane = Vec3::Zero();
  std::map<std::int64_t, Vec3> on_grain;
  for (std::size_t k = 0; k < grain.size(); k += 2) {
    const Vec3 f(force[3 * k], force[3 * k + 1], force[3 * k + 2]);
    CHECK((other[k] == -1) != (surface[k] == -1));
    on_grain.try_emplace(grain[k], Vec3::Zero()).first->second += f;
    if (surface[k] == 0) on_plane -= f;
    if (other[k] != -1) on_grain.try_emplace(other[k], Vec3::Zero()).first->second -= f;
  }
  REQUIRE(on_grain.size() == 8);
  for (const dem::GrainId p : bed.world.grains()) {
    if (p == bed.flier) continue;
    const double weight = 9.81 * bed.world.species(bed.world.species_of(p)).mass;
    CHECK((on_grain.at(p.value) - Vec3(0, 0, weight)).norm() < 0.01 * weight);
  }
  CHECK(on_plane.z() < 0.0);
}

TEST_CASE("lines that are none, and arrays that do not fit them, are refused") {
  const std::vector<double> five(5), twelve(12), three(3);
  CHECK_THAT(error_of([&] { dem::io::write_vtk_lines("x.vtp", five); }), ContainsSubstring("no multiple of 6"));
  CHECK_THAT(error_of([&] {
               dem::io::write_vtk_lines("x.vtp", twelve, {{"a", 1, std::span<const double>(three)}});
             }),
             ContainsSubstring("array 'a' has 3 values, but 2 lines"));
}
