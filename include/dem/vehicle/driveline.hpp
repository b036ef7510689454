#pragma once

#include <dem/vehicle/assembly.hpp>
#include <dem/vehicle/axle.hpp>
#include <dem/vehicle/engine.hpp>

#include <cmath>
#include <string>

namespace dem::vehicle {

struct DrivelineSpec {
  AxleSpec front, rear;
  PartMass shaft;
  Vec3 shaft_middle = Vec3::Zero();  ///< m; the shaft runs forward
  EngineSpec engine;
};

/// Engine, drive shaft and two axles. The drive shaft turns in the chassis and drives both pinions through slip
/// splines, prismatic joints along the shaft.
struct Driveline {
  BodyId shaft;
  JointId shaft_turn, front_spline, rear_spline;
  Axle front, rear;
  Engine engine;

  template <class V>
  void fields(V& v) {
    engine.fields(v);
  }
};

/// `wheels`: front left, front right, rear left, rear right. The shafts turn with wheels of `spin` (rad/s) at the
/// start.
DEM_SETUP inline Driveline add_driveline(const Assembly& in, BodyId chassis, const BodyId (&wheels)[4],
                                         const DrivelineSpec& s, double spin = 0.0) {
  using namespace mbd;
  Driveline d;
  d.front = add_axle(in, "front", chassis, wheels[0], wheels[1], s.front, spin);
  d.rear = add_axle(in, "rear", chassis, wheels[2], wheels[3], s.rear, spin);
  if (std::abs(s.front.ratio - s.rear.ratio) > 1e-9 * s.front.ratio) {
    fail("the axles have the ratios {:g} and {:g}, but one drive shaft turns both; give them the same", s.front.ratio,
         s.rear.ratio);
  }
  const Vec3 forward = Vec3::UnitX();
  d.shaft = in.body("drive shaft", s.shaft, s.shaft_middle, s.front.ratio * spin * forward);
  d.shaft_turn = in.joint(JointKind::revolute, "drive shaft", chassis, d.shaft, s.shaft_middle, forward);
  const auto spline = [&](const char* part, BodyId pinion, const AxleSpec& axle) {
    return in.joint(JointKind::prismatic, part, d.shaft, pinion, axle.middle + axle.pinion_ahead * forward, forward);
  };
  d.front_spline = spline("front spline", d.front.pinion, s.front);
  d.rear_spline = spline("rear spline", d.rear.pinion, s.rear);
  d.engine = add_engine(in, chassis, d.shaft_turn, s.engine, s.shaft_middle, forward, s.front.ratio * spin);
  return d;
}

/// rad/s, of the engine's own shaft.
inline double engine_speed(const mbd::Mechanism& m, const Driveline& d) {
  const Engine& e = d.engine;
  if (e.spec.kind == EngineSpec::Kind::geared) return m.speed(e.crank);
  return m.speed(d.shaft_turn) * (e.has_throttle() ? e.spec.ratio(0) : 1.0);
}

}  // namespace dem::vehicle
