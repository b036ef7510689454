#include "catch.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/polyhedron/polyhedron_sphere.hpp>

#include <random>

using Catch::Approx;
using dem::Mat3;
using dem::Vec3;
using namespace dem::shape;

namespace {

struct Found {
  std::uint32_t feature;
  Vec3 normal, point;
  double overlap, share;
};
template <class A, class B>
std::vector<Found> contacts(const A& a, const Mat3& ra, const B& b, const Mat3& rb, const Vec3& link) {
  alignas(64) double pose_a[A::pose_size + 1] = {}, pose_b[B::pose_size + 1] = {};
  a.orient(dem::from_eigen(ra), pose_a);
  b.orient(dem::from_eigen(rb), pose_b);
  std::vector<Found> found;
  NoWarmStart none;
  collide_pair(a, pose_a, b, pose_b, dem::from_eigen(link), none, [&](std::uint32_t feature, const auto& t) {
    found.push_back({feature, to_eigen(t.normal), to_eigen(t.arm), t.overlap, t.weight});
  });
  return found;
}

const Mat3 turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();

}  // namespace

TEST_CASE("a sphere touches a box on a face, an edge, a corner, or from inside") {
  const Polyhedron body = box({2.0, 4.0, 6.0});
  const Sphere ball(0.5);
  const auto check = [&](const Vec3& ball_at, const Vec3& nearest, const Vec3& outward, double height) {
    const auto found = contacts(ball, Mat3::Identity(), body, turn, -(turn * ball_at));
    REQUIRE(found.size() == 1);
    CHECK(found[0].overlap == Approx(0.5 - height).epsilon(1e-12));
    CHECK((found[0].normal + turn * outward).norm() < 1e-13);
    // Halfway between the boundaries of ball and box.
    CHECK((found[0].point - turn * (nearest - ball_at - 0.5 * found[0].overlap * outward)).norm() < 1e-12);
    CHECK(found[0].share == 1.0);
    // And the other way round.
    const auto other = contacts(body, turn, ball, Mat3::Identity(), turn * ball_at);
    REQUIRE(other.size() == 1);
    CHECK(other[0].feature == found[0].feature);
    CHECK((other[0].normal + found[0].normal).norm() < 1e-14);
    CHECK((other[0].point - (found[0].point + turn * ball_at)).norm() < 1e-13);
  };
  check({1.3, 0.4, -2.0}, {1.0, 0.4, -2.0}, {1, 0, 0}, 0.3);
  check({0.9, 2.2, 2.9}, {0.9, 2.0, 2.9}, {0, 1, 0}, 0.2);
  check({1.3, 2.3, 0.5}, {1.0, 2.0, 0.5}, Vec3(1, 1, 0).normalized(), 0.3 * std::sqrt(2.0));
  check({-1.1, 2.1, -3.2}, {-1, 2, -3}, Vec3(-0.1, 0.1, -0.2).normalized(), std::sqrt(0.06));
  check({0.8, 0.1, 0.2}, {1.0, 0.1, 0.2}, {1, 0, 0}, -0.2);
  const auto none = [&](const Vec3& ball_at) { return contacts(ball, turn, body, turn, -(turn * ball_at)).empty(); };
  CHECK(none({1.5001, 0, 0}));
  CHECK(none({1.36, 2.36, 0}));  // beyond both faces by less than the radius, but not the edge
  CHECK(none({1.3, 2.3, 3.3}));
}

TEST_CASE("the nearest point of a polyhedron is nearer than any other point of its boundary") {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  for (const Polyhedron& body : {tetrahedron(1.0), dodecahedron(1.0), rock({.length = 2.0, .flatness = 0.5})}) {
    const ConvexMesh& mesh = body.mesh();
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 p = Vec3(normal(random), normal(random), normal(random));
      NearestPoint nearest;
      REQUIRE(nearest_point(body.tables(), dem::from_eigen(p), 10.0, nearest));
      double sampled = 1e300, highest = -1e300;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& face = mesh.faces[f];
        highest = std::max(highest, mesh.normals[f].dot(p) - mesh.offsets[f]);
        const auto at = [&](std::size_t k) { return mesh.corners[static_cast<std::size_t>(face[k])]; };
        for (std::size_t k = 2; k < face.size(); ++k) {
          for (int i = 0; i <= 20; ++i) {
            for (int j = 0; i + j <= 20; ++j) {
              const Vec3 q = at(0) + i / 20.0 * (at(k - 1) - at(0)) + j / 20.0 * (at(k) - at(0));
              sampled = std::min(sampled, (p - q).norm());
            }
          }
        }
      }
      if (highest <= 0.0) {
        CHECK(nearest.height == Approx(highest));
        continue;
      }
      // The true distance is below that of all samples, which are up to 0.06 apart: 1e-3 more at distances around 1.
      CHECK(nearest.height <= sampled + 1e-12);
      CHECK(nearest.height > sampled - 0.06);
      const Vec3 q = p - nearest.height * to_eigen(nearest.outward);  // on the boundary
      double height = -1e300;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        height = std::max(height, mesh.normals[f].dot(q) - mesh.offsets[f]);
      }
      CHECK(std::abs(height) < 1e-12);
    }
  }
}

TEST_CASE("a cluster of one sphere touches a polyhedron as the sphere does, a larger one sphere by sphere") {
  const Polyhedron body = cube(1.0);
  const dem::Ball one[] = {{Vec3::Zero(), 0.5}};
  const Vec3 link(-0.3, 0.2, 1.45);
  const auto single = contacts(SphereCluster<1>(one), Mat3::Identity(), body, turn, link);
  const auto sphere = contacts(Sphere(0.5), Mat3::Identity(), body, turn, link);
  REQUIRE(single.size() == 1);
  REQUIRE(sphere.size() == 1);
  CHECK(single[0].overlap == Approx(sphere[0].overlap).epsilon(1e-13));
  CHECK((single[0].point - sphere[0].point).norm() < 1e-13);

  // A cube of eight spheres that lies on the cube: four spheres touch, each in its lowest point.
  const auto four = contacts(cube8(1.0), Mat3::Identity(), body, Mat3::Identity(), {0, 0, -1.98});
  REQUIRE(four.size() == 4);
  for (const Found& f : four) {
    CHECK(f.overlap == Approx(0.02));
    CHECK((f.normal - Vec3(0, 0, -1)).norm() < 1e-13);
    CHECK(std::abs(f.point.x()) == Approx(0.5));
    CHECK(f.point.z() == Approx(-0.99));
  }
}
