#include "catch.hpp"

#include <dem/geometry/contact_point.hpp>

using Catch::Approx;
using dem::Vec3;
using dem::Vector3;
using dem::contact::ClusterContactPoint;
using dem::contact::Geometry;
using dem::contact::SphereContactPoint;
using dem::contact::SurfaceContactPoint;

namespace {
// The numbers below are sums and products of a few numbers of size 1.
void check_close(const Vector3<double>& a, const Vec3& b) { CHECK((dem::to_eigen(a) - b).norm() < 1e-15); }
}  // namespace

TEST_CASE("two spheres touch in the middle of their overlap") {
  const Geometry<double> g = SphereContactPoint<double>{{0, 1.5, 2.0}, 2.0, 1.0}.geometry();  // distance 2.5
  check_close(g.normal, {0, 0.6, 0.8});
  CHECK(g.overlap == Approx(0.5).epsilon(1e-15));
  check_close(g.arm, 1.75 * Vec3(0, 0.6, 0.8));  // 2 - 0.25 from the centre of i; 1 - 0.25 from that of j
  CHECK(g.effective_radius == Approx(2.0 / 3.0).epsilon(1e-15));
  CHECK(g.weight == 1.0);
}

TEST_CASE("spheres of a cluster touch at arms from the grain's centre") {
  const Geometry<double> g = ClusterContactPoint<double>{{0.1, 0.2, 0.3}, {0, 1.5, 2.0}, 2.0, 1.0}.geometry();
  check_close(g.normal, {0, 0.6, 0.8});
  CHECK(g.overlap == Approx(0.5).epsilon(1e-15));
  check_close(g.arm, Vec3(0.1, 0.2, 0.3) + 1.75 * Vec3(0, 0.6, 0.8));
}

TEST_CASE("the same contact seen from either side is the same contact") {
  const Vec3 ci(0.3, -0.1, 0.2), cj(-0.2, 0.4, 0.1), separation(0.7, 0.9, -1.4);
  const Vec3 link = separation + cj - ci;
  const auto from_i = ClusterContactPoint<double>{dem::from_eigen(ci), dem::from_eigen(link), 1.2, 0.8}.geometry();
  const auto from_j =
      ClusterContactPoint<double>{dem::from_eigen(cj), dem::from_eigen(Vec3(-link)), 0.8, 1.2}.geometry();
  check_close(from_j.normal, -dem::to_eigen(from_i.normal));
  CHECK(from_j.overlap == Approx(from_i.overlap).epsilon(1e-14));
  check_close(from_j.arm, dem::to_eigen(from_i.arm) - separation);  // the same point in space
}

TEST_CASE("a sphere touches a surface in the middle of the overlap") {
  const Geometry<double> g = SurfaceContactPoint<double>{{0.5, 0, 0}, {0, 0, -1}, 1.0, 0.6, 1.0, 1.0}.geometry();
  CHECK(g.overlap == Approx(0.4));
  check_close(g.arm, {0.5, 0, -0.8});
  CHECK(g.effective_radius == 1.0);
  // A centre behind the surface: the gap is negative and the overlap larger than the radius.
  CHECK(SurfaceContactPoint<double>{{0, 0, 0}, {0, 0, -1}, 1.0, -0.5, 1.0, 1.0}.geometry().overlap == Approx(1.5));
}

TEST_CASE("spheres with the same centre give finite numbers") {
  const Geometry<double> g = SphereContactPoint<double>{{0, 0, 0}, 1.0, 1.0}.geometry();
  CHECK(g.overlap == 2.0);
  CHECK(dem::to_eigen(g.normal).allFinite());
  CHECK(dem::to_eigen(g.arm).allFinite());
}
