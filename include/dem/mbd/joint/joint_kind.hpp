#pragma once

// What the library knows of a kind of joint. Each kind says it in a file of its own, beside the function that makes
// such a joint; kinds.hpp has the list. A new kind is a file, a name in JointKind and a line in that list.

#include <dem/math/vector.hpp>
#include <dem/mbd/joint/dof.hpp>

#include <string>

namespace dem {
struct Body;
}

namespace dem::mbd {

struct Joint;
struct JointSpec;

/// What a joint leaves free. Joint frame: origin in the joint's point, z along its axis.
enum class JointKind {
  fixed,              ///< nothing
  spherical,          ///< all rotations
  revolute,           ///< rotation about z
  cylindrical,        ///< rotation about z and sliding along z
  prismatic,          ///< sliding along z
  planar,             ///< sliding along x and y, rotation about z
  universal,          ///< rotation about x of body a and about y of body b, the arms of its cross
  constant_velocity,  ///< bending in any direction; carries the rotation about the shafts unchanged
  point_on_line,      ///< all rotations and sliding along z
  point_on_plane,     ///< all rotations and sliding along x and y
  distance,           ///< all but the distance of two points
  bushing,            ///< everything, against springs and dampers of its own along and about x, y, z
  free                ///< everything; measures a rotation and a displacement, e.g. for a rotational actuator
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
  JointKind kind;
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

  /// Whether its own coordinate is a rotation about z, which is followed over whole turns.
  constexpr bool turns() const { return own == Dof::turn; }
};

}  // namespace dem::mbd
