#pragma once

#include <dem/rig/mobility/settings.hpp>
#include <dem/rig/number.hpp>
#include <dem/rig/stages.hpp>
#include <dem/terramechanics/wheel_forces.hpp>
#include <dem/vehicle/ending.hpp>
#include <dem/vehicle/lane_driver.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace dem::rig::mobility {

/// What differs between the drives of a study.
struct Case {
  std::string name;                      ///< of its files, and of its part of the run
  double slope = 0.0, side_slope = 0.0;  ///< percent
  double sprung_mass = 4430.0;           ///< kg
  std::vector<vehicle::LaneStretch> lane;
  bool is_held = false;  ///< on a load cell, over all slips
};

/// Pull of a car on a load cell at a slip.
struct PullPoint {
  double slip = 0.0;        ///< 1 - v/(omega r), of the rims' mean
  double pull = 0.0;        ///< N, on the load cell
  double torque = 0.0;      ///< N m, of the four wheels
  double sinkage = 0.0;     ///< m, mean of the four wheels
  double power = 0.0;       ///< W, of the engine
  double efficiency = 0.0;  ///< pull v over torque omega
};

/// What a drive finds. Means are over the second half of the way, forces of all four wheels together.
struct Result {
  std::string ended = {};                              ///< one of vehicle::ending; empty: not yet
  double way = 0.0, time = 0.0;                        ///< m, s
  double speed = not_known, slip = not_known;          ///< m/s; (omega r - v)/max
  double sinkage = not_known;                          ///< m
  double pull = not_known, torque = not_known;         ///< N, N m
  double resistance = not_known;                       ///< N, torque/r - pull: what the soil takes of the thrust
  double power = not_known;                            ///< W, of the engine
  double energy_per_metre = not_known;                 ///< J/m
  double cost_of_transport = not_known;                ///< energy per metre and weight
  double drift = not_known;                            ///< m, to the left at the end
  double rut_left = not_known, rut_right = not_known;  ///< m
  double weight = not_known;                           ///< N
  double widest_joint = 0.0;                           ///< m
  double computing = not_known;                        ///< s of one core for a second of the car
  std::vector<PullPoint> pulls = {};                   ///< of a car on a load cell

  [[nodiscard]] bool goes() const { return ended == vehicle::ending::arrived; }
  template <class V>
  void fields(V& v) {
    v("ended", ended), v("way", way), v("time", time), v("speed", speed), v("slip", slip), v("sinkage", sinkage);
    v("pull", pull), v("torque", torque), v("resistance", resistance), v("power", power);
    v("energy_per_metre", energy_per_metre), v("cost_of_transport", cost_of_transport), v("drift", drift);
    v("rut_left", rut_left), v("rut_right", rut_right), v("weight", weight), v("widest_joint", widest_joint);
    v("computing", computing), v.numbers("pulls", pulls);
  }
};

/// A row of telemetry: a hundredth of a second.
struct Sample {
  vehicle::CarSample car;         ///< its time counts from where the driver was told to go
  double way = 0.0, hitch = 0.0;  ///< m; N on the load cell
  std::array<vehicle::WheelSample, 4> wheels;
  std::array<vehicle::SuspensionSample, 4> suspension = {};

  [[nodiscard]] double mean(double vehicle::WheelSample::*value) const { return vehicle::mean_of(wheels, value); }
  [[nodiscard]] std::vector<std::string> columns() const {
    std::vector<std::string> names;
    vehicle::add_columns(names, car);
    names.insert(names.end(), {"way_m", "hitch_N"});
    vehicle::add_corner_columns(names);
    return names;
  }
  [[nodiscard]] std::vector<double> row() const {
    std::vector<double> row;
    vehicle::add_values(row, car);
    row.insert(row.end(), {way, hitch});
    vehicle::add_corner_values(row, wheels, suspension);
    return row;
  }
};

/// s of processor time that this thread has used.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The car of a case.
inline vehicle::ColumnCarSpec car_of(const Settings& s, const Case& c) {
  return {.car = vehicle::humvee(vehicle::with_engine({.sprung_mass = c.sprung_mass, .rubber_rear = false}, s.engine)),
          .lane = c.lane,
          .half_width = s.half_width,
          .spacing = s.spacing,
          .damping = s.damping,
          .bulldozing = s.bulldozing,
          .grade = 0.01 * c.slope,
          .side_grade = 0.01 * c.side_slope,
          .tyre_friction = s.tyre_friction,
          .ring = s.tyre == "ring" ? std::optional(vehicle::RingTyreSpec{.pressure = s.tyre_pressure}) : std::nullopt,
          .time_step = s.time_step};
}

/// A wheel of a case's car, as the semi-empirical equations know it.
inline terramechanics::Wheel wheel_of(const Settings& s, const Case& c) {
  const vehicle::ColumnCarSpec spec = car_of(s, c);
  if (spec.ring) return {.radius = spec.ring->radius, .width = spec.ring->width};
  return {.radius = spec.car.tyre.radius, .width = spec.car.tyre.width};
}

/// Who drives a car along the lane, to begin with as on its slope.
inline vehicle::LaneDriver driver_of(const Settings& s, const vehicle::ColumnCar& car) {
  const double grade = car.spec().grade;
  return {car.spec().car,
          {.speed = s.speed,
           .acceleration = s.acceleration,
           .spin_limit = s.spin_limit,
           .interval = vehicle::ColumnCar::interval},
          car.weight * grade / std::sqrt(1.0 + grade * grade)};
}

/// Sees how a drive ends. Asked after every sample.
class Judge {
 public:
  explicit Judge(const Settings& s) : settings_(s) {}

  /// One of vehicle::ending, or an empty text while the drive goes on.
  std::string operator()(const Sample& x, const vehicle::ColumnCar& car) {
    const Settings& s = settings_;
    const double far = std::numbers::pi / 3.0;
    if (std::abs(x.car.roll) > far || std::abs(x.car.pitch) > far) return vehicle::ending::rolled_over;
    for (std::size_t k = 0; k < 4; ++k) {
      // The soil ends some way beyond the wheel that leaves: half its width, and its lean.
      if (std::abs(car.middle_of(k).y()) > car.spec().half_width - 0.5) return vehicle::ending::left_lane;
      if (x.wheels[k].sinkage + x.wheels[k].deflection > car.spec().car.tyre.radius) return vehicle::ending::dug_in;
    }
    if (x.way < -0.3) return vehicle::ending::slid_back;
    // A car that just gets under way on a steep slope spins its wheels too.
    const bool slips = x.car.controls.throttle > 0.0 && x.mean(&vehicle::WheelSample::slip) > 0.8 &&
                       x.car.speed < (s.open_loop.empty() ? 0.05 * s.speed : 0.1);
    slips_since_ = !slips ? -1.0 : slips_since_ < 0.0 ? x.car.time : slips_since_;
    if (slips && x.car.time - slips_since_ >= 2.0) return vehicle::ending::dug_in;
    if (x.way >= s.path) return vehicle::ending::arrived;
    if (!s.open_loop.empty()) return x.car.time >= s.open_loop.end() ? vehicle::ending::inputs_ended : "";
    if (x.car.time > 4.0 * s.path / s.speed + 3.0) return vehicle::ending::too_slow;
    return {};
  }

 private:
  const Settings& settings_;
  double slips_since_ = -1.0;  // s
};

/// Slips that a car on a load cell goes through, in 32 s. Where it rolls with more slip than that it is towed.
inline double slip_of_hold(double time) { return std::clamp(-0.10 + 0.9 * (time - 4.0) / 28.0, -0.10, 0.80); }
inline constexpr double hold_time = 32.0;  ///< s

/// Means over the second half of the way.
inline void evaluate(Result& r, const std::vector<Sample>& samples, double radius) {
  if (samples.size() < 3) return;
  double n = 0.0, energy = 0.0, work = 0.0, from = 0.0, begin = 0.0;
  double speed = 0.0, slip = 0.0, sinkage = 0.0, pull = 0.0, torque = 0.0;
  using W = vehicle::WheelSample;
  const double ahead = r.way < 0.0 ? -1.0 : 1.0;  // the way that the car went
  for (const Sample& x : samples) {
    if (!(ahead * x.way >= 0.5 * ahead * r.way)) continue;
    if (n == 0.0) begin = x.car.time, from = x.way, work = x.car.engine_work;
    energy = x.car.engine_work - work;
    n += 1.0;
    speed += x.car.speed, slip += x.mean(&W::slip), sinkage += x.mean(&W::sinkage);
    pull += 4.0 * x.mean(&W::pull), torque += 4.0 * x.mean(&W::torque);
  }
  r.speed = speed / n, r.slip = slip / n, r.sinkage = sinkage / n, r.pull = pull / n, r.torque = torque / n;
  r.resistance = r.torque / radius - r.pull;
  r.power = energy / std::max(1e-9, r.time - begin);
  if (r.way > from + 0.2) {
    r.energy_per_metre = energy / (r.way - from);
    r.cost_of_transport = r.energy_per_metre / r.weight;
  }
  r.drift = samples.back().car.position.y() - samples.front().car.position.y();
}

/// Means of what the load cell saw in steps of slip of 0.05.
inline void evaluate_pulls(Result& r, const std::vector<Sample>& samples, const vehicle::ColumnCar& car) {
  const double radius = car.spec().car.tyre.radius;
  for (double low = -0.075; low < 0.79; low += 0.05) {
    PullPoint p;
    double n = 0.0, omega = 0.0, way = 0.0;
    for (const Sample& x : samples) {
      const double slip = slip_of_hold(x.car.time);
      if (x.car.time < 4.0 || slip < low || slip >= low + 0.05) continue;
      n += 1.0;
      p.slip += slip, p.pull += x.hitch, p.torque += 4.0 * x.mean(&vehicle::WheelSample::torque);
      p.sinkage += x.mean(&vehicle::WheelSample::sinkage), p.power += x.car.engine_power;
      omega += x.mean(&vehicle::WheelSample::spin), way += x.car.speed;
    }
    if (n < 10.0) continue;
    for (double* mean : {&p.slip, &p.pull, &p.torque, &p.sinkage, &p.power}) *mean /= n;
    omega /= n, way /= n;  // the hitch gives by some hundredths of a m/s: the car is not as fast as the sled
    p.slip = 1.0 - way / (omega * radius);
    p.efficiency = p.pull * way / (p.torque * omega);
    r.pulls.push_back(p);
  }
}

/// A drive with all that it was.
struct Driven {
  Result result;
  std::vector<Sample> samples;
  terramechanics::ColumnField field;  ///< the soil at its end
};

/// Drives a case: sets the car down, and drives until something ends it. `memory` is that of the columns before, if it
/// is not empty, and becomes that after. look(car, time) is called with each sample, a hundredth of a second; the time
/// (s) is from the start of the drive, as in the samples. `stages` are told `begun` to begun + share. Throws
/// Interrupted after Ctrl-C. What fails is told in the result.
template <class Look>
Driven drive(const Settings& s, Case c, std::vector<double>& memory, Stages& stages, double begun, double share,
             Look&& look) {
  if (c.is_held) c.lane.back().length += hold_time * s.speed;
  vehicle::ColumnCar car(car_of(s, c));
  if (!memory.empty()) car.soil().soil().restore(memory);
  Driven driven;
  Result& r = driven.result;
  std::vector<Sample>& samples = driven.samples;
  const double clock = thread_seconds();
  car.set_down();
  r.weight = car.weight;
  vehicle::LaneDriver driver = driver_of(s, car);
  Judge judge(s);
  const double start = car.machine.time(), from = car.way(), radius = car.spec().car.tyre.radius;
  if (c.is_held) car.hitch() = {.on = true, .speed = s.speed};
  while (r.ended.empty()) {
    const double time = car.machine.time() - start;
    // The sled takes the car along within the first seconds.
    if (c.is_held) car.hitch().speed = s.speed * std::min(1.0, 0.5 * time);
    const auto drive = [&] {
      if (c.is_held) {
        return vehicle::turn_rims(driver.steer(car.machine, car.car), car.hitch().speed / (1.0 - slip_of_hold(time)));
      }
      if (!s.open_loop.empty()) return driver.eased(s.open_loop(time), car.speed());
      return driver(car.machine, car.car, time);
    };
    car.advance(drive());
    Sample x{.car = car.sample(), .way = car.way() - from, .hitch = car.hitch().force, .wheels = {}};
    const double now = car.machine.time() - start;  // of the sample; the controls were chosen before
    x.car.time = now;
    for (std::size_t k = 0; k < 4; ++k) x.wheels[k] = car.wheel(k), x.suspension[k] = car.suspension(k);
    if (samples.size() % 50 == 0) {
      for (std::size_t j = 0; j < car.machine.parts().joints.size(); ++j) {
        r.widest_joint = std::max(r.widest_joint, car.machine.violation(JointId(j)).displacement);
      }
    }
    samples.push_back(x);
    r.way = x.way, r.time = now;
    if (!car.failed.empty()) r.ended = car.failed;
    else if (c.is_held) r.ended = now >= hold_time ? vehicle::ending::held : "";
    else r.ended = judge(x, car);
    look(std::as_const(car), now);
    if (io::interrupted()) throw Interrupted{};
    if (samples.size() % 10 == 0) {
      const double done = c.is_held ? now / hold_time : std::clamp(r.way / s.path, 0.0, 1.0);
      stages.update(begun + share * std::min(done, 0.99), text("{}: {:.1f} m, {:.1f} m/s", c.name, r.way, x.car.speed));
    }
  }
  evaluate(r, samples, radius);
  if (c.is_held) evaluate_pulls(r, samples, car);
  const double rear = car.middle_of(2).x() - 0.4;
  r.rut_left = car.rut_depth(0, 0.5, rear);
  r.rut_right = car.rut_depth(1, 0.5, rear);
  r.computing = (thread_seconds() - clock) / car.machine.time();
  memory.clear();
  car.soil().soil().collect(memory);
  driven.field = car.soil().soil().field();
  return driven;
}

}  // namespace dem::rig::mobility
