#include "catch.hpp"
#include "contacts.hpp"
#include "random.hpp"

#include <dem/geometry/superquadric/superquadric.hpp>
#include <dem/geometry/superquadric/superquadric_points.hpp>

#include <numbers>

using Catch::Approx;
using dem::Mat3;
using dem::Vec3;
using dem::shape::PointArea;
using dem::shape::Superquadric;
using dem::shape::SuperquadricPoints;

namespace {

double deepest(const std::vector<Contact>& found) {
  double depth = 0.0;
  for (const Contact& c : found) depth = std::max(depth, c.overlap);
  return depth;
}

/// Sum of weight times depth along the normals: the force of a stiffness of one.
template <class Shape>
Vec3 push(const Shape& a, const Mat3& ra, const Shape& b, const Mat3& rb, const Vec3& separation) {
  double pose_a[Shape::pose_size], pose_b[Shape::pose_size];
  a.orient(dem::from_eigen(ra), pose_a);
  b.orient(dem::from_eigen(rb), pose_b);
  Vec3 sum = Vec3::Zero();
  Shape::collide(a, pose_a, b, pose_b, dem::from_eigen(separation), [&](std::uint32_t, const auto& point) {
    sum += point.weight * point.overlap * to_eigen(point.normal);
  });
  return sum;
}

}  // namespace

TEST_CASE("points of spheres reach into each other as spheres do") {
  const double ra = 1.0, rb = 1.5, d = 2.3;
  const SuperquadricPoints a(Vec3::Constant(ra), {2, 2, 2}, 26, PointArea::physical);
  const SuperquadricPoints b(Vec3::Constant(rb), {2, 2, 2}, 26, PointArea::physical);
  Random random(5);
  const Vec3 along = random.direction();
  const auto found = contacts(a, random.rotation(), b, random.rotation(), Vec3(d * along));
  REQUIRE(found.size() > 50);
  for (const Contact& c : found) {
    // Radial depth is exact for spheres. The contact lies midway between the point and the other sphere's surface.
    const bool point_of_a = c.feature < SuperquadricPoints::other_way;
    const Vec3 out = point_of_a ? Vec3(-c.normal) : c.normal;
    const Vec3 point = c.point - 0.5 * c.overlap * out;
    const Vec3 from_other = point_of_a ? Vec3(point - d * along) : point;
    CHECK(from_other.norm() == Approx((point_of_a ? rb : ra) - c.overlap).epsilon(1e-12));
    CHECK((from_other.normalized() - out).norm() < 1e-12);
    CHECK((point_of_a ? point : Vec3(point - d * along)).norm() == Approx(point_of_a ? ra : rb).epsilon(1e-12));
  }
  // The integral of depth over the cap of a in b, at the distance s from b's centre: dA = 2 pi ra s ds / d, and the
  // same for b's cap; across the axis, forces cancel. Along it the normal's share is (d^2 + s^2 - ra^2) / (2 d s).
  const auto cap = [&](double mine, double other) {
    double sum = 0.0;
    const int n = 2000;
    for (int k = 0; k < n; ++k) {
      const double s = d - mine + (other + mine - d) * (k + 0.5) / n;
      sum += (other - s) * 2 * std::numbers::pi * mine * s / d * (d * d + s * s - mine * mine) / (2 * d * s) *
             (other + mine - d) / n;
    }
    return sum;
  };
  const Vec3 force = push(a, Mat3::Identity(), b, random.rotation(), Vec3(d * along));
  // About a hundred points share the caps, so their rims are drawn to a few per cent.
  CHECK(force.dot(along) == Approx(cap(ra, rb) + cap(rb, ra)).epsilon(0.03));
  CHECK((force - force.dot(along) * along).norm() < 0.03 * force.norm());
}

TEST_CASE("points and the common normal agree the better, the finer the points") {
  Random random(5);
  // What 218 and 4,058 points miss on average of 3,000 pairs (the table in ARCHITECTURE.md). Single pairs scatter by
  // 0.35 and 0.06: three deviations of the mean of 150 pairs.
  struct Missed {
    double exponent, coarse, fine;
  };
  const double scatter_coarse = 3 * 0.35 / std::sqrt(150.0), scatter_fine = 3 * 0.06 / std::sqrt(150.0);
  for (const Missed& missed : {Missed{2.0, 0.55, 0.036}, Missed{4.0, 0.62, 0.044}, Missed{8.0, 0.74, 0.073}}) {
    const double p = missed.exponent;
    const Vec3 radii(1, 1.2, 0.8), e = Vec3::Constant(p);
    const Superquadric direct(radii, e, 1);
    const SuperquadricPoints coarse(radii, e, 6), fine(radii, e, 26);
    double missed_coarse = 0.0, missed_fine = 0.0, above = 0.0;
    int pairs = 0;
    while (pairs < 150) {
      const Mat3 ra = random.rotation(), rb = random.rotation();
      const Vec3 way = random.direction();
      // The distance at which they overlap by 1 %.
      double apart = 3.2, deep = 0.0;
      std::vector<Contact> exact;
      for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (apart + deep);
        const auto found = contacts(direct, ra, direct, rb, Vec3(middle * way));
        (found.empty() || found[0].overlap < 0.01 ? apart : deep) = middle;
        if (deep == middle) exact = found;
      }
      const double distance = deep;
      ++pairs;
      const double few = deepest(contacts(coarse, ra, coarse, rb, Vec3(distance * way)));
      const double many = deepest(contacts(fine, ra, fine, rb, Vec3(distance * way)));
      missed_coarse += (exact[0].overlap - few) / exact[0].overlap;
      missed_fine += (exact[0].overlap - many) / exact[0].overlap;
      above = std::max(above, many / exact[0].overlap);
    }
    INFO("exponent " << p << ": points miss " << missed_coarse / pairs << " and " << missed_fine / pairs);
    // A point in the other grain is at most as deep as the grains overlap, but for the overestimate of its depth.
    CHECK(above < 1.001);
    CHECK(missed_coarse / pairs == Approx(missed.coarse).margin(scatter_coarse));
    CHECK(missed_fine / pairs == Approx(missed.fine).margin(scatter_fine));
  }
}

TEST_CASE("faces that lie on each other push with the area of the face") {
  const SuperquadricPoints cube(Vec3::Ones(), Vec3::Constant(8), 24, PointArea::physical);
  const Mat3 one = Mat3::Identity();
  const double depth = 0.01;
  const Vec3 force = push(cube, one, cube, one, Vec3(2 - depth, 0, 0));
  // Depth at (y, z) is that of one face, (1 - y^8 - z^8)^(1/8), and its mirror: integrated over the face, both ways
  // round. Points stand for cells, whose rims are drawn to a few per cent.
  double expected = 0.0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double y = (i + 0.5) / n, z = (j + 0.5) / n;
      const double rest = 1 - std::pow(y, 8) - std::pow(z, 8);
      if (rest <= 0) continue;
      const double d = 2 * std::pow(rest, 1.0 / 8) - (2 - depth);
      if (d > 0) expected += 2 * 4 * d / (n * n);
    }
  }
  CHECK(force.x() == Approx(expected).epsilon(0.05));
  CHECK(force.tail<2>().norm() < 1e-9 * force.x());

  // Relative areas: the same force, in mean points.
  const SuperquadricPoints relative(Vec3::Ones(), Vec3::Constant(8), 24, PointArea::relative);
  double total = 0.0;
  for (int k = 0; k < cube.points().count; ++k) total += cube.points().weight[static_cast<std::size_t>(k)];
  const Vec3 same = push(relative, one, relative, one, Vec3(2 - depth, 0, 0));
  CHECK(same.x() * total / cube.points().count == Approx(force.x()).epsilon(1e-12));

  // What the time step is told: the points of a face and their weight.
  const auto patch = cube.surface_patch();
  CHECK(cube.patch().points == 2 * patch.points);  // in a pair, a face of each
  CHECK(cube.patch().weight == 2 * patch.weight);
  // Behind the face's plane by less than a tenth of the mean radius 1.216: |y|^8 + |z|^8 < 1 - 0.878^8 = 0.647, which
  // is 4 * 0.647^(1/4) Gamma(9/8)^2 / Gamma(5/4) = 3.51; less the slope at the rim.
  CHECK(patch.weight < 3.51);
  CHECK(patch.weight == Approx(3.51).epsilon(0.1));
  CHECK(patch.points == Approx(25 * 25).epsilon(0.15));
}

TEST_CASE("points that share a contact are one contact, however many there are") {
  const Mat3 one = Mat3::Identity();
  const double depth = 0.01;
  // A cube of exponent 32 is flat over most of its face: but for those of the rim all points there are `depth` deep,
  // and their weights sum to 1.
  for (const int divisions : {4, 12, 24}) {
    const SuperquadricPoints cube(Vec3::Ones(), Vec3::Constant(32), divisions);
    CHECK(cube.has_shares());
    CHECK(push(cube, one, cube, one, Vec3(2 - depth, 0, 0)).x() == Approx(depth).epsilon(0.05));
    double weights = 0.0;
    std::size_t points = 0;
    for (const Contact& c : contacts(cube, one, cube, one, Vec3(2 - depth, 0, 0))) {
      weights += c.weight;
      points += 1;
    }
    CHECK(points >= 2 * 3 * 3);
    // Points at the rim, which are less deep, count less: the weights sum to a little more than what counts.
    CHECK(weights == Approx(1.0).epsilon(0.1));
    CHECK(cube.patch().weight == 1.0);
    CHECK(cube.surface_patch().weight == 1.0);
  }
  // The force does not jump when points come and go: a corner pressed into a face, in small steps.
  const SuperquadricPoints cube(Vec3::Ones(), Vec3::Constant(8), 12);
  const Mat3 tilted = Eigen::AngleAxisd(0.6, Vec3(1, 2, 0.5).normalized()).toRotationMatrix();
  double last = 0.0;
  for (double d = 2.7; d > 2.2; d -= 1e-3) {
    const double force = push(cube, one, cube, tilted, Vec3(d, 0, 0)).x();
    CHECK(std::abs(force - last) < 3e-3);  // K times the step, and twice that where weights shift to deeper points
    last = force;
  }
  CHECK(last > 0.05);
}

TEST_CASE("points look the same from either side and in any frame, and contacts keep their numbers") {
  Random random(5);
  const SuperquadricPoints a({1, 1.3, 0.7}, {3, 4, 8}, 8), b({1.1, 0.9, 1.2}, {2, 2.5, 6}, 8);
  int touching = 0;
  for (int k = 0; k < 60; ++k) {
    const Mat3 ra = random.rotation(), rb = random.rotation(), turn = random.rotation();
    const Vec3 d = 1.9 * random.direction();
    const auto from_a = contacts(a, ra, b, rb, d), from_b = contacts(b, rb, a, ra, -d);
    const auto turned = contacts(a, turn * ra, b, turn * rb, turn * d);
    touching += !from_a.empty();
    REQUIRE(from_b.size() == from_a.size());
    REQUIRE(turned.size() == from_a.size());
    for (std::size_t c = 0; c < from_a.size(); ++c) {
      if (c > 0) CHECK(from_a[c].feature > from_a[c - 1].feature);
      const std::uint32_t number = SuperquadricPoints::mirrored(from_a[c].feature);
      const auto same =
          std::find_if(from_b.begin(), from_b.end(), [&](const Contact& x) { return x.feature == number; });
      REQUIRE(same != from_b.end());
      CHECK(same->overlap == Approx(from_a[c].overlap).margin(1e-12));
      CHECK((same->normal + from_a[c].normal).norm() < 1e-9);
      CHECK((same->point + d - from_a[c].point).norm() < 1e-12);
      CHECK(turned[c].feature == from_a[c].feature);
      CHECK(turned[c].overlap == Approx(from_a[c].overlap).margin(1e-12));
      CHECK((turned[c].normal - turn * from_a[c].normal).norm() < 1e-9);
    }
  }
  CHECK(touching > 20);
}

TEST_CASE("a grain tells whether a point lies in it, whichever way it is turned") {
  Random random(5);
  const SuperquadricPoints grain({1, 1.3, 0.7}, {3, 4, 8}, 3);
  for (int k = 0; k < 200; ++k) {
    const Mat3 r = random.rotation();
    double pose[SuperquadricPoints::pose_size];
    grain.orient(dem::from_eigen(r), pose);
    const Vec3 x = random.direction();
    double depth = -1, own_depth = -1;
    dem::Vector3<double> normal{}, own{};
    const bool in = grain.penetration(pose, dem::from_eigen(Vec3(r * x)), depth, normal);
    REQUIRE(in == grain.solid().penetration(dem::from_eigen(x), own_depth, own));
    if (!in) continue;
    CHECK(depth == Approx(own_depth).margin(1e-12));
    CHECK((to_eigen(normal) - r * to_eigen(own)).norm() < 1e-9);
  }
}

TEST_CASE("a plane touches a turned ellipsoid where the closed form says") {
  Random random(5);
  const Vec3 radii(1, 1.3, 0.7);
  const SuperquadricPoints grain(radii, {2, 2, 2}, 3);
  for (int k = 0; k < 50; ++k) {
    const Mat3 r = random.rotation();
    double pose[SuperquadricPoints::pose_size];
    grain.orient(dem::from_eigen(r), pose);
    const Vec3 n = random.direction();
    // With the matrix A = R diag(r_i^2) R^T of the ellipsoid: A n over the root of n . A n.
    const Mat3 a = r * radii.cwiseAbs2().asDiagonal() * r.transpose();
    const Vec3 expected = a * n / std::sqrt(n.dot(a * n));
    CHECK((to_eigen(grain.support(pose, dem::from_eigen(n))) - expected).norm() < 1e-12);
  }
}
