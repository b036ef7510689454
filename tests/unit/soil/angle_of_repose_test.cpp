#include "catch.hpp"

#include <dem/soil/angle_of_repose.hpp>

#include <cmath>
#include <numbers>
#include <vector>

using namespace dem;
using namespace dem::soil;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Grains of a radius whose tops lie on a cone of a height (m) and a slope (rad), on a lattice finer than they are
/// wide.
std::vector<Placement> cone(double radius, double height, double slope) {
  std::vector<Placement> grains;
  const double foot = height / std::tan(slope), pitch = 0.25 * radius;
  const auto n = static_cast<int>(foot / pitch);
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const double z = height - std::tan(slope) * pitch * std::hypot(i, j);
      if (z > 0.0) grains.push_back({.position = {pitch * i, pitch * j, z}});
    }
  }
  return grains;
}

}  // namespace

TEST_CASE("a height map is what is seen of spheres from above") {
  const std::vector<Placement> one = {{.position = {0.2, -0.1, 3.0}}, {.position = {0.2, -0.1, 1.0}}};
  double covered = 0.0;
  for (const SurfacePoint& p : height_map(one, 1.0, 5.0)) {
    const double way = std::hypot(p.x - 0.2, p.y + 0.1);
    if (way >= 1.0) {
      CHECK(p.z == 0.0);
      continue;
    }
    CHECK(p.z == Approx(3.0 + std::sqrt(1.0 - way * way)));
    covered += 1.0;
  }
  CHECK(covered >= 2.0);  // rays are a radius apart: pi of them meet it on average
  CHECK(height_map({}, 1.0, 5.0).size() == 11 * 11);
  // Far away it is not seen, and does no harm.
  const std::vector<Placement> far = {{.position = {1e9, 0.0, 3.0}}};
  for (const SurfacePoint& p : height_map(far, 1.0, 5.0)) CHECK(p.z == 0.0);
  CHECK_THROWS_WITH(height_map({}, 0.0, 5.0), ContainsSubstring("radius of a grain"));
  CHECK_THROWS_WITH(height_map({}, 1e-6, 5.0), ContainsSubstring("reach of a height map"));
}

TEST_CASE("the flank of a cone has its angle in every direction") {
  // Spheres on a plane have a parallel plane above them; a ray may miss the highest point by the lattice's eighth of a
  // radius, less than 0.01 radii of height: over a flank of 20 radii that is far below a tenth of a degree. Rays on a
  // square lattice sample a sector's ends unevenly, but the points lie on its line all the same. The cone's curvature
  // across a sphere's width is left: tangent spheres at a radius s stand out by a^2/2s, which the flank's top shows.
  for (const double slope : {15.0, 30.0, 45.0}) {
    const Flank f = flank_of_heap(cone(0.5, 15.0, slope * degree), 0.5, 80.0);
    INFO("slope " << slope << " deg");
    REQUIRE(f.angles.size() == 12);
    CHECK(f.angle / degree == Approx(slope).margin(0.3));
    CHECK(f.scatter / degree < 0.3);
    CHECK(f.from == Approx(0.2 * 15.0 / std::tan(slope * degree)).margin(3.0));
    CHECK(f.to == Approx(0.8 * 15.0 / std::tan(slope * degree)).margin(3.0));
  }
}

TEST_CASE("a slope between walls has its angle in every strip") {
  std::vector<Placement> grains;
  const double slope = 25.0 * degree;
  for (double x = -40.0; x < 0.0; x += 0.25) {
    for (double y = -8.0; y < 8.0; y += 0.25) grains.push_back({.position = {x, y, 0.2 - std::tan(slope) * x}});
  }
  FlankOptions o;
  o.directions = 4;
  const Flank f = flank_of_slope(grains, 0.5, -40.0, 0.0, 8.0, o);
  REQUIRE(f.angles.size() == 4);
  CHECK(f.angle / degree == Approx(25.0).margin(0.1));
  CHECK(f.scatter / degree < 0.1);
}

TEST_CASE("where there is no flank, no angle is known") {
  CHECK(std::isnan(flank_of_heap({}, 1.0, 10.0).angle));
  CHECK(std::isnan(fit_flank({}, 1.0).angle));
  const std::vector<Placement> one = {{.position = {0.0, 0.0, 1.0}}};
  CHECK(flank_of_heap(one, 1.0, 10.0).angles.empty());
  // Few places are no line.
  const std::vector<SlopePoint> four = {{0.5, 4.0, 0}, {1.5, 3.0, 0}, {2.5, 2.0, 0}, {3.5, 1.0, 0}};
  CHECK(fit_flank(four, 1.0).angles.empty());
  CHECK_THROWS_WITH(fit_flank(four, 0.0), ContainsSubstring("width of a strip"));
  CHECK_THROWS_WITH(fit_flank(four, 1.0, {.low = 0.9}), ContainsSubstring("lower share of a flank"));
}
