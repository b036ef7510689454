#pragma once

#include <dem/vehicle/driver.hpp>
#include <dem/vehicle/telemetry.hpp>
#include <dem/vehicle/vehicle.hpp>

#include <algorithm>

namespace dem::vehicle {

/// Drives along a lane: gains speed evenly, holds it by throttle and brakes, and keeps to the middle by steering. The
/// engine's governor takes back the throttle where the wheels spin: from the spin limit (mean of the rims less the
/// car's speed) on, down to none at twice that. Asked at even times, a hundred a second.
class LaneDriver {
 public:
  struct Spec {
    double speed = 5.0;                                   ///< m/s, that is held
    double acceleration = 1.0;                            ///< m/s^2, at which it is reached
    double spin_limit = 1.0;                              ///< m/s
    double interval = 0.01;                               ///< s, between calls
    Vec3 from = Vec3(-100, 0, 0), to = Vec3(1000, 0, 0);  ///< m, of the path
  };

  /// `force` (N) is what it takes to stand on the slope; the throttle begins with it, so that the car hardly
  /// rolls back; with gears by some centimetres, until the rotor is up.
  LaneDriver(const VehicleSpec& car, const Spec& spec, double force)
      : spec_(spec), rear_(car.rear.points.wheel.x(), 0, 0) {
    largest_ = largest_torque(car.driveline.engine) * car.driveline.front.ratio / car.tyre.radius;
    hold_ = {.gain = 0.5, .integral = 0.3};
    hold_.sum = std::clamp(force / largest_, -1.0, 1.0) / hold_.integral;
    follow_.wheelbase = car.wheelbase();
    follow_.path = {spec.from, spec.to};
    follow_.preview = 4.0;
    follow_.trim = 1.0;
  }

  /// `time` (s) since the start.
  Controls operator()(const mbd::Mechanism& m, const Vehicle& v, double time) {
    Controls c = pedals(m, v, time);
    c.steer = steer(m, v);
    return c;
  }
  /// Without steering.
  Controls pedals(const mbd::Mechanism& m, const Vehicle& v, double time) {
    const double speed = speed_of(m, v), wanted = std::min(spec_.speed, spec_.acceleration * time);
    const double push = wanted < spec_.speed ? spec_.acceleration * weight_of(m) / 9.81 : 0.0;  // N
    const bool is_eased = rim_speed_of(m, v) > speed + spec_.spin_limit;
    return eased(hold_(speed, wanted, spec_.interval, push / largest_, is_eased), speed);
  }
  /// rad.
  double steer(const mbd::Mechanism& m, const Vehicle& v) {
    return follow_(point_of(m, v, rear_), forward_of(m, v), speed_of(m, v));
  }
  /// The same controls with the governor of this driver at a speed (m/s) of the car.
  [[nodiscard]] Controls eased(Controls c, double speed) const {
    c.ease_from = speed + spec_.spin_limit, c.ease_to = speed + 2.0 * spec_.spin_limit;
    return c;
  }
  template <class V>
  void fields(V& v) {
    v("hold", hold_), v("follow", follow_);
  }

 private:
  Spec spec_;
  Vec3 rear_;             ///< m, of the rear axle, from the vehicle's origin
  double largest_ = 0.0;  ///< N, that all wheels push with at most
  SpeedHold hold_;
  PathFollower follow_;
};

}  // namespace dem::vehicle
