#pragma once

#include <dem/core/error.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace dem::mbd {

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

inline const char* name_of(JointKind kind) {
  constexpr const char* names[] = {
      "fixed joint",         "spherical joint",      "revolute joint",  "cylindrical joint",
      "prismatic joint",     "planar joint",         "universal joint", "constant-velocity joint",
      "point-on-line joint", "point-on-plane joint", "distance joint",  "bushing",
      "free joint"};
  return names[static_cast<int>(kind)];
}

/// A coordinate of a joint, seen from body a: how far b's point has moved along an axis of a's joint frame, or how b
/// has turned.
enum class Dof {
  own,      ///< the rotation of joints that turn about z, the displacement of those that slide along z, or the length
  turn,     ///< rad, about z, over whole turns
  slide,    ///< m, along z
  slide_x,  ///< m
  slide_y,  ///< m
  length,   ///< m, between the points of a distance joint; it is held, so it can only be read
  bend,     ///< rad, angle between the two z axes, 0 to pi
  bend_x,   ///< rad, of a universal joint: about x of body a, the arm of its cross on a
  bend_y    ///< rad, of a universal joint: about y of body b, the arm of its cross on b
};

inline const char* name_of(Dof dof) {
  constexpr const char* names[] = {"coordinate", "turn", "slide",  "slide_x", "slide_y",
                                   "length",     "bend", "bend_x", "bend_y"};
  return names[static_cast<int>(dof)];
}
constexpr bool is_rotation(Dof f) { return f == Dof::turn || f >= Dof::bend; }

/// The coordinates that a kind of joint has, its own one first.
inline std::vector<Dof> dofs_of(JointKind kind) {
  using enum Dof;
  switch (kind) {
    case JointKind::revolute: return {turn};
    case JointKind::cylindrical: return {turn, slide};
    case JointKind::prismatic: return {slide};
    case JointKind::planar: return {turn, slide_x, slide_y};
    case JointKind::universal: return {bend_x, bend_y, bend};
    case JointKind::spherical:
    case JointKind::constant_velocity: return {bend};
    case JointKind::point_on_line: return {slide, bend};
    case JointKind::point_on_plane: return {slide_x, slide_y, bend};
    case JointKind::bushing: return {slide, slide_x, slide_y, bend};
    case JointKind::free: return {turn, slide, slide_x, slide_y, bend};
    case JointKind::distance: return {length};
    default: return {};
  }
}

/// Whether a kind's own coordinate is a rotation about z (else a displacement along z).
constexpr bool turns(JointKind kind) {
  using enum JointKind;
  return kind == revolute || kind == cylindrical || kind == planar || kind == free;
}
/// Whether a kind has a coordinate that slides along z.
constexpr bool slides(JointKind kind) {
  using enum JointKind;
  return kind == prismatic || kind == cylindrical || kind == point_on_line || kind == free;
}
/// The same coordinate by the name it has among dofs_of(kind); `own` stays where a kind has no own one.
constexpr Dof resolved(JointKind kind, Dof dof) {
  if (dof != Dof::own) return dof;
  if (kind == JointKind::distance) return Dof::length;
  return turns(kind) ? Dof::turn : slides(kind) ? Dof::slide : Dof::own;
}

/// The coordinate's resolved name. Throws Error, with the coordinates that there are, unless joints of this kind have
/// that one.
inline Dof known_dof(JointKind kind, Dof dof, const std::string& who) {
  dof = resolved(kind, dof);
  const std::vector<Dof> list = dofs_of(kind);
  if (std::find(list.begin(), list.end(), dof) != list.end()) return dof;
  std::string known;
  for (const Dof f : list) known += fmt::format("{}{}", known.empty() ? "" : ", ", name_of(f));
  if (known.empty()) fail("{} refers to a {}, which leaves no coordinate free", who, name_of(kind));
  if (dof == Dof::own) {
    fail("{} refers to a {}, which has no coordinate of its own; name one of its degrees of freedom: {}", who,
         name_of(kind), known);
  }
  fail("{} refers to '{}' of a {}, which has only: {}", who, name_of(dof), name_of(kind), known);
}

/// The same for what acts on a coordinate, which therefore has to be free.
inline Dof require_free_dof(JointKind kind, Dof dof, const std::string& who) {
  dof = known_dof(kind, dof, who);
  if (dof == Dof::length) {
    fail("{} acts on the length of a distance joint, which the joint holds; use a linear_actuator or a spring instead",
         who);
  }
  return dof;
}

}  // namespace dem::mbd
