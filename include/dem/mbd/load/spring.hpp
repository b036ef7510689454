#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/curve.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coordinate.hpp>

#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A spring and damper between two points, or on a coordinate of a joint: force over length (or torque over angle) from
/// a table or a stiffness and a free length.
struct SpringSpec {
  std::string name;
  BodyId a = {}, b = {};
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();  ///< m, global at assembly
  Curve force_over_length = {};                   ///< N over m (or N m over rad); positive pushes the points apart
  Curve force_over_speed = {};                    ///< N over m/s of lengthening (or N m over rad/s); likewise
  bool on = true;
  bool on_joint = false;  ///< acts on a joint's coordinate, not between two points
  JointId joint = {};
  Dof dof = Dof::own;
  bool from_start = false;  ///< the table counts from what the joint's coordinate is when the spring is added

  /// Acts on one of dofs_of(the joint's kind) instead of the joint's own coordinate.
  SpringSpec along(Dof f) const;
};

/// A linear spring (N/m) of free length (m; the length at assembly if negative) with a linear damper (N s/m).
SpringSpec spring(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b, double stiffness,
                  double damping = 0.0, double free_length = -1.0);
/// A spring of free length (m) whose force (N) over its compression (m, positive when shorter) is a table. Beyond the
/// table the force goes on with the slope of its last piece. With a curve that is `held_outside` it keeps its last
/// value instead: a bump stop is such a spring, which does not pull. The damper acts at every length.
SpringSpec spring_table(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b, double free_length,
                        const Curve& force_over_compression, double damping = 0.0);

/// On a coordinate of a joint, a torsion bar or a coil spring on a slide: a linear spring (N m/rad where it turns, N/m
/// where it slides) with a linear damper (N m s/rad, N s/m), free where the coordinate is when it is added.
SpringSpec joint_spring(std::string name, JointId joint, double stiffness, double damping = 0.0);
/// The same, free at a given value (rad or m) of the coordinate.
SpringSpec joint_spring(std::string name, JointId joint, double stiffness, double damping, double free_at);
/// The same from a table of torque (N m) over the coordinate (rad), or of force (N) over it (m): positive drives the
/// coordinate up, so a spring that holds its middle has a falling table. Beyond the table its last slope goes on,
/// unless the curve is held_outside().
SpringSpec joint_spring_table(std::string name, JointId joint, Curve torque_over_coordinate, double damping = 0.0);

struct Spring {
  SpringSpec spec;
  std::uint32_t a = 0, b = 0;
  Vector3<double> point_a = {}, point_b = {};  ///< m, body frames
  double start = 0.0;                          ///< m or rad, that the table counts from
  double length = 0.0, speed = 0.0;            ///< m, m/s (or rad, rad/s)
  double force = 0.0;                          ///< N (or N m), positive pushes the points apart
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v("on", spec.on), v.given("a", a), v.given("b", b), v.given("joint", spec.joint),
        v.given("dof", spec.dof);
    v.given("point_on_a", spec.at_a, "m"), v.given("point_on_b", spec.at_b, "m");
    v("force_over_length", spec.force_over_length), v("force_over_speed", spec.force_over_speed);
    v("point_a", point_a, "m"), v("point_b", point_b, "m"), v("length", length, "m"), v("speed", speed, "m/s");
    v("force", force, "N"), v("start", start);
  }
};

/// The coordinate that a spring acts on.
Coordinate coordinate_of(const Spring& s, const std::vector<Joint>& joints, const Body& a, const Body& b);

void apply_spring(Spring& s, const std::vector<Joint>& joints, std::vector<Body>& bodies);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE SpringSpec SpringSpec::along(Dof f) const {
  SpringSpec s = *this;
  s.dof = f;
  return s;
}

DEM_INLINE SpringSpec spring(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b, double stiffness,
                             double damping, double free_length) {
  require_non_negative(stiffness, "stiffness of a spring", "N/m");
  require_non_negative(damping, "damping of a spring", "N s/m");
  const double l0 = free_length < 0.0 ? norm(from_eigen(at_b) - from_eigen(at_a)) : free_length;
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = at_a,
          .at_b = at_b,
          .force_over_length = Curve::line(stiffness * l0, -stiffness),
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{}};
}

DEM_INLINE SpringSpec spring_table(std::string name, BodyId a, const Vec3& at_a, BodyId b, const Vec3& at_b,
                                   double free_length, const Curve& force_over_compression, double damping) {
  require_positive(free_length, "free length of a spring", "m");
  require_non_negative(damping, "damping of a spring", "N s/m");
  std::vector<std::pair<double, double>> points;
  for (const auto& [x, f] : force_over_compression.points()) points.emplace_back(free_length - x, f);
  const Curve over_length({points.rbegin(), points.rend()});
  return {.name = std::move(name),
          .a = a,
          .b = b,
          .at_a = at_a,
          .at_b = at_b,
          .force_over_length = force_over_compression.is_held_outside() ? over_length.held_outside() : over_length,
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{}};
}

DEM_INLINE SpringSpec joint_spring(std::string name, JointId joint, double stiffness, double damping) {
  require_non_negative(stiffness, "stiffness of a spring", "N m/rad or N/m");
  require_non_negative(damping, "damping of a spring", "N m s/rad or N s/m");
  return {.name = std::move(name),
          .force_over_length = Curve::line(0.0, -stiffness),
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{},
          .on_joint = true,
          .joint = joint,
          .from_start = true};
}

DEM_INLINE SpringSpec joint_spring(std::string name, JointId joint, double stiffness, double damping, double free_at) {
  SpringSpec s = joint_spring(std::move(name), joint, stiffness, damping);
  s.force_over_length = Curve::line(stiffness * free_at, -stiffness);
  s.from_start = false;
  return s;
}

DEM_INLINE SpringSpec joint_spring_table(std::string name, JointId joint, Curve torque_over_coordinate,
                                         double damping) {
  require_non_negative(damping, "damping of a spring", "N m s/rad or N s/m");
  return {.name = std::move(name),
          .force_over_length = std::move(torque_over_coordinate),
          .force_over_speed = damping > 0.0 ? Curve::line(0.0, -damping) : Curve{},
          .on_joint = true,
          .joint = joint};
}

DEM_INLINE Coordinate coordinate_of(const Spring& s, const std::vector<Joint>& joints, const Body& a, const Body& b) {
  return s.spec.joint.valid() ? coordinate_of(joints[s.spec.joint.index()], a, b, s.spec.dof)
                              : distance_of(s.point_a, s.point_b, a, b);
}

DEM_INLINE void apply_spring(Spring& s, const std::vector<Joint>& joints, std::vector<Body>& bodies) {
  Body &a = bodies[s.a], &b = bodies[s.b];
  const Coordinate q = coordinate_of(s, joints, a, b);
  s.length = q.value;
  s.speed = q.speed;
  s.force = 0.0;
  if (!s.spec.on) return;
  if (!s.spec.force_over_length.empty()) s.force += s.spec.force_over_length(q.value - s.start);
  if (!s.spec.force_over_speed.empty()) s.force += s.spec.force_over_speed(q.speed);
  q.apply(s.force, a, b);
}

}  // namespace dem::mbd

#endif
