#pragma once
// Ring tyres on the wheels of a vehicle.

#include <dem/vehicle/ring_tyre.hpp>
#include <dem/vehicle/vehicle.hpp>

#include <cmath>

namespace dem::vehicle {

/// The vehicle with wheels of the size of ring tyres, without the mass and inertia of their belts. Throws Error for a
/// tyre that cannot be, for belts that are heavier than the wheel with them, and for a time step (s) that they do not
/// bear.
DEM_SETUP inline VehicleSpec on_ring_tyres(VehicleSpec car, const RingTyreSpec& ring, double time_step) {
  check_ring_tyre(ring);
  if (!(time_step <= ring.stable_time_step())) {
    fail(
        "a time step of {:g} s is too long for the ring tyres, whose belts bear {:.2g} s; lower it, or "
        "belt_stiffness",
        time_step, ring.stable_time_step());
  }
  PartMass& wheel = car.wheel.mass;
  const double square = (ring.radius - 0.5 * ring.thickness) * (ring.radius - 0.5 * ring.thickness);
  const double across = 0.5 * square + ring.width * ring.width / 12.0;
  const PartMass rim = {wheel.mass - ring.mass, wheel.inertia - ring.mass * Vec3(across, square, across)};
  if (!(rim.mass > 0.0 && rim.inertia.minCoeff() > 0.0)) {
    fail(
        "the belt of a ring tyre weighs {:g} kg at {:g} m, but a wheel with it {:g} kg, with {:.3g} kg m^2 about its "
        "axle; lower the belt's mass",
        ring.mass, std::sqrt(square), wheel.mass, wheel.inertia.y());
  }
  wheel = rim;
  car.tyre.radius = ring.radius, car.tyre.width = ring.width;
  return car;
}

/// Puts a ring tyre on a wheel (0 to 3) of a vehicle as it is drawn, at rest.
DEM_SETUP inline RingTyre add_ring_tyre(const Assembly& in, const Vehicle& car, std::size_t corner,
                                        const RingTyreSpec& s) {
  Vec3 middle = (corner < 2 ? car.spec.front : car.spec.rear).points.wheel;
  if (corner % 2 == 1) middle.y() = -middle.y();
  return add_ring_tyre(in, corner_names[corner], car.wheels[corner].body, middle, s);
}

}  // namespace dem::vehicle
