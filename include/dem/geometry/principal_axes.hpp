#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/rotation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dem {

/// Principal axes of an inertia tensor.
struct PrincipalAxes {
  Vec3 moments;   ///< ascending only by accident; order follows the axes
  Mat3 rotation;  ///< columns: the axes; a proper rotation
};

namespace detail {

/// Eigenvalues, ascending, and eigenvectors, as columns, of a symmetric matrix, by Jacobi's rotations: each makes one
/// element beside the diagonal zero, and what is left falls quadratically (Golub and Van Loan, section 8.5). In place
/// of Eigen's solver, which costs each user a second of compiling.
struct SymmetricEigen {
  Vec3 values;
  Mat3 vectors;
};
SymmetricEigen eigen_of_symmetric(Mat3 m);

/// Of all frames along these eigenvectors (ascending eigenvalues) the one that turns the unit axes least. Eigenvectors
/// of equal eigenvalues may be any in their plane.
Mat3 nearest_axes(const Vec3& values, const Mat3& vectors);

}  // namespace detail

/// Finds the principal axes, in the order and with the signs that turn the given axes least. A tensor that is diagonal
/// already (to 1e-12) keeps its axes. Moments that differ by less than 1e-6 of the largest count as equal, as those of
/// a wheel from a file of single precision. Their axes stay as near to the given ones as they can, so a part that was
/// drawn along its axes stays as drawn. Throws Error unless the tensor is finite and symmetric (to 1e-9).
PrincipalAxes principal_axes(const Mat3& inertia);

}  // namespace dem

#if DEM_DEFINES

namespace dem::detail {

DEM_INLINE SymmetricEigen eigen_of_symmetric(Mat3 m) {
  Mat3 v = Mat3::Identity();
  const auto rotate = [](double& x, double& y, double c, double s) {
    const double old = x;
    x = c * old - s * y;
    y = s * old + c * y;
  };
  for (int sweep = 0; sweep < 50; ++sweep) {
    const double off = std::abs(m(0, 1)) + std::abs(m(0, 2)) + std::abs(m(1, 2));
    if (off <= 1e-300) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        // Too small to change the diagonal in double precision.
        if (std::abs(m(p, q)) <= 1e-17 * (std::abs(m(p, p)) + std::abs(m(q, q)))) {
          m(p, q) = m(q, p) = 0.0;
          continue;
        }
        const double theta = 0.5 * (m(q, q) - m(p, p)) / m(p, q);
        const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        for (int k = 0; k < 3; ++k) rotate(m(k, p), m(k, q), c, s);
        for (int k = 0; k < 3; ++k) rotate(m(p, k), m(q, k), c, s);
        for (int k = 0; k < 3; ++k) rotate(v(k, p), v(k, q), c, s);
        m(p, q) = m(q, p) = 0.0;
      }
    }
  }
  int order[3] = {0, 1, 2};
  for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}}) {
    if (m(order[j], order[j]) < m(order[i], order[i])) std::swap(order[i], order[j]);
  }
  SymmetricEigen found;
  for (int k = 0; k < 3; ++k) {
    found.values[k] = m(order[k], order[k]);
    for (int i = 0; i < 3; ++i) found.vectors(i, k) = v(i, order[k]);
  }
  return found;
}

DEM_INLINE Mat3 nearest_axes(const Vec3& values, const Mat3& vectors) {
  const double equal = 1e-6 * std::max(std::fabs(values[0]), std::fabs(values[2]));
  const bool low = values[1] - values[0] < equal, high = values[2] - values[1] < equal;
  if (low && high) return Mat3::Identity();
  if (low || high) {
    Vec3 z = column(vectors, low ? 2 : 0);  // of the moment that differs
    int k = 0;
    for (int i = 1; i < 3; ++i) k = std::fabs(z[i]) > std::fabs(z[k]) ? i : k;
    if (z[k] < 0.0) z = -z;
    Vec3 axis = Vec3::Zero();
    axis[k] = 1.0;
    return rotation_between(axis, z);
  }
  std::array<int, 3> order = {0, 1, 2};
  Mat3 best = Mat3::Identity();
  double least_turned = -4.0;  // the trace is 1 + 2 cos(angle)
  do {
    for (int signs = 0; signs < 4; ++signs) {  // the third sign makes it a rotation
      const Vec3 x = (signs & 1 ? -1.0 : 1.0) * column(vectors, order[0]);
      const Vec3 y = (signs & 2 ? -1.0 : 1.0) * column(vectors, order[1]);
      const Vec3 z = cross(x, y);
      const double trace = x.x() + y.y() + z.z();
      if (trace > least_turned) {
        least_turned = trace;
        best = from_columns(x, y, z);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

}  // namespace dem::detail

namespace dem {

DEM_INLINE PrincipalAxes principal_axes(const Mat3& inertia) {
  for (int k = 0; k < 9; ++k) {  // looked at first, as the largest of several numbers may leave a NaN out
    if (0.0 * inertia.data()[k] == 0.0) continue;
    fail("an inertia tensor has moments {:g}, {:g}, {:g} and products {:g}, {:g}, {:g}, but all must be finite",
         inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  }
  const double scale = largest_magnitude(inertia);
  const double skew = largest_magnitude(inertia - transposed(inertia));
  if (!(skew <= 1e-9 * scale)) {
    fail(
        "an inertia tensor is not symmetric: elements across its diagonal differ by {:g} where the largest is {:g}, "
        "allowed is 1e-9 of it; give both halves of the tensor, with the products of inertia negative",
        skew, scale);
  }
  const Mat3 off = inertia - diagonal_matrix(diagonal(inertia));
  if (largest_magnitude(off) <= 1e-12 * scale) return {diagonal(inertia), Mat3::Identity()};
  const auto [values, vectors] = detail::eigen_of_symmetric(inertia);
  const Mat3 axes = detail::nearest_axes(values, vectors);
  return {diagonal(axes.transpose() * inertia * axes), axes};
}

}  // namespace dem

#endif
