#include "catch.hpp"
#include "random.hpp"

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>

#include <numbers>

using Catch::Approx;
using dem::Vec3;
using dem::surface::TriangleMesh;
namespace mesh = dem::mesh;

namespace {

struct LinePart {
  double from, to;
};
std::vector<LinePart> parts_of(const TriangleMesh& solid, const Vec3& tail, const Vec3& head) {
  std::vector<LinePart> parts;
  solid.parts_inside(dem::from_eigen(tail), dem::from_eigen(head), [&](double from, double to) {
    parts.push_back({from, to});
  });
  return parts;
}

}  // namespace

TEST_CASE("the part of a line in a box of triangles is that in the box") {
  const Vec3 edges(0.4, 0.3, 0.2);
  const dem::surface::Box box(edges);
  Random random(5);
  for (const int pieces : {1, 7}) {
    const TriangleMesh solid(mesh::box(edges, pieces));
    int inside = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      const Vec3 tail = random.vector(0.4), head = random.vector(0.4);
      double from = 0.0, to = 1.0;
      const bool any = box.clip(dem::from_eigen(tail), dem::from_eigen(head), from, to);
      const auto parts = parts_of(solid, tail, head);
      // A line that ends inside at both ends crosses nothing: a body's corners are its points then.
      REQUIRE(parts.size() == (any && (from > 0.0 || to < 1.0) ? 1 : 0));
      if (parts.empty()) continue;
      ++inside;
      CHECK(parts[0].from == Approx(from).margin(1e-12));  // shares of a way through planes: rounding
      CHECK(parts[0].to == Approx(to).margin(1e-12));
    }
    CHECK(inside > 200);
  }
}

TEST_CASE("lines through edges and corners of a mesh's triangles go in once and out once") {
  const TriangleMesh solid(mesh::box({2, 2, 2}, 4));  // vertices every 0.5
  Random random(6);
  for (int trial = 0; trial < 500; ++trial) {
    // From a vertex, or the middle of an edge, of the top to one of the bottom.
    const auto on_grid = [&] { return 0.25 * std::round(random.between(-3.0, 3.0)); };
    const Vec3 top(on_grid(), on_grid(), 1.0), bottom(on_grid(), on_grid(), -1.0), d = bottom - top;
    const auto parts = parts_of(solid, top - 0.5 * d, bottom + 0.5 * d);
    REQUIRE(parts.size() == 1);
    CHECK(parts[0].from == Approx(0.25).margin(1e-9));
    CHECK(parts[0].to == Approx(0.75).margin(1e-9));
  }
  // In the plane of a side a way goes in and out through the rims of that side; the overlap there is nothing. Past it
  // there is no part.
  const auto grazing = parts_of(solid, {-2, 0.1, 1.0}, {2, 0.1, 1.0});
  REQUIRE(grazing.size() == 1);
  CHECK(grazing[0].from == Approx(0.25).margin(1e-9));
  CHECK(grazing[0].to == Approx(0.75).margin(1e-9));
  CHECK(parts_of(solid, {-2, 0.1, 1.001}, {2, 0.1, 1.001}).empty());
}

TEST_CASE("a line across a fork has a part in each prong, and one in a drum is outside") {
  dem::IndexedMesh fork = mesh::box({0.1, 1.0, 0.1}, 2).moved({-0.3, 0, 0});
  fork += mesh::box({0.1, 1.0, 0.1}, 2);
  fork += mesh::box({0.1, 1.0, 0.1}, 2).moved({0.3, 0, 0});
  const auto prongs = parts_of(TriangleMesh(fork), {-0.5, 0.01, 0.02}, {0.5, 0.03, -0.01});
  REQUIRE(prongs.size() == 3);
  for (int k = 0; k < 3; ++k) {
    CHECK(prongs[k].from == Approx(0.15 + 0.3 * k).margin(1e-12));
    CHECK(prongs[k].to == Approx(0.25 + 0.3 * k).margin(1e-12));
  }
  dem::surface::MeshOptions drum;
  drum.facing = dem::MeshFacing::inward;
  const auto ends = parts_of(TriangleMesh(mesh::box({1, 1, 1}, 1), drum), {-1, 0.1, 0.2}, {1, 0.1, 0.2});
  REQUIRE(ends.size() == 2);
  CHECK(ends[0].from == 0.0);
  CHECK(ends[0].to == Approx(0.25).margin(1e-12));
  CHECK(ends[1].from == Approx(0.75).margin(1e-12));
  CHECK(ends[1].to == 1.0);
}
