#include "catch.hpp"
#include "files.hpp"
#include "xml.hpp"

#include <dem/io/vtk_contacts.hpp>

#include <cstring>
#include <string>

using Catch::Matchers::ContainsSubstring;
using dem::ForceLine;
using dem::Vec3;

TEST_CASE("force chains are written as lines with their forces at both ends") {
  const TempFolder folder;
  ForceLine pair, wall;
  pair.from = {0, 0, 0};
  pair.to = {0, 0, 2};
  pair.grain = dem::ParticleId(3);
  pair.other_grain = dem::ParticleId(4);
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

  const std::string file = dem::io::read_file(folder / "chains.vtp");
  const std::string mark = "<AppendedData encoding=\"raw\">\n_";
  const auto at = file.find(mark);
  REQUIRE(at != std::string::npos);
  const auto tags = XmlReader::tags(file.substr(0, at) + "</VTKFile>");
  std::string names;
  for (const auto& tag : tags) {
    if (tag.name == "Piece") {
      CHECK(tag.at("NumberOfPoints") == "4");
      CHECK(tag.at("NumberOfLines") == "2");
    }
    if (tag.name != "DataArray") continue;
    names += tag.at("Name") + " ";
    const std::size_t from = at + mark.size() + std::stoul(tag.at("offset")) + 8;
    const auto number = [&]<class T>(std::size_t k, T value) {
      std::memcpy(&value, file.data() + from + k * sizeof(T), sizeof(T));
      return value;
    };
    if (tag.at("Name") == "force") {
      for (const std::size_t k : {0, 1}) CHECK(number(k, 0.0) == 5.0);
      for (const std::size_t k : {2, 3}) CHECK(number(k, 0.0) == 7.0);
    }
    if (tag.at("Name") == "on_surface") {
      for (const std::size_t k : {0, 1, 2, 3}) CHECK(number(k, std::int32_t{9}) == (k < 2 ? 0 : 1));
    }
    if (tag.at("Name") == "Points") CHECK(number(5, 0.0) == 2.0);
    if (tag.at("Name") == "offsets") CHECK(number(1, std::int32_t{0}) == 4);
  }
  CHECK(names == "force normal_force friction overlap points on_surface grain Points connectivity offsets ");
}

TEST_CASE("lines that are none, and arrays that do not fit them, are refused") {
  const std::vector<double> five(5), twelve(12), three(3);
  CHECK_THAT(error_of([&] { dem::io::write_vtk_lines("x.vtp", five); }), ContainsSubstring("no multiple of 6"));
  CHECK_THAT(error_of([&] {
               dem::io::write_vtk_lines("x.vtp", twelve, {{"a", 1, std::span<const double>(three)}});
             }),
             ContainsSubstring("array 'a' has 3 values, but 2 lines"));
}
