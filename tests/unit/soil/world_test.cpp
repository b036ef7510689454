#include "catch.hpp"
#include "worlds.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/soil/packing.hpp>
#include <dem/soil/rest.hpp>
#include <dem/world/world.hpp>

using Catch::Approx;
using dem::GrainId;
using dem::Vec3;

namespace {

using models::CorrectedBalls, models::CorrectedCubes;

}  // namespace

TEST_CASE("a row of three cubes: who touches whom") {
  dem::World<CorrectedCubes> world;
  const auto cube = world.add_species(dem::shape::cube8(1e-3), {});
  const double pitch = 1.99e-3;  // faces of four spheres each overlap a little
  for (const double x : {0.0, 1.0, 2.0, 5.0}) world.add_grain({.species = cube, .position = Vec3(x * pitch, 0, 0)});
  const auto c = dem::soil::coordination(world);
  CHECK(c.neighbours == std::vector<std::int32_t>{1, 2, 1, 0});
  CHECK(c.contacts == std::vector<std::int32_t>{4, 8, 4, 0});
  CHECK(c.mean() == Approx(1.0));
}

TEST_CASE("spheres count too, and an empty world has none") {
  dem::World<CorrectedBalls> world;
  CHECK(dem::soil::coordination(world).mean() == 0.0);
  CHECK(dem::soil::rms_speed(world) == 0.0);
  const auto ball = world.add_species(dem::shape::Sphere(1.0), {});
  world.add_grain({.species = ball, .position = Vec3(0, 0, 0), .velocity = Vec3(3, 0, 0)});
  world.add_grain({.species = ball, .position = Vec3(1.9, 0, 0), .velocity = Vec3(0, 4, 0)});
  CHECK(dem::soil::coordination(world).neighbours == std::vector<std::int32_t>{1, 1});
  CHECK(dem::soil::rms_speed(world) == Approx(std::sqrt(12.5)));
  const auto places = dem::soil::placements(world);
  REQUIRE(places.size() == 2);
  CHECK(places[1].position == Vec3(1.9, 0, 0));
}
