#pragma once

#include <dem/core/macros.hpp>
#include <dem/math/vector.hpp>

#include <cmath>

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

/// The vector of a rotation, the inverse of rotation_from_vector: its length is the angle (rad), from 0 to pi. Through
/// the quaternion, from its largest component, so that no angle loses digits. (In place of Eigen's AngleAxis, which
/// costs each user half a second of compiling.)
Vector3<double> vector_from_rotation(const Matrix3<double>& r);

/// The smallest turn that takes one direction into another; both of any length above 0. Opposite directions have no
/// smallest one: half a turn about some axis across them. (In place of Eigen's FromTwoVectors, which solves that case
/// by a singular value decomposition and costs each user seconds of compiling.)
Mat3 rotation_between(const Vec3& from, const Vec3& to);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE Vector3<double> vector_from_rotation(const Matrix3<double>& r) {
  const double xx = r.row0.x, yy = r.row1.y, zz = r.row2.z;
  // Quaternions times four of their components: w, x, y, z.
  const Vector3<double> off = {r.row2.y - r.row1.z, r.row0.z - r.row2.x, r.row1.x - r.row0.y};
  const double xy = r.row0.y + r.row1.x, yz = r.row1.z + r.row2.y, zx = r.row2.x + r.row0.z;
  double w = 1.0 + xx + yy + zz;
  Vector3<double> v = off;
  if (xx + yy + zz < 0.0) {
    if (xx >= yy && xx >= zz) {
      w = off.x;
      v = {1.0 + xx - yy - zz, xy, zx};
    } else if (yy >= zz) {
      w = off.y;
      v = {xy, 1.0 + yy - zz - xx, yz};
    } else {
      w = off.z;
      v = {zx, yz, 1.0 + zz - xx - yy};
    }
    if (w < 0.0) {
      w = -w;
      v = -v;
    }
  }
  const double sine = norm(v);  // of half the angle, but for the factor that w has as well
  return (sine > 0.0 ? 2.0 * std::atan2(sine, w) / sine : 0.0) * v;
}

DEM_INLINE Mat3 rotation_between(const Vec3& from, const Vec3& to) {
  const auto unit = [](const Vector3<double>& a) { return (1.0 / norm(a)) * a; };
  // I + s a b^T.
  const auto dyad = [](double s, const Vector3<double>& a, const Vector3<double>& b) {
    return Matrix3<double>{Vector3<double>{1, 0, 0} + (s * a.x) * b, Vector3<double>{0, 1, 0} + (s * a.y) * b,
                           Vector3<double>{0, 0, 1} + (s * a.z) * b};
  };
  const Vector3<double> a = unit(from_eigen(from)), b = unit(from_eigen(to));
  // Two reflections make a turn by twice the angle between their normals: the first takes a to -b, the second to b.
  const Vector3<double> middle = a + b;
  if (dot(middle, middle) < 1e-24) {
    const Vector3<double> other = std::abs(a.x) < 0.6 ? Vector3<double>{1, 0, 0} : Vector3<double>{0, 1, 0};
    const Vector3<double> across = unit(cross(a, other));
    return -to_eigen(dyad(-2.0, across, across));
  }
  const Vector3<double> n = unit(middle);
  return to_eigen(dyad(-2.0, b, b) * dyad(-2.0, n, n));
}

}  // namespace dem

#endif
