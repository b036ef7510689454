#pragma once

// Sums and products of Vec3 and Mat3 that return a Vec3 or a Mat3. Inside dem they are chosen before Eigen's, so no
// expression types are made: each of these costs a compiler some milliseconds, and three numbers gain nothing by them.
// Products add in Eigen's order, first + (second + third), so results are the same bits.

#include <dem/core/compiler.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <concepts>

namespace dem {

using Vec3 = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Mat3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;

namespace eager {

// Operators take nothing but these types themselves: what mixes them with Eigen's expressions stays Eigen's.
template <class T>
concept Vector = std::same_as<T, Vec3>;
template <class T>
concept Matrix = std::same_as<T, Mat3>;
template <class T>
concept Transpose = std::same_as<T, Eigen::Transpose<const Mat3>> || std::same_as<T, Eigen::Transpose<Mat3>>;
template <class T>
concept Number = std::same_as<T, double> || std::same_as<T, int>;

/// a[0] b[0] + ..., where a lies in steps of `stride`.
inline double dot3(const double* a, int stride, const double* b) {
  return a[0] * b[0] + (a[stride] * b[1] + a[2 * stride] * b[2]);
}
/// a b of two matrices stored by columns; `row_step` and `stride` (1, 3, or 3, 1) lead from row to row of a, and along
/// one: exchanged, they give a^T b.
inline Mat3 product(const double* a, int row_step, int stride, const double* b) {
  Mat3 r;
  double* p = r.data();
  for (int k = 0; k < 9; ++k) p[k] = dot3(a + k % 3 * row_step, stride, b + k / 3 * 3);
  return r;
}

}  // namespace eager

template <eager::Vector V>
inline V operator+(const V& a, const V& b) {
  const double *p = a.data(), *q = b.data();
  return V(p[0] + q[0], p[1] + q[1], p[2] + q[2]);
}
template <eager::Vector V>
inline V operator-(const V& a, const V& b) {
  const double *p = a.data(), *q = b.data();
  return V(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}
template <eager::Vector V>
inline V operator-(const V& a) {
  const double* p = a.data();
  return V(-p[0], -p[1], -p[2]);
}
template <eager::Number S, eager::Vector V>
inline V operator*(S s, const V& a) {
  const double* p = a.data();
  return V(s * p[0], s * p[1], s * p[2]);
}
template <eager::Vector V, eager::Number S>
inline V operator*(const V& a, S s) {
  const double* p = a.data();
  return V(p[0] * s, p[1] * s, p[2] * s);
}
template <eager::Vector V, eager::Number S>
inline V operator/(const V& a, S s) {
  const double* p = a.data();
  return V(p[0] / s, p[1] / s, p[2] / s);
}
template <eager::Matrix M, eager::Vector V>
inline V operator*(const M& m, const V& a) {
  const double *p = m.data(), *q = a.data();
  return V(eager::dot3(p, 3, q), eager::dot3(p + 1, 3, q), eager::dot3(p + 2, 3, q));
}
template <eager::Transpose T, eager::Vector V>
inline V operator*(const T& t, const V& a) {
  const double *p = t.nestedExpression().data(), *q = a.data();
  return V(eager::dot3(p, 1, q), eager::dot3(p + 3, 1, q), eager::dot3(p + 6, 1, q));
}

template <eager::Matrix M>
inline M operator+(const M& a, const M& b) {
  M r;
  for (int k = 0; k < 9; ++k) r.data()[k] = a.data()[k] + b.data()[k];
  return r;
}
template <eager::Matrix M>
inline M operator-(const M& a, const M& b) {
  M r;
  for (int k = 0; k < 9; ++k) r.data()[k] = a.data()[k] - b.data()[k];
  return r;
}
template <eager::Number S, eager::Matrix M>
inline M operator*(S s, const M& a) {
  M r;
  for (int k = 0; k < 9; ++k) r.data()[k] = s * a.data()[k];
  return r;
}
template <eager::Matrix M>
inline M operator*(const M& a, const M& b) {
  return eager::product(a.data(), 1, 3, b.data());
}
template <eager::Transpose T, eager::Matrix M>
inline M operator*(const T& a, const M& b) {
  return eager::product(a.nestedExpression().data(), 3, 1, b.data());
}
template <eager::Matrix M, eager::Transpose T>
inline M operator*(const M& a, const T& b) {
  M r;
  const double *p = a.data(), *q = b.nestedExpression().data();
  for (int k = 0; k < 9; ++k) {
    const int i = k % 3, j = k / 3;
    r.data()[k] = p[i] * q[j] + (p[i + 3] * q[j + 3] + p[i + 6] * q[j + 6]);
  }
  return r;
}

/// Vec3's products as functions, which give a Vec3 where Eigen's give a type of their own.
template <eager::Vector V>
inline V cross(const V& a, const V& b) {
  const double *p = a.data(), *q = b.data();
  return V(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]);
}
template <eager::Vector V>
inline double dot(const V& a, const V& b) {
  return eager::dot3(a.data(), 1, b.data());
}
/// The matrix a b^T.
template <eager::Vector V>
inline Mat3 outer(const V& a, const V& b) {
  Mat3 r;
  for (int k = 0; k < 9; ++k) r.data()[k] = a.data()[k % 3] * b.data()[k / 3];
  return r;
}
/// `s` times the unit matrix.
inline Mat3 scaled_identity(double s) {
  Mat3 r;
  for (int k = 0; k < 9; ++k) r.data()[k] = k % 4 == 0 ? s : 0.0;
  return r;
}
inline Mat3 diagonal_matrix(const Vec3& d) {
  Mat3 r = scaled_identity(0.0);
  for (int k = 0; k < 3; ++k) r.data()[4 * k] = d.data()[k];
  return r;
}
inline Vec3 column(const Mat3& m, int k) { return Vec3(m.data()[3 * k], m.data()[3 * k + 1], m.data()[3 * k + 2]); }
inline Mat3 from_columns(const Vec3& x, const Vec3& y, const Vec3& z) {
  Mat3 r;
  for (int k = 0; k < 3; ++k) r.data()[k] = x.data()[k], r.data()[3 + k] = y.data()[k], r.data()[6 + k] = z.data()[k];
  return r;
}
inline Vec3 diagonal(const Mat3& m) { return Vec3(m.data()[0], m.data()[4], m.data()[8]); }
inline Mat3 transposed(const Mat3& m) {
  Mat3 r;
  for (int k = 0; k < 9; ++k) r.data()[k] = m.data()[k % 3 * 3 + k / 3];
  return r;
}
/// Of each element.
inline Mat3 magnitudes(const Mat3& m) {
  Mat3 r;
  for (int k = 0; k < 9; ++k) r.data()[k] = __builtin_fabs(m.data()[k]);
  return r;
}
inline double largest_magnitude(const Mat3& m) {
  double largest = 0.0;
  for (int k = 0; k < 9; ++k) largest = largest < __builtin_fabs(m.data()[k]) ? __builtin_fabs(m.data()[k]) : largest;
  return largest;
}
inline Vec3 componentwise(const Vec3& a, const Vec3& b) {
  return Vec3(a.data()[0] * b.data()[0], a.data()[1] * b.data()[1], a.data()[2] * b.data()[2]);
}
/// The smaller, and the larger, of each of the components.
inline Vec3 lower(const Vec3& a, const Vec3& b) {
  Vec3 r;
  for (int k = 0; k < 3; ++k) r.data()[k] = a.data()[k] < b.data()[k] ? a.data()[k] : b.data()[k];
  return r;
}
inline Vec3 upper(const Vec3& a, const Vec3& b) {
  Vec3 r;
  for (int k = 0; k < 3; ++k) r.data()[k] = a.data()[k] < b.data()[k] ? b.data()[k] : a.data()[k];
  return r;
}
/// Whether each component of a is less than that of b; whether none is.
inline bool all_below(const Vec3& a, const Vec3& b) {
  const double *p = a.data(), *q = b.data();
  return p[0] < q[0] && p[1] < q[1] && p[2] < q[2];
}
inline bool none_below(const Vec3& a, const Vec3& b) {
  const double *p = a.data(), *q = b.data();
  return p[0] >= q[0] && p[1] >= q[1] && p[2] >= q[2];
}
/// Whether two boxes along the axes share a point.
inline bool boxes_overlap(const Vec3& low_a, const Vec3& high_a, const Vec3& low_b, const Vec3& high_b) {
  return none_below(high_b, low_a) && none_below(high_a, low_b);
}
/// (s, s, s).
inline Vec3 filled(double s) { return Vec3(s, s, s); }
inline bool is_finite(const Vec3& a) {
  // A difference of a finite number with itself is 0.
  return a.data()[0] - a.data()[0] == 0.0 && a.data()[1] - a.data()[1] == 0.0 && a.data()[2] - a.data()[2] == 0.0;
}
/// How far m is from a rotation matrix: the larger of |m^T m - 1| (of all elements) and, for a reflection, 2.
inline double distance_from_rotation(const Mat3& m) {
  const Mat3 d = m.transpose() * m - scaled_identity(1.0);
  double sum = 0.0;
  for (int k = 0; k < 9; ++k) sum += d.data()[k] * d.data()[k];
  const double* p = m.data();
  const double determinant =
      p[0] * (p[4] * p[8] - p[5] * p[7]) - p[3] * (p[1] * p[8] - p[2] * p[7]) + p[6] * (p[1] * p[5] - p[2] * p[4]);
  return determinant > 0.0 ? __builtin_sqrt(sum) : sum - sum == 0.0 ? 2.0 : sum;
}

}  // namespace dem
