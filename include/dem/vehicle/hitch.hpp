#pragma once
// What holds a whole car from outside: a crane that sets it down, a load cell behind it.

#include <dem/vehicle/telemetry.hpp>

#include <memory>

namespace dem::vehicle {

/// A damper against sinking, rolling and pitching of the chassis: the car's weight sinks at a speed (m/s), ever slower
/// as the ground takes it up.
DEM_SETUP inline LoadId add_crane(mbd::Mechanism& m, const Vehicle& car, double speed) {
  const double up = weight_of(m) / speed, turn = up * car.spec.wheelbase();
  return m.add_load(mbd::custom_load("crane", car.chassis, [up, turn](double, const Body& b) {
    const Vec3 v = b.velocity(), w = b.angular_velocity();
    return Wrench{{0, 0, -up * v.z()}, {-turn * w.x(), -turn * w.y(), 0}};
  }));
}

/// What holds a car on a load cell: a sled behind it that goes with a given speed along x. It pulls through a stiff
/// damper, so the car goes with it, whatever the car's wheels do.
struct Hitch {
  bool on = false;
  double speed = 1.0;     ///< m/s, of the sled
  double damping = 2e5;   ///< N s/m
  double constant = 0.0;  ///< N, backwards, besides: a trailer
  double force = 0.0;     ///< N, backwards on the car, in the newest evaluation
};

/// Adds a hitch 0.9 m behind the rear axle, so high (m) above the lowest points of the wheels where they are now. It is
/// off.
DEM_SETUP inline std::shared_ptr<Hitch> add_hitch(mbd::Mechanism& m, const Vehicle& car, double height) {
  const Body& b = m.body(car.chassis);
  const Vec3 wheel = m.body(car.wheels[2].body).position();
  const Vec3 at(wheel.x() - 0.9, b.position().y(), wheel.z() - car.spec.tyre.radius + height);
  const Vector3<double> point = transpose_times(b.motion.rotation, from_eigen(at) - b.motion.position);
  auto hitch = std::make_shared<Hitch>();
  m.add_load(mbd::custom_load("hitch", car.chassis, [point, h = hitch](double, const Body& body) {
    h->force = 0.0;
    if (!h->on) return Wrench{};
    const Vector3<double> arm = body.motion.rotation * point;
    const Vector3<double> spin = body.motion.rotation * body.motion.angular_velocity;
    h->force = h->constant + h->damping * (body.motion.velocity.x + cross(spin, arm).x - h->speed);
    const Vector3<double> force = {-h->force, 0, 0};
    return Wrench{force, cross(arm, force)};
  }));
  return hitch;
}

}  // namespace dem::vehicle
