#pragma once

#include <dem/core/ids.hpp>
#include <dem/grain/contact_list.hpp>
#include <dem/math/vector.hpp>

#include <cstdint>

namespace dem {

enum class ContactKind {
  grains,            ///< two grains
  grain_on_surface,  ///< a grain and a surface of a machine part
  bodies             ///< the surfaces of two machine parts
};

/// A contact point, and what passes through it. It is between a first partner, on whom the force is, and a second one,
/// who feels the opposite. All vectors are in global axes.
struct ContactForce {
  ContactKind kind = ContactKind::grains;
  GrainId grain;            ///< the first partner, unless both are bodies
  GrainId other_grain;      ///< the second partner of ContactKind::grains
  SurfaceId surface;        ///< the second partner of the other kinds
  SurfaceId own_surface;    ///< the first partner of ContactKind::bodies
  BodyContactId pair;       ///< of ContactKind::bodies
  std::uint32_t law = 0;    ///< row of the table of contact constants
  std::uint64_t point_key;  ///< tells the points of one pair apart

  Vec3 point;               ///< m
  Vec3 normal;              ///< unit vector from the first partner into the second
  double overlap;           ///< m; negative across a gap
  double effective_radius;  ///< m
  double weight;            ///< share of a whole contact, or m^2 where points have areas
  Vec3 arm, other_arm;      ///< m, from the partner's centre of mass to the point
  Vec3 force;               ///< N, on the first partner
  Vec3 torque;              ///< N m, on the first partner about its centre of mass
  Vec3 other_torque;        ///< N m, on the second partner about its centre of mass

  /// N; positive where the partners push each other, negative where they pull.
  double normal_force() const { return -force.dot(normal); }
  /// N, on the first partner, in the tangent plane.
  Vec3 tangential_force() const { return force + normal_force() * normal; }
  /// N m, on the first partner: what rolling resistance and torsion add to the torque of the force.
  Vec3 rolling_torque() const { return torque - Vec3(arm.cross(force)); }
  /// m, the centres of mass of the partners.
  Vec3 centre() const { return point - arm; }
  Vec3 other_centre() const { return point - other_arm; }
};

/// A contact of a world with what its laws remember.
template <class Model>
struct Contact : ContactForce {
  ContactHistory<Model, double> last;     ///< from the last evaluation; zeros of a contact that is new
  ContactHistory<Model, double> history;  ///< from which the force is: on by a step over the stages
};

}  // namespace dem
