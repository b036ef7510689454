#include <dem/integrator/predictor_corrector.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/math/rotation.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/terramechanics/column_wheel.hpp>
#include <dem/terramechanics/named_soils.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

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

TEST_CASE("a machine on columns has the same bits for any number of threads") {
  const auto rolled = [](int threads) {
    Rig<integrator::VelocityVerlet> rig;
    MachineColumns soil(rig.machine, lane(0.03));
    soil.soil().set_threads(threads);
    soil.add(rig.wheel, std::make_shared<ColumnCylinder>(0.13, 0.16), {0, 0, 0.13});
    REQUIRE(rig.machine.run(0.1, 5e-4).ok);
    REQUIRE(soil.loads()[0].force.z > 10.0);
    const auto& m = rig.machine.body(rig.wheel).motion;
    return std::array{m.position.x, m.position.z, m.velocity.x, m.velocity.z, m.angular_velocity.z};
  };
  const auto one = rolled(1);
  for (const int threads : {2, 3}) CHECK(rolled(threads) == one);
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
  CHECK_THROWS_WITH(roll_on_columns({.wheel = {.radius = 0.13, .width = 0.16, .grouser_share = 2.0}}, 0.1),
                    ContainsSubstring("share of the grousers"));
  CHECK_THROWS_WITH(roll_on_columns({.travel = 1e-6}, 0.0),
                    ContainsSubstring("travels 1e-06 m") && ContainsSubstring("time step of 0.00025 s"));
  CHECK_THROWS_WITH(roll_on_columns({.time_step = 0.0}, 0.0), ContainsSubstring("time step of a wheel on columns"));
  // Snow carries 1 kN only where the axle is in it.
  CHECK_THROWS_WITH(roll_on_columns({.soil = known_soil("snow").soil, .load = 1e3, .wheel_mass = 15.0}, 0.3),
                    ContainsSubstring("axle in the ground"));
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
  const SensorId contacts = machine.add_sensor(mbd::contact_sensor("under the block", block, 0.0));
  REQUIRE(machine.run(1.0, 2e-4).ok);
  CHECK(machine.sensor(contacts).latest().force.z == Approx(19.62).epsilon(1e-3));
  CHECK(soil.loads()[0].force.z == Approx(9.81).epsilon(1e-3));
  CHECK(soil.loads()[1].force.z == Approx(9.81).epsilon(1e-3));
  CHECK(machine.body(block).velocity().norm() < 1e-4);
  const double p = 9.81 / (0.03 * 0.1);
  CHECK(0.001 - machine.body(block).position().z() + 0.05 > 0.99 * under(melanz_sand.pressure, 0.03).sinkage(p));
}

TEST_CASE("a step that is too large for the soil, and a part that leaves it, end a run once, with the body's name") {
  const auto hull_on = [](mbd::Machine<integrator::VelocityVerlet>& machine, const Vec3& velocity) {
    const BodyId hull = machine.add_body(mbd::box_body("hull", {0.1, 0.1, 0.1}, 500.0).at({0, 0, 0.051}));
    machine.body(hull).motion.velocity = from_eigen(velocity);
    MachineColumns soil(
        machine, {.low_x = -0.2, .low_y = -0.2, .length_x = 0.4, .length_y = 0.4, .soil = melanz_sand, .damping = 1e4});
    soil.add(hull, std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.1}), {0, 0, 0.051});
    return soil;
  };
  mbd::Machine<integrator::VelocityVerlet> coarse, fine, leaving;
  const MachineColumns there = hull_on(coarse, {0, 0, 0});
  const mbd::MachineReport thrown = coarse.run(1.0, 1e-2);
  CHECK_FALSE(thrown.ok);
  CHECK(thrown.time < 0.5);
  CHECK_THAT(thrown.text, ContainsSubstring("the soil under body 'hull' asks for steps below 0.00") &&
                              ContainsSubstring("but they are 0.01 s"));
  CHECK(coarse.run(0.5, 1e-2).ok);
  CHECK(there.report().ok);
  hull_on(fine, {0, 0, 0});
  const mbd::MachineReport rests = fine.run(1.0, 1e-3);
  CHECK(rests.ok);
  CHECK(rests.note.empty());

  const MachineColumns left = hull_on(leaving, {2.0, 0, -0.2});
  const mbd::MachineReport gone = leaving.run(1.0, 1e-3);
  CHECK_FALSE(gone.ok);
  CHECK(gone.time == Approx(0.1).margin(0.03));  // nose down, its lower edge trails the upper one
  CHECK_THAT(gone.text, ContainsSubstring("body 'hull' leaves the soil at (0.1"));
  const mbd::MachineReport on = leaving.run(0.01, 1e-3);
  CHECK(on.ok);
  CHECK_THAT(on.note, ContainsSubstring("body 'hull': part 0 on soil columns leaves the soil"));
  CHECK_FALSE(left.report().ok);
}

TEST_CASE("a body or a tread that leaves the soil is told once, whatever the number of its parts") {
  const ColumnsSpec field = {
      .low_x = -0.2, .low_y = -0.2, .length_x = 0.4, .length_y = 0.4, .soil = melanz_sand, .damping = 1e4};
  const auto add_block = [](mbd::Machine<integrator::VelocityVerlet>& machine, const char* name, double x) {
    const BodyId block = machine.add_body(mbd::box_body(name, {0.1, 0.1, 0.1}, 500.0).at({x, 0, 0.051}));
    machine.body(block).motion.velocity = {2.0, 0, -0.2};
    return block;
  };
  const auto shape = std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.04, 0.1});
  mbd::Machine<integrator::VelocityVerlet> sledge, tread;
  const BodyId body = add_block(sledge, "sledge", 0.1);
  MachineColumns under_sledge(sledge, field);
  for (const double y : {-0.03, 0.03}) under_sledge.add(body, shape, {0.1, y, 0.051});
  const mbd::MachineReport gone = sledge.run(0.1, 1e-3);
  CHECK_FALSE(gone.ok);
  CHECK_THAT(gone.text, ContainsSubstring("body 'sledge' leaves the soil") && !ContainsSubstring("; body"));

  MachineColumns under_tread(tread, field);
  for (const double x : {0.1, 0.0}) {
    const std::size_t part = under_tread.add(add_block(tread, x > 0.0 ? "front" : "rear", x), shape, {x, 0, 0.051});
    if (part > 0) under_tread.continue_part(part, 0);
  }
  const mbd::MachineReport front = tread.run(0.1, 1e-3);
  CHECK_THAT(front.text, ContainsSubstring("body 'front' leaves the soil"));
  CHECK(tread.run(0.1, 1e-3).ok);
  CHECK(under_tread.loads()[1].leaves);
  CHECK_THROWS_WITH(mbd::terrain_of(tread, under_tread.id()).set_memory({0.0}),
                    ContainsSubstring("has 1 numbers, but the 2 bodies on them alone have 11"));
}

TEST_CASE("a hull that overhangs the edge of the soil is noted, and ends the run where it is in the ground there") {
  const auto run = [](double angle) {
    mbd::Machine<integrator::VelocityVerlet> machine;
    const Mat3 turn = to_eigen(rotation_from_vector(Vector3<double>{0, -angle, 0}));
    const Vec3 at = {0.15, 0, 0.3 * std::sin(angle)};
    const BodyId hull = machine.add_fixed_body("hull", at);
    MachineColumns soil(
        machine, {.low_x = -0.3, .low_y = -0.2, .length_x = 0.6, .length_y = 0.4, .soil = melanz_sand, .damping = 1e4});
    soil.add(hull, std::make_shared<ColumnBox>(Vector3<double>{0.6, 0.1, 0.05}), at, turn);
    const mbd::MachineReport report = machine.run(0.01, 1e-3);
    CHECK(soil.loads()[0].columns > 0);
    CHECK(soil.loads()[0].leaves);
    CHECK_THAT(report.ok ? report.note : report.text, ContainsSubstring("leaves the soil"));
    return report.ok;
  };
  CHECK(run(0.6));
  CHECK_FALSE(run(0.0));
}

TEST_CASE("columns without damping under a free body, and a wheel below its axle but no flat disc, are noted") {
  const auto note = [](double lean) {
    mbd::Machine<integrator::VelocityVerlet> machine;
    const BodyId wheel = machine.add_body(mbd::sphere_body("wheel", 0.1, 2000.0).at({0, 0, 0.1}));
    MachineColumns soil(
        machine, {.low_x = -0.3,
                  .low_y = -0.3,
                  .length_x = 0.6,
                  .length_y = 0.6,
                  .soil = {.pressure = Bekker{.k_c = 1.4, .k_phi = 820.0, .n = 1.0}, .shear = {.displacement = 0.01}}});
    const Mat3 turn = to_eigen(rotation_from_vector(Vector3<double>{lean, 0, 0}));
    soil.add(wheel, std::make_shared<ColumnCylinder>(0.1, 0.1), {0, 0, 0.1}, turn);
    const mbd::MachineReport report = machine.run(0.3, 1e-3);
    CHECK(report.ok);
    CHECK(machine.body(wheel).position().z() < 0.0);
    return report.note;
  };
  CHECK_THAT(note(0.0), ContainsSubstring("body 'wheel' has its axle") && ContainsSubstring("below the ground") &&
                            ContainsSubstring("columns without damping"));
  CHECK_THAT(note(0.5 * std::numbers::pi),
             !ContainsSubstring("has its axle") && ContainsSubstring("columns without damping"));
}

TEST_CASE("the set-up of columns tells shapes, their places on bodies, and soils apart, wherever the bodies are") {
  struct Wheel {
    std::shared_ptr<const ColumnShape> shape = std::make_shared<ColumnCylinder>(0.13, 0.16);
    double aside = 0.05;  // m
    double angle = 0.3;   // rad, about the axle
    double border = 0.5;  // m, from where on there is another soil
    Vec3 body = {0, 0, 0};
  };
  const auto set_up = [](const Wheel& w) {
    mbd::Machine<integrator::VelocityVerlet> machine;
    const Mat3 turn = to_eigen(rotation_from_vector(Vector3<double>{0.1, 0.7, w.body.x()}));
    const BodyId hub = machine.add_body(mbd::box_body("hub", {0.1, 0.1, 0.1}, 2000.0).at(w.body, turn));
    MachineColumns soil(machine, {.soil = melanz_sand});
    const std::array<Soil, 1> other = {mojave_martian_simulant};
    soil.soil().lay_soils(other, [&](double x, double) { return x > w.border; });
    const Mat3 place = to_eigen(rotation_from_vector(Vector3<double>{0, w.angle, 0}));
    soil.add(hub, w.shape, w.body + turn * Vec3(0.1, w.aside, 0.2), turn * place);
    return mbd::terrain_of(machine, soil.id()).set_up();
  };
  const std::string one = set_up({});
  CHECK_THAT(one, ContainsSubstring("cylinder of radius 0.13 m and width 0.16 m at (0.1, 0.05, 0.2) m"));
  CHECK(set_up({.body = {5.3, -2.7, 0.9}}) == one);
  CHECK(set_up({.shape = std::make_shared<ColumnCylinder>(0.13, 0.17)}) != one);
  CHECK(set_up({.shape = std::make_shared<ColumnCylinder>(0.131, 0.16)}) != one);
  CHECK(set_up({.aside = 0.0501}) != one);
  CHECK(set_up({.angle = 0.31}) != one);
  CHECK(set_up({.border = 0.52}) != one);
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

namespace {

/// The share of the shear strength under a plate that is drawn over columns from rest at 0.1 m/s^2 for 0.1 s.
double mobilised_by_a_start(double time_step) {
  mbd::Machine<integrator::PredictorCorrector> machine;
  const BodyId plate = machine.add_fixed_body("plate", {0, 0, 0});
  machine.add_motion(mbd::prescribed_position(
      "draw", plate, Vec3::UnitX(),
      mbd::Signal::function([](double t) { return 0.05 * t * t; }, [](double t) { return 0.1 * t; })));
  machine.most_substeps = 1;
  MachineColumns soil(machine, lane(0.1));
  soil.add(plate, std::make_shared<ColumnBox>(Vector3<double>{0.1, 0.1, 0.01}), {0, 0, 0});
  REQUIRE(machine.run(0.1, time_step).ok);
  const ColumnField& field = soil.soil().field();
  const ColumnRange middle = field.grid.around({0.0, 0.0, 0.0, 0.0});
  return norm(field.shear[field.grid.row(middle.to_x, middle.to_y)].mobilised);
}

}  // namespace

TEST_CASE("the way that shears columns is of second order in the predictor-corrector's step") {
  const double way = 0.5e-3, share = 1.0 - std::exp(-way / melanz_sand.shear.displacement);
  // With the speeds at the end of each of 20 steps the way would be 5 % too long, and half of that in 40 steps.
  const double coarse = mobilised_by_a_start(5e-3) - share, fine = mobilised_by_a_start(2.5e-3) - share;
  CHECK(std::abs(coarse) < 2e-3 * share);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.1));
}
