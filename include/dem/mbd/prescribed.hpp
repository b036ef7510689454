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
/// of every stage. It acts on one body alone: what it takes to move it is reported, not passed on. Where another body
/// has to feel the drive, use an actuator.
struct MotionSpec {
  enum class Target {
    position,  ///< displacement of a body's centre of mass along a global axis, from where it was at assembly
    rotation,  ///< turn of a body about a global axis through its centre of mass; it turns about no other axis
    joint,     ///< coordinate of a joint; moves the joint's body b
    pose       ///< everything
  };
  std::string name;
  Target target = Target::position;
  BodyId body = {};
  JointId joint = {};
  Vec3 axis = Vec3::UnitX();  ///< global; made a unit vector
  Signal motion = 0.0;        ///< m or rad
  std::function<Pose(double)> pose = {};
  bool on = true;
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
  MotionSpec spec;
  Vector3<double> axis = {};
  double start = 0.0;  ///< m, position along the axis at assembly
  Matrix3<double> start_rotation = Matrix3<double>::identity();
  struct Drive {
    double value = 0.0, rate = 0.0;  ///< what was set last
    double time = 0.0;               ///< s, for which it was set
    double earlier_rate = 0.0;       ///< what was set for the time before: a step has several stages
    double force = 0.0;              ///< N or N m that the drive gives along its coordinate (not for a pose)
  } drive;
};

namespace detail {

/// Turns a body by an angle about an axis through a global point.
inline void turn_about(Body& b, const Vector3<double>& axis, const Vector3<double>& point, double angle) {
  const Matrix3<double> turn = rotation_from_vector(angle * axis);
  b.motion.position = point + turn * (b.motion.position - point);
  const Vector3<double> w = b.motion.rotation * b.motion.angular_velocity;  // global, unchanged
  b.motion.rotation = turn * b.motion.rotation;
  b.motion.angular_velocity = transpose_times(b.motion.rotation, w);
}

inline double inertia_about(const Body& b, const Vector3<double>& axis) {
  const Vector3<double> n = transpose_times(b.motion.rotation, axis);
  return n.x * n.x * b.inertia[0] + n.y * n.y * b.inertia[1] + n.z * n.z * b.inertia[2];
}

}  // namespace detail

/// Sets the prescribed value and speed for `time`. `dt` (s) is the step over which the rate changed since the last
/// call; 0 where it is only set, and no force is reported. `gravity` enters the reported drive force.
inline void apply_motion(PrescribedMotion& p, const std::vector<Joint>& joints, std::vector<Body>& bodies, double time,
                         double dt, const Vector3<double>& gravity) {
  using V = Vector3<double>;
  if (!p.spec.on) return;
  Body& b = bodies[p.spec.body.index()];
  if (p.spec.target == MotionSpec::Target::pose) {
    const Pose pose = p.spec.pose(time);
    b.motion.position = from_eigen(pose.position);
    b.motion.velocity = from_eigen(pose.velocity);
    b.motion.rotation = from_eigen(pose.rotation);
    b.motion.angular_velocity = transpose_times(b.motion.rotation, from_eigen(pose.angular_velocity));
    return;
  }
  const Signal::Sample s = p.spec.motion(time);
  if (time != p.drive.time) p.drive.earlier_rate = p.drive.rate;
  p.drive.time = time;
  const double acceleration = dt > 0.0 ? (s.rate - p.drive.earlier_rate) / dt : 0.0;
  const auto report = [&](double force) {
    if (dt > 0.0) p.drive.force = force;
  };
  const V weight = b.mass * gravity;
  if (p.spec.target == MotionSpec::Target::position) {
    report((b.fixed ? 0.0 : b.mass * acceleration - dot(weight, p.axis)) - dot(b.force, p.axis));
    b.motion.position += (p.start + s.value - dot(b.motion.position, p.axis)) * p.axis;
    b.motion.velocity += (s.rate - dot(b.motion.velocity, p.axis)) * p.axis;
  } else if (p.spec.target == MotionSpec::Target::rotation) {
    report((b.fixed ? 0.0 : detail::inertia_about(b, p.axis) * acceleration) - dot(b.torque, p.axis));
    b.motion.rotation = rotation_from_vector(s.value * p.axis) * p.start_rotation;
    b.motion.angular_velocity = transpose_times(b.motion.rotation, s.rate * p.axis);
  } else {
    const Joint& j = joints[p.spec.joint.index()];
    const Body& a = bodies[j.a];
    const Coordinate q = coordinate_of(j, a, b);
    if (q.rotation) {
      const V point = b.motion.position + b.motion.rotation * j.point_b;
      const V arm =
          point - b.motion.position;  // the drive's torque about the joint, from that about the centre of mass
      const double inertia =
          detail::inertia_about(b, q.axis) + b.mass * (dot(arm, arm) - dot(arm, q.axis) * dot(arm, q.axis));
      report((b.fixed ? 0.0 : inertia * acceleration + dot(cross(arm, weight), q.axis)) -
             dot(b.torque - cross(arm, b.force), q.axis));
      detail::turn_about(b, q.axis, point, s.value - q.value);
      const V dw = (s.rate - q.speed) * q.axis;
      b.motion.angular_velocity += transpose_times(b.motion.rotation, dw);
      b.motion.velocity += cross(dw, b.motion.position - point);
    } else {
      report((b.fixed ? 0.0 : b.mass * acceleration - dot(weight, q.axis)) - dot(b.force, q.axis));
      b.motion.position += (s.value - q.value) * q.axis;
      b.motion.velocity += (s.rate - q.speed) * q.axis;
    }
  }
  p.drive.value = s.value;
  p.drive.rate = s.rate;
}

}  // namespace dem::mbd
