#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/joint/joint_kind.hpp>

#include <memory>

namespace dem::mbd {

/// Joint axes in a body's frame.
struct Axes {
  Vector3<double> x, y, z;
  template <class V>
  void fields(V& v) {
    v("x", x), v("y", y), v("z", z);
  }
};

struct BushingTables;

/// What a step needs of a joint.
struct Joint {
  std::uint32_t a, b;
  JointKind kind;
  bool turns = false;                ///< has a rotation about z, followed over whole turns
  bool on = true;                    ///< false: it holds nothing for now
  bool rigid = false;                ///< held by the solver, without springs (projected.hpp)
  Vector3<double> point_a, point_b;  ///< m, body frames
  Axes axes_a, axes_b;               ///< body frames
  double k = 0, c = 0;               ///< N/m, N s/m
  double kr = 0, cr = 0;             ///< N m/rad, N m s/rad
  Vector3<double> k3 = {0, 0, 0}, c3 = {0, 0, 0}, kr3 = {0, 0, 0}, cr3 = {0, 0, 0};  ///< bushing, along joint axes
  std::shared_ptr<const BushingTables> tables = {};                                  ///< of a bushing with tables
  double length = 0;                                                                 ///< m, of a distance joint
  double angle_offset = 0, slide_offset = 0;
  double angle_estimate = 0;  ///< rad, sum of speed dt: good to half a turn, says how many turns were made

  Vector3<double> force = {0, 0, 0};   ///< N, on b, global
  Vector3<double> torque = {0, 0, 0};  ///< N m, on b about the joint's point, global
  template <class V>
  void fields(V& v) {
    v.given("a", a), v.given("b", b), v("on", on), v("point_a", point_a, "m"), v("point_b", point_b, "m");
    v("axes_a", axes_a), v("axes_b", axes_b), v("k", k, "N/m"), v("c", c, "N s/m");
    v("kr", kr, "N m/rad"), v("cr", cr, "N m s/rad"), v("k3", k3, "N/m"), v("c3", c3, "N s/m");
    v("kr3", kr3, "N m/rad"), v("cr3", cr3, "N m s/rad"), v("length", length, "m");
    v("angle_offset", angle_offset, "rad"), v("slide_offset", slide_offset, "m");
    v("angle_estimate", angle_estimate, "rad"), v("force", force, "N"), v("torque", torque, "N m");
  }
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

}  // namespace detail
}  // namespace dem::mbd
