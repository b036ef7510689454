#pragma once

#include <dem/mbd/joint/bushing.hpp>
#include <dem/mbd/joint/constant_velocity.hpp>
#include <dem/mbd/joint/cylindrical.hpp>
#include <dem/mbd/joint/distance.hpp>
#include <dem/mbd/joint/fixed.hpp>
#include <dem/mbd/joint/free.hpp>
#include <dem/mbd/joint/planar.hpp>
#include <dem/mbd/joint/point_on_line.hpp>
#include <dem/mbd/joint/point_on_plane.hpp>
#include <dem/mbd/joint/prismatic.hpp>
#include <dem/mbd/joint/revolute.hpp>
#include <dem/mbd/joint/spherical.hpp>
#include <dem/mbd/joint/universal.hpp>

#include <string>

namespace dem::mbd {

/// All kinds of joint, in the order of JointKind.
inline constexpr const JointTraits* joint_kinds[] = {
    &fixed_joint,    &spherical_joint, &revolute_joint,          &cylindrical_joint,   &prismatic_joint,
    &planar_joint,   &universal_joint, &constant_velocity_joint, &point_on_line_joint, &point_on_plane_joint,
    &distance_joint, &bushing_joint,   &free_joint_traits};

constexpr const JointTraits& traits_of(JointKind kind) { return *joint_kinds[static_cast<int>(kind)]; }

constexpr bool joint_kinds_are_in_order() {
  int number = 0;
  for (const JointTraits* t : joint_kinds) {
    if (t->kind != static_cast<JointKind>(number++)) return false;
  }
  return true;
}
static_assert(joint_kinds_are_in_order(), "joint_kinds has to list the kinds in the order of JointKind");

inline const char* name_of(JointKind kind) { return traits_of(kind).name; }

/// The degrees of freedom that a kind of joint has, its own one first.
constexpr const Dofs& dofs_of(JointKind kind) { return traits_of(kind).dofs; }

/// The same degree of freedom by the name it has among dofs_of(kind); `own` stays where a kind has no own one.
constexpr Dof resolved(JointKind kind, Dof dof) { return dof == Dof::own ? traits_of(kind).own : dof; }

/// The degree of freedom's resolved name. Throws Error, with those that there are, unless joints of this kind have it.
inline Dof known_dof(JointKind kind, Dof dof, const std::string& who) {
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
