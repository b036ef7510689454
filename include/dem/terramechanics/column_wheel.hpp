#pragma once

#include <dem/integrator/velocity_verlet.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/terramechanics/column_shapes.hpp>
#include <dem/terramechanics/machine_columns.hpp>
#include <dem/terramechanics/wheel_load.hpp>

#include <memory>
#include <numbers>

namespace dem::terramechanics {

/// A wheel that is rolled on soil columns (dynamic Bekker), from level ground on. Slip is s = 1 - v/(omega r), r the
/// radius without grousers.
struct ColumnWheel {
  Wheel wheel = {.radius = 0.13, .width = 0.16};
  Soil soil = melanz_sand;
  double friction = ColumnPart::rough;  ///< mu of the rim on the soil
  double load = 130.0;                  ///< N
  double wheel_mass = 1.5;              ///< kg, which the load includes
  double spin = 0.3;                    ///< rad/s
  double travel = 0.3;                  ///< m; the second half counts
  double spacing = 0.01;                ///< m, of the columns
  double bulldozing = 0.5;              ///< ColumnsSpec::bulldozing
  double time_step = 2.5e-4;            ///< s
};

/// Means over the second half of the way.
struct ColumnWheelRun {
  double pull = 0.0, torque = 0.0, sinkage = 0.0;  ///< N, N m, m; the sinkage is that of the tips of grousers
  ColumnField field;                               ///< the ground at the end
};

/// Rolls the wheel at a slip below 1. It sits on a hub that slides up and down on a carriage, which is moved along.
/// Joints are springs as stiff as the masses at them and the time step allow: so nearly all of the load is the hub's.
/// Throws Error for a wheel that makes no sense, a way of less than a time step, and where the soil does not carry it
/// with its axle above the ground.
inline ColumnWheelRun roll_on_columns(const ColumnWheel& w, double slip) {
  check_wheel(w.wheel);
  require_within(slip, -10.0, 0.99, "the slip of a wheel on columns, 1 - v/(omega r)");
  require_positive(w.spin, "spin of a wheel on columns", "rad/s");
  require_positive(w.travel, "travel of a wheel on columns", "m");
  require_positive(w.time_step, "time step of a wheel on columns", "s");
  require_within(9.81 * w.wheel_mass, 1e-6 * w.load, 0.9 * w.load, "weight of a wheel on columns (N, of its load)");
  const double hub_edge = 0.3;  // m; only its mass counts
  // With grousers the soil shears off at their tips: the columns meet a wheel of that radius.
  const double rim = w.wheel.radius, r = w.wheel.shear_radius(), v = w.spin * rim * (1.0 - slip);
  if (!(w.travel >= v * w.time_step)) {
    fail("a wheel on columns travels {:g} m, but goes {:g} m in a time step of {:g} s; raise travel or lower time_step",
         w.travel, v * w.time_step, w.time_step);
  }
  mbd::Machine<integrator::VelocityVerlet> machine;
  const BodyId carriage = machine.add_fixed_body("carriage", {0, 0, 3 * r});
  const double hub_density = (w.load / 9.81 - w.wheel_mass) / (hub_edge * hub_edge * hub_edge);
  const BodyId hub = machine.add_body(mbd::box_body("hub", {hub_edge, hub_edge, hub_edge}, hub_density).at({0, 0, r}));
  const double density = w.wheel_mass / (std::numbers::pi * r * r * w.wheel.width);
  const Mat3 axle_along_y = to_eigen(rotation_from_vector(Vector3<double>{-0.5 * std::numbers::pi, 0, 0}));
  const BodyId wheel =
      machine.add_body(mbd::cylinder_body("wheel", r, w.wheel.width, density).at({0, 0, r}, axle_along_y));
  machine.add_joint(mbd::prismatic("slide", carriage, hub, {0, 0, r}, Vec3::UnitZ()));
  const auto axle = machine.add_joint(mbd::revolute("axle", hub, wheel, {0, 0, r}, Vec3::UnitY()));
  machine.add_motion(mbd::prescribed_position("travel", carriage, Vec3::UnitX(), mbd::Signal::ramp(0.0, v)));
  machine.add_motion(mbd::prescribed_joint("spin", axle, mbd::Signal::ramp(0.0, w.spin)));
  const double margin = 1.2 * r, width = w.wheel.width + 0.16;
  MachineColumns soil(machine, {.low_x = -margin,
                                .low_y = -0.5 * width,
                                .length_x = w.travel + 2 * margin,
                                .length_y = width,
                                .spacing = w.spacing,
                                .soil = w.soil,
                                .bulldozing = w.bulldozing});
  // b of the pressure law is the wheel's width, as in wheel_forces.
  soil.add(wheel, std::make_shared<ColumnCylinder>(r, w.wheel.width), machine.body(wheel).position(), Mat3::Identity(),
           w.wheel.width, w.friction);
  ColumnWheelRun mean;
  double count = 0.0;
  const auto report = machine.run(w.travel / v, w.time_step, [&] {
    if (machine.time() < 0.5 * w.travel / v) return;  // set down and settled
    mean.pull += soil.loads()[0].force.x;
    mean.torque -= soil.loads()[0].torque.y;
    mean.sinkage += r - machine.body(wheel).position().z();
    ++count;
  });
  if (!report) fail("{}", report.text);
  if (!soil.report()) fail("{}", soil.report().text);
  mean.pull /= count, mean.torque /= count, mean.sinkage /= count;
  if (!(mean.sinkage < r)) {
    fail(
        "the soil carries {:g} N only {:.3g} m below its surface, with the wheel's axle in the ground, where columns "
        "do "
        "not tell a wheel's forces; lower the load, or take a larger wheel than one of {:g} m",
        w.load, mean.sinkage, rim);
  }
  mean.field = soil.soil().field();
  return mean;
}

}  // namespace dem::terramechanics
