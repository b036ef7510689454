#include "fillet.hpp"
#include "random.hpp"
#include "surface_contacts.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>

#include <set>

using Catch::Approx;
using dem::IndexedMesh;
using dem::Vec3;
using dem::surface::MeshSide;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

TEST_CASE("edges of a mesh are shown to sharp grains where they stick out, near the grain") {
  struct Shown {
    Vec3 point;
    double weight;
  };
  const auto shown = [](const TriangleMesh& m, const Vec3& at, double radius) {
    std::vector<Shown> points;
    std::uint32_t last = 0;
    m.corners(dem::from_eigen(at), radius, [&](std::uint32_t k, const dem::Vector3<double>& p, double weight) {
      CHECK((points.empty() || k > last));  // ascending, as the keys of contacts have to
      last = k;
      points.push_back({to_eigen(p), weight});
    });
    std::sort(points.begin(), points.end(), [](const Shown& a, const Shown& b) { return a.point.y() < b.point.y(); });
    return points;
  };
  // Over the middle of a long edge: three points half a radius apart; a face's diagonal is no edge.
  const TriangleMesh box(mesh::box({2, 20, 2}));
  const auto over = shown(box, {1.1, 3.0, 1.2}, 0.8);
  REQUIRE(over.size() == 3);
  for (int k = 0; k < 3; ++k) {
    const Shown& point = over[static_cast<std::size_t>(k)];
    CHECK((point.point - Vec3(1, 2.6 + 0.4 * k, 1)).norm() < 1e-14);
    CHECK(point.weight == 1.0);
  }
  CHECK(shown(box, {0.2, 3.0, 1.2}, 0.8).empty());
  // Where the edge ends its points fade out before the corner, by 4 x/r; the corner's other edges have a point each.
  const auto end = shown(box, {1.1, 9.95, 1.1}, 0.8);
  REQUIRE(end.size() == 5);
  CHECK(end[0].point.y() == Approx(9.55));
  CHECK(end[1].point.y() == Approx(9.95));
  CHECK(end[1].weight == Approx(4 * 0.05 / 0.8));

  // A ridge of 10 degrees sticks out, a valley and a fold of a hundredth of a degree do not; the rim of a sheet does.
  const auto roof = [](double slope) {
    IndexedMesh m = {{{0, -5, 0}, {0, 5, 0}, {5, 5, -5 * slope}, {5, -5, -5 * slope}, {-5, 5, 0}, {-5, -5, 0}},
                     {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 5}}};
    return TriangleMesh(m, {.side = MeshSide::one_sided, .facing = dem::MeshFacing::as_given});
  };
  const double ten = std::tan(10 * std::numbers::pi / 180);
  CHECK(roof(ten).mesh().area_vector(0).z() > 0.0);
  CHECK(shown(roof(ten), {0.1, 1, 0.3}, 0.8).size() == 3);
  CHECK(shown(roof(-ten), {0.1, 1, 0.3}, 0.8).empty());
  CHECK(shown(roof(1e-4), {0.1, 1, 0.3}, 0.8).empty());
  CHECK(shown(roof(1e-4), {0.1, 5.1, 0.3}, 0.8).size() > 3);
}

TEST_CASE("contacts on one smooth group of triangles have names of their own, by their directions") {
  // A floor and a wall joined by a fillet of radius 1; a ball of radius 2 touches both, on one group.
  const TriangleMesh surface(fillet(1.0, 6, 4.0), {.side = MeshSide::one_sided});
  CHECK(surface.data().groups.count == 1);
  const auto both = surface_contacts(surface, {1.9, 0, 1.95}, 2.0),
             floor = surface_contacts(surface, {2.1, 0, 1.95}, 2.0),
             wall = surface_contacts(surface, {1.9, 0, 2.1}, 2.0);
  REQUIRE(both.size() == 2);
  REQUIRE(floor.size() == 1);
  REQUIRE(wall.size() == 1);
  CHECK(floor[0].feature != wall[0].feature);
  std::set<std::uint32_t> names = {both[0].feature, both[1].feature};
  CHECK(names == std::set<std::uint32_t>{floor[0].feature, wall[0].feature});
}

TEST_CASE("a direction is named by a square of the cube, less than 26 degrees across") {
  Random random(3);
  std::set<std::uint32_t> codes;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 n = random.in({1, 1, 1}).normalized();
    const std::uint32_t code = dem::surface::direction_code(dem::from_eigen(n));
    REQUIRE(code < dem::surface::directions);
    codes.insert(code);
    const Vec3 middle = to_eigen(dem::surface::direction_of(code));
    CHECK(middle.dot(n) > std::cos(13.0 * std::numbers::pi / 180));
    CHECK(dem::surface::direction_code(dem::from_eigen(middle)) == code);
  }
  CHECK(codes.size() == dem::surface::directions);
}

TEST_CASE("a polygon's corner below smooth_angle turns the force at once; above it both sides push steadily") {
  // A drum of 16 sides, 22.5 degrees from one to the next, and a ball that is moved round in it, K = 1, with overlaps
  // below r (1 - cos(22.5 degrees)): deeper, it would overlap the corner's edge itself, where a side's foot point ends.
  const double radius = 0.3, step = 1e-4;
  const auto round = [&](double smooth_angle) {
    const TriangleMesh drum(mesh::cylinder(1.0, 4.0, 16),
                            {.facing = dem::MeshFacing::inward, .smooth_angle = smooth_angle});
    struct {
      std::size_t most_contacts = 0;
      double turn = 0.0, deepening = 0.0;  // largest change of the force, and of its deepest overlap, in a step
      double at_turn = 0.0;                // overlap there
    } result;
    Vec3 last_force = Vec3::Zero();
    double last_depth = 0.0;
    for (double way = 0.0; way < 1.0; way += step) {  // over three corners
      const auto found = surface_contacts(drum, 0.7 * Vec3(std::cos(way), std::sin(way), 0.5), radius);
      Vec3 force = Vec3::Zero();
      double depth = 0.0;
      for (const SurfaceContact& t : found) {
        force -= (radius - t.gap) * t.normal;
        depth = std::max(depth, radius - t.gap);
      }
      if (way > 0.0) {
        if ((force - last_force).norm() > result.turn) {
          result.turn = (force - last_force).norm();
          result.at_turn = depth;
        }
        result.deepening = std::max(result.deepening, std::abs(depth - last_depth));
      }
      result.most_contacts = std::max(result.most_contacts, found.size());
      last_force = force;
      last_depth = depth;
    }
    return result;
  };
  const auto merged = round(TriangleMesh(mesh::box({1, 1, 1})).options().smooth_angle), apart = round(20.0);
  CHECK(merged.most_contacts == 1);
  CHECK(merged.deepening < step);  // by which the ball moves at the most: the energy of the contact does not jump
  CHECK(merged.turn == Approx(2.0 * merged.at_turn * std::sin(std::numbers::pi / 16)).epsilon(0.02));
  CHECK(merged.turn > 10.0 * step);
  CHECK(apart.most_contacts == 2);
  CHECK(apart.turn < 2.0 * step);  // two contacts of K = 1
}
