#include "catch.hpp"
#include "files.hpp"
#include "sleeping_bed.hpp"
#include "vtk_reader.hpp"
#include "xml.hpp"

#include <dem/io/vtk_grains.hpp>

#include <fstream>
#include <set>
#include <sstream>

using Catch::Approx;
using dem::Vec3;
using dem::io::grain_mesh;
using dem::io::SurfaceMesh;
using dem::shape::Mixed;
using dem::shape::Sphere;
using dem::shape::Superquadric;
using Cube = dem::shape::SphereCluster<8>;

namespace {

/// Checks that the quads close the surface, and returns the volume inside.
double closed_volume(const SurfaceMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  double volume = 0.0;
  for (const auto& quad : mesh.quads) {
    for (std::size_t k = 0; k < 4; ++k) CHECK(edges.emplace(quad[k], quad[(k + 1) % 4]).second);
    const auto vertex = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(quad[k])]; };
    for (std::size_t k = 2; k < 4; ++k) volume += vertex(0).dot(vertex(k - 1).cross(vertex(k))) / 6;
  }
  for (const auto& [a, b] : edges) CHECK(edges.count({b, a}) == 1);
  return volume;
}

/// What write_vtk_grains asks of a world.
template <class Shape>
struct FewGrains {
  struct Species {
    Shape shape;
  };
  struct State {
    std::vector<Species> species;
  };
  State all;
  std::vector<std::size_t> kinds;

  const State& state() const { return all; }
  std::vector<dem::GrainId> grains() const {
    std::vector<dem::GrainId> ids;
    for (std::size_t k = 0; k < kinds.size(); ++k) ids.push_back(dem::GrainId(k));
    return ids;
  }
  dem::SpeciesId species_of(dem::GrainId p) const { return dem::SpeciesId(kinds[p.index()]); }
  Vec3 position(dem::GrainId p) const { return {10.0 * static_cast<double>(p.index()), 0, 0}; }
  Vec3 velocity(dem::GrainId) const { return {3, 4, 0}; }
  dem::Mat3 rotation(dem::GrainId) const { return dem::Mat3::Identity(); }
};

}  // namespace

TEST_CASE("the meshes of grains are closed, face outwards and fill the grains") {
  // An inscribed mesh of n cells an edge misses about 1/n^2 of the volume, more where edges are sharp.
  const Superquadric rounded({1, 1.2, 0.8}, {8, 6, 4}, 1);
  CHECK(closed_volume(grain_mesh(rounded, 24)) == Approx(rounded.volume()).epsilon(0.01));
  CHECK(closed_volume(grain_mesh(rounded, 24)) < rounded.volume());
  const Sphere ball(2.0);
  CHECK(closed_volume(grain_mesh(ball, 24)) == Approx(ball.volume()).epsilon(0.01));
  // Eight balls that just touch each other.
  CHECK(closed_volume(grain_mesh(dem::shape::cube8(1.0), 24)) == Approx(8 * Sphere(0.5).volume()).epsilon(0.01));
  CHECK(grain_mesh(Mixed<Sphere, Superquadric>(rounded), 3).vertices == grain_mesh(rounded, 3).vertices);
}

TEST_CASE("grains of several kinds go into one file") {
  using Any = Mixed<Sphere, Cube, Superquadric>;
  const TempFolder folder;
  const FewGrains<Any> world = {{{{Sphere(1.0)}, {dem::shape::cube8(1.0)}, {Superquadric({1, 2, 3}, {2, 2, 2}, 1)}}},
                                {0, 1, 2, 0}};
  dem::io::write_vtk_grains(folder / "grains.vtp", world, 2);
  std::ostringstream text;
  text << std::ifstream(folder / "grains.vtp", std::ios::binary).rdbuf();
  // 26 points and 24 quads for each ball and each superquadric.
  CHECK_THAT(text.str(), Catch::Matchers::ContainsSubstring("NumberOfPoints=\"" + std::to_string(26 * 11) + "\""));
  CHECK_THAT(text.str(), Catch::Matchers::ContainsSubstring("NumberOfPolys=\"" + std::to_string(24 * 11) + "\""));
  CHECK_THAT(text.str(), Catch::Matchers::ContainsSubstring("Name=\"species\""));
  CHECK_THAT(text.str(), Catch::Matchers::ContainsSubstring("Name=\"speed\""));
}

TEST_CASE("a frame of a bed in which grains sleep says which of them do") {
  const TempFolder folder;
  const SleepingBed bed;
  dem::io::write_vtk_grains(folder / "grains.vtp", bed.world, 1);
  const VtkContent file = read_vtk(folder / "grains.vtp");
  const auto body = file.values<std::int32_t>("body"), asleep = file.values<std::int32_t>("asleep");
  const auto numbers = file.values<std::uint32_t>("grain");
  REQUIRE(asleep.size() == body.size());
  REQUIRE(numbers.size() == body.size());
  CHECK(file.array("asleep").at("type") == "Int32");
  const auto grains = bed.world.grains();
  std::vector<std::size_t> faces(grains.size(), 0);
  for (std::size_t k = 0; k < body.size(); ++k) {
    const auto row = static_cast<std::size_t>(body[k]);
    REQUIRE(row < grains.size());
    ++faces[row];
    CHECK(asleep[k] == (grains[row] == bed.flier ? 0 : 1));
    CHECK(numbers[k] == grains[row].value);
  }
  for (const std::size_t count : faces) CHECK(count == body.size() / grains.size());
  // Where none may sleep the column is not there.
  const SleepingBed awake(false);
  dem::io::write_vtk_grains(folder / "awake.vtp", awake.world, 1);
  CHECK(read_vtk(folder / "awake.vtp").bytes.count("asleep") == 0);
}
