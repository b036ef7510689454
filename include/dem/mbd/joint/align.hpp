#pragma once

// All that there is to know of the rotations that a joint holds. Springs are the gradient of an energy:
//   parallel  kr (1 - z_a.z_b)   locked  kr/2 sum(1 - e_a.e_b)   cross  kr/2 (x_a.y_b)^2
//   constant velocity  kr/8 (y_a.x_b - x_a.y_b)^2   bushing  see rotation_vector.hpp

#include <dem/core/macros.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/joint/hold.hpp>
#include <dem/mbd/joint/rotation_vector.hpp>

namespace dem::mbd::detail {

/// The torque (N m) on b of the springs and dampers at a relative angular velocity w (rad/s), global.
template <Align align>
DEM_HOT Vector3<double> aligning_torque(const Joint& j, const FrameOfA& at, const Matrix3<double>& B,
                                        const Vector3<double>& w) {
  using V = Vector3<double>;
  if constexpr (align == Align::parallel) {
    const V z = at.z();
    return j.kr * cross(B * j.axes_b.z, z) - j.cr * (w - dot(z, w) * z);
  } else if constexpr (align == Align::locked) {
    const V xa = at.x(), ya = at.y(), za = at.z();
    const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
    return (0.5 * j.kr) * (cross(xb, xa) + cross(yb, ya) + cross(zb, za)) - j.cr * w;
  } else if constexpr (align == Align::bushing) {
    const V x = at.x(), y = at.y(), z = at.z();
    const V r = rotation_vector(x, y, z, B * j.axes_b.x, B * j.axes_b.y, B * j.axes_b.z);
    const V spring = rotation_vector_torque(r, {j.kr3.x * r.x, j.kr3.y * r.y, j.kr3.z * r.z});
    return (spring.x - j.cr3.x * dot(x, w)) * x + (spring.y - j.cr3.y * dot(y, w)) * y +
           (spring.z - j.cr3.z * dot(z, w)) * z;
  } else if constexpr (align == Align::cross) {
    const V xa = at.x(), yb = B * j.axes_b.y;
    const V g = cross(yb, xa);
    return -(j.kr * dot(xa, yb) + j.cr * dot(g, w)) * g;
  } else if constexpr (align == Align::constant_velocity) {
    const V xa = at.x(), ya = at.y(), xb = B * j.axes_b.x, yb = B * j.axes_b.y;
    const V g = 0.5 * (cross(xb, ya) - cross(yb, xa));
    return -(j.kr * 0.5 * (dot(ya, xb) - dot(xa, yb)) + j.cr * dot(g, w)) * g;
  } else {
    return V{0, 0, 0};
  }
}

/// How far (rad, for small angles) a joint is from holding what it should. A bushing is meant to give way.
double misalignment(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B);

/// J, in the springs.
double aligning_energy(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B);

/// The square root of the stiffness as a matrix, of size 1 where it is the same in all held directions; B is b's
/// rotation; global.
Matrix3<double> held_rotations(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B);

/// The directions, global, in which a joint holds the rotation of b against a; A and B are their rotations.
template <class F>
void for_each_held_rotation(const Joint& j, Align align, const Matrix3<double>& A, const Matrix3<double>& B, F&& each) {
  switch (align) {
    case Align::locked: each(A * j.axes_a.z); [[fallthrough]];
    case Align::parallel:
      each(A * j.axes_a.x);
      each(A * j.axes_a.y);
      break;
    case Align::cross: each(normalised(cross(B * j.axes_b.y, A * j.axes_a.x))); break;
    case Align::constant_velocity: each(normalised(A * j.axes_a.z + B * j.axes_b.z)); break;
    case Align::bushing:
    case Align::nothing: break;
  }
}

/// The small rotation (rad, global) by which b is off what a joint holds.
Vector3<double> rotation_off(const Joint& j, Align align, const Matrix3<double>& A, const Matrix3<double>& B);

/// How far (rad) the joint is off along each rotation that it holds: `put(error)`.
template <class F>
void for_each_rotation_error(const Joint& j, Align align, const Matrix3<double>& A, const Matrix3<double>& B, F&& put) {
  if (align == Align::nothing) return;
  using V = Vector3<double>;
  const V xa = A * j.axes_a.x, ya = A * j.axes_a.y, za = A * j.axes_a.z;
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (align) {
    case Align::locked: {
      const V turn = 0.5 * (cross(xa, xb) + cross(ya, yb) + cross(za, zb));
      put(dot(za, turn));
      put(dot(xa, turn));
      put(dot(ya, turn));
      break;
    }
    case Align::parallel:  // za x zb along xa and ya
      put(-dot(ya, zb));
      put(dot(xa, zb));
      break;
    case Align::cross: put(dot(xa, yb)); break;
    case Align::constant_velocity: put(0.5 * (dot(ya, xb) - dot(xa, yb))); break;
    case Align::bushing:
    case Align::nothing: break;
  }
}

/// The gradients of these errors, in their order: the errors change at dot(row, w) (rad/s) as b turns at w (rad/s)
/// against a.
template <class F>
void for_each_rotation_row(const Joint& j, Align align, const Matrix3<double>& A, const Matrix3<double>& B, F&& each) {
  switch (align) {
    case Align::locked: each(A * j.axes_a.z); [[fallthrough]];
    case Align::parallel:
      each(A * j.axes_a.x);
      each(A * j.axes_a.y);
      break;
    case Align::cross: each(cross(B * j.axes_b.y, A * j.axes_a.x)); break;
    case Align::constant_velocity:
      each(0.5 * (cross(B * j.axes_b.x, A * j.axes_a.y) - cross(B * j.axes_b.y, A * j.axes_a.x)));
      break;
    case Align::bushing:
    case Align::nothing: break;
  }
}

/// The axes of b's joint frame, turned by an angle about their z.
Axes twisted(const Axes& axes, double angle);

/// The axes that a joint would need on b, in b, for nothing that it holds to be off in the present pose.
Axes axes_that_align(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B);

}  // namespace dem::mbd::detail

#if DEM_DEFINES

namespace dem::mbd::detail {

DEM_INLINE double misalignment(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B) {
  using V = Vector3<double>;
  const V xa = at.x(), ya = at.y(), za = at.z();
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (align) {
    case Align::parallel: return norm(cross(za, zb));
    case Align::locked: return 0.5 * norm(cross(xa, xb) + cross(ya, yb) + cross(za, zb));
    case Align::cross: return std::abs(dot(xa, yb));
    case Align::constant_velocity: return 0.5 * std::abs(dot(ya, xb) - dot(xa, yb));
    case Align::bushing:
    case Align::nothing: break;
  }
  return 0.0;
}

DEM_INLINE double aligning_energy(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B) {
  using V = Vector3<double>;
  const V xa = at.x(), ya = at.y(), za = at.z();
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (align) {
    case Align::parallel: return j.kr * (1.0 - dot(za, zb));
    case Align::locked: return 0.5 * j.kr * ((1.0 - dot(xa, xb)) + (1.0 - dot(ya, yb)) + (1.0 - dot(za, zb)));
    case Align::bushing: {
      const V r = rotation_vector(xa, ya, za, xb, yb, zb);
      return 0.5 * (j.kr3.x * r.x * r.x + j.kr3.y * r.y * r.y + j.kr3.z * r.z * r.z);
    }
    case Align::cross:
    case Align::constant_velocity: {
      const double off = misalignment(j, align, at, B);
      return 0.5 * j.kr * off * off;
    }
    case Align::nothing: break;
  }
  return 0.0;
}

DEM_INLINE Matrix3<double> held_rotations(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B) {
  const Vector3<double> z = at.z();
  switch (align) {
    case Align::parallel: return diagonal_matrix(1, 1, 1) - outer(z, z);
    case Align::locked: return diagonal_matrix(1, 1, 1);
    case Align::bushing: return square_root_of(j.kr3, at);
    case Align::cross: {
      const Vector3<double> g = normalised(cross(B * j.axes_b.y, at.x()));  // square to the cross
      return outer(g, g);
    }
    case Align::constant_velocity: {
      const Vector3<double> g = normalised(z + B * j.axes_b.z);  // half way between the shafts
      return outer(g, g);
    }
    case Align::nothing: break;
  }
  return diagonal_matrix(0, 0, 0);
}

DEM_INLINE Vector3<double> rotation_off(const Joint& j, Align align, const Matrix3<double>& A,
                                        const Matrix3<double>& B) {
  using V = Vector3<double>;
  const V xa = A * j.axes_a.x, ya = A * j.axes_a.y, za = A * j.axes_a.z;
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (align) {
    case Align::locked: return 0.5 * (cross(xa, xb) + cross(ya, yb) + cross(za, zb));
    case Align::parallel: return cross(za, zb);
    case Align::cross: {
      const V g = cross(yb, xa);
      return (dot(xa, yb) / max(dot(g, g), 1e-6)) * g;
    }
    case Align::constant_velocity: {
      const V g = 0.5 * (cross(xb, ya) - cross(yb, xa));
      return (0.5 * (dot(ya, xb) - dot(xa, yb)) / max(dot(g, g), 1e-6)) * g;
    }
    case Align::bushing:
    case Align::nothing: break;
  }
  return {0, 0, 0};
}

DEM_INLINE Axes twisted(const Axes& axes, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * axes.x + s * axes.y, c * axes.y - s * axes.x, axes.z};
}

DEM_INLINE Axes axes_that_align(const Joint& j, Align align, const FrameOfA& at, const Matrix3<double>& B) {
  using V = Vector3<double>;
  const V xa = at.x(), ya = at.y(), za = at.z();
  const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
  switch (align) {
    case Align::parallel: {
      const Matrix3<double> turn = from_eigen(rotation_between(to_eigen(zb), to_eigen(za)));
      return {transpose_times(B, turn * xb), transpose_times(B, turn * yb), transpose_times(B, turn * zb)};
    }
    case Align::locked:
    case Align::bushing: return {transpose_times(B, xa), transpose_times(B, ya), transpose_times(B, za)};
    case Align::cross: return twisted(j.axes_b, std::atan(dot(xa, yb) / dot(xa, xb)));
    case Align::constant_velocity:
      return twisted(j.axes_b, std::atan2(dot(xa, yb) - dot(ya, xb), dot(xa, xb) + dot(ya, yb)));
    case Align::nothing: break;
  }
  return j.axes_b;
}

}  // namespace dem::mbd::detail

#endif
