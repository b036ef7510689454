#include "catch.hpp"
#include "contacts.hpp"
#include "random.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/math/rotation.hpp>

namespace polyhedron_contact_test {

using Catch::Approx;
using dem::Mat3;
using dem::Vec3;
using namespace dem::shape;

namespace {

Mat3 about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(axis.normalized())).toRotationMatrix();
}

/// A point of a patch with its share.
struct Point : Contact {
  double share;
};
std::vector<Point> patch(const Polyhedron& a, const Mat3& ra, const Polyhedron& b, const Mat3& rb, const Vec3& link) {
  double pose_a[Polyhedron::pose_size], pose_b[Polyhedron::pose_size];
  a.orient(dem::from_eigen(ra), pose_a);
  b.orient(dem::from_eigen(rb), pose_b);
  std::vector<Point> found;
  Polyhedron::collide(a, pose_a, b, pose_b, dem::from_eigen(link), [&](std::uint32_t feature, const auto& t) {
    found.push_back({{feature, to_eigen(t.normal), to_eigen(t.arm), t.overlap, t.effective_radius}, t.weight});
  });
  return found;
}

/// Force on b and torque about a's centre at unit stiffness.
struct Push {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};
Push push(const std::vector<Point>& points) {
  Push sum;
  for (const Point& p : points) {
    sum.force += p.share * p.overlap * p.normal;
    sum.torque += p.point.cross(Vec3(p.share * p.overlap * p.normal));
  }
  return sum;
}

/// Depth of the origin in the hull of all differences of corners: the least overlap along any axis whatsoever
/// (negative: a gap), from nothing but the corners.
double least_overlap(const Polyhedron& a, const Mat3& ra, const Polyhedron& b, const Mat3& rb, const Vec3& link) {
  std::vector<Vec3> differences;
  for (const Vec3& p : a.mesh().corners) {
    for (const Vec3& q : b.mesh().corners) differences.push_back(ra * p - (rb * q + link));
  }
  double depth = 1e300;
  for (const auto& t : dem::convex_hull(differences)) {
    const Vec3 &p = differences[std::size_t(t[0])], &q = differences[std::size_t(t[1])],
               &r = differences[std::size_t(t[2])];
    depth = std::min(depth, (q - p).cross(Vec3(r - p)).normalized().dot(p));
  }
  return depth;
}

double height_above(const Polyhedron& body, const Mat3& turn, const Vec3& point) {
  double highest = -1e300;
  for (std::size_t f = 0; f < body.mesh().faces.size(); ++f) {
    highest = std::max(highest, body.mesh().normals[f].dot(turn.transpose() * point) - body.mesh().offsets[f]);
  }
  return highest;
}

const std::vector<Polyhedron>& bodies() {
  static const std::vector<Polyhedron> list = {
      cube(1.0),          tetrahedron(1.2),    octahedron(1.2),
      prism(5, 1.0, 1.5), box({2.0, 1.0, .5}), rock({.length = 2.0, .flatness = 0.6, .points = 14})};
  return list;
}

}  // namespace

TEST_CASE("two polyhedra overlap as much as the hull of their difference says") {
  Random random(3);
  int touching = 0, apart = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Polyhedron &a = bodies()[random.below(bodies().size())], &b = bodies()[random.below(bodies().size())];
    const Mat3 ra = random.rotation(), rb = random.rotation();
    const Vec3 link = (a.radius() + b.radius()) * (1.05 + 0.25 * random.unit()) * random.direction();
    const double expected = least_overlap(a, ra, b, rb, link);
    const auto turn_a = dem::from_eigen(ra), turn_b = dem::from_eigen(rb);
    const PolyhedronContact found(a.tables(), turn_a, b.tables(), turn_b, dem::from_eigen(link));
    REQUIRE((found.count() > 0) == (expected > 0.0));
    (expected > 0.0 ? touching : apart) += 1;
    // Bodies of size 1; cross products of nearly parallel edges round by some 1e-12.
    if (expected > 0.0) CHECK(found.least_overlap() == Approx(expected).margin(1e-11));
  }
  CHECK(touching > 100);
  CHECK(apart > 100);
}

TEST_CASE("a contact of polyhedra is the same from both sides, and turns with the bodies") {
  Random random(3);
  int points = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Polyhedron &a = bodies()[random.below(bodies().size())], &b = bodies()[random.below(bodies().size())];
    const Mat3 ra = random.rotation(), rb = random.rotation(), turn = random.rotation();
    const Vec3 link = (a.radius() + b.radius()) * random.direction();
    const auto here = patch(a, ra, b, rb, link), there = patch(b, rb, a, ra, -link);
    const auto turned = patch(a, turn * ra, b, turn * rb, turn * link);
    REQUIRE(here.size() == there.size());
    REQUIRE(here.size() == turned.size());
    points += static_cast<int>(here.size());
    for (const Point& p : here) {
      const auto same = std::find_if(there.begin(), there.end(),
                                     [&](const Point& q) { return Polyhedron::mirrored(q.feature) == p.feature; });
      REQUIRE(same != there.end());
      CHECK((same->normal + p.normal).norm() < 1e-12);
      CHECK((same->point + link - p.point).norm() < 1e-11);
      CHECK(same->overlap == Approx(p.overlap).margin(1e-12));
      CHECK(same->share == Approx(p.share).margin(1e-9));  // small patches divide small areas
      CHECK(same->effective_radius == p.effective_radius);
    }
    for (std::size_t k = 0; k < here.size(); ++k) {
      CHECK(turned[k].feature == here[k].feature);
      CHECK((turned[k].normal - turn * here[k].normal).norm() < 1e-12);
      CHECK((turned[k].point - turn * here[k].point).norm() < 1e-11);
      CHECK(turned[k].overlap == Approx(here[k].overlap).margin(1e-12));
      if (k > 0) CHECK(here[k].feature > here[k - 1].feature);
    }
  }
  CHECK(points > 400);
}

TEST_CASE("the points of a patch lie in both bodies, and their shares add up to one at the most") {
  // Overlaps of a percent, as in beds; corners of 70 degrees and more.
  Random random(3);
  int touching = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Polyhedron &a = bodies()[random.below(bodies().size())], &b = bodies()[random.below(bodies().size())];
    const Mat3 ra = random.rotation(), rb = random.rotation();
    Vec3 link = random.direction();
    double scale = 3.0;
    for (int k = 0; k < 8; ++k) {  // pushed together until they just touch
      const double overlap = least_overlap(a, ra, b, rb, scale * link);
      if (overlap > 0.0) break;
      scale += overlap - 1e-3;
    }
    const auto points = patch(a, ra, b, rb, scale * link);
    if (points.empty() || points[0].overlap > 0.02) continue;
    ++touching;
    double sum = 0.0;
    for (const Point& p : points) {
      // Halfway between the boundaries; on the border of the patch it is inside by rounding and by the patch's slack of
      // 1e-6.
      CHECK(height_above(a, ra, p.point) < 0.25 * p.overlap + 2e-6);
      CHECK(height_above(b, rb, p.point - scale * link) < 0.25 * p.overlap + 2e-6);
      sum += p.share;
    }
    CHECK(sum < 1.0 + 1e-12);
    CHECK(sum > 0.3);  // a corner has a third
    if (touching > 150) break;
  }
  CHECK(touching > 100);
}

TEST_CASE("cubes face on face touch in the corners of the common rectangle with the whole stiffness") {
  const Polyhedron c = cube(1.0);
  const Mat3 level = Mat3::Identity();
  for (const Vec3& link : {Vec3(0, 0, 1.99), Vec3(0.5, 0.3, 1.99), Vec3(-1.2, 0.7, 1.99), Vec3(0.4, -1.99, 0.8)}) {
    const auto points = patch(c, level, c, level, link);
    REQUIRE(points.size() == 4);
    double sum = 0.0;
    Vec3 middle = Vec3::Zero();
    for (const Point& p : points) {
      CHECK(p.overlap == Approx(0.01));
      CHECK(p.share == Approx(0.25));
      CHECK((p.normal.cwiseAbs() - (link.z() > 1.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0))).norm() < 1e-12);
      sum += p.share;
      middle += 0.25 * p.point;
    }
    CHECK(sum == Approx(1.0));
    CHECK((middle - 0.5 * link).norm() < 1e-12);  // the common box of equal cubes is midway
  }
  // Turned by 45 degrees, a square in a square: an octagon.
  const auto octagon = patch(c, level, c, about(Vec3::UnitZ(), 0.25 * std::numbers::pi), {0, 0, 1.99});
  REQUIRE(octagon.size() == 8);
  for (const Point& p : octagon) CHECK(p.share == Approx(0.125));
}

TEST_CASE("an edge on a face has half the stiffness, a corner and crossed edges a third") {
  const Polyhedron c = cube(1.0);
  const Mat3 level = Mat3::Identity(), on_edge = about(Vec3::UnitX(), 0.25 * std::numbers::pi);
  const auto edge = patch(c, level, c, on_edge, {0.1, 0.2, 1.0 + std::sqrt(2.0) - 0.01});
  REQUIRE(edge.size() == 2);
  CHECK(push(edge).force.z() == Approx(0.5 * 0.01));

  const Mat3 on_corner = dem::rotation_between(Vec3(1, 1, 1), -Vec3::UnitZ());
  const auto corner = patch(c, level, c, on_corner, {0.1, 0.2, 1.0 + std::sqrt(3.0) - 0.01});
  REQUIRE(corner.size() == 1);
  CHECK(corner[0].share == Approx(1.0 / 3.0));
  CHECK(corner[0].overlap == Approx(0.01));
  CHECK((corner[0].point - Vec3(0.1, 0.2, 0.995)).norm() < 1e-12);

  const auto crossed =
      patch(c, on_edge, c, about(Vec3::UnitY(), 0.25 * std::numbers::pi), {0.1, 0.2, 2.0 * std::sqrt(2.0) - 0.01});
  REQUIRE(crossed.size() == 1);
  CHECK(crossed[0].share == Approx(1.0 / 3.0));
  CHECK(crossed[0].overlap == Approx(0.01));
  CHECK((crossed[0].normal - Vec3::UnitZ()).norm() < 1e-12);
  CHECK((crossed[0].point - Vec3(0.1, 0.0, std::sqrt(2.0) - 0.005)).norm() < 1e-12);
}

TEST_CASE("force and torque do not jump while a patch changes its corners") {
  // Largest change from one of many small steps to the next, against the largest slope that overlap (1e-2) and motion
  // allow. A jump of a share or of a corner would be some 1e-3, a step is 1e-5.
  const Polyhedron c = cube(1.0), wide = box({8.0, 8.0, 2.0});
  const auto largest_change = [&](const Polyhedron& below, int steps, auto&& motion) {
    Push last;
    double worst = 0.0, strongest = 0.0;
    for (int k = 0; k <= steps; ++k) {
      const auto [turn, link] = motion(double(k) / steps);
      const Push now = push(patch(below, Mat3::Identity(), c, turn, link));
      if (k > 0) worst = std::max({worst, (now.force - last.force).norm(), (now.torque - last.torque).norm()});
      strongest = std::max(strongest, now.force.norm());
      last = now;
    }
    REQUIRE(strongest > 3e-3);
    return worst;
  };
  // Turned about the vertical: 4 points to 8 and back.
  CHECK(largest_change(c, 4000,
                       [](double s) { return std::pair(about(Vec3::UnitZ(), 2.0 * s), Vec3(0.1, 0.2, 1.99)); }) < 2e-5);
  // Slid over the other's edges, turned, until a corner of five depths is left: the torque changes with the place of
  // the force, 1e-2 a unit of length.
  CHECK(largest_change(c, 4000, [](double s) {
          return std::pair(about(Vec3::UnitZ(), 0.3), Vec3(0.2 + 1.8 * s, 0.1 + 0.95 * s, 1.99));
        }) < 3e-5);
  // From face to edge: the lowest edge keeps its depth of 0.01, the face lifts off (at 0.005, hence small steps there).
  const auto touching_down = [](const Mat3& turn) {
    return std::pair(turn, Vec3(0.1, 0.2, 1.99 + turn.row(2).cwiseAbs().sum() - 1.0));
  };
  for (const Polyhedron& below : {c, wide}) {
    CHECK(largest_change(below, 20000, [&](double s) { return touching_down(about(Vec3::UnitX(), 0.7 * s * s)); }) <
          3e-5);
  }
  // From edge to corner, and from one face that looks down to the next.
  CHECK(largest_change(wide, 20000, [&](double s) {
          return touching_down(about(Vec3::UnitY(), 0.5 * s * s) * about(Vec3::UnitX(), 0.6));
        }) < 3e-5);
  CHECK(largest_change(wide, 20000, [&](double s) {
          return touching_down(about(Vec3::UnitY(), 0.5) * about(Vec3::UnitX(), 0.6 + 0.4 * s));
        }) < 3e-5);
}

TEST_CASE("where edges take over from a face the force turns, by the angle that counts as flat, and keeps its size") {
  // The lower edge of a cube lies across the edge of another and tilts: at 0.05 the edges get the contact. (At 0.07 the
  // lowest corner overlaps as little as the edges and gets it, as in every test of separating axes.)
  const Polyhedron c = cube(1.0);
  Push last;
  double turned = 0.0, resized = 0.0;
  for (int k = 0; k <= 4000; ++k) {
    const Mat3 turn = about(Vec3::UnitY(), 0.065 * k / 4000.0) * about(Vec3::UnitX(), 0.6);
    const Push now = push(patch(c, Mat3::Identity(), c, turn, {0.1, 0.2, 0.99 + turn.row(2).cwiseAbs().sum()}));
    REQUIRE(now.force.norm() > 1e-3);
    if (k > 0) {
      turned = std::max(turned, (now.force.normalized() - last.force.normalized()).norm());
      resized = std::max(resized, std::abs(now.force.norm() / last.force.norm() - 1.0));
    }
    last = now;
  }
  CHECK(turned == Approx(0.05).epsilon(0.01));
  CHECK(resized < 5e-3);
}

}  // namespace polyhedron_contact_test
