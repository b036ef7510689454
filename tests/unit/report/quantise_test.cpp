#include "catch.hpp"

#include <dem/report/quantise.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace quantise_test {

using namespace dem::report;
using Catch::Approx;
using dem::Mat3;
using dem::Vec3;

namespace {

using Quaternion4 = std::array<double, 4>;

/// The angle (rad) between two rotations.
double angle_between(const Quaternion4& a, const Quaternion4& b) {
  // By the length of their difference, which loses no digits at small angles; q and -q are the same rotation.
  double same = 0.0, opposite = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    same += (a[k] - b[k]) * (a[k] - b[k]);
    opposite += (a[k] + b[k]) * (a[k] + b[k]);
  }
  return 4.0 * std::asin(0.5 * std::sqrt(std::min(same, opposite)));
}
Quaternion4 unit(Quaternion4 q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& x : q) x /= length;
  return q;
}

}  // namespace

TEST_CASE("coordinates are off by half a step at most, and keep to the box") {
  std::mt19937 random(1);
  const double low = -0.37, high = 2.21, half = (high - low) / 131070;
  std::uniform_real_distribution<double> anywhere(low, high);
  double worst = 0.0;
  for (int k = 0; k < 20'000; ++k) {
    const double x = anywhere(random);
    worst = std::max(worst, std::abs(unpack_coordinate(pack_coordinate(x, low, high), low, high) - x));
  }
  CHECK(worst < half * (1 + 1e-9));
  CHECK(worst > 0.99 * half);
  for (const double x : {low, high}) CHECK(unpack_coordinate(pack_coordinate(x, low, high), low, high) == Approx(x));
  CHECK(pack_coordinate(low - 1, low, high) == 0);
  CHECK(pack_coordinate(high + 1, low, high) == 65535);
  // A box without extent, as of grains in one plane.
  CHECK(unpack_coordinate(pack_coordinate(0.5, 0.5, 0.5), 0.5, 0.5) == 0.5);
}

TEST_CASE("the quaternion of a rotation matrix is Eigen's, also for half turns") {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double angle = k % 4 == 0 ? std::numbers::pi : k % 4 == 1 ? 1e-9 : normal(random);
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(angle, axis));
    const Mat3 matrix = expected.toRotationMatrix();
    CHECK(angle_between(quaternion_of(matrix), {expected.w(), expected.x(), expected.y(), expected.z()}) < 1e-14);
  }
}

TEST_CASE("rotations of 32 bits are off by 4.9e-3 rad at most, and by nothing where there is none") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double worst = 0.0;
  const auto look = [&](const Quaternion4& q) {
    const Quaternion4 back = unpack_rotation(pack_rotation(q));
    CHECK(back[0] * back[0] + back[1] * back[1] + back[2] * back[2] + back[3] * back[3] == Approx(1.0).epsilon(1e-12));
    worst = std::max(worst, angle_between(q, back));
  };
  for (int k = 0; k < 5'000; ++k) look(unit({normal(random), normal(random), normal(random), normal(random)}));
  // The worst are near four equal components.
  for (int k = 0; k < 20'000; ++k) {
    const auto near = [&] { return (random() % 2 == 0 ? -1.0 : 1.0) + 1e-2 * normal(random); };
    look(unit({near(), near(), near(), near()}));
  }
  // And where the largest component changes, or two are as large as can be.
  for (const double sign : {-1.0, 1.0})
    look(unit({1.0, sign, 0.0, 0.0})), look(unit({0.0, 1.0, sign * (1 + 1e-12), 0.0}));
  CHECK(worst < 4.9e-3);
  CHECK(worst > 4.0e-3);
  CHECK(unpack_rotation(pack_rotation({1, 0, 0, 0})) == Quaternion4{1, 0, 0, 0});
  CHECK(unpack_rotation(pack_rotation({0, 0, -1, 0})) == Quaternion4{0, 0, 1, 0});
}

TEST_CASE("scalars of 8 bits are fine where they are small") {
  std::mt19937 random(4);
  const double most = 3.7;
  double worst = 0.0;  // of what is allowed
  for (int k = 0; k < 20'000; ++k) {
    const double x = most * std::pow(std::uniform_real_distribution<double>(0, 1)(random), 3);
    const double allowed = std::sqrt(x * most) / 255 + most / 260100;
    worst = std::max(worst, std::abs(unpack_scalar(pack_scalar(x, most), most) - x) / allowed);
  }
  CHECK(worst < 1 + 1e-9);
  CHECK(worst > 0.9);
  CHECK(unpack_scalar(pack_scalar(most, most), most) == most);
  CHECK(pack_scalar(0.0, most) == 0);
  CHECK(pack_scalar(0.0, 0.0) == 0);
  CHECK(pack_scalar(9.9, most) == 255);
}

}  // namespace quantise_test
