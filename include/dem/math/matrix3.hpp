#pragma once

// A little algebra of 3 x 3 matrices of doubles, for code that is compiled with every program: Eigen's expressions cost
// each of them a fraction of a second.

#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>

namespace dem {

inline Matrix3<double> operator+(const Matrix3<double>& a, const Matrix3<double>& b) {
  return {a.row0 + b.row0, a.row1 + b.row1, a.row2 + b.row2};
}
inline Matrix3<double> operator-(const Matrix3<double>& a, const Matrix3<double>& b) {
  return {a.row0 - b.row0, a.row1 - b.row1, a.row2 - b.row2};
}
inline Matrix3<double> operator*(double s, const Matrix3<double>& m) { return {s * m.row0, s * m.row1, s * m.row2}; }

/// A matrix with these diagonal elements and zeros.
inline Matrix3<double> diagonal_matrix(double x, double y, double z) { return {{x, 0, 0}, {0, y, 0}, {0, 0, z}}; }
inline Matrix3<double> diagonal_matrix(const Vector3<double>& d) { return diagonal_matrix(d.x, d.y, d.z); }
/// a b^T.
inline Matrix3<double> outer(const Vector3<double>& a, const Vector3<double>& b) { return {a.x * b, a.y * b, a.z * b}; }
/// [a]x, with which [a]x b = a x b.
inline Matrix3<double> cross_matrix(const Vector3<double>& a) {
  return {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
}
/// A matrix with these columns.
inline Matrix3<double> from_columns(const Vector3<double>& x, const Vector3<double>& y, const Vector3<double>& z) {
  return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
}

inline double trace(const Matrix3<double>& m) { return m.row0.x + m.row1.y + m.row2.z; }
inline double determinant(const Matrix3<double>& m) { return dot(m.row0, cross(m.row1, m.row2)); }
/// The sum of the squares of all elements.
inline double squared_norm(const Matrix3<double>& m) {
  return dot(m.row0, m.row0) + dot(m.row1, m.row1) + dot(m.row2, m.row2);
}

inline Vector3<double> operator/(const Vector3<double>& a, double s) { return {a.x / s, a.y / s, a.z / s}; }
inline Vector3<double> normalised(const Vector3<double>& a) { return a / norm(a); }
/// A unit vector across another.
inline Vector3<double> any_across(const Vector3<double>& a) {
  const bool along_z = std::abs(a.x) + std::abs(a.y) < 1e-6 * std::abs(a.z);
  return normalised(along_z ? Vector3<double>{0, -a.z, a.y} : Vector3<double>{-a.y, a.x, 0});
}
inline bool is_finite(const Vector3<double>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Largest eigenvalue of a symmetric matrix, by the trigonometric solution of its cubic.
inline double largest_eigenvalue(const Matrix3<double>& m) {
  const double mean = trace(m) / 3.0;
  const Matrix3<double> rest = m - diagonal_matrix(mean, mean, mean);
  const double p = std::sqrt(squared_norm(rest) / 6.0);
  if (p <= 1e-15 * std::abs(mean) || p < 1e-300) return mean;
  const double cosine = std::clamp(determinant((1.0 / p) * rest) / 2.0, -1.0, 1.0);
  return mean + 2.0 * p * std::cos(std::acos(cosine) / 3.0);
}
/// The same of one that has no negative eigenvalue and at most two that are not 0: half of their sum and difference.
inline double largest_eigenvalue_of_two(const Matrix3<double>& m) {
  const double sum = trace(m);
  return 0.5 * (sum + std::sqrt(std::max(0.0, 2.0 * squared_norm(m) - sum * sum)));
}

}  // namespace dem
