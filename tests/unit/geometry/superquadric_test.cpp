#include "catch.hpp"
#include "contacts.hpp"
#include "random.hpp"

#include <dem/geometry/sphere/sphere.hpp>
#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/math/rotation.hpp>

using Catch::Approx;
using dem::Mat3;
using dem::Vec3;
using dem::Vector3;
using dem::shape::CommonNormal;
using dem::shape::SolidPair;
using dem::shape::Superquadric;
using dem::shape::SuperquadricSolid;

namespace {

/// The distance from a to b at which their surfaces share the normal n with a given overlap: what the search must find.
Vec3 separation_for(const Superquadric& a, const Mat3& ra, const Superquadric& b, const Mat3& rb, const Vec3& n,
                    double overlap, Vec3* point = nullptr) {
  Vector3<double> pa, pb;
  a.solid().support(dem::from_eigen(Vec3(ra.transpose() * n)), pa);
  b.solid().support(dem::from_eigen(Vec3(-rb.transpose() * n)), pb);
  const Vec3 of_a = ra * to_eigen(pa), of_b = rb * to_eigen(pb);
  if (point != nullptr) *point = of_a - 0.5 * overlap * n;
  return of_a - of_b - overlap * n;
}

const std::vector<Vec3> exponents = {{2, 2, 2}, {3, 3, 3},  {2.5, 3.7, 6.1}, {8, 8, 8},
                                     {2, 2, 8}, {2, 3, 24}, {32, 32, 32}};

}  // namespace

TEST_CASE("superquadrics with exponent 2 and equal radii are spheres") {
  Random random(7);
  for (int k = 0; k < 200; ++k) {
    const double ra = random.between(0.5, 2), rb = random.between(0.5, 2);
    const Vec3 d = random.between(0.9, 1.05) * (ra + rb) * random.direction();
    const auto balls = contacts(dem::shape::Sphere(ra), Mat3::Identity(), dem::shape::Sphere(rb), Mat3::Identity(), d);
    const auto found = contacts(Superquadric(Vec3::Constant(ra), {2, 2, 2}, 1), random.rotation(),
                                Superquadric(Vec3::Constant(rb), {2, 2, 2}, 1), random.rotation(), d);
    REQUIRE(found.size() == balls.size());
    if (found.empty()) continue;
    // The search stops when a step is below 3e-6 of a radius. What is left of the tangential error is that times the
    // rate of convergence, overlap/radius = 0.1; the overlap errs by its square.
    CHECK(found[0].overlap == Approx(balls[0].overlap).margin(1e-11));
    CHECK((found[0].normal - balls[0].normal).norm() < 1e-6);
    CHECK((found[0].point - balls[0].point).norm() < 1e-6);
    CHECK(found[0].effective_radius == Approx(balls[0].effective_radius).epsilon(1e-12));
  }
}

TEST_CASE("the contact of two superquadrics is their common normal") {
  Random random(7);
  for (const Vec3& e : exponents) {
    for (int k = 0; k < 150; ++k) {
      const Superquadric a(random.radii(), e, 1), b(random.radii(), {e.z(), e.x(), e.y()}, 1);
      Mat3 ra = random.rotation(), rb = random.rotation();
      Vec3 n = random.direction();
      if (k % 3 == 1) n = ra * (Vec3::Unit(k % 2) + 1e-3 * random.direction()).normalized();  // a face
      if (k % 3 == 2) rb = ra * Eigen::AngleAxisd(1e-4, random.direction());                  // nearly aligned
      // Overlaps stay below the radii of curvature of the edges, about 2/p of a grain's radius.
      const double overlap = random.between(-1, 1) * 0.02 / e.maxCoeff();
      Vec3 point;
      const Vec3 d = separation_for(a, ra, b, rb, n, overlap, &point);
      const auto found = contacts(a, ra, b, rb, d);
      INFO("exponents " << e.transpose() << ", pair " << k << ", overlap " << overlap);
      REQUIRE(found.size() == (overlap > 0 ? 1u : 0u));
      if (found.empty()) continue;
      CHECK(found[0].overlap == Approx(overlap).margin(1e-9));
      // On a flat face a normal that is 1e-9 away may belong to a point that is a long way off, so the point is checked
      // only where the surfaces are curved: along directions away from the faces.
      // The last step went less than 3e-6, over a curvature of up to 2 p for each grain; what is left of that is the
      // rate of convergence, overlap times curvature, less than 0.1.
      CHECK((found[0].normal - n).norm() < 1e-6 * e.maxCoeff());
      if (k % 3 == 0 && e.maxCoeff() < 10) CHECK((found[0].point - point).norm() < 1e-5);
    }
  }
}

TEST_CASE("superquadrics find each other across a gap, at the distance of their surfaces") {
  Random random(11);
  for (const Vec3& e : exponents) {
    for (int k = 0; k < 100; ++k) {
      const Superquadric a(random.radii(), e, 1), b(random.radii(), {e.z(), e.x(), e.y()}, 1);
      const Mat3 ra = random.rotation(), rb = random.rotation();
      const Vec3 n = random.direction();
      const double distance = random.between(0.0, 0.1), gap = 0.05;
      const Vec3 d = separation_for(a, ra, b, rb, n, -distance);
      INFO("exponents " << e.transpose() << ", pair " << k << ", distance " << distance);
      CHECK(contacts(a, ra, b, rb, d).empty());
      const auto found = contacts(a, ra, b, rb, d, gap);
      REQUIRE(found.size() == (distance < gap ? 1u : 0u));
      if (found.empty()) continue;
      // Convex solids that share a normal across a gap are nowhere nearer. The search's tolerance is 3e-6 of a radius.
      CHECK(found[0].overlap == Approx(-distance).margin(1e-9));
      CHECK((found[0].normal - n).norm() < 1e-6 * e.maxCoeff());
    }
  }
}

TEST_CASE("ellipsoids tip to tip and side to side") {
  const Superquadric a({2, 1, 0.5}, {2, 2, 2}, 1);
  const Mat3 one = Mat3::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const double r = a.solid().radius().x * (axis == 0) + (axis == 1) * 1.0 + (axis == 2) * 0.5;
    const auto found = contacts(a, one, a, one, Vec3(1.99 * r * Vec3::Unit(axis)));
    REQUIRE(found.size() == 1);
    CHECK(found[0].overlap == Approx(0.01 * r).epsilon(1e-9));
    CHECK((found[0].normal - Vec3::Unit(axis)).norm() < 1e-9);
    CHECK((found[0].point - 0.995 * r * Vec3::Unit(axis)).norm() < 1e-9);
    CHECK(contacts(a, one, a, one, Vec3(2.001 * r * Vec3::Unit(axis))).empty());
  }
  // The support function of an ellipsoid at an angle: the root of the sum of (r_i n_i)^2.
  const Vec3 n = Vec3(1, -2, 0.5).normalized();
  Vector3<double> point;
  CHECK(a.solid().support(dem::from_eigen(n), point) ==
        Approx(std::sqrt(4 * n.x() * n.x() + n.y() * n.y() + 0.25 * n.z() * n.z())).epsilon(1e-12));
}

TEST_CASE("rounded cubes face to face, edge to edge and corner to corner") {
  const double p = 8;
  const Superquadric cube(Vec3::Ones(), Vec3::Constant(p), 1);
  const Mat3 one = Mat3::Identity();
  // Faces that lie askew by 0.3 along y: the point lies midway, where both surfaces slope alike.
  auto found = contacts(cube, one, cube, one, Vec3(1.99, 0.3, 0));
  REQUIRE(found.size() == 1);
  // Along x the surfaces are as far as at y = +-0.15: x = (1 - 0.15^8)^(1/8), 3e-8 less than 1.
  CHECK(found[0].overlap == Approx(2 * std::pow(1 - std::pow(0.15, p), 1 / p) - 1.99).margin(1e-9));
  // Both slope by 0.15^7 = 1.7e-6 there.
  CHECK((found[0].normal - Vec3(1, std::pow(0.15, p - 1), 0)).norm() < 3e-9);
  CHECK(found[0].point.y() == Approx(0.15).margin(0.03));  // normals that differ by 1e-9 lie that far apart

  // Edges: the middle of an edge lies at u = v = 2^(-1/8), at the distance sqrt(2) u.
  const double edge = std::sqrt(2.0) * std::pow(0.5, 1 / p), corner = std::sqrt(3.0) * std::pow(1.0 / 3, 1 / p);
  const Vec3 across = Vec3(1, 1, 0).normalized(), along = Vec3(1, 1, 1).normalized();
  found = contacts(cube, one, cube, one, Vec3((2 * edge - 0.004) * across));
  REQUIRE(found.size() == 1);
  CHECK(found[0].overlap == Approx(0.004).margin(1e-9));
  CHECK((found[0].normal - across).norm() < 1e-6);
  // Crossed edges: b turned by a right angle about the normal.
  found = contacts(cube, one, cube, Mat3(Eigen::AngleAxisd(M_PI / 2, across)), Vec3((2 * edge - 0.004) * across));
  REQUIRE(found.size() == 1);
  CHECK(found[0].overlap == Approx(0.004).margin(1e-9));
  CHECK((found[0].point - (edge - 0.002) * across).norm() < 1e-5);
  found = contacts(cube, one, cube, Mat3(Eigen::AngleAxisd(1.0, along)), Vec3((2 * corner - 0.004) * along));
  REQUIRE(found.size() == 1);
  CHECK(found[0].overlap == Approx(0.004).margin(1e-9));
  CHECK((found[0].normal - along).norm() < 1e-6);
  // A corner on the middle of a face.
  found = contacts(cube, one, cube, dem::rotation_between(along, -Vec3::UnitX()), Vec3(1 + corner - 0.004, 0, 0));
  REQUIRE(found.size() == 1);
  CHECK(found[0].overlap == Approx(0.004).margin(1e-9));
  CHECK((found[0].normal - Vec3::UnitX()).norm() < 1e-6);
}

TEST_CASE("a pair of superquadrics looks the same from either side and in any frame") {
  Random random(7);
  for (const Vec3& e : exponents) {
    for (int k = 0; k < 40; ++k) {
      const Superquadric a(random.radii(), e, 1), b(random.radii(), e, 1);
      const Mat3 ra = random.rotation(), rb = random.rotation(), turn = random.rotation();
      const Vec3 d = separation_for(a, ra, b, rb, random.direction(), 0.01 / e.maxCoeff());
      const auto from_a = contacts(a, ra, b, rb, d), from_b = contacts(b, rb, a, ra, -d);
      const auto turned = contacts(a, turn * ra, b, turn * rb, turn * d);
      REQUIRE(from_a.size() == 1);
      REQUIRE(from_b.size() == 1);
      REQUIRE(turned.size() == 1);
      CHECK(from_b[0].overlap == Approx(from_a[0].overlap).margin(1e-9));
      CHECK(turned[0].overlap == Approx(from_a[0].overlap).margin(1e-9));
      CHECK((from_b[0].normal + from_a[0].normal).norm() < 1e-6 * e.maxCoeff());
      CHECK((turned[0].normal - turn * from_a[0].normal).norm() < 1e-6 * e.maxCoeff());
      CHECK(Superquadric::mirrored(from_a[0].feature) == from_b[0].feature);
    }
  }
}

TEST_CASE("a search that goes on from the last step finds what a new one finds") {
  Random random(7);
  for (const Vec3& e : exponents) {
    const Superquadric a(random.radii(), e, 1), b(random.radii(), e, 1);
    alignas(64) double pose_a[Superquadric::pose_size], pose_b[Superquadric::pose_size];
    CommonNormal found;
    int touching = 0;
    // b tumbles over a, faster than grains do, in and out of contact; the overlaps stay below the radii of the edges.
    for (int k = 0; k < 2000; ++k) {
      const Mat3 rb(Eigen::AngleAxisd(1e-3 * k, Vec3(1, 2, 3).normalized()));
      const Vec3 n = Eigen::AngleAxisd(1e-3 * k, Vec3(2, -1, 1).normalized()) * Vec3(0.9, 0.3, 0.3).normalized();
      const double overlap = 0.02 / e.maxCoeff() * (0.5 + std::sin(0.05 * k));
      const Vec3 d = separation_for(a, Mat3::Identity(), b, rb, n, overlap);
      a.orient(dem::Matrix3<double>::identity(), pose_a);
      b.orient(dem::from_eigen(rb), pose_b);
      double warm = 0.0, cold = 0.0;
      Superquadric::collide(a, pose_a, b, pose_b, dem::from_eigen(d), found,
                            [&](std::uint32_t, const auto& point) { warm = point.overlap; });
      Superquadric::collide(a, pose_a, b, pose_b, dem::from_eigen(d),
                            [&](std::uint32_t, const auto& point) { cold = point.overlap; });
      touching += warm > 0.0;
      CHECK(warm == Approx(std::max(0.0, overlap)).margin(1e-9));
      CHECK(cold == Approx(warm).margin(1e-9));
    }
    INFO(e.transpose());
    CHECK(touching > 1000);
  }
}
