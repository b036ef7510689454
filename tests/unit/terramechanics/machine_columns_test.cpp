#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/terramechanics/column_wheel.hpp>

#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "rolling_wheel.hpp"

using namespace dem;
using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

ColumnsSpec lane(double travel) {
  return {.low_x = -0.12,
          .low_y = -0.11,
          .length_x = travel + 0.24,
          .length_y = 0.22,
          .spacing = 0.01,
          .soil = melanz_sand};
}

/// The wheel of rolling_wheel.hpp as a machine: a carriage that is moved along, a hub that slides up and down on it,
/// and a wheel that is turned. Its weight is that of hub and wheel.
template <class Integrator>
struct Rig {
  mbd::Machine<Integrator> machine;
  BodyId wheel;
  RollingWheel same{.slip = 0.3};

  Rig() {
    const double v = same.spin * same.radius * (1.0 - same.slip);
    const BodyId carriage = machine.add_fixed_body("carriage", {0, 0, 0.3});
    const BodyId hub = machine.add_body(mbd::box_body("hub", {0.1, 0.1, 0.1}, 1000.0).at({0, 0, same.radius}));
    const Mat3 turn = to_eigen(rotation_from_vector(Vector3<double>{-0.5 * std::numbers::pi, 0, 0}));
    const double density = (same.mass - 1.0) / (std::numbers::pi * same.radius * same.radius * same.width);
    wheel =
        machine.add_body(mbd::cylinder_body("wheel", same.radius, same.width, density).at({0, 0, same.radius}, turn));
    machine.joint_tolerance = 0.01;  // m; the slide tilts by 0.02 rad, and the wheel is compared to 0.005
    machine.most_substeps = 1;       // steps of the soil are counted
    machine.add_joint(mbd::prismatic("slide", carriage, hub, {0, 0, same.radius}, Vec3::UnitZ()));
    const auto axle = machine.add_joint(mbd::revolute("axle", hub, wheel, {0, 0, same.radius}, Vec3::UnitY()));
    machine.add_motion(mbd::prescribed_position("travel", carriage, Vec3::UnitX(), mbd::Signal::ramp(0.0, v)));
    machine.add_motion(mbd::prescribed_joint("spin", axle, mbd::Signal::ramp(0.0, same.spin)));
  }
};

template <class Integrator>
void check_rig() {
  const double travel = 0.12;
  Rig<Integrator> rig;
  MachineColumns soil(rig.machine, lane(travel));
  const std::size_t part = soil.add(rig.wheel, std::make_shared<ColumnCylinder>(0.13, 0.16), {0, 0, 0.13});
  const double time = travel / (rig.same.spin * rig.same.radius * (1.0 - rig.same.slip));
  double pull = 0.0, torque = 0.0, sinkage = 0.0;
  int count = 0;
  const mbd::MachineReport report = rig.machine.run(time, 5e-4, [&] {
    CHECK(soil.report().ok);
    if (2.0 * rig.machine.time() < time) return;
    ++count;
    pull += soil.loads()[part].force.x;
    torque -= soil.loads()[part].torque.y;
    sinkage += 0.13 - rig.machine.body(rig.wheel).motion.position.z;
  });
  INFO(report.text);
  REQUIRE(report.ok);
  SoilColumns alone(lane(travel));
  const auto mean = rig.same.roll(alone, travel);
  CHECK(pull / count == Approx(mean.pull).epsilon(0.005));
  CHECK(torque / count == Approx(mean.torque).epsilon(0.005));
  CHECK(sinkage / count == Approx(mean.sinkage).epsilon(0.005));
  CHECK(soil.soil().steps() == Approx(time / 5e-4).margin(2));  // each step was kept once
}

}  // namespace

TEST_CASE("a machine's wheel on columns does what the wheel alone does, with either kind of integrator") {
  check_rig<integrator::VelocityVerlet>();
  check_rig<integrator::PredictorCorrector>();
}

TEST_CASE("a wheel of the library's rig on columns feels what the wheel alone does") {
  const double travel = 0.12;
  for (const double slip : {-0.3, 0.3}) {
    RollingWheel alone{.slip = slip};
    SoilColumns columns(lane(travel));
    const auto mean = alone.roll(columns, travel);
    const ColumnWheel test{.spin = alone.spin, .travel = travel, .bulldozing = 0.0};
    const ColumnWheelRun run = roll_on_columns(test, slip);
    // As above: joints that give, here by up to 0.02 rad, and another time step.
    CHECK(run.pull == Approx(mean.pull).epsilon(0.01));
    CHECK(run.torque == Approx(mean.torque).epsilon(0.01));
    CHECK(run.sinkage == Approx(mean.sinkage).epsilon(0.01));
    CHECK(run.field.surface(run.field.grid.row(run.field.grid.nx / 2, run.field.grid.ny / 2)) < -0.5 * mean.sinkage);
  }
  CHECK_THROWS_WITH(roll_on_columns({}, 1.0), ContainsSubstring("slip of a wheel on columns"));
  CHECK_THROWS_WITH(roll_on_columns({.load = 10.0}, 0.1), ContainsSubstring("weight of a wheel on columns"));
}

TEST_CASE("a block comes to rest on columns and weighs what it weighs") {
  mbd::Machine<integrator::VelocityVerlet> machine;
  const BodyId block = machine.add_body(mbd::box_body("block", {0.1, 0.1, 0.1}, 2000.0).at({0, 0, 0.051}));
  ColumnsSpec spec = {
      .low_x = -0.2, .low_y = -0.2, .length_x = 0.4, .length_y = 0.4, .soil = melanz_sand, .damping = 2e4};
  MachineColumns soil(machine, spec);
  // Of two plates under its feet.
  const auto foot = std::make_shared<ColumnBox>(Vector3<double>{0.03, 0.1, 0.01});
  soil.add(block, foot, {-0.035, 0, 0.006});
  soil.add(block, foot, {0.035, 0, 0.006});
  REQUIRE(machine.run(1.0, 2e-4).ok);
  CHECK(soil.loads()[0].force.z == Approx(9.81).epsilon(1e-3));
  CHECK(soil.loads()[1].force.z == Approx(9.81).epsilon(1e-3));
  CHECK(machine.body(block).velocity().norm() < 1e-4);
  const double p = 9.81 / (0.03 * 0.1);
  CHECK(0.001 - machine.body(block).position().z() + 0.05 > 0.99 * under(melanz_sand.pressure, 0.03).sinkage(p));
}

TEST_CASE("bodies that are not there, and shapes without a width, are refused") {
  mbd::Machine<integrator::VelocityVerlet> machine;
  const BodyId block = machine.add_body(mbd::box_body("block", {0.1, 0.1, 0.1}, 2000.0));
  MachineColumns soil(machine, {.soil = melanz_sand});
  CHECK_THROWS_WITH(soil.add(block, nullptr, Vec3::Zero()), ContainsSubstring("body 'block' was given no shape"));
  CHECK_THROWS_WITH(soil.add(block, std::make_shared<ColumnBall>(0.1), Vec3::Zero()),
                    ContainsSubstring("tells no width"));
  CHECK_THROWS(soil.add(BodyId(7), std::make_shared<ColumnBall>(0.1), Vec3::Zero(), Mat3::Identity(), 0.1));
}
