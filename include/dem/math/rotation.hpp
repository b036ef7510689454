#pragma once

#include <dem/math/vector.hpp>

namespace dem {

/// sin(t)/t and (1 - cos(t))/t^2 as functions of t^2. Taylor series up to |t| = 0.5, where the first term left out is
/// below 1e-16; grains turn by far less than that in one step.
template <class T>
DEM_HOT void sinc_cosc(const T& t2, T& sinc, T& cosc) {
  // clang-format off
  sinc = T(1) - t2 * (T(1.0 / 6) - t2 * (T(1.0 / 120) - t2 * (T(1.0 / 5040) - t2 * (T(1.0 / 362880) -
                t2 * (T(1.0 / 39916800) - t2 * T(1.0 / 6227020800.0))))));
  cosc = T(0.5) - t2 * (T(1.0 / 24) - t2 * (T(1.0 / 720) - t2 * (T(1.0 / 40320) - t2 * (T(1.0 / 3628800) -
                t2 * (T(1.0 / 479001600) - t2 * T(1.0 / 87178291200.0))))));
  // clang-format on
}

/// The rotation by the vector `angle` (direction: axis; length: angle in rad): Rodrigues' formula,
/// R = I + sin(t)/t [angle]x + (1 - cos(t))/t^2 [angle]x^2.
template <class T>
DEM_HOT Matrix3<T> rotation_from_vector(const Vector3<T>& angle) {
  const T t2 = dot(angle, angle);
  T sinc, cosc;
  sinc_cosc(t2, sinc, cosc);
  if (any_of(t2 > T(0.25))) [[unlikely]] {
    if constexpr (sizeof(T) == sizeof(double)) {
      const double t = std::sqrt(t2);
      sinc = std::sin(t) / t;
      cosc = (1.0 - std::cos(t)) / t2;
    } else {
      const auto exact_sinc = [&](int k) {
        const double t = std::sqrt(lane(t2, k));
        return t > 0.5 ? std::sin(t) / t : lane(sinc, k);
      };
      const auto exact_cosc = [&](int k) {
        const double t = std::sqrt(lane(t2, k));
        return t > 0.5 ? (1.0 - std::cos(t)) / (t * t) : lane(cosc, k);
      };
      const T s = generate(exact_sinc), c = generate(exact_cosc);
      sinc = s;
      cosc = c;
    }
  }
  const Vector3<T> s = sinc * angle;
  const Vector3<T> c = cosc * angle;
  const T diagonal = T(1) - cosc * t2;
  return {{diagonal + c.x * angle.x, c.x * angle.y - s.z, c.x * angle.z + s.y},
          {c.y * angle.x + s.z, diagonal + c.y * angle.y, c.y * angle.z - s.x},
          {c.z * angle.x - s.y, c.z * angle.y + s.x, diagonal + c.z * angle.z}};
}

/// One Newton step towards the nearest rotation, R (3 I - R^T R) / 2: removes the rounding that a product of many
/// rotations gathers. Squares the error, so an error of 1e-9 is gone after one call.
template <class T>
DEM_HOT Matrix3<T> orthonormalised(const Matrix3<T>& r) {
  const T xx = dot(r.row0, r.row0), yy = dot(r.row1, r.row1), zz = dot(r.row2, r.row2);
  const T xy = dot(r.row0, r.row1), xz = dot(r.row0, r.row2), yz = dot(r.row1, r.row2);
  // (3 I - R R^T) / 2, applied from the left: the same step, written with the rows at hand.
  const Matrix3<T> correction = {{T(1.5) - T(0.5) * xx, T(-0.5) * xy, T(-0.5) * xz},
                                 {T(-0.5) * xy, T(1.5) - T(0.5) * yy, T(-0.5) * yz},
                                 {T(-0.5) * xz, T(-0.5) * yz, T(1.5) - T(0.5) * zz}};
  return correction * r;
}

/// The smallest turn that takes one direction into another; both of any length above 0. Opposite directions have no
/// smallest one: half a turn about some axis across them. (In place of Eigen's FromTwoVectors, which solves that case
/// by a singular value decomposition and costs each user seconds of compiling.)
inline Mat3 rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized();
  // Two reflections make a turn by twice the angle between their normals: the first takes a to -b, the second to b.
  const Vec3 middle = a + b;
  if (middle.squaredNorm() < 1e-24) {
    const Vec3 across = a.cross(std::abs(a.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    return 2.0 * across * across.transpose() - Mat3::Identity();
  }
  const Vec3 n = middle.normalized();
  const Mat3 to_minus_b = Mat3::Identity() - 2.0 * n * n.transpose();
  return (Mat3::Identity() - 2.0 * b * b.transpose()) * to_minus_b;
}

}  // namespace dem
