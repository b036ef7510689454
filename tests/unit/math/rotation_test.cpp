#include "catch.hpp"

#include <dem/math/rotation.hpp>

#include <numbers>
#include <tuple>

using dem::from_eigen;
using dem::Mat3;
using dem::Pack;
using dem::to_eigen;
using dem::Vec3;

namespace {

/// Largest deviation from a rotation.
double not_a_rotation(const Mat3& r) {
  return std::max((r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(), std::abs(r.determinant() - 1.0));
}

/// Eigen's formula with sin and cos, which shares no code with the library's series.
Mat3 reference(const Vec3& angle) {
  const double t = angle.norm();
  return t == 0.0 ? Mat3(Mat3::Identity()) : Mat3(Eigen::AngleAxisd(t, angle / t).toRotationMatrix());
}

const Vec3 axis = Vec3(1, -2, 3).normalized();

}  // namespace

TEST_CASE("a rotation vector of any length gives its rotation") {
  // Both branches, their border at 0.5, and half and whole turns. Six products each: below 1e-15 but for the argument
  // reduction of sin and cos.
  for (const double t :
       {0.0, 1e-300, 1e-9, 1e-4, 0.01, 0.3, 0.499999, 0.5, 0.500001, 1.0, std::numbers::pi, 6.0, 100.0}) {
    const Mat3 r = to_eigen(dem::rotation_from_vector(from_eigen(Vec3(t * axis))));
    CAPTURE(t);
    CHECK((r - reference(t * axis)).cwiseAbs().maxCoeff() < 2e-15 * std::max(1.0, t));
    CHECK(not_a_rotation(r) < 2e-15);
  }
}

TEST_CASE("a rotation gives back its vector, whatever its angle") {
  // About axes near each of the quaternion's components. The vector is good to some roundings of the matrix, 1e-15.
  for (const Vec3& direction : {axis, Vec3(1, 0.1, -0.2), Vec3(-0.1, 1, 0.3), Vec3(0.2, 0.1, -1), Vec3(1, 1, 1)}) {
    for (const double t : {0.0, 1e-300, 1e-9, 0.01, 1.0, 2.0, 2.1, 3.0, std::numbers::pi - 1e-9}) {
      CAPTURE(t, direction.transpose());
      const Vec3 angle = t * direction.normalized();
      const Vec3 back = to_eigen(dem::vector_from_rotation(dem::rotation_from_vector(from_eigen(angle))));
      CHECK((back - angle).norm() < 4e-15);
    }
    // Half a turn: one way round or the other.
    const auto half = dem::rotation_from_vector(from_eigen(Vec3(std::numbers::pi * direction.normalized())));
    const Vec3 back = to_eigen(dem::vector_from_rotation(half));
    CHECK(std::abs(back.norm() - std::numbers::pi) < 4e-15);
    CHECK(back.cross(direction.normalized()).norm() < 4e-15);
  }
}

TEST_CASE("a rotation turns the right way") {
  const auto quarter = dem::rotation_from_vector(dem::Vector3<double>{0, 0, std::numbers::pi / 2});
  const Vec3 turned = to_eigen(quarter * dem::Vector3<double>{1, 0, 0});
  CHECK((turned - Vec3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("each lane of a pack turns by its own angle, large or small") {
  const auto angle = [](int k) { return k % 2 == 0 ? 0.01 * (k + 1) : 0.9 * k; };
  const Pack t = dem::generate(angle);
  const dem::Vector3<Pack> v = {t * Pack(axis.x()), t * Pack(axis.y()), t * Pack(axis.z())};
  const dem::Matrix3<Pack> r = dem::rotation_from_vector(v);
  for (int k = 0; k < dem::pack_width; ++k) {
    const auto row = [&](const dem::Vector3<Pack>& p) {
      return dem::Vector3<double>{dem::lane(p.x, k), dem::lane(p.y, k), dem::lane(p.z, k)};
    };
    const Mat3 one = to_eigen(dem::Matrix3<double>{row(r.row0), row(r.row1), row(r.row2)});
    CHECK((one - reference(angle(k) * axis)).cwiseAbs().maxCoeff() < 4e-15);
  }
}

TEST_CASE("orthonormalising squares the error") {
  const Mat3 r = reference(0.7 * axis);
  Mat3 noise;
  noise << 1, -2, 0.5, 0.3, -1, 2, -0.7, 1.5, 0.9;
  for (const double error : {1e-3, 1e-6, 1e-9}) {
    const Mat3 off = r + error * noise;
    REQUIRE(not_a_rotation(off) > error);
    const Mat3 once = to_eigen(dem::orthonormalised(from_eigen(off)));
    // Newton: 3/8 (R^T R - 1)^2; the noise has size 3.6, so R^T R is off by up to 10 times `error`. And rounding.
    CHECK(not_a_rotation(once) < 40 * error * error + 2e-15);
    CHECK((once - r).norm() < 10 * error);  // it stays the same rotation
  }
}

TEST_CASE("the turn between two directions takes one into the other by the smallest angle") {
  // Square, oblique, the same, nearly opposite and opposite; lengths do not count. A few products each: 1e-15, but for
  // nearly opposite ones, whose half-way direction is their sum of 1e-7, rounded by 2e-16: 2e-9, doubled by reflecting.
  const Vec3 x = Vec3::UnitX(), nearly = Vec3(-1, 1e-7, 0);
  for (const auto& [from, to, tolerance] :
       {std::tuple{x, Vec3(0, 2, 0), 2e-15}, std::tuple{Vec3(1, 2, 3), Vec3(-2, 1, 0.5), 2e-15},
        std::tuple{axis, axis, 2e-15}, std::tuple{x, nearly, 5e-9}, std::tuple{axis, Vec3(-axis), 2e-15},
        std::tuple{x, Vec3(-x), 2e-15}}) {
    const Mat3 r = dem::rotation_between(from, to);
    CHECK(not_a_rotation(r) < tolerance);
    CHECK((r * from.normalized() - to.normalized()).norm() < tolerance);
    // Nothing turns about the normal of both but by the angle between them: cos of it is half of trace - 1.
    CHECK(std::abs((r.trace() - 1.0) / 2 - from.normalized().dot(to.normalized())) < tolerance);
  }
}
