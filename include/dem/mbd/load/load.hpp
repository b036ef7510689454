#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/math/wrench.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/mbd/drive/signal.hpp>
#include <dem/mbd/ids.hpp>

#include <dem/core/function.hpp>
#include <string>
#include <utility>
#include <vector>

namespace dem::mbd {

/// A force law of the user's own: force (N) and torque (N m, about the body's centre of mass) in global axes, at a time
/// (s) and a state of the body. It may be called after grains were moved: who wants to know of grains asks between
/// steps.
using LoadLaw = Function<Wrench(double time, const Body& body)>;

/// A force law between two bodies: force (N) and torque (N m, about b's centre of mass) that b feels, in global axes.
/// Body a feels the opposite, at the same place, so momentum and angular momentum are kept.
using PairLoadLaw = Function<Wrench(double time, const Body& a, const Body& b)>;

/// A force (N) at a point of a body, or a torque (N m), along a direction that stays in space or turns with the body;
/// or whatever a law gives.
struct LoadSpec {
  std::string name;
  BodyId body = {};
  bool is_torque = false;
  Vec3 direction = Vec3::UnitZ();  ///< global at assembly; made a unit vector
  Signal size = 0.0;               ///< N or N m
  Vec3 at = Vec3::Zero();          ///< m, global at assembly
  bool follows_body = false;       ///< the direction turns with the body
  bool on = true;
  LoadLaw law = {};           ///< if given, it stands for direction, size and point
  BodyId a = {};              ///< the other body of a law between two
  PairLoadLaw pair_law = {};  ///< likewise, between body a and `body`
  bool by_terrain = false;    ///< a terrain writes the force: see terrain_load()
  bool has_law() const { return law || pair_law || by_terrain; }
};

LoadSpec applied_force(std::string name, BodyId body, const Vec3& at, const Vec3& direction, Signal newtons);
LoadSpec applied_torque(std::string name, BodyId body, const Vec3& axis, Signal newton_metres);
/// Drag, a tyre, a field: a law that is called at each evaluation of the forces.
///
///     custom_load("drag", car, [](double, const Body& b) { return Wrench{from_eigen(Vec3(-c * b.velocity())), {}}; })
///
/// Forces at a point x of the body have the torque (x - b.position()) x force. What the body carries so far in `force`
/// and `torque` depends on the order of the parts. The stable time step does not know the law: keep its stiffness below
/// m (0.5/dt)^2 and its damping below 0.5 m/dt. Velocity Verlet shows it the speed of half a step before (first order).
LoadSpec custom_load(std::string name, BodyId body, LoadLaw law);

/// The same between two bodies: a tyre on a road that moves, a torque converter, a field between two magnets. The law
/// gives what body b feels, about its centre of mass; body a feels the opposite.
///
///     custom_load("converter", pump, turbine, [=](double, const Body& a, const Body& b) {
///       const double slip = axis.dot(a.angular_velocity() - b.angular_velocity());
///       return Wrench{{0, 0, 0}, from_eigen(Vec3(c * slip * axis))};
///     })
LoadSpec custom_load(std::string name, BodyId a, BodyId b, PairLoadLaw law);

struct Load {
  LoadSpec spec;
  Vector3<double> point = {};      ///< m, body frame
  Vector3<double> direction = {};  ///< global, or body frame if it follows the body
  double size = 0.0;               ///< N or N m, in the newest force evaluation; not of a law
  Wrench wrench;                   ///< what it put on the body then, about the centre of mass, global axes
  template <class V>
  void fields(V& v) {
    v.given("name", spec.name), v.given("body", spec.body), v.given("is_torque", spec.is_torque);
    v.given("follows_body", spec.follows_body), v.given("has_law", spec.has_law()), v("on", spec.on);
    v.given("point_given", spec.at, "m"), v.given("direction_given", spec.direction);
    v("signal", spec.size), v("point", point, "m"), v("direction", direction), v("size", size), v("wrench", wrench);
  }
};

void apply_load(Load& load, std::vector<Body>& bodies, double time, double dt);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE LoadSpec applied_force(std::string name, BodyId body, const Vec3& at, const Vec3& direction,
                                  Signal newtons) {
  return {.name = std::move(name), .body = body, .direction = direction, .size = std::move(newtons), .at = at};
}

DEM_INLINE LoadSpec applied_torque(std::string name, BodyId body, const Vec3& axis, Signal newton_metres) {
  return {
      .name = std::move(name), .body = body, .is_torque = true, .direction = axis, .size = std::move(newton_metres)};
}

DEM_INLINE LoadSpec custom_load(std::string name, BodyId body, LoadLaw law) {
  if (!law) fail("load '{}' was given no function; give one that returns the force and the torque", name);
  return {.name = std::move(name), .body = body, .law = std::move(law)};
}

DEM_INLINE LoadSpec custom_load(std::string name, BodyId a, BodyId b, PairLoadLaw law) {
  if (!law) fail("load '{}' was given no function; give one that returns the force and the torque", name);
  return {.name = std::move(name), .body = b, .a = a, .pair_law = std::move(law)};
}

DEM_INLINE void apply_load(Load& load, std::vector<Body>& bodies, double time, double dt) {
  if (!load.spec.by_terrain || !load.spec.on) load.wrench = {};
  if (!load.spec.on) return;
  Body& b = bodies[load.spec.body.index()];
  if (load.spec.by_terrain) {
    // The terrain has written it.
  } else if (load.spec.law) {
    load.wrench = load.spec.law(time, b);
  } else if (load.spec.pair_law) {
    Body& a = bodies[load.spec.a.index()];
    load.wrench = load.spec.pair_law(time, a, b);
    a.force -= load.wrench.force;
    a.torque -= load.wrench.torque + cross(b.motion.position - a.motion.position, load.wrench.force);
  } else {
    const Matrix3<double>& r = b.motion.rotation;
    load.size = load.spec.size(time, dt).value;
    const Vector3<double> f = load.size * (load.spec.follows_body ? r * load.direction : load.direction);
    load.wrench = load.spec.is_torque ? Wrench{{0, 0, 0}, f} : Wrench{f, cross(r * load.point, f)};
  }
  b.force += load.wrench.force;
  b.torque += load.wrench.torque;
}

}  // namespace dem::mbd

#endif
