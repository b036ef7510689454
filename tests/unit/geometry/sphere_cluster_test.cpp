#include "contacts.hpp"
#include "core/error_of.hpp"
#include "random.hpp"

#include <dem/geometry/cluster/sphere_cluster.hpp>
#include <dem/geometry/sphere/sphere.hpp>

#include <array>

namespace sphere_cluster_test {

using Catch::Approx;
using dem::Ball;
using dem::Mat3;
using dem::Vec3;
using dem::shape::Sphere;
using dem::shape::SphereCluster;

namespace {

/// The contacts by trying every pair of balls, from nothing but their centres.
template <int N>
std::vector<Contact> every_pair(const SphereCluster<N>& a, const Mat3& ra, const SphereCluster<N>& b, const Mat3& rb,
                                const Vec3& separation) {
  std::vector<Contact> found;
  for (int k = 0; k < a.count(); ++k) {
    for (int m = 0; m < b.count(); ++m) {
      const Vec3 from = ra * a.ball(k).centre, link = separation + rb * b.ball(m).centre - from;
      const double overlap = a.ball(k).radius + b.ball(m).radius - link.norm();
      if (overlap <= 0.0) continue;
      const double r = a.ball(k).radius, s = b.ball(m).radius;
      found.push_back({static_cast<std::uint32_t>(k * N + m), link.normalized(),
                       from + (r - 0.5 * overlap) * link.normalized(), overlap, r * s / (r + s)});
    }
  }
  return found;
}

template <int N>
void check_against_every_pair(const SphereCluster<N>& a, const SphereCluster<N>& b, double spread) {
  Random random(11);
  std::size_t touching = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const Vec3 separation = spread * random.vector();
    const auto found = contacts(a, ra, b, rb, separation), expected = every_pair(a, ra, b, rb, separation);
    touching += expected.size();
    REQUIRE(found.size() == expected.size());
    for (std::size_t c = 0; c < found.size(); ++c) {
      CHECK(found[c].feature == expected[c].feature);
      // Sums of a few numbers of size 1.
      CHECK(found[c].overlap == Approx(expected[c].overlap).margin(1e-14));
      CHECK((found[c].normal - expected[c].normal).norm() < 1e-13);
      CHECK((found[c].point - expected[c].point).norm() < 1e-13);
      CHECK(found[c].effective_radius == Approx(expected[c].effective_radius));
    }
  }
  REQUIRE(touching > 300);
}

const std::array<Ball, 3> bent = {{{{0, 0, 0}, 0.5}, {{0.7, 0, 0}, 0.4}, {{0.7, 0.6, 0.1}, 0.3}}};

}  // namespace

TEST_CASE("clusters touch where their balls do") {
  const SphereCluster<8> cube = dem::shape::cube8(1.0);
  check_against_every_pair(cube, cube, 1.6);
  // More than a pack, and a number of balls that fills no pack; different clusters of one type.
  std::vector<Ball> chain;
  for (int k = 0; k < 19; ++k) chain.push_back({{0.15 * k, 0.05 * (k % 3), 0.0}, 0.2 + 0.01 * k});
  const SphereCluster<21> long_one(chain), short_one(std::span<const Ball>(chain.data(), 5));
  check_against_every_pair(long_one, short_one, 1.2);
  check_against_every_pair(short_one, long_one, 1.2);
}

TEST_CASE("a contact of clusters has a mirrored feature when the clusters change places") {
  const SphereCluster<4> a(bent), b(std::span<const Ball>(bent.data(), 2));
  Random random(11);
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const Vec3 separation = 1.2 * random.vector();
    const auto ab = contacts(a, ra, b, rb, separation), ba = contacts(b, rb, a, ra, -separation);
    REQUIRE(ab.size() == ba.size());
    for (const Contact& c : ab) {
      const auto same = std::find_if(
          ba.begin(), ba.end(), [&](const Contact& d) { return d.feature == SphereCluster<4>::mirrored(c.feature); });
      REQUIRE(same != ba.end());
      CHECK((same->normal + c.normal).norm() < 1e-14);
      CHECK((same->point + separation - c.point).norm() < 1e-14);
      CHECK(SphereCluster<4>::mirrored(SphereCluster<4>::mirrored(c.feature)) == c.feature);
      ++compared;
    }
  }
  REQUIRE(compared > 100);
}

TEST_CASE("a cluster of one ball is a sphere") {
  const double r = 0.7;
  const std::array<Ball, 1> ball = {{{{0.3, -0.2, 0.1}, r}}};
  const SphereCluster<1> cluster(ball, [&] {
    auto mass = dem::sphere_mass_properties(r);
    mass.centre = ball[0].centre;
    return mass;
  }());
  const Sphere sphere(r);
  CHECK(cluster.bounding_radius() == Approx(sphere.bounding_radius()).epsilon(1e-15));
  CHECK(cluster.volume() == sphere.volume());
  CHECK(cluster.unit_inertia() == sphere.unit_inertia());
  CHECK(cluster.frame_centre() == ball[0].centre);
  // Without given mass properties they are the closed form: as good as rounding.
  const SphereCluster<1> found(ball);
  CHECK(found.volume() == Approx(sphere.volume()).epsilon(1e-15));
  CHECK((found.unit_inertia() - sphere.unit_inertia()).norm() < 1e-15);
  CHECK((found.frame_centre() - ball[0].centre).norm() < 1e-15 * r);
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 separation = 1.2 * random.vector();
    const auto c = contacts(cluster, random.rotation(), cluster, random.rotation(), separation);
    const auto s = contacts(sphere, Mat3::Identity(), sphere, Mat3::Identity(), separation);
    REQUIRE(c.size() == s.size());
    if (s.empty()) continue;
    CHECK(c[0].feature == s[0].feature);
    CHECK(c[0].overlap == Approx(s[0].overlap).margin(1e-14));
    CHECK((c[0].point - s[0].point).norm() < 1e-14);
  }
}

TEST_CASE("the cube of eight spheres has the mass properties of the solid cube") {
  const double h = 1.2e-3;
  const SphereCluster<8> cube = dem::shape::cube8(h);
  CHECK(cube.count() == 8);
  CHECK(cube.volume() == Approx(8 * h * h * h).epsilon(1e-14));
  // Edge 2h: V (2h)^2 / 6.
  for (int k = 0; k < 3; ++k) CHECK(cube.unit_inertia()[k] == Approx(8 * h * h * h * 4 * h * h / 6).epsilon(1e-14));
  CHECK(cube.bounding_radius() == Approx((std::sqrt(3.0) / 2 + 0.5) * h).epsilon(1e-14));
  for (int k = 0; k < 8; ++k) {
    CHECK(cube.ball(k).radius == 0.5 * h);
    CHECK((cube.ball(k).centre.cwiseAbs() - Vec3::Constant(0.5 * h)).norm() == 0.0);
    for (int m = 0; m < k; ++m) CHECK((cube.ball(k).centre - cube.ball(m).centre).norm() > 0.99 * h);
  }
}

TEST_CASE("a cluster's frame sits in the centre of mass along the principal axes") {
  const SphereCluster<4> c(bent);
  const auto mass = dem::union_mass_properties(bent);
  CHECK((c.frame_centre() - mass.centre).norm() < 1e-15);
  CHECK(c.frame_rotation().determinant() == Approx(1.0));
  const Mat3 back = c.frame_rotation() * c.unit_inertia().asDiagonal() * c.frame_rotation().transpose();
  CHECK((back - mass.inertia).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(c.unit_inertia().minCoeff() < 0.9 * c.unit_inertia().maxCoeff());
  CHECK(c.count() == 3);
  for (int k = 0; k < 3; ++k) {
    const Ball& original = bent[static_cast<std::size_t>(k)];
    CHECK((c.frame_centre() + c.frame_rotation() * c.ball(k).centre - original.centre).norm() < 1e-14);
    CHECK(c.ball(k).radius == original.radius);
    CHECK(c.ball(k).centre.norm() + c.ball(k).radius <= c.bounding_radius() * (1 + 1e-15));
  }
}

TEST_CASE("a cluster of balls that do not overlap has exact mass properties") {
  // Two balls that touch exactly, askew, and a third one apart from both.
  const Vec3 way = Vec3(1, 2, 2) / 3.0;
  const double a = 0.3, b = 0.2, c = 0.1;
  const std::array<Ball, 3> balls = {{{Vec3::Zero(), a}, {(a + b) * way, b}, {Vec3(-1, 0.5, 0), c}}};
  const SphereCluster<3> cluster(balls);
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // integral of x x^T about the origin, of each ball r^2/5 of its volume besides
  for (const Ball& ball : balls) {
    const double v = Sphere(ball.radius).volume();
    volume += v;
    first += v * ball.centre;
    second += v * (ball.centre * ball.centre.transpose() + ball.radius * ball.radius / 5.0 * Mat3::Identity());
  }
  const Vec3 centre = first / volume;
  second -= volume * centre * centre.transpose();
  const Mat3 inertia = second.trace() * Mat3::Identity() - second;
  CHECK(cluster.volume() == Approx(volume).epsilon(1e-15));
  CHECK((cluster.frame_centre() - centre).norm() < 1e-15);
  const Mat3 back =
      cluster.frame_rotation() * cluster.unit_inertia().asDiagonal() * cluster.frame_rotation().transpose();
  CHECK((back - inertia).cwiseAbs().maxCoeff() < 1e-14 * inertia.trace());
  // A hair nearer, their common part counts once: within the integration's error it is the same.
  const std::array<Ball, 2> near = {{{Vec3::Zero(), a}, {0.99 * (a + b) * way, b}}};
  REQUIRE(dem::any_overlap(near));
  REQUIRE_FALSE(dem::any_overlap(balls));
  const SphereCluster<2> integrated(near);
  CHECK(integrated.volume() < Sphere(a).volume() + Sphere(b).volume());
  CHECK(integrated.volume() == Approx(Sphere(a).volume() + Sphere(b).volume()).epsilon(1e-3));
}

TEST_CASE("given mass properties are taken as they are") {
  const dem::MassProperties given = {2.0, Vec3(0.1, 0.2, 0.3), Vec3(1.0, 2.0, 2.5).asDiagonal()};
  const SphereCluster<4> c(bent, given);
  CHECK(c.volume() == 2.0);
  CHECK(c.unit_inertia() == Vec3(1.0, 2.0, 2.5));
  CHECK(c.frame_centre() == given.centre);
  CHECK(c.frame_rotation() == Mat3::Identity());
  CHECK((c.ball(1).centre - (bent[1].centre - given.centre)).norm() < 1e-15);
}

TEST_CASE("a cluster shows each of its balls to surfaces, and no more") {
  const SphereCluster<8> c(bent);
  alignas(64) double pose[SphereCluster<8>::pose_size];
  const Mat3 turn = Random(11).rotation();
  c.orient(dem::from_eigen(turn), pose);
  std::uint32_t next = 0;
  c.sample_points(pose, [&](std::uint32_t k, const dem::contact::SamplePoint& sample) {
    CHECK(k == next++);
    CHECK((to_eigen(sample.centre) - turn * c.ball(static_cast<int>(k)).centre).norm() < 1e-15);
    CHECK(sample.radius == c.ball(static_cast<int>(k)).radius);
    CHECK(sample.effective_radius == sample.radius);
  });
  CHECK(next == 3);
}

TEST_CASE("wrong shapes are refused") {
  check_refused([] { Sphere(-0.1); }, "radius of a sphere is -0.1 m", "greater than zero");
  check_refused([] { dem::shape::cube8(0.0); }, "half-edge of a cube of 8 spheres is 0 m");
  check_refused([] { SphereCluster<2>{bent}; }, "SphereCluster<2> was given 3 spheres", "takes 1 to 2", "larger N");
  check_refused([] { SphereCluster<2>{std::span<const Ball>()}; }, "given 0 spheres");
  check_refused([] { SphereCluster<2>{std::array<Ball, 1>{{{{0, 0, 0}, -1.0}}}}; }, "radius of a sphere of a cluster");
  check_refused([] { SphereCluster<4>(bent, dem::MassProperties{}); }, "volume of a sphere cluster is 0 m^3");
}

}  // namespace sphere_cluster_test
