#pragma once

#include <dem/vehicle/assembly.hpp>

#include <string>

namespace dem::vehicle {

/// Shafts of a driven axle with independent wheels. Lengths in m.
struct AxleSpec {
  Vec3 middle = Vec3::Zero();    ///< of the differential; the pinion's axis runs forward through it
  double side_shaft_end = 0.25;  ///< distance of the inner joints of the half shafts from the middle
  Vec3 outer = Vec3::Zero();     ///< left outer joint of a half shaft, on the axis of the wheel
  double pinion_ahead = 0.12;    ///< how far the middle of the pinion is ahead of that of the differential
  PartMass pinion, cage, side_shaft, half_shaft;
  double ratio = 5.0;  ///< turns of the pinion for one turn of the cage
};

/// A driven axle of six bodies: pinion, cage of the differential, two side shafts, two half shafts. The pinion turns in
/// a revolute joint of the chassis. Cage and side shafts sit in sleeves, with stops along their axis: 0.1 mm for the
/// cage, and for the side shafts the plunge that the travel of the wheels needs. Half shafts hang on them by universal
/// joints and drive the wheels through constant-velocity joints.
struct Axle {
  BodyId pinion, cage, left_side, right_side, left_half, right_half;
  JointId pinion_turn, cage_turn, left_turn, right_turn;  ///< of the shafts on the chassis
  JointId left_inner, right_inner, left_outer, right_outer;
  CouplingId bevel_gear, differential;
};

/// `left_wheel`, `right_wheel`: bodies that turn about y. The shafts start turning with them at `spin` (rad/s).
DEM_SETUP inline Axle add_axle(const Assembly& in, const std::string& name, BodyId chassis, BodyId left_wheel,
                               BodyId right_wheel, const AxleSpec& s, double spin = 0.0) {
  using namespace mbd;
  require_positive(s.ratio, ("ratio of the " + name + " axle").c_str(), "(turns of the pinion for one of the cage)");
  Mechanism& m = in.mechanism();
  const Vec3 forward = Vec3::UnitX(), across = Vec3::UnitY();
  const Vec3 pinion_at = s.middle + s.pinion_ahead * forward;
  Axle a;
  a.pinion = in.body(name + " pinion", s.pinion, pinion_at, s.ratio * spin * forward);
  a.pinion_turn = in.joint(JointKind::revolute, name + " pinion", chassis, a.pinion, pinion_at, forward);
  const auto sleeve = [&](const std::string& part, BodyId body, const Vec3& at, double play) {
    return in.add_joint(cylindrical(in.name(part), chassis, body, in.point(at), in.direction(across))
                            .with_limits(Dof::slide, -play, play));
  };
  a.cage = in.body(name + " cage", s.cage, s.middle, spin * across);
  a.cage_turn = sleeve(name + " cage", a.cage, s.middle, 1e-4);
  const auto side = [&](const std::string& which, double y, BodyId wheel, BodyId& side_shaft, BodyId& half_shaft,
                        JointId& turn, JointId& inner, JointId& outer) {
    const Vec3 from = s.middle + y * s.side_shaft_end * across, to(s.outer.x(), y * s.outer.y(), s.outer.z());
    const Vec3 middle = s.middle + 0.5 * y * s.side_shaft_end * across;
    const std::string side_name = name + " " + which;
    side_shaft = in.body(side_name + " side shaft", s.side_shaft, middle, spin * across);
    half_shaft = in.body(side_name + " half shaft", s.half_shaft, 0.5 * (from + to), spin * across);
    turn = sleeve(side_name + " side shaft", side_shaft, middle, 0.1);
    const Vec3 along = y * (to - from);  // both shafts point to the left, as the axis of the wheel does
    inner = in.add_joint(universal(in.name(side_name + " inner joint"), side_shaft, half_shaft, in.point(from),
                                   in.direction(across), in.direction(along)));
    outer = in.add_joint(constant_velocity(in.name(side_name + " outer joint"), half_shaft, wheel, in.point(to),
                                           in.direction(along), in.direction(across)));
  };
  side("left", 1.0, left_wheel, a.left_side, a.left_half, a.left_turn, a.left_inner, a.left_outer);
  side("right", -1.0, right_wheel, a.right_side, a.right_half, a.right_turn, a.right_inner, a.right_outer);
  a.bevel_gear = m.add_coupling(gear(in.name(name + " bevel gear"), a.pinion_turn, a.cage_turn, 1.0 / s.ratio));
  a.differential =
      m.add_coupling(differential(in.name(name + " differential"), a.cage_turn, a.left_turn, a.right_turn, 1.0));
  return a;
}

}  // namespace dem::vehicle
