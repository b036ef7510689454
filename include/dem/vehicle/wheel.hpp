#pragma once

#include <dem/vehicle/assembly.hpp>
#include <dem/vehicle/road_tyre.hpp>

#include <algorithm>
#include <memory>
#include <string>

namespace dem::vehicle {

struct WheelSpec {
  PartMass mass;                 ///< rim and tyre; y is the axis
  double brake = 4000.0;         ///< N m, the most that the brake holds
  double brake_stiffness = 1e5;  ///< N m/rad, of a brake that holds
  double brake_damping = 300.0;  ///< N m s/rad
};

/// A wheel on a knuckle, with its brake: a rotational actuator that holds the wheel where it is, up to a torque. Beyond
/// it the held angle gives way, as an asperity does.
struct Wheel {
  BodyId body;
  JointId turn;  ///< of the wheel on the knuckle; positive drives forward
  ActuatorId brake;
  LoadId road;                 ///< of the tyre on hard ground, if there is one
  TerrainId tyre;              ///< likewise; see tyre_of()
  double largest_brake = 0.0;  ///< N m
  double brake_angle = 0.0;    ///< rad, which the brake holds
  double brake_torque = 0.0;   ///< N m, asked for
  double brake_work = 0.0;     ///< J, that the brake took so far; summed by drive()

  template <class V>
  void fields(V& v) {
    v("brake_angle", brake_angle, "rad"), v("brake_torque", brake_torque, "N m"), v("brake_work", brake_work, "J");
  }
};

DEM_SETUP inline Wheel add_wheel(const Assembly& in, const std::string& corner, BodyId knuckle, const Vec3& middle,
                                 const WheelSpec& s, double spin = 0.0) {
  using namespace mbd;
  require_non_negative(s.brake, ("brake of the " + corner + " wheel").c_str(), "N m");
  require_positive(s.brake_stiffness, ("brake stiffness of the " + corner + " wheel").c_str(), "N m/rad");
  Wheel w;
  w.largest_brake = s.brake;
  w.body = in.body(corner + " wheel", s.mass, middle, Vec3(0, spin, 0));
  w.turn = in.joint(JointKind::revolute, corner + " wheel", knuckle, w.body, middle, Vec3::UnitY());
  w.brake = in.mechanism().add_actuator(
      joint_actuator(in.name(corner + " brake"), w.turn, s.brake_stiffness, s.brake_damping, Signal(0.0))
          .switched_off());
  return w;
}

/// Puts a tyre on a hard road. Not for worlds where the wheel has a surface that touches ground. Throws Error for a
/// tyre or road that cannot be, a wheel that has a tyre already, or one that is too deep in the road where it is. The
/// tyre is as given here until set_tyre().
DEM_SETUP inline void add_tyre(const Assembly& in, const std::string& corner, Wheel& w, const TyreSpec& tyre,
                               const Road& road) {
  check_tyre(tyre);
  check_road(road);
  mbd::Mechanism& m = in.mechanism();
  const Body& wheel = m.body(w.body);
  const std::string name = in.name(corner + " tyre"), wheel_name = wheel.name;
  if (w.tyre.valid()) fail("body '{}' has a tyre already, but is given another one, '{}'; give one", wheel_name, name);
  Road ground = road;
  ground.normal = road.normal.normalized();
  const Vec3 axis = wheel.rotation().transpose() * in.direction(Vec3::UnitY()), up = in.direction(Vec3::UnitZ());
  if (const double depth = depth_in(ground, tyre.radius, wheel, axis); depth > deepest_deflection(tyre)) {
    if (const Vec3& n = road.normal; !road.heights && n.dot(up) < 0.0) {
      fail("the normal of the road under body '{}' is ({:g}, {:g}, {:g}), into the ground; give its opposite",
           wheel_name, n.x(), n.y(), n.z());
    }
    fail(
        "body '{}' starts {:.3g} m deep in the road, but its tyre of radius {:g} m may be at most half of that deep; "
        "place it higher by {:.3g} m, or lower the road",
        wheel_name, depth, tyre.radius, depth);
  }
  w.road = m.add_load(mbd::terrain_load(name, w.body));
  w.tyre = mbd::add_terrain(m, name, std::make_unique<RoadTyre>(tyre, ground, w.body, axis, w.road, wheel_name));
}

namespace detail {

inline RoadTyre& road_tyre_of(const mbd::Mechanism& m, const Wheel& w) {
  if (!w.tyre.valid()) fail("body '{}' has no tyre on hard ground; give add_vehicle a road", m.body(w.body).name);
  return static_cast<RoadTyre&>(mbd::terrain_of(m, w.tyre));
}

}  // namespace detail

/// What a wheel's tyre on hard ground did in the newest evaluation of the forces. Throws Error if it has none.
inline const TyreState& tyre_of(const mbd::Mechanism& m, const Wheel& w) { return detail::road_tyre_of(m, w).state(); }

/// Gives a wheel's tyre on hard ground other numbers, between two steps: less friction on ice, less stiffness for less
/// air. VehicleSpec::tyre stays as it was built. A saved state is only loaded where tyres were changed the same way.
/// Throws Error if the wheel has none, or for one that cannot be.
DEM_SETUP inline void set_tyre(mbd::Mechanism& m, const Wheel& w, const TyreSpec& tyre) {
  detail::road_tyre_of(m, w).set_spec(tyre);
}

/// Sets the brake, 0 to 1 of its largest torque. To be called before every step: a brake that slips moves the angle
/// that it holds.
inline void set_brake(mbd::Mechanism& m, Wheel& w, double share) {
  mbd::Actuator& brake = m.parts().actuators[w.brake.index()];
  const double torque = std::clamp(share, 0.0, 1.0) * w.largest_brake;
  const double angle = m.coordinate(w.turn);
  w.brake_torque = torque;
  if (!(torque > 0.0)) {
    brake.spec.on = false;
    brake.spec.max_force = mbd::ActuatorSpec{}.max_force;
    return;
  }
  if (!brake.spec.on) w.brake_angle = angle;
  const double slack = torque / brake.spec.position_gain;
  w.brake_angle = std::clamp(w.brake_angle, angle - slack, angle + slack);
  brake.spec.on = true;
  brake.spec.max_force = torque;
  brake.spec.set_point = mbd::Signal(w.brake_angle);
}

}  // namespace dem::vehicle
