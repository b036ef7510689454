#include "catch.hpp"
#include "contacts.hpp"
#include "random.hpp"

#include <dem/geometry/mixed.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>
#include <dem/geometry/superquadric/superquadric_polyhedron.hpp>
#include <dem/math/rotation.hpp>

using Catch::Approx;
using dem::Ball;
using dem::Mat3;
using dem::Vec3;
using dem::shape::Mixed;
using dem::shape::PointArea;
using dem::shape::Polyhedron;
using dem::shape::Sphere;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;
using Cube = dem::shape::SphereCluster<8>;
using Any = Mixed<Sphere, Cube, Superquadric>;
using WithPoints = Mixed<Sphere, Cube, SuperquadricPoints>;
using WithPolyhedra = Mixed<Sphere, Polyhedron, Cube>;
using Sharp = Mixed<Polyhedron, Superquadric>;
using SharpPoints = Mixed<Polyhedron, SuperquadricPoints>;
using Clusters = Mixed<Cube, dem::shape::SphereCluster<3>>;

static_assert(dem::shape::WarmStartedShape<Any> && !dem::shape::WarmStartedShape<WithPoints>);
static_assert(dem::shape::ReachingShape<Clusters> && dem::shape::ReachingShape<Mixed<Sphere, Cube>>);
static_assert(dem::shape::ReachingShape<Any> && !dem::shape::ReachingShape<WithPolyhedra>);
static_assert(!dem::shape::ReachingShape<WithPoints>);

namespace {

Cube one_ball(double radius) {
  const Ball ball = {Vec3::Zero(), radius};
  return Cube({&ball, 1});
}

/// The same contacts, whatever their numbers.
void check_same(const std::vector<Contact>& a, const std::vector<Contact>& b, double tolerance) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].overlap == Approx(b[k].overlap).margin(tolerance));
    CHECK((a[k].normal - b[k].normal).norm() < 10 * tolerance);
    CHECK((a[k].point - b[k].point).norm() < 10 * tolerance);
    CHECK(a[k].effective_radius == Approx(b[k].effective_radius).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("a mixed shape is what its kind is") {
  const Cube cube = dem::shape::cube8(1.0);
  const Any mixed = cube;
  CHECK(mixed.volume() == cube.volume());
  CHECK(mixed.bounding_radius() == cube.bounding_radius());
  CHECK(mixed.unit_inertia() == cube.unit_inertia());
  CHECK(Any::pose_size == std::max({Cube::pose_size, Superquadric::pose_size}));
  CHECK(mixed.kind().index() == 1);
  const SuperquadricPoints points({1, 1, 1}, {8, 8, 8}, 4, PointArea::physical);
  CHECK(WithPoints(points).patch().weight == points.patch().weight);
  CHECK(WithPoints(cube).patch().weight == cube.patch().weight);

  // Two grains of one kind: the kind's own contacts, to the bit, and its own numbers behind the mark of the kind.
  Random random(3);
  int touching = 0;
  for (int k = 0; k < 100; ++k) {
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const Vec3 d = 2.0 * random.direction();
    const auto plain = contacts(cube, ra, cube, rb, d), found = contacts(mixed, ra, mixed, rb, d);
    REQUIRE(found.size() == plain.size());
    touching += !plain.empty();
    for (std::size_t c = 0; c < plain.size(); ++c) {
      CHECK(found[c].overlap == plain[c].overlap);
      CHECK(found[c].normal == plain[c].normal);
      CHECK(found[c].point == plain[c].point);
      CHECK((found[c].feature & 0xffffffu) == plain[c].feature);
      CHECK((Any::mirrored(found[c].feature) & 0xffffffu) == Cube::mirrored(plain[c].feature));
      CHECK(Any::mirrored(Any::mirrored(found[c].feature)) == found[c].feature);
    }
  }
  CHECK(touching > 20);
}

TEST_CASE("a cluster of one ball and a superquadric ball are spheres among the others") {
  Random random(3);
  const Cube cube = dem::shape::cube8(1.0);
  const Superquadric rounded({1, 1.2, 0.8}, {4, 4, 4}, 1);
  int touching = 0;
  for (int k = 0; k < 300; ++k) {
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const double r = random.between(0.5, 1.5);
    const Vec3 d = random.between(1.0, 1.1) * (1 + r) * random.direction();
    const Any ball = Sphere(r), cluster = one_ball(r), smooth = Superquadric(Vec3::Constant(r), {2, 2, 2}, 1);
    for (const Any& other : {Any(Sphere(1.0)), Any(cube), Any(rounded)}) {
      const auto expected = contacts(other, ra, ball, rb, d);
      touching += !expected.empty();
      check_same(contacts(other, ra, cluster, rb, d), expected, 1e-12);
      // The searches stop within 3e-6 of the point, and within its square of the overlap; they may see grains that
      // overlap by less than that differently. The normals err by that step times the curvature, below 5, and the rate
      // of convergence. Points: measured, 2.1e-5 at the most. Effective radii of clusters are those
      // of their balls.
      const auto found = contacts(other, ra, smooth, rb, d);
      if (!expected.empty() && expected.front().overlap > 1e-9 && other.kind().index() != 1) {
        REQUIRE(found.size() == 1);
        CHECK(found[0].overlap == Approx(expected[0].overlap).margin(1e-9));
        CHECK((found[0].normal - expected[0].normal).norm() < 1e-4);
        CHECK((found[0].point - expected[0].point).norm() < 3e-5);
      }
    }
  }
  CHECK(touching > 100);
}

TEST_CASE("a ball on a superquadric touches where the surface is nearest to its centre") {
  Random random(3);
  for (const Vec3& e : {Vec3(2, 2, 2), Vec3(3, 5, 2.5), Vec3(8, 8, 8), Vec3(32, 32, 32)}) {
    const Superquadric grain({1, 1.3, 0.7}, e, 1);
    for (int k = 0; k < 100; ++k) {
      const Mat3 r = random.rotation();
      const auto foot = grain.solid().radial(dem::from_eigen(random.direction()));
      const double radius = random.between(0.2, 2), overlap = random.between(-0.02, 0.02) / e.maxCoeff();
      const Vec3 n = r * to_eigen(foot.normal), d = r * to_eigen(foot.position) + (radius - overlap) * n;
      const auto found = contacts(Any(grain), r, Any(Sphere(radius)), random.rotation(), d);
      INFO("exponents " << e.transpose() << ", overlap " << overlap << ", radius " << radius);
      REQUIRE(found.size() == (overlap > 0 ? 1u : 0u));
      if (found.empty()) continue;
      CHECK(found[0].overlap == Approx(overlap).margin(1e-9));
      CHECK((found[0].normal - n).norm() < 1e-6 * e.maxCoeff());
      CHECK((found[0].point - (d - (radius - 0.5 * overlap) * n)).norm() < 1e-5);
    }
  }
}

TEST_CASE("superquadrics of either policy touch each other by the points of both") {
  using Both = Mixed<Superquadric, SuperquadricPoints>;
  Random random(3);
  const Vec3 radii(1, 1.2, 0.8), exponents(6, 4, 8);
  int touching = 0;
  for (int k = 0; k < 100; ++k) {
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const Vec3 d = random.between(1.6, 2.2) * random.direction();
    const SuperquadricPoints points(radii, exponents, 6), other(Vec3::Ones(), {8, 8, 8}, 4);
    const Superquadric smooth(Vec3::Ones(), {8, 8, 8}, 4);
    const auto expected = contacts(points, ra, other, rb, d);
    const auto found = contacts(Both(points), ra, Both(smooth), rb, d);
    check_same(found, expected, 1e-14);  // the same numbers by the same way
    for (std::size_t c = 0; c < found.size(); ++c) CHECK(found[c].weight == Approx(expected[c].weight).epsilon(1e-12));
    // From the other side: the same contacts, mirrored.
    auto turned = contacts(Both(smooth), rb, Both(points), ra, -d);
    REQUIRE(turned.size() == found.size());
    for (std::size_t c = 0; c < found.size(); ++c) {
      CHECK((turned[c].normal + found[c].normal).norm() < 1e-12);
      CHECK((turned[c].point + d - found[c].point).norm() < 1e-12);
      CHECK(turned[c].weight == Approx(found[c].weight));
      CHECK(turned[c].feature == found[c].feature);
    }
    touching += !found.empty();
    // Points that weigh by area are counted on their own side alone.
    const SuperquadricPoints weighed(radii, exponents, 6, PointArea::physical);
    const auto by_area = contacts(Both(weighed), ra, Both(smooth), rb, d);
    std::size_t own = 0;
    for (const Contact& c : expected) {
      if ((c.feature & SuperquadricPoints::other_way) != 0) continue;
      REQUIRE(own < by_area.size());
      CHECK(by_area[own].overlap == Approx(c.overlap));
      CHECK(by_area[own].weight == weighed.points().weight[c.feature]);
      ++own;
    }
    CHECK(by_area.size() == own);
  }
  CHECK(touching > 20);
}

TEMPLATE_TEST_CASE("a superquadric and a polyhedron touch as one contact", "", Superquadric, SuperquadricPoints) {
  using Both = Mixed<Polyhedron, TestType>;
  const Polyhedron brick = dem::shape::box({3.0, 2.0, 4.0});  // edges
  const double depth = 0.004;
  const Mat3 one = Mat3::Identity();
  const auto push = [](const Both& a, const Mat3& ra, const Both& b, const Mat3& rb, const Vec3& d) {
    Vec3 sum = Vec3::Zero();
    for (const Contact& c : contacts(a, ra, b, rb, d)) sum += c.weight * c.overlap * c.normal;
    return sum;
  };
  const Both cube(TestType(Vec3::Ones(), Vec3::Constant(32), 8));
  // A face on a face; the boundary of the rounded cube is flat to 1 % of the depth over most of it.
  Vec3 force = push(cube, one, brick, one, Vec3(2.5 - depth, 0.1, 0.2));
  CHECK(force.x() == Approx(depth).epsilon(0.05));
  CHECK(force.tail<2>().norm() < 5e-3 * depth);  // points near the rim, off the middle on one side
  // An edge of the brick across a face: the cube shows no point there.
  const Mat3 on_edge = Eigen::AngleAxisd(-std::atan2(2.0, 3.0), Vec3::UnitZ()).toRotationMatrix();
  const double reach = 0.5 * std::sqrt(13.0);  // from the brick's centre to its edge along z
  force = push(cube, one, brick, on_edge, Vec3(1 + reach - depth, 0.1, 0.05));
  CHECK(force.x() == Approx(depth).epsilon(0.05));
  // A corner of the brick in a face, and a round ellipsoid's pole on a face of the brick.
  const Vec3 diagonal = Vec3(1.5, 1.0, 2.0);
  const Mat3 on_corner = dem::rotation_between(diagonal.normalized(), -Vec3::UnitX());
  force = push(cube, one, brick, on_corner, Vec3(1 + diagonal.norm() - depth, 0.1, 0.05));
  CHECK(force.x() == Approx(depth).epsilon(1e-2));
  CHECK(push(cube, one, brick, on_corner, Vec3(1 + diagonal.norm() + 1e-9, 0.1, 0.05)).norm() == 0.0);
  const Both egg(TestType({1, 1, 1.5}, {2, 2, 2}, 10));  // its poles are points of the boundary
  CHECK(push(egg, one, brick, one, Vec3(0, 0, 3.5 - depth)).z() == Approx(depth).epsilon(1e-9));
}

TEMPLATE_TEST_CASE("pairs of different kinds look the same from either side", "", Any, WithPoints, WithPolyhedra, Sharp,
                   SharpPoints, Clusters) {
  Random random(3);
  std::vector<TestType> kinds;
  constexpr bool is_sharp = std::is_same_v<TestType, Sharp> || std::is_same_v<TestType, SharpPoints>;
  if constexpr (!is_sharp) kinds = {one_ball(0.9), dem::shape::cube8(0.9)};
  if constexpr (std::is_same_v<TestType, Clusters>) {
    const Ball three[] = {{{0, 0, 0}, 0.6}, {{0.5, 0, 0}, 0.5}, {{0, 0.6, 0.2}, 0.4}};
    kinds.push_back(dem::shape::SphereCluster<3>(three));
  } else if constexpr (is_sharp) {
    kinds = {dem::shape::box({2.0, 1.6, 2.2})};
    if constexpr (std::is_same_v<TestType, Sharp>) kinds.push_back(Superquadric({1, 0.8, 1.1}, {3, 4, 8}, 4));
    if constexpr (std::is_same_v<TestType, SharpPoints>)
      kinds.push_back(SuperquadricPoints({1, 0.8, 1.1}, {3, 4, 8}, 8));
  } else {
    kinds.push_back(Sphere(1.0));
    if constexpr (std::is_same_v<TestType, Any>) kinds.push_back(Superquadric({1, 0.8, 1.1}, {3, 4, 8}, 1));
    if constexpr (std::is_same_v<TestType, WithPoints>)
      kinds.push_back(SuperquadricPoints({1, 0.8, 1.1}, {3, 4, 8}, 8));
    if constexpr (std::is_same_v<TestType, WithPolyhedra>) kinds.push_back(dem::shape::box({2.0, 1.6, 2.2}));
  }
  // What is computed from either side rounds by 1e-16 of lengths of 1, and shares by that over the overlap. Searches
  // for a common normal stop within 3e-6 of the point and its square of the overlap; the point then errs as above.
  constexpr bool searched = std::is_same_v<TestType, Any> || std::is_same_v<TestType, Sharp>;
  int touching = 0;
  for (int k = 0; k < 60; ++k) {
    for (const TestType& a : kinds) {
      for (const TestType& b : kinds) {
        const Mat3 ra = random.rotation(), rb = random.rotation();
        const Vec3 d = 1.9 * random.direction();
        const auto from_a = contacts(a, ra, b, rb, d), from_b = contacts(b, rb, a, ra, -d);
        REQUIRE(from_a.size() == from_b.size());
        touching += !from_a.empty();
        for (std::size_t c = 0; c < from_a.size(); ++c) {
          if (c > 0) CHECK(from_a[c].feature > from_a[c - 1].feature);
          const std::uint32_t number = TestType::mirrored(from_a[c].feature);
          const auto same =
              std::find_if(from_b.begin(), from_b.end(), [&](const Contact& x) { return x.feature == number; });
          REQUIRE(same != from_b.end());
          CHECK(same->overlap == Approx(from_a[c].overlap).margin(searched ? 1e-9 : 1e-12));
          CHECK((same->normal + from_a[c].normal).norm() < (searched ? 1e-5 : 1e-12));
          CHECK((same->point + d - from_a[c].point).norm() < (searched ? 1e-4 : 1e-12));
          CHECK(same->weight == Approx(from_a[c].weight).epsilon(1e-9));
          CHECK(same->effective_radius == Approx(from_a[c].effective_radius).epsilon(1e-12));
        }
      }
    }
  }
  CHECK(touching > 100);
}
