#pragma once

#include <dem/core/macros.hpp>
#include <dem/mbd/drive/signal.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/coordinate.hpp>

#include <dem/core/function.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// Where one of the two frames of a driven body is (MotionSpec::frame), and how it moves. A velocity that is not given
/// is found by central differences over 2e-6 s.
struct Pose {
  Vec3 position = Vec3::Zero();               ///< m, origin of the frame, global
  Mat3 rotation = Mat3::Identity();           ///< frame -> global
  std::optional<Vec3> velocity = {};          ///< m/s, of the origin of the frame
  std::optional<Vec3> angular_velocity = {};  ///< rad/s, global axes
};

using PoseFunction = Function<Pose(double)>;  ///< of the time (s)

/// A prescribed motion (eq. 19): the value and the speed of one coordinate, or a whole pose, are set exactly at the end
/// of every stage, whatever force it takes. That force is reported.
///
/// A drive acts as a force would: along its axis at the joint's point, or as a torque, on one body and opposite on the
/// other. So momentum is kept (of rotation to the order of the time step). Side effects of this force are carried by
/// the joints. All drives are met at once. Where two repeat or contradict each other, the earlier one counts. A body
/// that is fixed or whose pose is prescribed yields to no other drive, and contacts meet it with an endless mass; of
/// two motions of such a body, the later one counts. A drive starts from the present value of its coordinate: a value
/// that is more than 1 mm or 1 mrad off when the drive is added, switched on, loaded or given another signal is
/// refused; in a world of grains also one that is more than a tenth of the smallest grain's radius off. A speed is set
/// within one step, and the force of that step is the jolt that this takes.
///
/// Two coordinates of joints cannot be prescribed. A bend has no direction where the joint is straight; bend_x and
/// bend_y of a universal joint have one. The length of a distance joint is held by the joint itself: drive the slide of
/// a prismatic joint between the two bodies instead, or use a linear_actuator without the joint.
struct MotionSpec {
  enum class Target {
    position,  ///< displacement of a body's centre of mass along a global axis, from where it is when the motion is
               ///< added
    rotation,  ///< turn of a body about a global axis, likewise; it turns about no other axis
    joint,     ///< coordinate of a joint, but no bend or length
    pose       ///< everything
  };
  std::string name;
  Target target = Target::position;
  BodyId body = {};
  JointId joint = {};
  Dof dof = Dof::own;         ///< the joint's coordinate that is prescribed
  Vec3 axis = Vec3::UnitX();  ///< global; made a unit vector
  Signal motion = 0.0;        ///< m or rad
  bool by_speed = false;      ///< only the signal's rate counts; the coordinate grows by its integral over each step
  PoseFunction pose = {};
  BodyFrame frame = BodyFrame::reference;  ///< of the body, which the pose is that of
  bool on = true;

  /// Prescribes one of dofs_of(the joint's kind) instead of the joint's own coordinate.
  MotionSpec along(Dof f) const;
};

DEM_SETUP inline MotionSpec prescribed_position(std::string name, BodyId body, const Vec3& axis, Signal metres) {
  return {.name = std::move(name), .body = body, .axis = axis, .motion = std::move(metres)};
}
MotionSpec prescribed_rotation(std::string name, BodyId body, const Vec3& axis, Signal radians);
MotionSpec prescribed_joint(std::string name, JointId joint, Signal coordinate);
/// Prescribes the speed of a joint's coordinate (m/s or rad/s), from whatever value it has: a driven wheel. In each
/// step the value grows by the integral of the signal over the step (Simpson's rule, exact for cubics), whatever the
/// load is.
MotionSpec prescribed_speed(std::string name, JointId joint, Signal speed);
/// Prescribes where one of the body's frames is: by default the reference frame, as BodySpec::at does.
MotionSpec prescribed_pose(std::string name, BodyId body, PoseFunction pose, BodyFrame frame = BodyFrame::reference);

/// The way to a value that was set from outside with a rate: from where the coordinate is, straight through the step
/// that comes next. So each of its sub-steps makes its share of it, and value and rate agree.
struct WayToValue {
  static constexpr double not_yet = 1e300;
  double from = 0.0;                   ///< m or rad
  double begin = 0.0, end = -not_yet;  ///< s; end: not_yet before the step begins

  /// A value was set.
  void set() { end = not_yet; }
  void drop() { end = -not_yet; }
  void end_if_begun() {
    if (!is_ahead()) drop();
  }
  bool is_ahead() const { return end == not_yet; }
  void begin_step(double start_of_step, double end_of_step);
  /// A rate of 0 asks for a jump, and one whose value stays is a belt's.
  double at(double time, const Signal::Sample& wanted) const;
  template <class V>
  void fields(V& v) {
    v("from", from), v("begin", begin, "s"), v("end", end, "s");
  }
};

struct PrescribedMotion {
  MotionSpec spec;
  Vector3<double> axis = {};
  double start = 0.0;       ///< m, position along the axis when it was added
  bool has_hold = false;    ///< it has been compared with its coordinate since it was added or changed
  bool was_loaded = false;  ///< from a file, since when it has not been looked at
  Matrix3<double> start_rotation = Matrix3<double>::identity();
  Vector3<double> centre = {0, 0, 0};                  ///< m, of mass, in the frame of the poses
  Matrix3<double> axes = Matrix3<double>::identity();  ///< body frame -> frame of the poses
  struct Drive {
    double value = 0.0, rate = 0.0;  ///< what was set last
    double start = 0.0;              ///< m or rad, at the start of the step; of a motion by speed its coordinate
    double start_rate = 0.0;         ///< of a motion by its value, at the start of the step
    double expected = 0.0;           ///< m or rad, at the end of the step if `value` does not jump
    double reached = 0.0;            ///< of a motion by speed: its coordinate when it was set last, m or rad
    double time = 0.0;               ///< s, that `value` belongs to
    bool moves = false;              ///< `time` is that of the end of a step
    WayToValue way;
    double impulse = 0.0;  ///< N s or N m s, given since the force was reported
    double force = 0.0;    ///< N or N m, makes the coordinate grow (not for a pose)
  } drive;
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.given("target", spec.target), v.given("body", spec.body);
    v.given("joint", spec.joint), v.given("dof", spec.dof), v.given("by_speed", spec.by_speed), v("on", spec.on);
    v.given("axis_given", spec.axis), v.given("frame", spec.frame);
    v("motion", spec.motion), v("axis", axis), v("start", start, "m"), v("has_hold", has_hold);
    v("start_rotation", start_rotation), v("centre", centre, "m"), v("axes", axes), v("value", drive.value);
    v("rate", drive.rate), v("start_of_step", drive.start), v("reached", drive.reached), v("time_of_value", drive.time),
        v("moves", drive.moves), v("way", drive.way), v("impulse", drive.impulse), v("force", drive.force);
  }
};

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE MotionSpec MotionSpec::along(Dof f) const {
  MotionSpec s = *this;
  s.dof = f;
  return s;
}

DEM_INLINE MotionSpec prescribed_rotation(std::string name, BodyId body, const Vec3& axis, Signal radians) {
  return {.name = std::move(name),
          .target = MotionSpec::Target::rotation,
          .body = body,
          .axis = axis,
          .motion = std::move(radians)};
}

DEM_INLINE MotionSpec prescribed_joint(std::string name, JointId joint, Signal coordinate) {
  return {
      .name = std::move(name), .target = MotionSpec::Target::joint, .joint = joint, .motion = std::move(coordinate)};
}

DEM_INLINE MotionSpec prescribed_speed(std::string name, JointId joint, Signal speed) {
  MotionSpec s = prescribed_joint(std::move(name), joint, speed.as_rate());
  s.by_speed = true;
  return s;
}

DEM_INLINE MotionSpec prescribed_pose(std::string name, BodyId body, PoseFunction pose, BodyFrame frame) {
  return {.name = std::move(name),
          .target = MotionSpec::Target::pose,
          .body = body,
          .pose = std::move(pose),
          .frame = frame};
}

DEM_INLINE void WayToValue::begin_step(double start_of_step, double end_of_step) {
  if (!is_ahead()) return;
  begin = start_of_step;
  end = end_of_step;
}

DEM_INLINE double WayToValue::at(double time, const Signal::Sample& wanted) const {
  if (wanted.rate == 0.0 || end == -not_yet) return wanted.value;
  if (is_ahead()) return from;
  const double share = (time - begin) / (end - begin);
  return share < 1.0 - 1e-9 ? from + share * (wanted.value - from) : wanted.value;
}

}  // namespace dem::mbd

#endif
