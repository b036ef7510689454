#include "catch.hpp"
#include "core/error_of.hpp"

#include <dem/geometry/polyhedron/convex_hull.hpp>
#include <dem/geometry/polyhedron/polyhedron_mass.hpp>

#include <random>
#include <set>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::Mat3;
using dem::Vec3;

namespace {

std::set<int> corners_of(const std::vector<dem::Triangle>& triangles) {
  std::set<int> corners;
  for (const auto& t : triangles) corners.insert(t.begin(), t.end());
  return corners;
}
std::vector<std::vector<int>> as_faces(const std::vector<dem::Triangle>& triangles) {
  std::vector<std::vector<int>> faces;
  for (const auto& t : triangles) faces.emplace_back(t.begin(), t.end());
  return faces;
}
double largest_height(const std::vector<Vec3>& points, const std::vector<dem::Triangle>& triangles) {
  double highest = -1e300;
  for (const auto& t : triangles) {
    const Vec3 a = points[std::size_t(t[0])], b = points[std::size_t(t[1])], c = points[std::size_t(t[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3& p : points) highest = std::max(highest, normal.dot(p - a));
  }
  return highest;
}

}  // namespace

TEST_CASE("the hull of a grid of points in a cube has the cube's eight corners") {
  std::vector<Vec3> points;
  for (int k = 0; k < 125; ++k) points.push_back(1e-3 * Vec3(k % 5, k / 5 % 5, k / 25));
  points.insert(points.end(), points.begin(), points.begin() + 60);  // doubled points do no harm
  const auto hull = dem::convex_hull(points);
  CHECK(hull.size() == 12);
  CHECK(corners_of(hull).size() == 8);
  CHECK(dem::polyhedron_mass_properties(points, as_faces(hull)).volume == Approx(64e-9).epsilon(1e-14));
}

TEST_CASE("a hull holds all its points, and is closed") {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3> points;
    for (int k = 0; k < 30 + 10 * trial; ++k) {
      points.emplace_back(normal(random), normal(random), 0.3 * normal(random));
      if (trial % 2 == 0) points.back().normalize();  // every point a corner
    }
    const auto hull = dem::convex_hull(points);
    const auto corners = corners_of(hull);
    if (trial % 2 == 0) CHECK(corners.size() == points.size());
    CHECK(hull.size() == 2 * corners.size() - 4);  // Euler, for triangles
    CHECK(largest_height(points, hull) < 1e-8);    // of bodies of size 1 to 8; the hull leaves out 1e-9 of that
    std::set<std::pair<int, int>> runs;
    for (const auto& t : hull) {
      for (std::size_t k = 0; k < 3; ++k) CHECK(runs.emplace(t[k], t[(k + 1) % 3]).second);
    }
    for (const auto& [from, to] : runs) CHECK(runs.contains({to, from}));
  }
}

TEST_CASE("a hull of points that are off a plane by any small distance is found, and closes") {
  // A pyramid on a pentagon of which one corner hangs low: by as much as rounding decides, it is in the planes of some
  // triangles of the pentagon and not of others.
  for (const int copies : {1, 3}) {
    for (double depth = 1e-12; depth < 1e-4; depth *= 1.13) {
      CAPTURE(depth, copies);
      const std::vector<Vec3> pyramid = {{1, 0, 0},     {0.9, 0.25, 0},      {-1, 0.8, 0},
                                         {-1, -0.8, 0}, {0.6, -0.9, -depth}, {0, 0, -1}};
      std::vector<Vec3> points;
      for (int k = 0; k < copies; ++k) points.insert(points.end(), pyramid.begin(), pyramid.end());
      const auto hull = dem::convex_hull(points);
      CHECK(corners_of(hull).size() <= pyramid.size());  // copies are one corner, also when points are shifted
      CHECK(hull.size() == 2 * corners_of(hull).size() - 4);
      CHECK(dem::polyhedron_mass_properties(points, as_faces(hull)).volume == Approx(0.85).margin(2e-6 + depth));
    }
  }
}

TEST_CASE("points without a volume have no hull") {
  std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK_THAT(message_of([&] { dem::convex_hull(points); }), ContainsSubstring("3 points"));
  points.push_back({1, 1, 0});
  CHECK_THAT(message_of([&] { dem::convex_hull(points); }), ContainsSubstring("one plane"));
  CHECK_THAT(message_of([&] { dem::convex_hull(std::vector<Vec3>(5, Vec3(1, 2, 3))); }),
             ContainsSubstring("one plane"));
  points.push_back({0, 0, std::nan("")});
  CHECK_THAT(message_of([&] { dem::convex_hull(points); }), ContainsSubstring("point 4"));
}

TEST_CASE("volume integrals of polyhedra are those of closed forms") {
  // A tetrahedron with legs a, b, c on the axes: V = a b c/6, centre (a, b, c)/4, and about the centre
  // int x^2 = 3 V a^2/80, int x y = -V a b/80.
  const double a = 2.0, b = 3.0, c = 0.5, v = a * b * c / 6.0;
  const std::vector<Vec3> corners = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
  const std::vector<std::vector<int>> faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto m = dem::polyhedron_mass_properties(corners, faces);
  CHECK(m.volume == Approx(v).epsilon(1e-14));
  CHECK((m.centre - 0.25 * Vec3(a, b, c)).norm() < 1e-14);
  CHECK(m.inertia(0, 0) == Approx(3.0 * v / 80.0 * (b * b + c * c)).epsilon(1e-13));
  CHECK(m.inertia(1, 1) == Approx(3.0 * v / 80.0 * (a * a + c * c)).epsilon(1e-13));
  CHECK(m.inertia(0, 1) == Approx(v * a * b / 80.0).epsilon(1e-13));
  CHECK(m.inertia(1, 2) == Approx(v * b * c / 80.0).epsilon(1e-13));

  // An L of three cubes, not convex and far from the origin: cubes of edge 1 at (0,0), (1,0), (0,1).
  std::vector<Vec3> l;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
      l.push_back(Vec3(x, y, z) + Vec3(100, 200, 300));
    }
  }
  const auto body = dem::polyhedron_mass_properties(
      l, std::vector<std::vector<int>>{{3, 2, 1, 0},
                                       {5, 4, 3, 0},
                                       {6, 7, 8, 9},
                                       {6, 9, 10, 11},
                                       {0, 1, 7, 6},
                                       {1, 2, 8, 7},
                                       {2, 3, 9, 8},
                                       {3, 4, 10, 9},
                                       {4, 5, 11, 10},
                                       {5, 0, 6, 11}});
  CHECK(body.volume == Approx(3.0).epsilon(1e-12));
  CHECK((body.centre - Vec3(100 + 5.0 / 6, 200 + 5.0 / 6, 300.5)).norm() < 1e-11);
  // About z: three cubes of 1/6, at distances^2 2/9, 5/9, 5/9 from the common centre.
  CHECK(body.inertia(2, 2) == Approx(0.5 + 12.0 / 9.0).epsilon(1e-11));
}
