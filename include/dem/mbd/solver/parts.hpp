#pragma once

#include <dem/core/known.hpp>
#include <dem/core/macros.hpp>
#include <dem/mbd/body/body_spec.hpp>
#include <dem/mbd/drive/actuator.hpp>
#include <dem/mbd/drive/clutch.hpp>
#include <dem/mbd/drive/prescribed.hpp>
#include <dem/mbd/joint/coupling.hpp>
#include <dem/mbd/joint/friction.hpp>
#include <dem/mbd/joint/joint_spec.hpp>
#include <dem/mbd/joint/limits.hpp>
#include <dem/mbd/load/load.hpp>
#include <dem/mbd/load/spring.hpp>
#include <dem/mbd/load/terrain.hpp>
#include <dem/mbd/sensor/sensor.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace dem::mbd {

namespace detail {
struct PartKind;
}

/// One coordinate that is prescribed now; a rotation of a body makes three of them, all others one.
struct JacobianRow {
  static constexpr std::uint32_t no_body = ~std::uint32_t{0};
  std::uint32_t motion = 0;
  bool is_reported = true;                 ///< its force is the motion's
  bool is_held = false;                    ///< by the driven joint: it stays as it is while values are corrected
  std::uint32_t a = no_body, b = no_body;  ///< bodies that it moves
  Coordinate now;
  double value = 0.0, rate = 0.0;  ///< wanted
};

/// A named point of a body to which joints are attached (thesis section 2.3).
struct Connection {
  std::string name;
  BodyId body;
  Vec3 point = Vec3::Zero();  ///< m, body frame
  Vec3 at = Vec3::Zero();     ///< m, global, where it was added
  template <class V>
  void fields(V& v) {
    v.given("name", name), v.given("body", body), v.given("at", at, "m"), v("point", point, "m");
  }
};

/// The bodies of a machine, side by side in memory. There is always room for one more, so that the ground can be added
/// (Mechanism::ground) while references to bodies are held.
class BodyList : public std::vector<Body> {
 public:
  BodyList() = default;
  BodyList(const BodyList& o);
  BodyList(BodyList&&) noexcept = default;
  BodyList& operator=(const BodyList& o) { return *this = BodyList(o); }
  BodyList& operator=(BodyList&&) noexcept = default;
  ~BodyList() = default;

  void add(const Body& body);
  void add_ground(const Body& body) { push_back(body); }  ///< moves no other body
};

/// All that a machine is made of, as plain arrays; an Id is an index into its array.
struct Parts {
  DEM_VALUE(Parts)

  BodyList bodies;
  std::vector<BuiltBody> built;  ///< each body as it was added, with its reference frame
  std::vector<Connection> connections;
  std::vector<Joint> joints;                 ///< what a step needs
  std::vector<JointSpec> joint_specs;        ///< as given: what was left to derive is still empty
  std::vector<JointLimitState> limits;       ///< of the coordinates that have them
  std::vector<JointFrictionState> friction;  ///< of the joints that have friction
  std::vector<Coupling> couplings;
  std::vector<Clutch> clutches;  ///< and brakes
  std::vector<Actuator> actuators;
  std::vector<Spring> springs;
  std::vector<Load> loads;
  std::vector<TerrainPart> terrains;
  std::vector<PrescribedMotion> motions;
  std::vector<Sensor> sensors;

  std::vector<const detail::PartKind*> kinds;  ///< that there are, in the order in which they are evaluated
  /// What prescribed motions and sensors need, if there are any: see motion_part.hpp and sensor_part.hpp.
  void (*apply_motions)(Parts& parts, double time, double dt, bool is_over) = nullptr;
  void (*check_holds)(Parts& parts, double time) = nullptr;
  void (*sample_sensors)(Parts& parts, double dt) = nullptr;
  double allowed_jump = HUGE_VAL;  ///< m, of a motion that takes hold: what the grains of a world stand

  bool couplings_changed = false;  ///< added, switched on or given another ratio since a lock was looked for
  bool is_stepping = false;        ///< loads, signals and laws are being asked
  std::uint64_t releases = 0;      ///< grows where a body that a motion carries is let go (CarriedBodies)
  std::uint64_t revision = 0;      ///< grows with each body, joint, coupling ... that is added, set free or fixed

  template <class V>
  void fields(V& v) {
    v.list("bodies", bodies, "body"), v.list("connections", connections, "connection point");
    v.list("joint_specs", joint_specs, "joint");
    v.list("joints", joints, "joint", [this](const Joint& j) {
      return " '" + joint_specs[static_cast<std::size_t>(&j - joints.data())].name + "'";
    });
    v.list("limits", limits, "limit");
    v.list("friction", friction, "joint friction"), v.list("couplings", couplings, "coupling");
    v.list("actuators", actuators, "actuator"), v.list("clutches", clutches, "clutch or brake"),
        v.list("springs", springs, "spring"), v.list("loads", loads, "load");
    v.list("motions", motions, "prescribed motion"), v.list("sensors", sensors, "sensor");
    if (!terrains.empty()) v.list("terrains", terrains, "terrain");
    v("revision", revision), v("spin", global_angular_velocity, "rad/s"), v("outside", outside);
  }

  // Scratch of a force evaluation, one entry per body.
  std::vector<Vector3<double>> global_angular_velocity;  ///< rad/s, of the bodies
  std::vector<Wrench> outside;  ///< contact forces that the world added, about the centre of mass

  // Scratch of the prescribed motions.
  std::vector<JacobianRow> rows;
  std::vector<double> drive_matrix, drive_directions, drive_errors, drive_held;
};

/// What a joint puts on its body b, about the joint's point: its springs and dampers, its limits and its friction.
Wrench reaction_of(const Parts& parts, std::size_t joint);

/// Reports and recorders tell parts by their names: one that has none gets that of its kind (`one`) and its number, one
/// that another of its kind has is refused. `name_of(item)` is the name of an item.
template <class Items, class NameOf>
void settle_name(std::string& name, const Items& items, const char* one, const char* several, NameOf&& name_of) {
  if (name.empty()) name = dem::text("{} {}", one, items.size());
  for (const auto& item : items) {
    if (name_of(item) == name) fail("two {} are named '{}'; rename one, so that reports are clear", several, name);
  }
}

/// The body of an id, or an Error that names who asked for it.
const Body& known_body(const Parts& parts, BodyId id, const std::string& asker);

const Joint& known_joint(const Parts& parts, JointId id, const std::string& asker);

/// A coordinate of a joint and its speed, now. Throws Error unless joints of this kind have it.
Coordinate coordinate_now(const Parts& parts, JointId id, Dof dof);
/// The limits of a joint's coordinate, or its friction; nullptr if it has none.
const JointLimitState* limits_of(const Parts& parts, JointId id, Dof dof);
const JointFrictionState* friction_of(const Parts& parts, JointId id);

/// While it lives, forces are found and bodies move: nothing can be added.
class Stepping {
 public:
  explicit Stepping(Parts& parts) : parts_(parts), was_(parts.is_stepping) { parts_.is_stepping = true; }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;
  ~Stepping() { parts_.is_stepping = was_; }

 private:
  Parts& parts_;
  bool was_;
};

/// Throws Error where a step is under way: lists of parts that are being gone through must stay what they are.
void require_no_step(const Parts& parts);

/// Keeps a part; structural ones make what was derived and initialised before out of date.
template <class Id, class Part>
Id keep(Parts& parts, std::vector<Part>& list, Part&& part, bool structural = true) {
  require_no_step(parts);
  list.push_back(std::move(part));
  if (structural) ++parts.revision;
  return Id(list.size() - 1);
}
inline constexpr auto name_in_spec = [](const auto& part) -> const std::string& { return part.spec.name; };

/// A global point in a body's frame.
inline Vector3<double> to_body(const Body& b, const Vector3<double>& global) {
  return transpose_times(b.motion.rotation, global - b.motion.position);
}

/// A point (m) that was given as `what`, or an Error if it is nowhere.
Vector3<double> finite_point(const Vec3& p, const std::string& what);

Vector3<double> unit(const Vector3<double>& v, const std::string& asker);
/// A direction that was given by `asker`, of length 1.
inline Vector3<double> unit(const Vec3& v, const std::string& asker) { return unit(from_eigen(v), asker); }

/// Throws Error for an element whose force could move neither of the bodies that it acts on.
void require_one_moves(const Body& a, const Body& b, const std::string& who);

/// Checks the two ends of an element between points and puts the points into body frames.
template <class Part, class Spec>
void attach_points(const Parts& parts, Part& part, const Spec& s, const std::string& who) {
  const Body &a = known_body(parts, s.a, who), &b = known_body(parts, s.b, who);
  if (s.a == s.b) fail("{} joins body '{}' to itself; give it two different bodies", who, a.name);
  require_one_moves(a, b, who);
  const auto point_a = finite_point(s.at_a, "the first point of " + who);
  const auto point_b = finite_point(s.at_b, "the second point of " + who);
  if (const double apart = norm(point_b - point_a); !(apart > 1e-9)) {
    fail(
        "the two points of {} are {:g} m apart, so its direction is not known; move one of them, or act on a joint's "
        "coordinate instead",
        who, apart);
  }
  part.point_a = to_body(a, point_a);
  part.point_b = to_body(b, point_b);
}

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE BodyList::BodyList(const BodyList& o) : std::vector<Body>() {
  reserve(o.size() + 1);
  insert(end(), o.begin(), o.end());
}

DEM_INLINE void BodyList::add(const Body& body) {
  if (capacity() < size() + 2) reserve(2 * size() + 2);
  push_back(body);
}

DEM_DEFINE_VALUE(Parts)

DEM_INLINE Wrench reaction_of(const Parts& parts, std::size_t joint) {
  Wrench w = {parts.joints[joint].force, parts.joints[joint].torque};
  for (const JointFrictionState& e : parts.friction) {
    if (e.joint == joint) w = w + Wrench{e.force, e.torque};
  }
  for (const JointLimitState& e : parts.limits) {
    if (e.joint == joint) (is_rotation(e.dof) ? w.torque : w.force) += e.force * e.axis;
  }
  return w;
}

DEM_INLINE const Body& known_body(const Parts& parts, BodyId id, const std::string& asker) {
  if (!id.valid()) fail("{} names a body that was never added; use the BodyId that add_body returned", asker);
  if (id.index() >= parts.bodies.size()) {
    fail("{} names body {}, but the machine has {} (0 to {}); use the BodyId that add_body returned", asker, id.index(),
         parts.bodies.size(), static_cast<long>(parts.bodies.size()) - 1);
  }
  return parts.bodies[id.index()];
}

DEM_INLINE const Joint& known_joint(const Parts& parts, JointId id, const std::string& asker) {
  if (!id.valid() || id.index() >= parts.joints.size()) {
    fail("{} names a joint that the machine does not have (it has {}); use the JointId that add_joint returned", asker,
         parts.joints.size());
  }
  return parts.joints[id.index()];
}

DEM_INLINE Coordinate coordinate_now(const Parts& parts, JointId id, Dof dof) {
  const Joint& j = known(parts.joints, id, "joint");
  const std::string& name = parts.joint_specs[id.index()].name;
  return coordinate_of(j, parts.bodies[j.a], parts.bodies[j.b],
                       known_dof(j.kind, dof, "a coordinate of '" + name + "'"));
}

DEM_INLINE const JointLimitState* limits_of(const Parts& parts, JointId id, Dof dof) {
  dof = resolved(known(parts.joints, id, "joint").kind, dof);
  for (const JointLimitState& e : parts.limits) {
    if (e.joint == id.value && e.dof == dof) return &e;
  }
  return nullptr;
}

DEM_INLINE const JointFrictionState* friction_of(const Parts& parts, JointId id) {
  for (const JointFrictionState& e : parts.friction) {
    if (e.joint == id.value) return &e;
  }
  return nullptr;
}

DEM_INLINE void require_no_step(const Parts& parts) {
  if (parts.is_stepping) {
    fail(
        "a part is added to a machine within a step, from a load, a signal or a law; add it between steps, or in what "
        "run() calls after each");
  }
}

DEM_INLINE Vector3<double> finite_point(const Vec3& p, const std::string& what) {
  if (!is_finite(from_eigen(p))) fail("{} is ({:g}, {:g}, {:g}), but must be finite", what, p.x(), p.y(), p.z());
  return from_eigen(p);
}

DEM_INLINE Vector3<double> unit(const Vector3<double>& v, const std::string& asker) {
  const double length = norm(v);
  if (!(length > 1e-12) || !std::isfinite(length)) {
    fail("the direction of {} is ({:g}, {:g}, {:g}), but needs a length; give any vector along it", asker, v.x, v.y,
         v.z);
  }
  return v / length;
}

DEM_INLINE void require_one_moves(const Body& a, const Body& b, const std::string& who) {
  if (!a.is_fixed_for_good() || !b.is_fixed_for_good()) return;
  fail(
      "{} acts on {}{}, which {} fixed and has no mass, so it would move nothing; make a body with a mass (box_body), "
      "on a prismatic joint if it is to slide along one direction",
      who, "body '" + a.name + "'", &a == &b ? "" : " and body '" + b.name + "'", &a == &b ? "is" : "are each");
}

}  // namespace dem::mbd

#endif
