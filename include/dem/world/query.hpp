#pragma once

#include <dem/world/contacts.hpp>

#include <vector>

// What is often asked of the grains of a world. All of it looks at each grain or contact once.

namespace dem {

/// The grains whose centres lie in a box (m, global axes), its faces included; in the order in which they were added.
/// Throws Error for a box whose low corner is above its high one.
template <class Model>
std::vector<GrainId> grains_in(const World<Model>& world, const Vec3& low, const Vec3& high) {
  if (!none_below(high, low)) {
    fail("the box to look for grains in reaches from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m; swap its corners",
         low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  }
  std::vector<GrainId> found;
  for (const GrainId p : world.grains()) {
    const Vec3 x = world.position(p);
    if (none_below(x, low) && none_below(high, x)) found.push_back(p);
  }
  return found;
}

/// Of all grains; held ones are parts of the bodies that hold them, and are left out.
struct Momentum {
  double mass = 0.0;            ///< kg
  Vec3 linear = Vec3::Zero();   ///< kg m/s
  Vec3 angular = Vec3::Zero();  ///< kg m^2/s, about the point that was given
  Vec3 centre = Vec3::Zero();   ///< m, of mass
};

/// Momentum of the grains, the angular one about `point` (m).
template <class Model>
Momentum momentum_of(const World<Model>& world, const Vec3& point = Vec3::Zero()) {
  Momentum sum;
  for (const GrainId p : world.grains()) {
    const auto& kind = world.species(world.species_of(p));
    if (kind.is_held()) continue;
    const Vec3 x = world.position(p), v = world.velocity(p),
               w = world.rotation(p).transpose() * world.angular_velocity(p);
    const Vec3 spin(kind.inertia[0] * w.x(), kind.inertia[1] * w.y(), kind.inertia[2] * w.z());
    sum.mass += kind.mass;
    sum.linear += kind.mass * v;
    sum.angular += kind.mass * cross(x - point, v) + world.rotation(p) * spin;
    sum.centre += kind.mass * x;
  }
  if (sum.mass > 0.0) sum.centre *= 1.0 / sum.mass;
  return sum;
}

/// The contacts of one grain, of those that contacts_of gave. The force of a contact acts on Contact::grain; where the
/// grain that was asked for is the other one, it feels the opposite.
template <class Model>
std::vector<Contact<Model>> contacts_with(const std::vector<Contact<Model>>& contacts, GrainId grain) {
  std::vector<Contact<Model>> found;
  for (const Contact<Model>& c : contacts) {
    if (c.kind == ContactKind::bodies) continue;
    if (c.grain == grain || (c.kind == ContactKind::grains && c.other_grain == grain)) found.push_back(c);
  }
  return found;
}

/// Fabric tensor: the mean of n n^T over the contacts between grains that touch (overlap not negative). Its trace is 1,
/// and a third of it stands on the diagonal where contacts look in all directions alike; 0 without contacts.
template <class Model>
Mat3 fabric_of(const std::vector<Contact<Model>>& contacts) {
  Mat3 sum = Mat3::Zero();
  double count = 0.0;
  for (const Contact<Model>& c : contacts) {
    if (c.kind != ContactKind::grains || c.overlap < 0.0) continue;
    sum += c.normal * c.normal.transpose();
    count += 1.0;
  }
  if (count > 0.0) sum *= 1.0 / count;
  return sum;
}

/// Mean stress (Pa, compression is positive) of the grains in a volume (m^3), by the contacts that contacts_of gave:
/// the sum of F l^T over the volume, l from a grain's centre to the contact point and F the force that it exerts there
/// (Love 1927, Weber 1966). Of all contacts of a specimen it is that within its walls; soil::averages has it by place,
/// and with what moving grains carry.
template <class Model>
Mat3 stress_of(const std::vector<Contact<Model>>& contacts, double volume) {
  require_positive(volume, "volume to take the stress of", "m^3");
  Mat3 sum = Mat3::Zero();
  for (const Contact<Model>& c : contacts) {
    if (c.kind == ContactKind::bodies) continue;
    sum -= c.force * (c.point - c.centre()).transpose();
    if (c.kind == ContactKind::grains) sum -= c.force * (c.other_centre() - c.point).transpose();
  }
  return sum * (1.0 / volume);
}

}  // namespace dem
