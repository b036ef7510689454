#include "core/error_of.hpp"

#include <dem/geometry/superquadric/superquadric_boundary.hpp>
#include <dem/geometry/superquadric/superquadric_integrals.hpp>

#include <numbers>
#include <random>

using Catch::Approx;
using dem::Vec3;
using dem::Vector3;
using dem::shape::SuperquadricSolid;

namespace {

struct Case {
  Vec3 radii, exponents;
};
const std::vector<Case> cases = {{{1, 1, 1}, {2, 2, 2}},       {{1, 1.3, 0.7}, {2, 2, 2}}, {{1, 1.3, 0.7}, {3, 3, 3}},
                                 {{1, 1.3, 0.7}, {8, 8, 8}},   {{0.5, 1, 2}, {2, 2, 8}},   {{1, 1.3, 0.7}, {2, 3, 7.5}},
                                 {{1, 0.4, 1.1}, {2.5, 5, 20}}};

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random);
  return Vec3(x, y, normal(random)).normalized();
}

/// Integral of x_axis^(power - 1) over the solid by the midpoint rule in the shares' variables: columns along z are
/// integrated exactly, and x = a s^3 (10 - 15 s + 6 s^2) (and y alike) smooths the ends.
double moment_by_columns(const Case& c, int power_axis, double power) {
  const int n = 400;
  double sum = 0.0;
  const auto smooth = [](double s) { return s * s * s * (10 - 15 * s + 6 * s * s); };
  const auto slope = [](double s) { return 30 * s * s * (1 - s) * (1 - s); };
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n, x = c.radii.x() * smooth(s);
    const double rest_x = 1 - std::pow(x / c.radii.x(), c.exponents.x());
    const double widest = c.radii.y() * std::pow(rest_x, 1 / c.exponents.y());
    for (int j = 0; j < n; ++j) {
      const double t = (j + 0.5) / n, y = widest * smooth(t);
      const double rest = std::max(0.0, rest_x - std::pow(y / c.radii.y(), c.exponents.y()));
      const double z = c.radii.z() * std::pow(rest, 1 / c.exponents.z());
      const double cell = c.radii.x() * slope(s) * widest * slope(t) / (n * n);
      const double value = power_axis == 0   ? std::pow(x, power) * z
                           : power_axis == 1 ? std::pow(y, power) * z
                                             : std::pow(z, power + 1) / (power + 1);
      sum += 8 * cell * value;
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("volume and inertia of superquadrics are Dirichlet's integrals") {
  for (const Case& c : cases) {
    const auto mass = dem::shape::superquadric_mass_properties(c.radii, c.exponents);
    // The midpoint rule with 400 x 400 smoothed columns errs by far less than 1e-6.
    CHECK(mass.volume == Approx(moment_by_columns(c, 0, 0.0)).epsilon(1e-6));
    const double xx = moment_by_columns(c, 0, 2), yy = moment_by_columns(c, 1, 2), zz = moment_by_columns(c, 2, 2);
    CHECK(mass.inertia(0, 0) == Approx(yy + zz).epsilon(1e-6));
    CHECK(mass.inertia(1, 1) == Approx(xx + zz).epsilon(1e-6));
    CHECK(mass.inertia(2, 2) == Approx(xx + yy).epsilon(1e-6));
  }
  // Closed forms without gamma functions: an ellipsoid, and a box as the limit.
  const Vec3 r(1, 1.3, 0.7);
  const auto ellipsoid = dem::shape::superquadric_mass_properties(r, {2, 2, 2});
  CHECK(ellipsoid.volume == Approx(4.0 / 3 * std::numbers::pi * r.prod()).epsilon(1e-13));
  CHECK(ellipsoid.inertia(0, 0) == Approx(ellipsoid.volume / 5 * (1.3 * 1.3 + 0.7 * 0.7)).epsilon(1e-13));
  const auto box = dem::shape::superquadric_mass_properties(r, Vec3::Constant(1e5));
  CHECK(box.volume == Approx(8 * r.prod()).epsilon(1e-4));  // 1 - 3/p and the like
}

TEST_CASE("the bounding radius of a superquadric is the distance of its farthest point") {
  std::mt19937 random(1);
  for (const Case& c : cases) {
    const SuperquadricSolid solid(c.radii, c.exponents);
    const double bound = dem::shape::superquadric_bounding_radius(c.radii, c.exponents);
    // Climbs from a sample: towards the point whose tangent plane is farthest along the point itself.
    double farthest = 0.0;
    for (int k = 0; k < 40; ++k) {
      Vector3<double> x = solid.radial(dem::from_eigen(random_direction(random))).position;
      for (int m = 0; m < 200; ++m) {
        Vector3<double> next;
        solid.support(x, next);
        x = next;
      }
      farthest = std::max(farthest, norm(x));
    }
    CHECK(farthest <= bound * (1 + 1e-12));
    CHECK(farthest == Approx(bound).epsilon(1e-6));  // power iterations converge linearly
  }
  // A cube with exponent p: its corners have shares of 1/3.
  CHECK(dem::shape::superquadric_bounding_radius({1, 1, 1}, {8, 8, 8}) ==
        Approx(std::sqrt(3.0) * std::pow(3.0, -1.0 / 8)).epsilon(1e-12));
  CHECK(dem::shape::superquadric_bounding_radius({1, 3, 2}, {2, 2, 2}) == Approx(3.0).epsilon(1e-14));
  // A cylinder-like grain's rim: u^2 + w^8 = 1 with the largest u^2 + w^2, at w^6 = 1/4.
  const double w2 = std::pow(0.25, 1.0 / 3);
  CHECK(dem::shape::superquadric_bounding_radius({1, 1, 1}, {2, 2, 8}) ==
        Approx(std::sqrt(1 - std::pow(w2, 4) + w2)).epsilon(1e-12));
}

TEST_CASE("gauge, support function and derivatives of a superquadric belong together") {
  std::mt19937 random(2);
  for (const Case& c : cases) {
    const SuperquadricSolid solid(c.radii, c.exponents);
    for (int k = 0; k < 50; ++k) {
      const Vector3<double> n = dem::from_eigen(random_direction(random));
      Vector3<double> point;
      const double h = solid.support(n, point);
      // The support point lies on the surface, with the gradient along n; the gauge is 1 there and 1-homogeneous.
      CHECK(solid.value(point) == Approx(1.0).epsilon(1e-12));
      CHECK(h == Approx(dot(n, point)).epsilon(1e-14));
      const auto jet = solid.jet(point);
      CHECK(norm(cross(jet.gradient, n)) < 1e-9 * norm(jet.gradient));
      CHECK(solid.gauge(0.3 * point) == Approx(0.3).epsilon(1e-12));
      // No other point reaches farther.
      for (int m = 0; m < 20; ++m) {
        CHECK(dot(n, solid.radial(dem::from_eigen(random_direction(random))).position) <= h * (1 + 1e-12));
      }
      // Central differences of F and its gradient: errors of h^2 times the next derivatives, below 20^3 * 1e-10.
      const double d = 1e-5;
      const auto up = solid.jet(point + Vector3<double>{d, 0, 0}), down = solid.jet(point - Vector3<double>{d, 0, 0});
      CHECK((up.value - down.value) / (2 * d) == Approx(jet.gradient.x).margin(2e-6));
      CHECK((up.gradient.x - down.gradient.x) / (2 * d) == Approx(jet.curvature.x).margin(2e-4));
    }
  }
}

TEST_CASE("depth and normal of a point in a superquadric err by no more than their bounds") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Case& c : cases) {
    const SuperquadricSolid solid(c.radii, c.exponents);
    for (const double true_depth : {1e-4, 1e-3, 1e-2}) {
      double worst = 0.0;
      for (int k = 0; k < 200; ++k) {
        // A point straight below a surface point: its depth is known while it is less than the radius of curvature,
        // which is over 0.03 everywhere on these grains but on the edges of exponent 20.
        const auto foot = solid.radial(dem::from_eigen(random_direction(random)));
        const Vector3<double> x = foot.position - true_depth * foot.normal;
        const auto jet = solid.jet(foot.position);
        const double sharpest = std::max({jet.curvature.x, jet.curvature.y, jet.curvature.z}) / norm(jet.gradient);
        if (2 * sharpest * true_depth > 1) continue;
        double depth = 0.0;
        Vector3<double> normal{};
        REQUIRE(solid.penetration(x, depth, normal));
        CHECK(norm(normal) == Approx(1.0).epsilon(1e-12));
        CHECK(depth >= true_depth * (1 - 1e-9));
        // The stated bound, with the sharper curvature of both ends, and as much again for higher orders; of the normal
        // too.
        const Vector3<double> ray = (1 / norm(x)) * x;
        const double cosine = dot(ray, normal), tangent2 = std::max(0.0, 1 / (cosine * cosine) - 1);
        const auto other = solid.jet(solid.radial(x).position);
        const double curvature = std::max(
            sharpest, std::max({other.curvature.x, other.curvature.y, other.curvature.z}) / norm(other.gradient));
        CHECK(depth - true_depth <=
              true_depth * std::pow(true_depth * curvature, 3) * tangent2 * std::pow(1 + 0.5 * tangent2, 2) + 1e-12);
        CHECK(norm(normal - foot.normal) <=
              2 * std::pow(true_depth * curvature, 2) * std::sqrt(tangent2) * (1 + 0.5 * tangent2) + 1e-9);
        worst = std::max(worst, depth / true_depth - 1);
      }
      INFO("exponents " << c.exponents.transpose() << ", depth " << true_depth);
      CHECK(worst < 1e-3);  // a hundredth of a radius deep, grains with edges of radius 0.03
    }
    double depth = 0.0;
    Vector3<double> normal{};
    CHECK_FALSE(solid.penetration({2 * c.radii.x(), 0, 0}, depth, normal));
    REQUIRE(solid.penetration({0, 0, 0}, depth, normal));
    CHECK(depth == Approx(c.radii.minCoeff()));
  }
}

TEST_CASE("the points of a superquadric's surface share its area") {
  // A sphere, a prolate spheroid in closed form, and a cube whose exponent is as high as it goes.
  const auto total = [](const Vec3& radii, const Vec3& exponents, int divisions) {
    const auto boundary = dem::shape::superquadric_boundary(SuperquadricSolid(radii, exponents), divisions);
    CHECK(boundary.points.size() == std::size_t(6 * divisions * divisions + 2));
    CHECK(boundary.quads.size() == std::size_t(6 * divisions * divisions));
    double sum = 0.0;
    for (const double a : boundary.areas) {
      CHECK(a > 0.0);
      sum += a;
    }
    return sum;
  };
  const double pi = std::numbers::pi;
  CHECK(total({2, 2, 2}, {2, 2, 2}, 4) == Approx(16 * pi).epsilon(1e-8));
  const double e = std::sqrt(1 - 1 / 2.25);
  CHECK(total({1, 1, 1.5}, {2, 2, 2}, 4) == Approx(2 * pi * (1 + 1.5 / e * std::asin(e))).epsilon(1e-6));
  CHECK(total({1, 1, 1}, {32, 32, 32}, 8) == Approx(24.0).epsilon(0.06));  // edges are rounded over 2/p
  CHECK(total({1, 1, 1}, {32, 32, 32}, 8) < 24.0);
  // Finer points, the same area: what the quadrature misses on the edges.
  CHECK(total({1, 1.3, 0.7}, {8, 8, 8}, 4) == Approx(total({1, 1.3, 0.7}, {8, 8, 8}, 12)).epsilon(1e-3));

  // The quads look outward, and normals are those of the surface.
  const SuperquadricSolid solid({1, 1.3, 0.7}, {3, 4, 2});
  const auto boundary = dem::shape::superquadric_boundary(solid, 5);
  for (const auto& quad : boundary.quads) {
    const auto at = [&](std::size_t k) { return boundary.points[static_cast<std::size_t>(quad[k])]; };
    CHECK(dot(cross(at(2).position - at(0).position, at(3).position - at(1).position), at(0).normal) > 0.0);
  }
}

TEST_CASE("wrong superquadrics are refused in words") {
  check_refused([] { SuperquadricSolid(Vec3(1, 0, 1), Vec3(2, 2, 2)); }, "radius of a superquadric is 0 m");
  check_refused([] { SuperquadricSolid(Vec3(1, 1, 1), Vec3(2, 1.5, 2)); }, "exponent of a superquadric is 1.5");
  check_refused([] { SuperquadricSolid(Vec3(1, 1, 1), Vec3(2, 33, 2)); }, "is 33", "between 2 and 32");
  check_refused([] { dem::shape::superquadric_boundary(SuperquadricSolid(1.0), 27); }, "27 divisions", "1 to 26");
}
