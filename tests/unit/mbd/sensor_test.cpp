#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("a window average forgets what is older than its window") {
  WindowAverage average(1.0);
  const auto sample = [](double f) { return Wrench{{f, 2 * f, 0}, {0, 0, -f}}; };
  for (int k = 0; k < 1000; ++k) average.add(sample(100.0), 1e-3);
  CHECK(average.mean().force.x == Approx(100.0));
  for (int k = 0; k < 500; ++k) average.add(sample(0.0), 1e-3);
  CHECK(average.mean().force.x == Approx(50.0).epsilon(0.04));  // the oldest edge is 1/64 of the window coarse
  for (int k = 0; k < 600; ++k) average.add(sample(0.0), 1e-3);
  CHECK(average.mean().force.x == 0.0);
  CHECK(average.latest().torque.z == 0.0);
  average.add(sample(7.0), 1e-3);
  CHECK(average.latest().force.y == 14.0);
  average.clear();
  CHECK(average.mean().force.x == 7.0);  // nothing in the window: the newest sample
  CHECK_THAT(message_of([] { WindowAverage(-1.0); }), Contains("averaging window is -1 s"));
}

TEST_CASE("a window of as many samples as fill it holds no more, however their times round") {
  // Samples 0.01, 0.02 ... 10 that each held for 0.01 s: ten of them sum up to a hair less than 0.1 s. Fewer than 64
  // samples have a bin each, so the mean is exact; 11 instead of 10 are 0.005 off.
  for (const int n : {10, 20, 50, 64}) {
    CAPTURE(n);
    WindowAverage average(n * 0.01);
    for (int k = 1; k <= 1000; ++k) average.add({{k * 0.01, 0, 0}, {}}, 0.01);
    CHECK(average.mean().force.x == Approx(10.0 - 0.005 * (n - 1)).epsilon(1e-12));
  }
}

TEST_CASE("a mean over an oscillation finds its middle") {
  WindowAverage average(0.5);
  for (int k = 0; k < 20000; ++k) average.add({{3.0 + std::sin(2 * pi * 40.0 * k * 1e-4), 0, 0}, {}}, 1e-4);
  CHECK(average.mean().force.x == Approx(3.0).epsilon(5e-3));
}

TEST_CASE("sensors read contacts, sums, joints and actuators") {
  InWorld<PredictorCorrector> world;
  Mechanism& m = world.m;
  const BodyId lid = m.add_body(given_body("lid", 2.0, Vec3(0.1, 0.1, 0.1)));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), lid, {0, 0, 0}));
  // A weight that a ram holds up, critically damped with 100/s: at rest long before the window begins.
  const BodyId weight = m.add_body(given_body("weight", 2.0, Vec3(0.1, 0.1, 0.1)).at({1, 0, 0}));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), weight, {1, 0, 0}, Z));
  const ActuatorId ram = m.add_actuator(joint_actuator("ram", guide, 2e4, 400.0));
  const SensorId push = m.add_sensor(actuator_sensor("push", ram, 0.05));
  const SensorId contact = m.add_sensor(contact_sensor("grains on the lid", lid, 0.05));
  const SensorId total = m.add_sensor(total_force_sensor("all on the lid", lid, 0.05));
  const SensorId joint = m.add_sensor(joint_sensor("load cell", weld, 0.05));
  const double dt = 1e-4;
  const Vec3 gravity(0, 0, -9.81);
  world.start(dt, gravity);
  for (int k = 0; k < 3000; ++k) {  // with a push in place of grains
    world.step(dt, gravity, [&] { m.body(lid).apply({0, 0, -5.0}, {0.1, 0, 0}); });
  }
  CHECK(world.solver.time() == Approx(0.3));
  CHECK(m.sensor(contact).mean().force.z == Approx(-5.0));
  CHECK(m.sensor(contact).mean().torque.y == Approx(0.5));
  CHECK(m.sensor(joint).mean().force.z == Approx(5.0 + 2.0 * 9.81).epsilon(1e-6));
  CHECK(m.sensor(joint).mean().torque.y == Approx(-0.5).epsilon(1e-6));
  CHECK(m.sensor(total).mean().force.z == Approx(2.0 * 9.81).epsilon(1e-6));
  CHECK(m.sensor(push).mean().force.x == Approx(2.0 * 9.81).epsilon(1e-6));
  // What the ram's law gives for where its guide is; the state has moved on by a step since, by less than 1e-9 m.
  const double law = -2e4 * m.coordinate(guide) - 400.0 * m.speed(guide);
  CHECK(m.sensor(push).latest().force.x == Approx(law).epsilon(1e-6));
  CHECK(m.drive_effort(push) == m.sensor(push).mean().force.x);
  CHECK_THAT(message_of([&] { (void)m.drive_effort(joint); }), Contains("'load cell' measures no actuator"));
}

TEST_CASE("what a drive that turns something gives is a torque, and is called so") {
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId wheel = m.add_body(given_body("wheel", 2.0, Vec3(0.3, 0.3, 0.5)));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const MotionId drive =
      m.add_motion(prescribed_joint("drive", axle, Signal::function([](double t) { return t * t; })));
  const SensorId torque = m.add_sensor(drive_sensor("torque", drive, 0.05));
  REQUIRE(m.run(0.2, 1e-4));
  CHECK(m.drive_effort(torque) == Approx(0.5 * 2.0).epsilon(1e-6));  // the moment of inertia times 2 rad/s^2
}

TEMPLATE_TEST_CASE("the sensor of a drive has the force of the step that is over", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // 1 kg along t^3/6 takes t newtons; from t - dt to t the mean is t - dt/2, and no rounding comes near 1e-9 of it.
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(ball("cart"));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint(
      "drive", rail, Signal::function([](double t) { return t * t * t / 6; }, [](double t) { return t * t / 2; })));
  const SensorId now = m.add_sensor(drive_sensor("now", drive, 0.0));
  const SensorId mean = m.add_sensor(drive_sensor("mean", drive, 0.1));
  const double dt = 0.01;
  REQUIRE(m.run(1.0, dt, [&] {
    CHECK(m.drive_effort(now) == Approx(m.time() - dt / 2).epsilon(1e-9));
    CHECK(m.drive_effort(now) == m.motion(drive).drive.force);
  }));
  CHECK(m.drive_effort(mean) == Approx(1.0 - 0.05).epsilon(1e-9));
}
