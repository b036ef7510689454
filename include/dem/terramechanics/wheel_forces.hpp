#pragma once

#include <dem/terramechanics/wheel_contact.hpp>

#include <array>
#include <cmath>

namespace dem::terramechanics {

/// What the soil does to a wheel in steady motion (thesis eqs. 2-4, 43, 44).
struct WheelForces {
  double sinkage = 0.0;        ///< z, m
  double load = 0.0;           ///< what the soil carries, N, upwards
  double thrust = 0.0;         ///< of the shear stresses, N, forwards
  double resistance = 0.0;     ///< of the pressure, N, backwards
  double pull = 0.0;           ///< drawbar pull, N: thrust - resistance
  double torque = 0.0;         ///< that drives the wheel, N m
  double speed_ratio = 0.0;    ///< v/(omega r)
  double entry = 0.0;          ///< theta_f, rad
  double exit = 0.0;           ///< theta_r, rad
  double peak = 0.0;           ///< theta_m, rad
  double peak_pressure = 0.0;  ///< Pa
  double radius = 0.0;         ///< r, m, that slip and speed ratio refer to

  /// Tractive efficiency (thesis eq. 44), pull times speed over torque times spin. It means something where the wheel
  /// drives, torque and pull positive; NaN or infinite without a torque.
  double efficiency() const { return pull * speed_ratio * radius / torque; }
  /// What the soil takes of the power, over the load times the rim's speed: (T omega - F v)/(W omega r). BrakedShear::
  /// two_zones has no energy balance: in cohesive soil it gives a braked wheel under a light load power from nowhere.
  double loss() const { return (torque / radius - pull * speed_ratio) / load; }
};

/// Forces on a wheel at a sinkage (m) and a slip by any SlipDefinition and of any sign. `places` sets the accuracy of
/// the integrals (integrate); its default is good for 1e-11. Throws Error for a wheel, soil or slip out of range, and
/// unless 0 < sinkage < radius.
template <std::size_t places = 40>
WheelForces wheel_forces(const Wheel& wheel, const Soil& soil, const Slip& slip, double sinkage,
                         const WheelModel& model = {}) {
  check_wheel(wheel);
  check_soil(soil);
  check_slip(slip);
  require_within(model.bridge, 0.0, 1.0, "bridge from negative to positive slip");
  if (!(sinkage > 0.0 && sinkage < wheel.radius)) {
    fail("sinkage is {:g} m, but must be above 0 and below the wheel's radius, {:g} m", sinkage, wheel.radius);
  }
  const WheelContact contact(wheel, soil, slip, sinkage, model);
  // sigma cos, sigma sin, tau cos, tau sin, tau
  std::array<double, 5> sums{};
  const auto stresses = [&](double theta) -> std::array<double, 5> {
    const double sigma = contact.pressure(theta), tau = contact.shear(theta, sigma);
    const double c = std::cos(theta), s = std::sin(theta);
    return {sigma * c, sigma * s, tau * c, tau * s, tau};
  };
  const std::array<double, 5> bends = contact.bends();
  for (std::size_t k = 1; k < bends.size(); ++k) integrate<places>(bends[k - 1], bends[k], stresses, sums);
  const double area = wheel.width * wheel.radius, shear_area = wheel.width * contact.shear_radius();
  WheelForces f;
  f.sinkage = sinkage;
  f.load = area * sums[0] + shear_area * sums[3];
  f.thrust = shear_area * sums[2];
  f.resistance = area * sums[1];
  f.pull = f.thrust - f.resistance;
  f.torque = shear_area * contact.shear_radius() * sums[4];
  f.speed_ratio = contact.speed_ratio();
  f.entry = contact.entry();
  f.exit = contact.exit();
  f.peak = contact.peak();
  f.peak_pressure = contact.pressure(contact.peak());
  f.radius = wheel.radius;
  return f;
}

}  // namespace dem::terramechanics
