#pragma once

// All that there is to know of the displacements that a joint holds: one struct for each Hold. Springs are the gradient
// of an energy, so that without damping energy is kept; with d = x_b - x_a, the way from a's point to b's:
//   point  k/2 |d|^2   line  k/2 |d - z z.d|^2   plane  k/2 (z.d)^2   length  k/2 (|d| - l)^2
//   bushing  (kx (x.d)^2 + ky (y.d)^2 + kz (z.d)^2) / 2

#include <dem/core/macros.hpp>
#include <dem/math/matrix3.hpp>
#include <dem/mbd/joint/joint.hpp>

#include <cmath>

namespace dem::mbd::detail {

/// Axes of a's joint frame, global. Those that a joint does not need are never computed.
struct FrameOfA {
  const Joint& joint;
  const Matrix3<double>& A;
  DEM_HOT Vector3<double> x() const { return A * joint.axes_a.x; }
  DEM_HOT Vector3<double> y() const { return A * joint.axes_a.y; }
  DEM_HOT Vector3<double> z() const { return A * joint.axes_a.z; }
};

/// The square root of a stiffness k along the axes of a's joint frame, as a matrix in global axes.
Matrix3<double> square_root_of(const Vector3<double>& k, const FrameOfA& at);

/// The force (N) on b of the springs and dampers at a displacement d (m) and its rate v (m/s), global.
template <Hold hold>
DEM_HOT Vector3<double> holding_force(const Joint& j, const FrameOfA& at, const Vector3<double>& d,
                                      const Vector3<double>& v) {
  using V = Vector3<double>;
  if constexpr (hold == Hold::point) {
    return -(j.k * d) - j.c * v;
  } else if constexpr (hold == Hold::line) {
    const V z = at.z();
    return -(j.k * (d - dot(z, d) * z)) - j.c * (v - dot(z, v) * z);
  } else if constexpr (hold == Hold::plane) {
    const V z = at.z();
    return -(j.k * dot(z, d) + j.c * dot(z, v)) * z;
  } else if constexpr (hold == Hold::length) {
    const double l = norm(d);
    const V n = (1.0 / max(l, 1e-300)) * d;
    return -(j.k * (l - j.length) + j.c * dot(n, v)) * n;
  } else if constexpr (hold == Hold::bushing) {
    const V x = at.x(), y = at.y(), z = at.z();
    return -(j.k3.x * dot(x, d) + j.c3.x * dot(x, v)) * x - (j.k3.y * dot(y, d) + j.c3.y * dot(y, v)) * y -
           (j.k3.z * dot(z, d) + j.c3.z * dot(z, v)) * z;
  } else {
    return V{0, 0, 0};
  }
}

/// How far (m) a joint is from holding what it should at a displacement d. A bushing is meant to give way.
double opening(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d);

/// J, in the springs at a displacement d.
double holding_energy(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d);

/// The part of the way from one point to the other in the directions that are held, with z the joint's axis: only there
/// two points have to meet at assembly.
Vector3<double> held_part(Hold hold, const Vector3<double>& z, const Vector3<double>& gap);

/// The axes of a's joint frame, in a, along which b's point is held at a fixed place: `each(axis)`. A joint of given
/// length and a bushing have none.
template <class F>
void for_each_held_axis(const Joint& j, Hold hold, F&& each) {
  if (hold == Hold::point || hold == Hold::line) {
    each(j.axes_a.x);
    each(j.axes_a.y);
  }
  if (hold == Hold::point || hold == Hold::plane) each(j.axes_a.z);
}

/// The square root of the stiffness as a matrix, of size 1 where it is the same in all held directions; d is the
/// displacement; global.
Matrix3<double> held_displacements(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE Matrix3<double> square_root_of(const Vector3<double>& k, const FrameOfA& at) {
  const Matrix3<double> axes = from_columns(at.x(), at.y(), at.z());
  return axes * diagonal_matrix(std::sqrt(k.x), std::sqrt(k.y), std::sqrt(k.z)) * transposed(axes);
}

DEM_INLINE double opening(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d) {
  switch (hold) {
    case Hold::point: return norm(d);
    case Hold::line: return norm(d - dot(at.z(), d) * at.z());
    case Hold::plane: return std::abs(dot(at.z(), d));
    case Hold::length: return std::abs(norm(d) - j.length);
    case Hold::bushing:
    case Hold::nothing: break;
  }
  return 0.0;
}

DEM_INLINE double holding_energy(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d) {
  if (hold == Hold::bushing) {
    const double x = dot(at.x(), d), y = dot(at.y(), d), z = dot(at.z(), d);
    return 0.5 * (j.k3.x * x * x + j.k3.y * y * y + j.k3.z * z * z);
  }
  const double open = opening(j, hold, at, d);
  return 0.5 * j.k * open * open;
}

DEM_INLINE Vector3<double> held_part(Hold hold, const Vector3<double>& z, const Vector3<double>& gap) {
  if (hold == Hold::line) return gap - dot(z, gap) * z;
  if (hold == Hold::plane) return dot(z, gap) * z;
  return gap;
}

DEM_INLINE Matrix3<double> held_displacements(const Joint& j, Hold hold, const FrameOfA& at, const Vector3<double>& d) {
  const Vector3<double> z = at.z();
  switch (hold) {
    case Hold::point: return diagonal_matrix(1, 1, 1);
    case Hold::line: return diagonal_matrix(1, 1, 1) - outer(z, z);
    case Hold::plane: return outer(z, z);
    case Hold::length: {
      const Vector3<double> n = normalised(d);
      return outer(n, n);
    }
    case Hold::bushing: return square_root_of(j.k3, at);
    case Hold::nothing: break;
  }
  return diagonal_matrix(0, 0, 0);
}

}  // namespace dem::mbd::detail

#endif
