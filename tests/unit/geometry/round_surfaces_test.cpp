#include "core/error_of.hpp"
#include "random.hpp"
#include "surface_contacts.hpp"

#include <dem/geometry/cylinder/cylinder.hpp>
#include <dem/geometry/sphere/sphere_surface.hpp>
#include <dem/geometry/superquadric/superquadric_surface.hpp>

namespace round_surfaces {  // whose names are those of grains elsewhere

using Catch::Approx;
using dem::Vec3;
using dem::surface::Cylinder;
using dem::surface::Side;
using dem::surface::Sphere;
using dem::surface::Superquadric;

namespace {

/// near() must say yes wherever contacts() finds something, for doubles and for packs, and bounds() must hold it.
template <class Surface>
void check_near(const Surface& surface, const Vec3& half) {
  Random random(11);
  int touching = 0, excluded = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Vec3 p = random.in(half);
    const double r = trial % 4 == 0 ? 0.0 : random.between(0.0, 0.4);
    const auto found = surface_contacts(surface, p, r);
    const dem::Vector3<dem::Pack> packed = {dem::Pack(p.x()), dem::Pack(p.y()), dem::Pack(p.z())};
    const bool near = surface.near(dem::from_eigen(p), r);
    CHECK(near == dem::any_of(surface.near(packed, dem::Pack(r))));
    excluded += !near;
    for (const SurfaceContact& t : found) {
      CHECK(near);
      CHECK(t.gap < r);
      const auto bounds = surface.bounds();
      CHECK((p.array() >= bounds.low.array() - r).all());
      CHECK((p.array() <= bounds.high.array() + r).all());
    }
    touching += !found.empty();
  }
  CHECK(touching > 100);
  CHECK(excluded > 100);
}

}  // namespace

TEST_CASE("a ball and a round cavity are touched where the closed form says") {
  const Sphere ball(2.0), cavity(2.0, Side::inside);
  const Vec3 u = Vec3(1, -2, 2) / 3;
  check_one(surface_contacts(ball, 2.3 * u, 0.5), -u, 0.3);
  check_one(surface_contacts(ball, 1.5 * u, 0.1), -u, -0.5);
  check_one(surface_contacts(ball, 1.5 * u, 0.0), -u, -0.5);
  CHECK(surface_contacts(ball, 2.6 * u, 0.5).empty());
  check_one(surface_contacts(cavity, 1.7 * u, 0.5), u, 0.3);
  check_one(surface_contacts(cavity, 2.3 * u, 0.5), u, -0.3);
  CHECK(surface_contacts(cavity, 1.4 * u, 0.5).empty());
  CHECK(surface_contacts(ball, Vec3::Zero(), 0.5).size() == 1);
  check_near(ball, {3, 3, 3});
  check_near(cavity, {2.1, 2.1, 2.1});
}

TEST_CASE("a solid cylinder is touched on lateral surface, ends and rims") {
  const Cylinder c(1.0, 3.0);
  const Vec3 u(0.6, 0.8, 0);
  check_one(surface_contacts(c, 1.2 * u + Vec3(0, 0, 0.7), 0.3), -u, 0.2);
  check_one(surface_contacts(c, 0.5 * u + Vec3(0, 0, 1.7), 0.3), {0, 0, -1}, 0.2);
  check_one(surface_contacts(c, 0.5 * u + Vec3(0, 0, -1.7), 0.3), {0, 0, 1}, 0.2);
  check_one(surface_contacts(c, 1.12 * u + Vec3(0, 0, 1.66), 0.3), -0.6 * u - Vec3(0, 0, 0.8), 0.2);  // a rim
  check_one(surface_contacts(c, 0.9 * u, 0.3), -u, -0.1);  // from inside: out
  check_one(surface_contacts(c, 0.2 * u + Vec3(0, 0, -1.45), 0.0), {0, 0, 1}, -0.05);
  CHECK(surface_contacts(c, 1.4 * u, 0.3).empty());
  CHECK(surface_contacts(c, Vec3(0, 0, 0), 0.1).size() == 1);
  check_near(c, {1.8, 1.8, 2.2});
}

TEST_CASE("a drum is touched from inside on its lateral surface and its ends") {
  const Cylinder drum(1.0, 3.0, Side::inside);
  const Vec3 u(0.6, 0.8, 0);
  check_one(surface_contacts(drum, 0.8 * u, 0.3), u, 0.2);
  check_one(surface_contacts(drum, 1.1 * u, 0.3), u, -0.1);
  const auto corner = surface_contacts(drum, 0.8 * u + Vec3(0, 0, -1.4), 0.3);
  REQUIRE(corner.size() == 2);
  CHECK(corner[0].feature == Cylinder::lateral);
  CHECK(corner[1].feature == Cylinder::low_end);
  CHECK((corner[1].normal - Vec3(0, 0, -1)).norm() == 0.0);
  CHECK(corner[1].gap == Approx(0.1));
  CHECK(surface_contacts(drum, Vec3(0, 0, 0), 0.3).empty());
  check_near(drum, {1.1, 1.1, 1.6});
}

TEST_CASE("a tube is touched from inside, from outside, and on its rims") {
  const Cylinder tube = Cylinder::tube(1.0, 1.2, 3.0);
  const Vec3 u(0.6, 0.8, 0), top(0, 0, 1.5);
  check_one(surface_contacts(tube, 0.8 * u, 0.3), u, 0.2);
  check_one(surface_contacts(tube, 1.4 * u, 0.3), -u, 0.2);
  check_one(surface_contacts(tube, 1.1 * u + Vec3(0, 0, 1.6), 0.3), {0, 0, -1}, 0.1);
  check_one(surface_contacts(tube, 0.88 * u + top + Vec3(0, 0, 0.16), 0.3), 0.6 * u - Vec3(0, 0, 0.8),
            0.2);                                               // inner rim
  check_one(surface_contacts(tube, 1.05 * u, 0.3), u, -0.05);   // in the wall: back inside
  check_one(surface_contacts(tube, 1.15 * u, 0.3), -u, -0.05);  // or outside
  CHECK(surface_contacts(tube, Vec3(0, 0, 1.5), 0.3).empty());
  check_near(tube, {1.8, 1.8, 2.2});
}

TEST_CASE("round superquadrics are balls and ellipsoids") {
  const Superquadric ball(Vec3::Constant(2.0));
  Random random(11);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 u = random.in({1, 1, 1}).normalized();
    check_one(surface_contacts(ball, 2.3 * u, 0.5), -u, 0.3, 1e-11);
    check_one(surface_contacts(ball, 1.8 * u, 0.0), -u, -0.2, 1e-11);
    check_one(surface_contacts(Superquadric(Vec3::Constant(2.0), Vec3::Constant(2.0), Side::inside), 1.7 * u, 0.5), u,
              0.3, 1e-11);
  }
  // From a place on an ellipsoid along its normal n = grad F/|grad F|: that is the way back, from both sides.
  const Superquadric egg({1.0, 1.5, 2.0});
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 s = random.in({1, 1, 1}).normalized(), x = s.cwiseProduct(egg.radii());
    const Vec3 n = x.cwiseQuotient(egg.radii().cwiseProduct(egg.radii())).normalized();
    check_one(surface_contacts(egg, x + 0.2 * n, 0.3), -n, 0.2, 1e-10);
    check_one(surface_contacts(egg, x - 0.2 * n, 0.0), -n, -0.2, 1e-10);  // 0.2 < smallest radius of curvature, 1/2
  }
  check_near(egg, {1.5, 2.0, 2.5});
  check_near(Superquadric({1.0, 1.5, 2.0}, {4, 3, 2}, Side::inside), {0.9, 1.4, 1.9});
}

TEST_CASE("superquadrics of any exponent: the place found is the nearest one, and the normal is that of the surface") {
  Random random(11);
  for (const Vec3& exponents : {Vec3(8, 8, 8), Vec3(2, 2, 8), Vec3(3.5, 20, 2)}) {
    const Superquadric s({1.0, 1.5, 2.0}, exponents);
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 p = random.in({1.6, 2.1, 2.6});
      if (s.function().value(p.data()) < 0.0) continue;
      const auto found = surface_contacts(s, p, 9.0);
      REQUIRE(found.size() == 1);
      const Vec3 foot = p + found[0].gap * found[0].normal;
      CHECK(std::abs(s.function().value(foot.data())) < 1e-10);
      double g[3];
      s.function().gradient(foot.data(), g);
      CHECK((Vec3(g[0], g[1], g[2]).normalized() + found[0].normal).norm() < 1e-9);
      // No place of the surface near that one is closer (it is convex, so none anywhere).
      for (int k = 0; k < 20; ++k) {
        Vec3 other = foot + random.in({0.05, 0.05, 0.05});
        for (int pull = 0; pull < 60; ++pull) {  // onto the surface, along the ray from the centre
          const double f = s.function().value(other.data());
          s.function().gradient(other.data(), g);
          other *= 1.0 - f / Vec3(g[0], g[1], g[2]).dot(other);
        }
        CHECK((other - p).norm() >= found[0].gap - 1e-10);
      }
    }
  }
  // Large exponents make a box.
  check_one(surface_contacts(Superquadric({1.0, 1.5, 2.0}, Vec3::Constant(32)), {1.2, 0.1, 0.1}, 0.3), {-1, 0, 0}, 0.2,
            1e-9);
  const auto middle = surface_contacts(Superquadric({1.0, 1.5, 2.0}), Vec3::Zero(), 0.0);
  check_one(middle, {-1, 0, 0}, -1.0, 1e-9);
}

TEST_CASE("points of round surfaces lie on them") {
  int n = 0;
  const dem::surface::Aabb all = {Vec3::Constant(-9), Vec3::Constant(9)};
  const Superquadric s({1.0, 1.5, 2.0}, {4, 3, 2});
  s.points(all, [&](std::uint32_t k, const auto& p, double) {
    CHECK(k == static_cast<std::uint32_t>(n++));
    CHECK(std::abs(s.function().value(to_eigen(p).eval().data())) < 1e-12);
  });
  CHECK(n == 9 * 9 * 9 - 7 * 7 * 7);
  n = 0;
  Cylinder(1.0, 3.0).with_rim_points(12).points(all, [&](std::uint32_t k, const auto& p, double) {
    CHECK(k == static_cast<std::uint32_t>(n++));
    CHECK(std::hypot(p.x, p.y) == Approx(1.0));
    CHECK(std::abs(p.z) == 1.5);
  });
  CHECK(n == 24);
  // A tube shows the rims of its hole too, a drum nothing.
  int outer = 0, inner = 0;
  Cylinder::tube(0.8, 1.0, 3.0).with_rim_points(12).points(all, [&](std::uint32_t k, const auto& p, double) {
    CHECK(k == static_cast<std::uint32_t>(outer + inner));
    (std::hypot(p.x, p.y) > 0.9 ? outer : inner) += 1;
    CHECK(std::hypot(p.x, p.y) == Approx(outer > 0 && inner == 0 ? 1.0 : 0.8));
  });
  CHECK(outer == 24);
  CHECK(inner == 24);
  Cylinder(1.0, 3.0, Side::inside).points(all, [&](auto...) { CHECK(false); });
}

TEST_CASE("rims are shown to sharp grains where they are near, as straight edges are") {
  // Fixed points are 2 pi/48 apart; for a grain of radius 0.1 three more of each rim lie half a radius apart.
  const Cylinder tube = Cylinder::tube(0.8, 1.0, 3.0);
  const Vec3 at(0.9 * std::cos(0.2), 0.9 * std::sin(0.2), 1.52);
  std::vector<Vec3> near;
  std::uint32_t last = 0;
  tube.corners(dem::from_eigen(at), 0.15, [&](std::uint32_t k, const dem::Vector3<double>& p) {
    CHECK((near.empty() || k > last));
    last = k;
    CHECK((to_eigen(p) - at).norm() <= 0.15);
    CHECK(p.z == 1.5);
    if (k >= 4 * 48) near.push_back(to_eigen(p));
  });
  REQUIRE(near.size() == 6);
  for (int place = 0; place < 3; ++place) {
    const double outer = 0.2 + (0.5 * place - 0.5) * 0.15, inner = 0.2 + (0.5 * place - 0.5) * 0.15 / 0.8;
    const auto k = static_cast<std::size_t>(place);
    CHECK((near[k] - Vec3(std::cos(outer), std::sin(outer), 1.5)).norm() < 1e-14);
    CHECK((near[k + 3] - Vec3(0.8 * std::cos(inner), 0.8 * std::sin(inner), 1.5)).norm() < 1e-14);
  }
  // A grain for which the fixed points are close enough sees those only.
  tube.corners({0, 0, 1.6}, 2.0, [&](std::uint32_t k, const auto&) { CHECK(k < 4 * 48); });
}

TEST_CASE("round surfaces of impossible sizes are refused") {
  check_refused([] { Sphere(0.0); }, "radius of a sphere is 0 m");
  check_refused([] { Cylinder(1.0, -1.0); }, "length of a cylinder is -1 m");
  check_refused([] { Cylinder::tube(1.0, 0.9, 1.0); }, "outer radius of a tube is 0.9 m", "exceed the inner one, 1 m");
  check_refused([] { Superquadric({1, 1, 1}, {2, 1.5, 2}); }, "exponent of a superquadric is 1.5", "between 2 and 32");
}

}  // namespace round_surfaces
