#pragma once

// Two vector vocabularies, each for its own use: Eigen types (Vec3, Mat3) in the public interface, and plain structs
// over any number type (Vector3<T>, Matrix3<T>) inside kernels, where T may be a pack of doubles and the struct has to
// be trivially copyable for device code.

#include <dem/math/eager.hpp>
#include <dem/math/pack.hpp>

namespace dem {

template <class T>
struct Vector3 {
  T x, y, z;
};

template <class T>
DEM_HOT Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
DEM_HOT Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
DEM_HOT Vector3<T> operator-(const Vector3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
DEM_HOT Vector3<T> operator*(const T& s, const Vector3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
DEM_HOT Vector3<T>& operator+=(Vector3<T>& a, const Vector3<T>& b) {
  a.x += b.x;
  a.y += b.y;
  a.z += b.z;
  return a;
}
template <class T>
DEM_HOT Vector3<T>& operator-=(Vector3<T>& a, const Vector3<T>& b) {
  a.x -= b.x;
  a.y -= b.y;
  a.z -= b.z;
  return a;
}
template <class T>
DEM_HOT T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
DEM_HOT Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
DEM_HOT T norm(const Vector3<T>& a) {
  return sqrt(dot(a, a));
}

/// A 3 x 3 matrix by rows.
template <class T>
struct Matrix3 {
  Vector3<T> row0, row1, row2;

  DEM_HOT static Matrix3 identity() { return {{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}; }
};

template <class T>
DEM_HOT Vector3<T> operator*(const Matrix3<T>& m, const Vector3<T>& a) {
  return {dot(m.row0, a), dot(m.row1, a), dot(m.row2, a)};
}
/// transpose(m) * a: a vector from the global into the body frame when m is the body's rotation.
template <class T>
DEM_HOT Vector3<T> transpose_times(const Matrix3<T>& m, const Vector3<T>& a) {
  return {m.row0.x * a.x + m.row1.x * a.y + m.row2.x * a.z, m.row0.y * a.x + m.row1.y * a.y + m.row2.y * a.z,
          m.row0.z * a.x + m.row1.z * a.y + m.row2.z * a.z};
}
template <class T>
DEM_HOT Matrix3<T> operator*(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {transpose_times(b, a.row0), transpose_times(b, a.row1), transpose_times(b, a.row2)};
}

template <class T>
DEM_HOT Matrix3<T> transposed(const Matrix3<T>& m) {
  return {{m.row0.x, m.row1.x, m.row2.x}, {m.row0.y, m.row1.y, m.row2.y}, {m.row0.z, m.row1.z, m.row2.z}};
}

/// A 3-vector or a 3 x 3 matrix (or an expression of that size) as the plain struct.
template <class Derived>
auto from_eigen(const Eigen::MatrixBase<Derived>& expression) {
  static_assert(Derived::RowsAtCompileTime == 3);
  if constexpr (Derived::ColsAtCompileTime == 1) {
    const Vec3 a = expression;
    return Vector3<double>{a.x(), a.y(), a.z()};
  } else {
    static_assert(Derived::ColsAtCompileTime == 3);
    const Mat3 m = expression;
    return Matrix3<double>{{m(0, 0), m(0, 1), m(0, 2)}, {m(1, 0), m(1, 1), m(1, 2)}, {m(2, 0), m(2, 1), m(2, 2)}};
  }
}
inline Vec3 to_eigen(const Vector3<double>& a) { return {a.x, a.y, a.z}; }
inline Mat3 to_eigen(const Matrix3<double>& m) {
  Mat3 e;
  e << m.row0.x, m.row0.y, m.row0.z, m.row1.x, m.row1.y, m.row1.z, m.row2.x, m.row2.y, m.row2.z;
  return e;
}

}  // namespace dem
