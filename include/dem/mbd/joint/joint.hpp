#pragma once

// What a step needs of a joint, and the penalty force itself. All kinds are one choice of held displacements (Hold) and
// one of held rotations (Align): the thesis's revolute joint, two spherical joints on a line at +-h, each of half the
// stiffness k, is exactly Hold::point with k and Align::parallel with k h^2, evaluated in closed form.

#include <dem/core/macros.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/rotation_vector.hpp>

#include <cmath>
#include <numbers>

namespace dem::mbd {

/// Which displacements of b's point in a's joint frame are held at zero.
enum class Hold { nothing, point, line, plane, length, bushing };
/// Which rotations of b's joint frame in a's are held.
enum class Align { nothing, parallel, locked, cross, constant_velocity };

/// Joint axes in a body's frame.
struct Axes {
  Vector3<double> x, y, z;
};

struct Joint {
  std::uint32_t a, b;
  JointKind kind;
  bool turns = false;                ///< has a rotation about z, followed over whole turns
  Vector3<double> point_a, point_b;  ///< m, body frames
  Axes axes_a, axes_b;               ///< body frames
  double k = 0, c = 0;               ///< N/m, N s/m
  double kr = 0, cr = 0;             ///< N m/rad, N m s/rad
  Vector3<double> k3 = {0, 0, 0}, c3 = {0, 0, 0}, kr3 = {0, 0, 0}, cr3 = {0, 0, 0};  ///< bushing, along joint axes
  double length = 0;                                                                 ///< m, of a distance joint
  double angle_offset = 0, slide_offset = 0;
  double angle_estimate = 0;  ///< rad, sum of speed dt: good to half a turn, says how many turns were made

  Vector3<double> force = {0, 0, 0};   ///< N, on b, global
  Vector3<double> torque = {0, 0, 0};  ///< N m, on b about the joint's point, global
};

namespace detail {

/// Adds a force f at arms ra, rb from the centres of mass, and a torque t, to b; the opposite to a. Both forces act at
/// the same point, so momentum and angular momentum are kept exactly.
DEM_HOT void act(Body& a, Body& b, const Vector3<double>& ra, const Vector3<double>& rb, const Vector3<double>& f,
                 const Vector3<double>& t) {
  b.force += f;
  b.torque += cross(rb, f) + t;
  a.force -= f;
  a.torque -= cross(ra, f) + t;
}

/// The gradient of a joint's turn: the rate of the turn is this times the relative angular velocity. Where the z axes
/// agree it is theirs; where they are bent (a free joint) it lies between them, of length 1/cos(bend/2).
DEM_HOT Vector3<double> turn_gradient(const Vector3<double>& za, const Vector3<double>& zb) {
  return (1.0 / max(1.0 + dot(za, zb), 1e-6)) * (za + zb);
}

/// The penalty force of a joint. Springs are the gradient of an energy, so that without damping energy is kept:
///   point  k/2 |d|^2   line  k/2 |d - z z.d|^2   plane  k/2 (z.d)^2   length  k/2 (|d| - l)^2, d = x_b - x_a
///   parallel  kr (1 - z_a.z_b)   locked  kr/2 sum(1 - e_a.e_b)   cross  kr/2 (x_a.y_b)^2
///   constant velocity  kr/8 (y_a.x_b - x_a.y_b)^2   bushing  see rotation_vector.hpp
/// wa, wb: rad/s, global.
template <Hold hold, Align align>
DEM_HOT void penalty(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb, double dt) {
  using V = Vector3<double>;
  const Matrix3<double>&A = a.motion.rotation, &B = b.motion.rotation;
  const V rb = B * j.point_b;
  const V ra = b.motion.position - a.motion.position + rb;
  const V w = wb - wa;
  V f = {0, 0, 0}, t = {0, 0, 0}, za = {0, 0, 0};
  if constexpr (hold == Hold::line || hold == Hold::plane || hold == Hold::bushing || align != Align::nothing) {
    za = A * j.axes_a.z;
  }
  if constexpr (hold != Hold::nothing) {
    const V d = ra - A * j.point_a;
    const V v = b.motion.velocity - a.motion.velocity + cross(wb, rb) - cross(wa, ra);
    if constexpr (hold == Hold::point) {
      f = -(j.k * d) - j.c * v;
    } else if constexpr (hold == Hold::line) {
      f = -(j.k * (d - dot(za, d) * za)) - j.c * (v - dot(za, v) * za);
    } else if constexpr (hold == Hold::plane) {
      f = -(j.k * dot(za, d) + j.c * dot(za, v)) * za;
    } else if constexpr (hold == Hold::length) {
      const double l = norm(d);
      const V n = (1.0 / max(l, 1e-300)) * d;
      f = -(j.k * (l - j.length) + j.c * dot(n, v)) * n;
    } else if constexpr (hold == Hold::bushing) {
      const V xa = A * j.axes_a.x, ya = A * j.axes_a.y;
      f = -(j.k3.x * dot(xa, d) + j.c3.x * dot(xa, v)) * xa - (j.k3.y * dot(ya, d) + j.c3.y * dot(ya, v)) * ya -
          (j.k3.z * dot(za, d) + j.c3.z * dot(za, v)) * za;
    }
  }
  if constexpr (align == Align::parallel) {
    const double spin = dot(za, w);
    t = j.kr * cross(B * j.axes_b.z, za) - j.cr * (w - spin * za);
    j.angle_estimate += dt * spin;
  } else if constexpr (align == Align::locked) {
    const V xa = A * j.axes_a.x, ya = A * j.axes_a.y;
    const V xb = B * j.axes_b.x, yb = B * j.axes_b.y, zb = B * j.axes_b.z;
    if constexpr (hold == Hold::bushing) {
      const V r = rotation_vector(xa, ya, za, xb, yb, zb);
      const V spring = rotation_vector_torque(r, {j.kr3.x * r.x, j.kr3.y * r.y, j.kr3.z * r.z});
      t = (spring.x - j.cr3.x * dot(xa, w)) * xa + (spring.y - j.cr3.y * dot(ya, w)) * ya +
          (spring.z - j.cr3.z * dot(za, w)) * za;
    } else {
      t = (0.5 * j.kr) * (cross(xb, xa) + cross(yb, ya) + cross(zb, za)) - j.cr * w;
    }
  } else if constexpr (align == Align::cross) {
    const V xa = A * j.axes_a.x, yb = B * j.axes_b.y;
    const V g = cross(yb, xa);
    t = -(j.kr * dot(xa, yb) + j.cr * dot(g, w)) * g;
  } else if constexpr (align == Align::constant_velocity) {
    const V xa = A * j.axes_a.x, ya = A * j.axes_a.y, xb = B * j.axes_b.x, yb = B * j.axes_b.y;
    const V g = 0.5 * (cross(xb, ya) - cross(yb, xa));
    t = -(j.kr * 0.5 * (dot(ya, xb) - dot(xa, yb)) + j.cr * dot(g, w)) * g;
  }
  act(a, b, ra, rb, f, t);
  j.force = f;
  j.torque = t;
}

}  // namespace detail

constexpr Hold hold_of(JointKind kind) {
  using enum JointKind;
  switch (kind) {
    case cylindrical:
    case prismatic:
    case point_on_line: return Hold::line;
    case planar:
    case point_on_plane: return Hold::plane;
    case distance: return Hold::length;
    case bushing: return Hold::bushing;
    case free: return Hold::nothing;
    default: return Hold::point;
  }
}
constexpr Align align_of(JointKind kind) {
  using enum JointKind;
  switch (kind) {
    case fixed:
    case prismatic:
    case bushing: return Align::locked;
    case revolute:
    case cylindrical:
    case planar: return Align::parallel;
    case universal: return Align::cross;
    case constant_velocity: return Align::constant_velocity;
    default: return Align::nothing;
  }
}

/// Flattened, because the vector operators in it have to be inlined however large the program is.
/// Adds a joint's penalty force to its bodies and keeps it as the reaction. dt is the time by which the joint's turns
/// are followed: the time step in the last stage of a step, else 0.
DEM_FLATTEN inline void apply_penalty(Joint& j, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb,
                                      double dt) {
  using enum JointKind;
#define DEM_MBD_JOINT(kind) \
  case kind: return detail::penalty<hold_of(kind), align_of(kind)>(j, a, b, wa, wb, dt)
  switch (j.kind) {
    DEM_MBD_JOINT(fixed);
    DEM_MBD_JOINT(spherical);
    DEM_MBD_JOINT(revolute);
    DEM_MBD_JOINT(cylindrical);
    DEM_MBD_JOINT(prismatic);
    DEM_MBD_JOINT(planar);
    DEM_MBD_JOINT(universal);
    DEM_MBD_JOINT(constant_velocity);
    DEM_MBD_JOINT(point_on_line);
    DEM_MBD_JOINT(point_on_plane);
    DEM_MBD_JOINT(distance);
    DEM_MBD_JOINT(bushing);
    case free:  // only its turns are followed
      j.angle_estimate +=
          dt * dot(detail::turn_gradient(a.motion.rotation * j.axes_a.z, b.motion.rotation * j.axes_b.z), wb - wa);
      return;
  }
#undef DEM_MBD_JOINT
}

}  // namespace dem::mbd
