#include "catch.hpp"

#include <dem/geometry/cluster/ball_mass_properties.hpp>
#include <dem/geometry/principal_axes.hpp>

#include <array>
#include <numbers>

using Catch::Approx;
using dem::Ball;
using dem::Mat3;
using dem::Vec3;
using std::numbers::pi;

namespace {

/// Two balls of radius r, centres at z = -c and +c, overlapping: each is a ball without the cap beyond z = 0. Volume
/// and moments by integrating discs of radius^2 r^2 - (z - c)^2 over 0 < z < c + r, twice.
struct Lens {
  double volume, along, across;
};
Lens two_balls(double r, double c) {
  const double h = r + c;
  // With u = z - c from -c to r: disc = pi (r^2 - u^2); along the axis disc^2/(4 pi) * 2; across adds z^2 disc.
  const auto power = [&](int n) { return (std::pow(r, n + 1) - std::pow(-c, n + 1)) / (n + 1); };  // int u^n du
  const double disc = pi * (r * r * power(0) - power(2));
  const double disc2 = pi * (std::pow(r, 4) * power(0) - 2 * r * r * power(2) + power(4));  // disc^2 / pi
  const double z2 = pi * (r * r * (power(2) + 2 * c * power(1) + c * c * power(0)) -
                          (power(4) + 2 * c * power(3) + c * c * power(2)));
  REQUIRE(h > 0);
  return {2 * disc, disc2, disc2 / 2 + 2 * z2};
}

}  // namespace

TEST_CASE("sphere and box have their closed forms") {
  const auto sphere = dem::sphere_mass_properties(0.3);
  CHECK(sphere.volume == Approx(4.0 / 3.0 * pi * 0.027).epsilon(1e-14));
  CHECK(sphere.inertia(1, 1) == Approx(0.4 * sphere.volume * 0.09).epsilon(1e-14));
  const auto box = dem::box_mass_properties({1.0, 2.0, 3.0});
  CHECK(box.volume == Approx(6.0));
  CHECK(box.inertia(0, 0) == Approx(6.0 / 12 * (4 + 9)).epsilon(1e-14));
  CHECK(box.inertia(2, 2) == Approx(6.0 / 12 * (1 + 4)).epsilon(1e-14));
  CHECK(box.inertia(0, 1) == 0.0);
}

TEST_CASE("one ball by integration is the closed form") {
  const Ball ball = {{0.1, -0.2, 0.3}, 0.5};
  const auto exact = dem::sphere_mass_properties(0.5);
  const auto p = dem::union_mass_properties(std::array{ball});
  // The documented error of the default grid, 1e-4 of the volume.
  CHECK(p.volume == Approx(exact.volume).epsilon(1e-4));
  CHECK((p.centre - ball.centre).norm() < 1e-4 * ball.radius);
  CHECK((p.inertia - exact.inertia).cwiseAbs().maxCoeff() < 2e-4 * exact.inertia(0, 0));
}

TEST_CASE("two overlapping balls count their common part once") {
  const double r = 0.5, c = 0.3;
  const Lens exact = two_balls(r, c);
  REQUIRE(exact.volume < 2 * dem::sphere_mass_properties(r).volume);
  // The columns run along z: so try the common axis along each direction, and once askew to the grid.
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(Vec3(1, 2, -2) / 3.0)}) {
    const Vec3 at(1.0, -2.0, 0.5);
    const auto p = dem::union_mass_properties(std::array<Ball, 2>{{{at + c * axis, r}, {at - c * axis, r}}});
    CHECK(p.volume == Approx(exact.volume).epsilon(2e-4));
    CHECK((p.centre - at).norm() < 1e-4);
    CHECK(axis.dot(p.inertia * axis) == Approx(exact.along).epsilon(5e-4));
    CHECK((p.inertia.trace() - axis.dot(p.inertia * axis)) / 2 == Approx(exact.across).epsilon(5e-4));
  }
}

TEST_CASE("balls that do not touch add up") {
  const std::array<Ball, 2> balls = {{{{0, 0, -1.0}, 0.4}, {{0, 0, 1.0}, 0.2}}};
  const auto a = dem::sphere_mass_properties(0.4), b = dem::sphere_mass_properties(0.2);
  const auto p = dem::union_mass_properties(balls, 1000);
  const double centre = (b.volume - a.volume) / (a.volume + b.volume);
  CHECK(p.volume == Approx(a.volume + b.volume).epsilon(1e-4));
  CHECK(p.centre.z() == Approx(centre).epsilon(1e-3));
  // Steiner's theorem.
  const double across =
      a.inertia(0, 0) + a.volume * std::pow(centre + 1, 2) + b.inertia(0, 0) + b.volume * std::pow(1 - centre, 2);
  CHECK(p.inertia(0, 0) == Approx(across).epsilon(1e-3));
  // The closed form is the same to rounding.
  REQUIRE_FALSE(dem::any_overlap(balls));
  const auto exact = dem::separate_mass_properties(balls);
  CHECK(exact.volume == Approx(a.volume + b.volume).epsilon(1e-15));
  CHECK(exact.centre.z() == Approx(centre).epsilon(1e-15));
  CHECK(exact.inertia(0, 0) == Approx(across).epsilon(1e-14));
  CHECK(exact.inertia(2, 2) == Approx(a.inertia(2, 2) + b.inertia(2, 2)).epsilon(1e-14));
}

TEST_CASE("balls overlap when they share more than a contact point") {
  const auto overlap = [](double distance) {
    return dem::any_overlap(std::array<Ball, 2>{{{{0, 0, 0}, 0.4}, {{0, distance, 0}, 0.2}}});
  };
  CHECK_FALSE(overlap(0.6));
  CHECK_FALSE(overlap(0.6 - 1e-7));  // rounding, less than a millionth of 0.2
  CHECK(overlap(0.6 - 3e-7));
  CHECK(overlap(0.0));  // one inside the other
}

TEST_CASE("principal axes bring an inertia tensor to its diagonal") {
  const Mat3 r = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 inertia = r * Vec3(1.0, 2.0, 2.5).asDiagonal() * r.transpose();
  const auto p = dem::principal_axes(inertia);
  CHECK(p.rotation.determinant() == Approx(1.0));
  CHECK((p.rotation * p.moments.asDiagonal() * p.rotation.transpose() - inertia).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("an inertia tensor that is diagonal keeps its axes and their order") {
  const auto p = dem::principal_axes(Vec3(3.0, 1.0, 2.0).asDiagonal());
  CHECK(p.rotation == Mat3::Identity());
  CHECK(p.moments == Vec3(3.0, 1.0, 2.0));
}

TEST_CASE("an inertia tensor with an element that is not finite is refused, whichever it is") {
  for (const double wrong : {std::nan(""), HUGE_VAL}) {
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        Mat3 inertia = Mat3::Identity();
        inertia(i, k) = inertia(k, i) = wrong;
        CHECK_THROWS_WITH(dem::principal_axes(inertia), Catch::Matchers::ContainsSubstring("all must be finite"));
      }
    }
  }
}
