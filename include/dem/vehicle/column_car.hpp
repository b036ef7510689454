#pragma once

#include <dem/integrator/velocity_verlet.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/machine_columns.hpp>
#include <dem/vehicle/hitch.hpp>
#include <dem/vehicle/ring_wheels.hpp>
#include <dem/vehicle/telemetry.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// A stretch of a lane: one soil for a length.
struct LaneStretch {
  terramechanics::NamedSoil soil;
  double length = 0.0;  ///< m
};

/// A car on soil columns, as it is asked for. x runs along the lane, up a grade; y to the left.
struct ColumnCarSpec {
  VehicleSpec car;
  /// One after the other from x = 0. A named soil without a known unloading stiffness k0 springs back by up to a tenth
  /// of its sinkage: a wheel may pull more on it than by the equations with a0 = a1 = 0, a small one by half
  /// (examples/soil_columns/RESULTS.md).
  std::vector<LaneStretch> lane;
  double margin = 4.0;                    ///< m, of soil before the lane's start and beyond its end
  double half_width = 1.6;                ///< m, of soil on either side of the middle
  double spacing = 0.05;                  ///< m, of the columns
  double damping = 2e3;                   ///< Pa s/m, of the columns
  double bulldozing = 0.3;                ///< share of the soil that is pushed aside
  double grade = 0.0;                     ///< rise over run along the lane
  double side_grade = 0.0;                ///< of the left side over the right one
  double tyre_friction = 0.8;             ///< mu of the tyres on the soil
  std::optional<RingTyreSpec> ring = {};  ///< pneumatic tyres instead of rigid ones, with their radius and width
  double time_step = 5e-5;                ///< s, a whole number of times in ColumnCar::interval
  double set_down_speed = 0.5;            ///< m/s, of the crane
  double hitch_height = 0.6;              ///< m, over the ground, of the hitch behind the rear axle
};

/// A vehicle of humvee.hpp or the like on soil columns (dynamic Bekker): its tyres are rigid cylinders on them, or
/// rings. A machine alone, without grains: a second of driving takes half a second to one on rigid tyres, three on
/// rings.
///
///     ColumnCar car({.car = humvee({.rubber_rear = false}), .lane = {{known_soil("dry-sand"), 30.0}}});
///     car.set_down();
///     while (car.way() < 20.0) car.advance({.throttle = 0.3});
class ColumnCar {
 public:
  using Machine = mbd::Machine<integrator::VelocityVerlet>;
  static constexpr double interval = 0.01;  ///< s, of advance()

  /// Throws Error for a lane that is none, numbers beyond their range, a time step that does not divide the interval,
  /// and what check_columns refuses.
  explicit ColumnCar(const ColumnCarSpec& given) : spec_(on_its_tyres(given)), soil_(machine, columns(spec_)) {
    const ColumnCarSpec& spec = spec_;
    const TyreSpec& tyre = spec.car.tyre;
    machine.gravity = Vec3(0, 0, -9.81);
    machine.joint_tolerance = 0.5;  // m: light shafts wind up
    const double height = tyre.radius - spec.car.front.points.wheel.z();
    const Assembly in(machine, "car", Vec3(-spec.car.rear.points.wheel.x(), 0, height));
    car = add_vehicle(in, spec.car);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (spec.ring) add_ring(in, corner);
      else add_rigid_tyre(corner);
    }
    lay_soils();
    weight = weight_of(machine);
    crane_ = add_crane(machine, car, spec.set_down_speed);
    hitch_ = add_hitch(machine, car, spec.hitch_height);
    design_for(machine, spec.time_step);
    machine.initialise(0.0, machine.gravity);
  }
  ColumnCar(const ColumnCar&) = delete;
  ColumnCar& operator=(const ColumnCar&) = delete;

  /// Lowers the car on its brakes by a crane for 1.2 s, lets it stand for 0.5 s, then turns gravity to that of the
  /// slope within half a second.
  void set_down() {
    const Controls brakes{.brake = 1.0};
    for (int k = 0; k < 120; ++k) advance(brakes);
    machine.switch_on(crane_, false);
    for (int k = 0; k < 50; ++k) advance(brakes);
    const double size = std::sqrt(1.0 + spec_.grade * spec_.grade + spec_.side_grade * spec_.side_grade);
    const Vec3 whole = 9.81 / size * Vec3(-spec_.grade, -spec_.side_grade, -1.0), flat = machine.gravity;
    if (size == 1.0) return;
    for (int k = 1; k <= 70; ++k) {
      const double t = std::min(1.0, k / 50.0), share = t * t * (3.0 - 2.0 * t);
      machine.gravity = (1.0 - share) * flat + share * whole;
      advance(brakes);
    }
  }

  /// Steps of a length (s) in an interval. Throws Error, which names them as `what`, for those that do not fill it
  /// evenly, or are more than 100,000.
  static long steps_of(double time_step, const char* what = "time step of a car on soil columns") {
    const double steps = interval / time_step, whole = std::round(steps);
    if (!(steps <= 1e5) || !(whole >= 1.0) || !(std::abs(steps - whole) <= 1e-9 * whole)) {
      fail("{} is {:g} s, but must fill {:g} s evenly in at most 100000 steps, as 5e-05 s does", what, time_step,
           interval);
    }
    return static_cast<long>(whole);
  }

  /// Ten milliseconds with these controls. Nothing moves on once something has failed.
  void advance(const Controls& controls) {
    const double dt = spec_.time_step;
    controls_ = controls;
    for (long k = steps_of(dt); k > 0 && failed.empty(); --k) {
      drive(machine, car, controls, dt);
      if (const auto report = machine.step(dt); !report) failed = report.text;
    }
    if (failed.empty() && !soil_.report().ok) failed = soil_.report().text;
  }

  /// m, of the wheels' middles along the lane, on the mean: 0 where the rear wheels stood at the start.
  double way() const {
    double sum = 0.0;
    for (const Wheel& w : car.wheels) sum += machine.body(w.body).position().x();
    return 0.25 * sum - 0.5 * spec_.car.wheelbase();
  }
  double speed() const { return speed_of(machine, car); }
  Vec3 middle_of(std::size_t corner) const { return machine.body(car.wheels[corner].body).position(); }
  CarSample sample() const { return sample_of(machine, car, controls_, machine.time()); }
  WheelSample wheel(std::size_t corner) const {
    const Vector3<double> middle = machine.body(car.wheels[corner].body).motion.position;
    Wrench soil;
    for (const Piece& p : pieces_[corner]) {
      const terramechanics::ColumnLoad& load = soil_.loads()[p.part];
      const Vector3<double> arm = machine.body(p.body).motion.position - middle;
      soil = soil + Wrench{load.force, load.torque + cross(arm, load.force)};
    }
    const double deflection = rings_[corner] ? deflection_of(machine, *rings_[corner]) : 0.0;
    return wheel_sample_of(machine, car, corner, soil, 0.0, spec_.car.tyre.radius, deflection);
  }
  SuspensionSample suspension(std::size_t corner) const { return suspension_sample_of(machine, car, corner); }
  /// m/s, of the rims, as the drive shaft turns: their mean.
  double rim_speed() const { return rim_speed_of(machine, car); }
  /// m, mean depth of the rut of the left (0) or right (1) wheels between two places along the lane, over the middle
  /// half of the tyre's width; NaN if there is none.
  double rut_depth(std::size_t side, double from, double to) const {
    const auto& f = soil_.soil().field();
    const double middle = (side == 0 ? 0.5 : -0.5) * spec_.car.track(), half = 0.25 * spec_.car.tyre.width;
    double sum = 0.0, count = 0.0;
    for (std::size_t iy = 0; iy < f.grid.ny; ++iy) {
      if (std::abs(f.grid.y(iy) - middle) > half) continue;
      for (std::size_t ix = 0; ix < f.grid.nx; ++ix) {
        if (f.grid.x(ix) < from || f.grid.x(ix) > to) continue;
        sum -= f.surface(f.grid.row(ix, iy));
        count += 1.0;
      }
    }
    return sum / count;
  }
  terramechanics::MachineColumns& soil() { return soil_; }
  const terramechanics::MachineColumns& soil() const { return soil_; }
  const ColumnCarSpec& spec() const { return spec_; }
  Hitch& hitch() { return *hitch_; }

  Machine machine;
  Vehicle car;
  double weight = 0.0;  ///< N
  std::string failed;   ///< what ended the run, in words

 private:
  /// A part on the soil, and its body.
  struct Piece {
    std::size_t part;
    BodyId body;
  };

  /// Throws Error for numbers beyond their range.
  static ColumnCarSpec on_its_tyres(ColumnCarSpec s) {
    steps_of(s.time_step);
    require_within(s.margin, 1.0, 1e3, "margin of a lane of soil columns (m)");
    require_within(s.grade, -1.0, 1.0, "grade of a lane of soil columns (rise over run)");
    require_within(s.side_grade, -1.0, 1.0, "side grade of a lane of soil columns (rise over run)");
    require_within(s.set_down_speed, 0.05, 5.0, "speed at which a car is set down on soil columns (m/s)");
    require_within(s.hitch_height, 0.0, 5.0, "height of a hitch over soil columns (m)");
    if (!s.ring) return s;
    s.car = on_ring_tyres(s.car, *s.ring, s.time_step);
    return s;
  }
  void add_rigid_tyre(std::size_t corner) {
    const TyreSpec& tyre = spec_.car.tyre;
    const BodyId wheel = car.wheels[corner].body;
    const auto shape = std::make_shared<terramechanics::ColumnCylinder>(tyre.radius, tyre.width);
    const std::size_t part =
        soil_.add(wheel, shape, machine.body(wheel).position(), Mat3::Identity(), 0.0, spec_.tyre_friction);
    pieces_[corner] = {{part, wheel}};
  }
  void add_ring(const Assembly& in, std::size_t corner) {
    const RingTyre& tyre = rings_[corner].emplace(add_ring_tyre(in, car, corner, *spec_.ring));
    const auto shape = std::make_shared<terramechanics::ColumnBox>(tyre.edges(), true);
    for (const BodyId b : tyre.segments) {
      const std::size_t part = soil_.add(b, shape, machine.body(b).position(), machine.reference_rotation(b),
                                         tyre.spec.width, spec_.tyre_friction);
      if (!pieces_[corner].empty()) soil_.continue_part(part, pieces_[corner].front().part);
      pieces_[corner].push_back({part, b});
    }
  }
  static terramechanics::ColumnsSpec columns(const ColumnCarSpec& s) {
    if (s.lane.empty()) fail("a lane of soil columns has no stretch; give at least one soil with its length");
    double length = 0.0;
    for (const LaneStretch& part : s.lane) {
      length += require_positive(part.length, ("length of the stretch of " + part.soil.name).c_str(), "m");
    }
    const double reach = s.car.track() + s.car.tyre.width;
    if (!(2.0 * s.half_width > reach)) {
      fail("a lane of soil columns is {:g} m wide, but the car is {:g} m wide; raise half_width", 2.0 * s.half_width,
           reach);
    }
    return {.low_x = -s.margin,
            .low_y = -s.half_width,
            .length_x = length + s.car.wheelbase() + 2.0 * s.margin,
            .length_y = 2.0 * s.half_width,
            .spacing = s.spacing,
            .soil = s.lane[0].soil.soil,
            .damping = s.damping,
            .bulldozing = s.bulldozing};
  }
  void lay_soils() {
    if (spec_.lane.size() < 2) return;
    std::vector<terramechanics::Soil> others;
    for (std::size_t k = 1; k < spec_.lane.size(); ++k) others.push_back(spec_.lane[k].soil.soil);
    // Where the car has gone as far as a stretch is long its front wheels meet the next one.
    soil_.soil().lay_soils(others, [&](double x, double) {
      std::size_t k = 0;
      double end = spec_.lane[0].length + spec_.car.wheelbase();
      while (k + 1 < spec_.lane.size() && x > end) end += spec_.lane[++k].length;
      return k;
    });
  }

  ColumnCarSpec spec_;
  terramechanics::MachineColumns soil_;
  std::array<std::vector<Piece>, 4> pieces_;           ///< of the tyres
  std::array<std::optional<RingTyre>, 4> rings_ = {};  ///< of pneumatic ones
  std::shared_ptr<Hitch> hitch_;
  LoadId crane_;
  Controls controls_;
};

}  // namespace dem::vehicle
