#pragma once

#include <dem/vehicle/assembly.hpp>

#include <cmath>
#include <string>

namespace dem::vehicle {

/// Rack and pinion in front of or behind an axle. Lengths in m.
struct RackSteeringSpec {
  Vec3 rod_inner = Vec3::Zero(), rod_outer = Vec3::Zero();  ///< left tie rod: on the rack, on the knuckle
  PartMass rack, pinion, rod;
  double pinion_radius = 0.1;
  double largest_angle = 0.8726646;  ///< rad, of the pinion, both ways
};

/// The tie rods hang on the rack by universal joints, so they do not turn about themselves. The pinion's angle is
/// prescribed; positive steers to the left.
struct RackSteering {
  BodyId rack, pinion, left_rod, right_rod;
  JointId rack_slide, pinion_turn, left_inner, left_outer, right_inner, right_outer;
  CouplingId gear;
  MotionId steer;
  double largest_angle = 0.0;  ///< rad
};

/// `arm` (m): how far the outer ends of the rods are ahead of the axes about which the knuckles steer, negative where
/// they are behind. Throws Error for less than a millimetre.
DEM_SETUP inline RackSteering add_rack_steering(const Assembly& in, BodyId chassis, BodyId left_knuckle,
                                                BodyId right_knuckle, const RackSteeringSpec& s, double arm) {
  using namespace mbd;
  require_positive(s.pinion_radius, "radius of the steering pinion", "m");
  require_positive(s.largest_angle, "largest angle of the steering pinion", "rad");
  if (!(std::abs(arm) >= 1e-3)) {
    fail(
        "the arm of the steering is {:g} m, but its tie rods must end 0.001 m or more from the kingpins; move "
        "rod_outer",
        arm);
  }
  Mechanism& m = in.mechanism();
  const Vec3 middle(s.rod_inner.x(), 0, s.rod_inner.z());
  const Vec3 on_pinion = middle + Vec3(0, 0, s.pinion_radius);
  RackSteering r;
  r.largest_angle = s.largest_angle;
  r.rack = in.body("steering rack", s.rack, middle);
  r.pinion = in.body("steering pinion", s.pinion, on_pinion);
  // Rods behind the kingpins move to the right to steer to the left.
  r.rack_slide =
      in.joint(JointKind::prismatic, "steering slide", chassis, r.rack, middle, Vec3(0, arm < 0.0 ? -1.0 : 1.0, 0));
  r.pinion_turn = in.joint(JointKind::revolute, "steering pinion", chassis, r.pinion, on_pinion, Vec3::UnitX());
  r.gear = m.add_coupling(rack_and_pinion(in.name("steering gear"), r.pinion_turn, r.rack_slide, s.pinion_radius));
  const auto rod = [&](const char* side, double y, BodyId knuckle, BodyId& body, JointId& inner, JointId& outer) {
    const Vec3 from(s.rod_inner.x(), y * s.rod_inner.y(), s.rod_inner.z());
    const Vec3 to(s.rod_outer.x(), y * s.rod_outer.y(), s.rod_outer.z());
    const std::string name = std::string(side) + " tie rod";
    body = in.body(name, s.rod, 0.5 * (from + to));
    const Vec3 along = to - from;
    inner = in.add_joint(
        universal(in.name(name + " inner"), r.rack, body, in.point(from), in.direction(along), in.direction(along)));
    outer = in.joint(JointKind::spherical, name + " outer", body, knuckle, to);
  };
  rod("left", 1.0, left_knuckle, r.left_rod, r.left_inner, r.left_outer);
  rod("right", -1.0, right_knuckle, r.right_rod, r.right_inner, r.right_outer);
  r.steer = m.add_motion(prescribed_joint(in.name("steer"), r.pinion_turn, 0.0));
  return r;
}

}  // namespace dem::vehicle
