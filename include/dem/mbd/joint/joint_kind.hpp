#pragma once

// What the library knows of a kind of joint. Each kind says it in a file of its own, beside the function that makes
// such a joint. A kind of your own is a JointKind of your own traits and needs no change of the library. The library's
// kinds also have a name in JointKind and a line in kinds.hpp.

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/matrix3.hpp>
#include <dem/math/vector.hpp>
#include <dem/mbd/joint/dof.hpp>

#include <string>

namespace dem {
struct Body;
}

namespace dem::mbd {

struct Joint;
struct JointSpec;
struct JointTraits;
namespace detail {
struct FrameOfA;
}

/// What a joint leaves free. Joint frame: origin in the joint's point, z along its axis. Each kind is defined in a file
/// of its own, with its traits; a kind of your own is a JointKind of your own traits.
class JointKind {
 public:
  static const JointKind fixed;        ///< nothing
  static const JointKind spherical;    ///< all rotations
  static const JointKind revolute;     ///< rotation about z
  static const JointKind cylindrical;  ///< rotation about z and sliding along z
  static const JointKind prismatic;    ///< sliding along z
  static const JointKind planar;       ///< sliding along x and y, rotation about z
  static const JointKind universal;    ///< rotation about x of body a and y of body b, the arms of its cross
  static const JointKind
      constant_velocity;  ///< bending in any direction; carries the rotation about the shafts unchanged
  /// As constant_velocity; the point of shaft b slides along shaft a.
  static const JointKind plunging_constant_velocity;
  static const JointKind point_on_line;        ///< all rotations and sliding along z
  static const JointKind point_on_plane;       ///< all rotations and sliding along x and y
  static const JointKind distance;             ///< all but the distance of two points
  static const JointKind bushing;              ///< everything, against springs and dampers along and about x, y, z
  static const JointKind bushing_with_tables;  ///< likewise, against tables of load over displacement
  static const JointKind free;                 ///< everything; measures a rotation and a displacement

  constexpr JointKind() = default;  ///< none: a joint of it is refused
  constexpr explicit JointKind(const JointTraits& traits) : traits_(&traits) {}
  constexpr const JointTraits& traits() const { return *traits_; }
  constexpr bool valid() const { return traits_ != nullptr; }
  constexpr bool operator==(const JointKind&) const = default;

 private:
  const JointTraits* traits_ = nullptr;
};

/// Which displacements of b's point in a's joint frame are held at zero (hold.hpp).
enum class Hold { nothing, point, line, plane, length, bushing };
/// Which rotations of b's joint frame in a's are held (align.hpp).
enum class Align { nothing, parallel, locked, cross, constant_velocity, bushing };
/// What rubs in a joint (friction.hpp).
enum class Bearing {
  none,
  journal,  ///< turns about z
  guide,    ///< slides along z
  sleeve,   ///< turns about z and slides along z
  plate,    ///< slides along x and y; turns about z too, if it has a radius
  point,    ///< slides along x and y
  socket    ///< turns about x, y and z
};
/// Where the stiffness of a joint comes from.
enum class Stiffness {
  derived,  ///< what is not given is derived from the time step
  own,      ///< constants for each direction, all of them given
  none      ///< it holds nothing
};

struct JointTraits {
  const char* name;                 ///< in reports
  Dofs dofs = {};                   ///< the degrees of freedom that can be read
  Dof own = Dof::own;               ///< which of them is meant where none is named; `own`: none of them
  Bearing bearing = Bearing::none;  ///< what rubs
  Stiffness stiffness = Stiffness::derived;
  bool two_axes = false;      ///< each body has an axis of its own, up to 87 deg from the other's
  bool points_apart = false;  ///< the two points need not meet
  /// Whether another pose changes how easily the bodies give way: the lever on body a grows as the joint slides, or the
  /// directions that it holds turn in one of the bodies.
  bool changes_with_pose = true;
  /// Throws Error for what this kind cannot be given; called by `who`. May be left out.
  void (*check)(const JointSpec& spec, const std::string& who) = nullptr;
  /// Takes over what this kind alone is given; `gap` (m) is from the point on a to that on b. May be left out.
  void (*take)(Joint& joint, const JointSpec& spec, const Vector3<double>& gap, const std::string& who) = nullptr;

  // Set by joint_that_holds (penalty.hpp).
  Hold hold = Hold::nothing;
  Align align = Align::nothing;
  /// Adds the joint's force to its bodies and keeps it as the reaction. wa, wb: rad/s, global. dt (s) is the time by
  /// which the joint's turns are followed: the time step in the last stage of a step, else 0.
  void (*force)(Joint& joint, Body& a, Body& b, const Vector3<double>& wa, const Vector3<double>& wb,
                double dt) = nullptr;

  /// J in its springs, of kinds whose springs are not those of `hold` and `align`; d (m) is the way between the points,
  /// `b` the rotation of body b.
  double (*energy)(const Joint& joint, const detail::FrameOfA& at, const Matrix3<double>& b,
                   const Vector3<double>& d) = nullptr;

  /// Whether its own coordinate is a rotation about z, which is followed over whole turns.
  constexpr bool turns() const { return own == Dof::turn; }
};

constexpr const JointTraits& traits_of(JointKind kind) { return kind.traits(); }
DEM_SETUP inline const char* name_of(JointKind kind) { return traits_of(kind).name; }

/// The degrees of freedom that a kind of joint has, its own one first.
constexpr const Dofs& dofs_of(JointKind kind) { return traits_of(kind).dofs; }

/// The same degree of freedom by the name it has among dofs_of(kind); `own` stays where a kind has no own one.
constexpr Dof resolved(JointKind kind, Dof dof) { return dof == Dof::own ? traits_of(kind).own : dof; }

/// The degree of freedom's resolved name. Throws Error, with those that there are, unless joints of this kind have it.
Dof known_dof(JointKind kind, Dof dof, const std::string& who);

/// The same for what acts on a coordinate, which therefore has to be free.
Dof require_free_dof(JointKind kind, Dof dof, const std::string& who);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE Dof known_dof(JointKind kind, Dof dof, const std::string& who) {
  dof = resolved(kind, dof);
  const Dofs& list = dofs_of(kind);
  if (list.has(dof)) return dof;
  std::string known;
  for (const Dof f : list) known += (known.empty() ? "" : ", ") + std::string(name_of(f));
  if (known.empty()) fail("{} refers to a {}, which leaves no coordinate free", who, name_of(kind));
  if (dof == Dof::own) {
    fail("{} refers to a {}, which has no coordinate of its own; name one of its degrees of freedom: {}", who,
         name_of(kind), known);
  }
  fail("{} refers to '{}' of a {}, which has only: {}", who, name_of(dof), name_of(kind), known);
}

DEM_INLINE Dof require_free_dof(JointKind kind, Dof dof, const std::string& who) {
  dof = known_dof(kind, dof, who);
  if (dof == Dof::length) {
    fail("{} acts on the length of a distance joint, which the joint holds; use a linear_actuator or a spring instead",
         who);
  }
  return dof;
}

}  // namespace dem::mbd

#endif
