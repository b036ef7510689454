#pragma once

#include <dem/mbd/coordinate.hpp>
#include <dem/mbd/signal.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// Where a driven body is, and how it moves.
struct Pose {
  Vec3 position = Vec3::Zero();          ///< m, centre of mass, global
  Mat3 rotation = Mat3::Identity();      ///< body frame -> global
  Vec3 velocity = Vec3::Zero();          ///< m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, global axes
};

/// A prescribed motion (eq. 19): the value and the speed of one coordinate, or a whole pose, are set exactly at the end
/// of every stage, whatever force it takes; that force is reported.
///
/// A joint's drive acts between its two bodies. If one of them is fixed, or is driven itself by a motion that was added
/// before, the other one moves and the reaction ends there. If both move freely, each takes its share: the drive gives
/// them opposite impulses, so momentum is kept.
///
/// Where it is no more than an approximation: joints that leave the driven body free to turn (point on line or plane,
/// planar, free) are driven as if the force acted in its centre of mass; several drives that share a free body meet
/// their values to the order of the time step only, and the force that one of them reports leaves the others out; and a
/// body that any motion drives, in whatever direction, takes the reactions of the joint drives that are added after it.
/// An actuator has none of these limits.
struct MotionSpec {
  enum class Target {
    position,  ///< displacement of a body's centre of mass along a global axis, from where it was at assembly
    rotation,  ///< turn of a body about a global axis through its centre of mass; it turns about no other axis
    joint,     ///< coordinate of a joint, but not its bend
    pose       ///< everything
  };
  std::string name;
  Target target = Target::position;
  BodyId body = {};
  JointId joint = {};
  Freedom freedom = Freedom::own;  ///< the joint's coordinate that is prescribed
  Vec3 axis = Vec3::UnitX();       ///< global; made a unit vector
  Signal motion = 0.0;             ///< m or rad
  std::function<Pose(double)> pose = {};
  bool on = true;

  /// Prescribes one of freedoms_of(the joint's kind) instead of the joint's own coordinate.
  MotionSpec along(Freedom f) const {
    MotionSpec s = *this;
    s.freedom = f;
    return s;
  }
};

inline MotionSpec prescribed_position(std::string name, BodyId body, const Vec3& axis, Signal metres) {
  return {.name = std::move(name), .body = body, .axis = axis, .motion = std::move(metres)};
}
inline MotionSpec prescribed_rotation(std::string name, BodyId body, const Vec3& axis, Signal radians) {
  return {.name = std::move(name),
          .target = MotionSpec::Target::rotation,
          .body = body,
          .axis = axis,
          .motion = std::move(radians)};
}
inline MotionSpec prescribed_joint(std::string name, JointId joint, Signal coordinate) {
  return {
      .name = std::move(name), .target = MotionSpec::Target::joint, .joint = joint, .motion = std::move(coordinate)};
}
inline MotionSpec prescribed_pose(std::string name, BodyId body, std::function<Pose(double)> pose) {
  return {.name = std::move(name), .target = MotionSpec::Target::pose, .body = body, .pose = std::move(pose)};
}

struct PrescribedMotion {
  enum class Moves { b, a, both };  ///< of the joint's bodies

  MotionSpec spec;
  Moves moves = Moves::b;
  Vector3<double> axis = {};
  double start = 0.0;  ///< m, position along the axis at assembly
  Matrix3<double> start_rotation = Matrix3<double>::identity();
  struct Drive {
    double value = 0.0, rate = 0.0;  ///< what was set last
    double time = 0.0;               ///< s, for which it was set
    double force = 0.0;              ///< N or N m, makes the coordinate grow (not for a pose)
    /// kg m/s and kg m^2/s (about the centre of mass) of the driven body: as set last, and as set for the time before,
    /// for a step has several stages.
    Vector3<double> momentum = {0, 0, 0}, spin = {0, 0, 0}, earlier_momentum = {0, 0, 0}, earlier_spin = {0, 0, 0};
  } drive;
};

namespace detail {

/// Turns a body by an angle (rad) about an axis through a global point.
inline void turn_about(Body& b, const Vector3<double>& axis, const Vector3<double>& point, double angle) {
  const Matrix3<double> turn = rotation_from_vector(angle * axis);
  b.motion.position = point + turn * (b.motion.position - point);
  const Vector3<double> w = b.motion.rotation * b.motion.angular_velocity;  // global, unchanged
  b.motion.rotation = turn * b.motion.rotation;
  b.motion.angular_velocity = transpose_times(b.motion.rotation, w);
}

/// What a unit impulse along a coordinate does to the body b of a joint, or the opposite one to a: m/s and rad/s.
struct Response {
  Vector3<double> velocity, spin;
  double gain;  ///< of the coordinate's speed, per unit of impulse
};
inline Response response_of(const Body& x, const Coordinate& q, const Vector3<double>& arm) {
  const Vector3<double> t = q.rotation ? q.axis : cross(arm, q.axis);
  const Vector3<double> in_body = transpose_times(x.motion.rotation, t);
  Response r;
  r.velocity = ((q.rotation ? 0.0 : 1.0) / x.mass) * q.axis;
  r.spin =
      x.motion.rotation * Vector3<double>{in_body.x / x.inertia[0], in_body.y / x.inertia[1], in_body.z / x.inertia[2]};
  r.gain = dot(q.axis, q.rotation ? r.spin : r.velocity + cross(r.spin, arm));
  return r;
}

/// Sets a joint's coordinate and its speed by opposite impulses on both bodies, so that neither momentum nor centre of
/// mass of the two changes.
inline void share_motion(const Joint& j, Freedom freedom, Body& a, Body& b, const Signal::Sample& s) {
  const auto displace = [](Body& x, const Response& r, double by) {
    x.motion.position += by * r.velocity;
    turn_about(x, r.spin, x.motion.position, by);
  };
  for (int k = 0; k < 3; ++k) {  // Newton's iteration: one is exact but for rotations, each squares what is left
    const Coordinate q = coordinate_of(j, a, b, freedom);
    const Response ra = response_of(a, q, q.arm_a), rb = response_of(b, q, q.arm_b);
    const double by = (s.value - q.value) / (ra.gain + rb.gain);
    displace(b, rb, by);
    displace(a, ra, -by);
  }
  const Coordinate q = coordinate_of(j, a, b, freedom);
  const Response ra = response_of(a, q, q.arm_a), rb = response_of(b, q, q.arm_b);
  const double impulse = (s.rate - q.speed) / (ra.gain + rb.gain);
  b.motion.velocity += impulse * rb.velocity;
  a.motion.velocity -= impulse * ra.velocity;
  b.motion.angular_velocity += transpose_times(b.motion.rotation, impulse * rb.spin);
  a.motion.angular_velocity -= transpose_times(a.motion.rotation, impulse * ra.spin);
}

/// Sets a joint's coordinate and its speed by moving one body x alone, rigidly along or about the joint's axis; sign is
/// 1 for the joint's body b and -1 for a.
inline void move_one(const Joint& j, Freedom freedom, const std::vector<Body>& bodies, Body& x, double sign,
                     const Signal::Sample& s) {
  const Coordinate q = coordinate_of(j, bodies[j.a], bodies[j.b], freedom);
  const double by = sign * (s.value - q.value), faster = sign * (s.rate - q.speed);
  if (q.rotation) {
    const Vector3<double> point = bodies[j.b].motion.position + bodies[j.b].motion.rotation * j.point_b;
    turn_about(x, q.axis, point, by);
    const Vector3<double> dw = faster * q.axis;
    x.motion.angular_velocity += transpose_times(x.motion.rotation, dw);
    x.motion.velocity += cross(dw, x.motion.position - point);
  } else {
    x.motion.position += by * q.axis;
    x.motion.velocity += faster * q.axis;
  }
}

/// The force (N) or torque (N m) along an axis that a drive has to give its body x: what its momentum gained in dt (s),
/// less what weight and the other forces gave. Torques are about a point, through which nothing else drives it.
inline double drive_force(const PrescribedMotion::Drive& d, const Body& x, const Vector3<double>& axis, bool rotation,
                          const Vector3<double>& point, const Vector3<double>& gravity, double dt) {
  using V = Vector3<double>;
  const double gain = x.fixed ? 0.0 : 1.0 / dt;
  const V force = gain * (d.momentum - d.earlier_momentum) - (x.fixed ? 0.0 : x.mass) * gravity - x.force;
  if (!rotation) return dot(axis, force);
  const V torque = gain * (d.spin - d.earlier_spin) - x.torque;
  return dot(axis, torque + cross(x.motion.position - point, force));
}

/// Keeps the momentum that the driven body has for `time`, and that for the time before.
inline void follow(PrescribedMotion::Drive& d, const Body& x, double time) {
  if (time != d.time) {
    d.earlier_momentum = d.momentum;
    d.earlier_spin = d.spin;
  }
  const Vector3<double>& w = x.motion.angular_velocity;
  d.time = time;
  d.momentum = x.mass * x.motion.velocity;
  d.spin = x.motion.rotation * Vector3<double>{x.inertia[0] * w.x, x.inertia[1] * w.y, x.inertia[2] * w.z};
}

}  // namespace detail

/// Sets the prescribed value and speed for `time`. `dt` (s) is the step in which the body's momentum changed since the
/// last call; 0 where it is only set, and no force is reported. `gravity` enters the reported drive force.
inline void apply_motion(PrescribedMotion& p, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time,
                         double dt, const Vector3<double>& gravity) {
  using V = Vector3<double>;
  using Moves = PrescribedMotion::Moves;
  Body& x = bodies[p.spec.body.index()];
  if (!p.spec.on) {
    p.drive.force = 0.0;
    detail::follow(p.drive, x, time);
    return;
  }
  if (p.spec.target == MotionSpec::Target::pose) {
    const Pose pose = p.spec.pose(time);
    x.motion.position = from_eigen(pose.position);
    x.motion.velocity = from_eigen(pose.velocity);
    x.motion.rotation = from_eigen(pose.rotation);
    x.motion.angular_velocity = transpose_times(x.motion.rotation, from_eigen(pose.angular_velocity));
    return;
  }
  const Signal::Sample s = p.spec.motion(time);
  V axis = p.axis, point = x.motion.position;
  bool rotation = p.spec.target == MotionSpec::Target::rotation;
  double sign = 1.0;
  if (p.spec.target == MotionSpec::Target::position) {
    x.motion.position += (p.start + s.value - dot(x.motion.position, axis)) * axis;
    x.motion.velocity += (s.rate - dot(x.motion.velocity, axis)) * axis;
  } else if (rotation) {
    x.motion.rotation = rotation_from_vector(s.value * axis) * p.start_rotation;
    x.motion.angular_velocity = transpose_times(x.motion.rotation, s.rate * axis);
  } else {
    const Joint& j = joints[p.spec.joint.index()];
    sign = p.moves == Moves::a ? -1.0 : 1.0;
    if (p.moves == Moves::both) {
      detail::share_motion(j, p.spec.freedom, bodies[j.a], bodies[j.b], s);
    } else {
      detail::move_one(j, p.spec.freedom, bodies, x, sign, s);
    }
    const Coordinate q = coordinate_of(j, bodies[j.a], bodies[j.b], p.spec.freedom);
    axis = q.axis;
    rotation = q.rotation;
    point = bodies[j.b].motion.position + bodies[j.b].motion.rotation * j.point_b;
  }
  detail::follow(p.drive, x, time);
  if (dt > 0.0) p.drive.force = sign * detail::drive_force(p.drive, x, axis, rotation, point, gravity, dt);
  p.drive.value = s.value;
  p.drive.rate = s.rate;
}

}  // namespace dem::mbd
