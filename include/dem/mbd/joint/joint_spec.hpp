#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/vector.hpp>
#include <dem/mbd/drive/curve.hpp>
#include <dem/mbd/ids.hpp>
#include <dem/mbd/joint/joint_kind.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

struct Parts;

/// A limit at each end of a coordinate of a joint (rad for rotations, m for slides).
struct JointLimits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<double> stiffness = {};  ///< N/m or N m/rad; derived if not given
  std::optional<double> damping = {};    ///< N s/m or N m s/rad, while moving into the limit; derived if not given
  Dof dof = Dof::own;                    ///< which coordinate
  template <class V>
  void fields(V& v) {
    v.given("stiffness_of_limit", stiffness), v.given("damping_of_limit", damping);
  }
};

/// What a coordinate of a joint is at assembly, rad or m.
struct JointStart {
  Dof dof = Dof::own;
  double value = 0.0;
  template <class V>
  void fields(V& v) {
    v.given("starting_dof", dof), v.given("starting_at", value);
  }
};

/// Asperity friction in a joint (thesis section 2.2.2). The normal force is that which the joint carries, plus a
/// preload.
struct JointFriction {
  double coefficient = 0.0;
  /// m, of the bearing, where rotation rubs. Joints with a held point (revolute, cylindrical, spherical, universal, CV)
  /// need it; a planar joint with a radius rubs its rotation too, without one its sliding alone; guides (prismatic,
  /// point on line or plane) rub their sliding alone and have none.
  double radius = 0.0;
  double preload =
      0.0;             ///< N, added to the normal force; for a brake, which no load on the bearing tightens, see brake
  double lever = 0.0;  ///< m, distance of the bearings: adds torque/lever; 0: left out
  double breaking_factor = 0.975;
  std::optional<double> stiffness = {};           ///< N/m; derived if not given
  std::optional<double> velocity_stiffness = {};  ///< N s/m; derived if not given
  template <class V>
  void fields(V& v) {
    v.given("friction_coefficient", coefficient), v.given("friction_radius", radius, "m");
    v.given("friction_preload", preload, "N"), v.given("friction_lever", lever, "m");
    v.given("friction_breaking_factor", breaking_factor), v.given("friction_stiffness", stiffness, "N/m");
    v.given("friction_velocity_stiffness", velocity_stiffness, "N s/m");
  }
};

/// What a bushing resists with along and about the axes of its frame: force (N) over displacement (m) and torque (N m)
/// over angle (rad), positive for a positive displacement of b. Outside a table its last slope goes on, unless the
/// curve is held_outside(). An empty curve resists nothing.
struct BushingTables {
  Curve x = {}, y = {}, z = {};
  Curve about_x = {}, about_y = {}, about_z = {};
  template <class V>
  void fields(V& v) {
    v("table_x", x), v("table_y", y), v("table_z", z);
    v("table_about_x", about_x), v("table_about_y", about_y), v("table_about_z", about_z);
  }
};

/// What a joint is made from. Each kind has a function that makes it (kinds.hpp); the `with_...` functions refine it. A
/// stiffness or damping that is not given is derived when the machine learns its time step (see solver/part_kind.hpp).
struct JointSpec {
  std::string name;
  JointKind kind = {};
  BodyId a = {}, b = {};
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero();        ///< m, global at assembly: the joint's point on a and on b
  Vec3 axis_a = Vec3::UnitZ(), axis_b = Vec3::UnitZ();  ///< global at assembly: z of the joint's frame on a and on b
  std::optional<Vec3> x_axis = {};                      ///< global at assembly: x of the joint's frame, see with_x
  ConnectionId connection_a = {}, connection_b = {};    ///< instead of a, at_a and b, at_b
  std::optional<double> stiffness = {};                 ///< N/m
  std::optional<double> damping = {};                   ///< N s/m
  std::optional<double> rotational_stiffness = {};      ///< N m/rad
  std::optional<double> rotational_damping = {};        ///< N m s/rad
  Vec3 bushing_stiffness = Vec3::Zero(), bushing_damping = Vec3::Zero();                        ///< N/m, N s/m
  Vec3 bushing_rotational_stiffness = Vec3::Zero(), bushing_rotational_damping = Vec3::Zero();  ///< N m/rad, N m s/rad
  std::shared_ptr<const BushingTables> bushing_tables = {};  ///< of a bushing with tables
  std::optional<double> length = {};     ///< m, of a distance joint, within `tolerance`; that at assembly if not given
  std::vector<JointStart> starts = {};   ///< of coordinates that are not 0 at assembly
  std::vector<JointLimits> limits = {};  ///< one for each coordinate that is limited; see with_limits
  std::optional<JointFriction> friction = {};  ///< see with_friction
  /// m, within which the two points have to meet at assembly; rad for the axes. What is within it is made to meet: each
  /// body's point moves to the middle of the gap and its axis to the mean of both, so that the joint starts at rest.
  double tolerance = 1e-6;
  /// Set by with_limits and with_friction, without which a program has no code for either: add the joint's limits, its
  /// friction, to a machine's parts.
  void (*add_limits)(Parts& parts, JointSpec& spec, const Joint& joint, std::uint32_t number) = nullptr;
  void (*add_friction)(Parts& parts, JointSpec& spec, const Joint& joint, std::uint32_t number) = nullptr;

  template <class V>
  void fields(V& v) {
    v.given("name", name), v.given("kind", std::string(name_of(kind)));
    v.given("stiffness", stiffness, "N/m"), v.given("damping", damping, "N s/m");
    v.given("rotational_stiffness", rotational_stiffness, "N m/rad");
    v.given("rotational_damping", rotational_damping, "N m s/rad");
    v.given("bushing_stiffness", bushing_stiffness, "N/m"), v.given("bushing_damping", bushing_damping, "N s/m");
    v.given("bushing_rotational_stiffness", bushing_rotational_stiffness, "N m/rad");
    v.given("bushing_rotational_damping", bushing_rotational_damping, "N m s/rad");
    v.given("point_on_a", at_a, "m"), v.given("point_on_b", at_b, "m");
    v.given("axis_on_a", axis_a), v.given("axis_on_b", axis_b), v.given("x_axis", x_axis);
    v.given("given_length", length, "m"), v.given("starts", starts), v.given("limits", limits);
    v.given("friction", friction), v.given("has_tables", bushing_tables != nullptr);
    if (bushing_tables) v.given("tables", *bushing_tables);
  }

  /// x of the joint's frame lies in the plane of z and this direction (global at assembly): the first direction of a
  /// planar joint or a bushing, or the arm of a universal joint's cross on body a. Without it x is the global X made
  /// square to z or, where z is within 26 deg of X, the global Y: for z along Z all three axes are the global ones.
  JointSpec with_x(const Vec3& direction) const;
  JointSpec with_stiffness(double translation, double rotation) const;
  JointSpec with_damping(double translation, double rotation) const;
  JointSpec with_limits(double lower, double upper) const { return with_limits(JointLimits{lower, upper}); }
  JointSpec with_limits(Dof dof, double lower, double upper) const {
    return with_limits(JointLimits{.lower = lower, .upper = upper, .dof = dof});
  }
  JointSpec with_limits(const JointLimits& given) const;
  bool has_stiffness_or_damping() const { return stiffness || damping || rotational_stiffness || rotational_damping; }
  JointSpec with_friction(const JointFriction& f) const;
  /// The joint's own coordinate, or another one that turns about or slides along z, counts from this value (rad or m)
  /// at assembly.
  JointSpec starting_at(double coordinate) const { return starting_at(Dof::own, coordinate); }
  JointSpec starting_at(Dof dof, double coordinate) const;
};

/// A joint of any kind at a global point, with a global axis that both bodies share at assembly.
JointSpec joint(JointKind kind, std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis = Vec3::UnitZ());
/// A joint of any kind between two connection points, which have to meet.
JointSpec joint(JointKind kind, std::string name, ConnectionId a, ConnectionId b, const Vec3& axis = Vec3::UnitZ());

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE JointSpec JointSpec::with_x(const Vec3& direction) const {
  JointSpec s = *this;
  s.x_axis = direction;
  return s;
}

DEM_INLINE JointSpec JointSpec::with_stiffness(double translation, double rotation) const {
  JointSpec s = *this;
  s.stiffness = translation;
  s.rotational_stiffness = rotation;
  return s;
}

DEM_INLINE JointSpec JointSpec::with_damping(double translation, double rotation) const {
  JointSpec s = *this;
  s.damping = translation;
  s.rotational_damping = rotation;
  return s;
}

DEM_INLINE JointSpec JointSpec::starting_at(Dof dof, double coordinate) const {
  JointSpec s = *this;
  s.starts.push_back({dof, coordinate});
  return s;
}

DEM_INLINE JointSpec joint(JointKind kind, std::string name, BodyId a, BodyId b, const Vec3& at, const Vec3& axis) {
  return {
      .name = std::move(name), .kind = kind, .a = a, .b = b, .at_a = at, .at_b = at, .axis_a = axis, .axis_b = axis};
}

DEM_INLINE JointSpec joint(JointKind kind, std::string name, ConnectionId a, ConnectionId b, const Vec3& axis) {
  return {.name = std::move(name), .kind = kind, .axis_a = axis, .axis_b = axis, .connection_a = a, .connection_b = b};
}

}  // namespace dem::mbd

#endif
