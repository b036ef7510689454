#pragma once

// The Humvee on hard ground: one run, with its telemetry and the sums that close its energy.

#include <dem/mbd/mbd.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/telemetry.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hard_ground {

using dem::Mat3;
using dem::Vec3;

struct Setup {
  /// Rear ball joints of rubber need steps of 1.5e-5 s.
  dem::vehicle::HumveeOptions options = {.rubber_rear = false};
  double speed = 0.0;       ///< m/s, at the start
  double friction = 0.8;    ///< of the tyres
  double slope = 0.0;       ///< rise over run; the car points up it
  bool free_front = false;  ///< the front axle is not driven: its bevel gear is open
  std::shared_ptr<const dem::vehicle::RoadHeights> heights = {};  ///< of the road, in place of a plane
  double time_step = 5e-5;                                        ///< s
  double wheel_centre = 0.46;                                     ///< m above the road at the start
};

/// Energy since the start, J. What is left over went into the dampers of joints and gears.
struct EnergyBalance {
  double gained = 0.0;                                                            ///< motion, height, joints
  double engine = 0.0, brakes = 0.0, tyres = 0.0, springs = 0.0, steering = 0.0;  ///< work on the bodies
  double clutch = 0.0;                                                            ///< slip of the clutch, below 0
  double throughput = 0.0;  ///< of all of them, and of motion and height
  double left_over() const { return engine + brakes + tyres + springs + steering + clutch - gained; }
  double error() const { return throughput > 0.0 ? left_over() / throughput : 0.0; }
};

class Car {
 public:
  dem::mbd::Machine<dem::integrator::VelocityVerlet> machine;
  dem::vehicle::Vehicle vehicle;
  Setup setup;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  explicit Car(const Setup& s) : setup(s) {
    using namespace dem::vehicle;
    VehicleSpec spec = humvee(s.options);
    spec.tyre.friction = s.friction;
    const double angle = std::atan(s.slope);
    machine.gravity = 9.81 * Vec3(-std::sin(angle), 0, -std::cos(angle));
    machine.joint_tolerance = 0.5;  // m: no more sub-steps; what is allowed is compared with the results
    const Assembly in(machine, "car", Vec3(0, 0, s.wheel_centre - spec.front.points.wheel.z()), Mat3::Identity(),
                      s.speed);
    vehicle = add_vehicle(in, spec, Road{.heights = s.heights});
    if (s.free_front) machine.switch_on(vehicle.driveline.front.bevel_gear, false);
    dem::vehicle::design_for(machine, s.time_step);
    machine.initialise(0.0, machine.gravity);
    start_ = stored();
    dem::vehicle::add_columns(columns, dem::vehicle::CarSample{});
    for (const char* corner : dem::vehicle::corner_letters) {
      for (const char* what :
           {"load_N", "pull_N", "side_N", dem::vehicle::slip_column, "slip_angle_rad", "travel_m", "brake_torque_Nm"}) {
        columns.push_back(std::string(corner) + "_" + what);
      }
      dem::vehicle::add_columns(columns, dem::vehicle::SuspensionSample{}, std::string(corner) + "_");
    }
  }

  const dem::vehicle::TyreState& tyre(std::size_t corner) const {
    return dem::vehicle::tyre_of(machine, vehicle.wheels[corner]);
  }
  /// Load on the front axle (0) or the rear one (1), N.
  double load(std::size_t axle) const { return tyre(2 * axle).load + tyre(2 * axle + 1).load; }
  double speed() const { return dem::vehicle::speed_of(machine, vehicle); }
  Vec3 position() const { return dem::vehicle::point_of(machine, vehicle, Vec3::Zero()); }
  double weight() const { return dem::vehicle::weight_of(machine); }
  /// The widest joint, m, and the most crooked one, rad, so far. Bushings are meant to give way.
  double widest = 0.0, crooked = 0.0;
  std::string widest_joint, crooked_joint, failed;
  static constexpr double widest_allowed = 1e-3, crooked_allowed = 0.1;  ///< m, rad
  bool is_closed() const { return widest <= widest_allowed && crooked <= crooked_allowed; }
  EnergyBalance energy;
  std::function<void(double)> each_step = [](double) {};  ///< after each step of dt (s)

  /// Drives for a time (s): `controls(car)` is asked every 10 ms and returns false to stop, after it set `now`.
  dem::vehicle::Controls now;
  template <class F>
  bool drive(double seconds, F&& controls) {
    const double dt = setup.time_step;
    const long steps = std::lround(seconds / dt), between = std::lround(0.01 / dt);
    for (long k = 0; k < steps; ++k, ++step_) {
      if (step_ % between == 0) {
        if (!controls(*this)) break;
        record();
      }
      dem::vehicle::drive(machine, vehicle, now, dt);
      if (const auto report = machine.step(dt); !report) {
        failed = report.text;
        break;
      }
      add_work(dt);
      each_step(dt);
    }
    energy.gained = stored() - start_;
    energy.clutch = 0.0;
    for (const auto& c : machine.parts().clutches) energy.clutch -= c.history.slip_work;
    energy.throughput = sum_ + std::abs(energy.gained);
    return failed.empty();
  }

 private:
  /// J, but for springs and shocks, whose work is summed.
  double stored() const {
    const dem::mbd::Energy e = dem::mbd::energy_of(machine.parts(), machine.gravity);
    return e.sum() - e.springs;
  }
  void add_work(double dt) {
    const auto& parts = machine.parts();
    const auto add = [&](double& to, double power) {
      to += dt * power;
      sum_ += dt * std::abs(power);
    };
    for (const auto& a : parts.actuators) {
      add(a.spec.name == "car engine" ? energy.engine : energy.brakes, a.power());
    }
    for (const auto& s : parts.springs) add(energy.springs, s.force * s.speed);
    for (const auto& m : parts.motions) add(energy.steering, m.drive.force * m.drive.rate);
    for (const auto& w : vehicle.wheels) {
      const dem::Body& b = machine.body(w.body);
      const dem::Wrench& f = machine.load(w.road).wrench;
      add(energy.tyres, to_eigen(f.force).dot(b.velocity()) + to_eigen(f.torque).dot(b.angular_velocity()));
    }
  }

  void record() {
    for (std::size_t j = 0; j < machine.parts().joints.size(); ++j) {
      const auto open = machine.violation(dem::JointId(j));
      if (open.displacement > widest) {
        widest = open.displacement;
        widest_joint = machine.parts().joint_specs[j].name;
      }
      if (open.rotation > crooked) {
        crooked = open.rotation;
        crooked_joint = machine.parts().joint_specs[j].name;
      }
    }
    std::vector<double> row;
    dem::vehicle::add_values(row, dem::vehicle::sample_of(machine, vehicle, now, machine.time()));
    for (std::size_t k = 0; k < 4; ++k) {
      const dem::vehicle::TyreState& t = tyre(k);
      for (const double x : {t.load, t.pull, t.side, t.slip, t.slip_angle, travel_of(machine, vehicle, k),
                             -machine.actuator(vehicle.wheels[k].brake).force}) {
        row.push_back(x);
      }
      dem::vehicle::add_values(row, suspension_sample_of(machine, vehicle, k));
    }
    rows.push_back(std::move(row));
  }

  double start_ = 0.0, sum_ = 0.0;
  long step_ = 0;
};

}  // namespace hard_ground
