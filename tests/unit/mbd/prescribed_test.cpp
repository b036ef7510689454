#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("prescribed motion is met exactly and reports its drive force", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const SensorId cell = m.add_sensor(drive_sensor("cell", drive, 0.0));
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  for (int k = 0; k < 3000; ++k) REQUIRE(m.step(dt));
  const double t = m.time();
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  CHECK(m.speed(guide) == Approx(0.01 * w * std::cos(w * t)).epsilon(1e-9));
  // Mass times acceleration, of the middle of the step.
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * (t - dt / 2))).epsilon(1e-3));
  CHECK(m.sensor(cell).latest().force.x == m.motion(drive).drive.force);
}

TEMPLATE_TEST_CASE("prescribed motion holds in the sub-steps that a world asks for", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // As a world steps it: the contact forces (none here) first, then several machine steps; of two stages the second
  // starts again.
  InWorld<TestType> world;
  Mechanism& m = world.m;
  m.substeps = 4;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const double dt = 4e-4, w = 2.0 * pi * 2.0;
  world.start(dt);
  for (int s = 0; s < 800; ++s) world.step(dt, Vec3::Zero(), [] {});
  const double t = world.solver.time();
  CHECK(t == Approx(0.32));
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * (t - dt / 8))).epsilon(1e-3));
}

TEST_CASE("any degree of freedom of a joint may be prescribed, each by its own motion") {
  Machine<VelocityVerlet> m;
  const BodyId rod = m.add_body(ball("rod"));
  const JointId guide = m.add_joint(cylindrical("guide", m.ground(), rod, {0, 0, 0}, Z));
  m.add_motion(prescribed_joint("out", guide, Signal::sine(0.02, 1.0)).along(Dof::slide));
  m.add_motion(prescribed_joint("round", guide, Signal::ramp(0.0, 3.0)).along(Dof::turn));
  const BodyId cross = m.add_body(ball("cross").at({1, 0, 0}));
  const JointId bent = m.add_joint(universal("bent", m.ground(), cross, {1, 0, 0}, Z, Z));
  m.add_motion(prescribed_joint("bend", bent, Signal::sine(0.3, 0.5)).along(Dof::bend_x));
  REQUIRE(m.run(0.6, 1e-4));
  const double t = m.time();
  CHECK(m.coordinate(guide, Dof::slide) == Approx(0.02 * std::sin(2 * pi * t)).epsilon(1e-12));
  CHECK(m.coordinate(guide, Dof::turn) == Approx(3.0 * t).epsilon(1e-12));
  CHECK(m.speed(guide, Dof::turn) == Approx(3.0).epsilon(1e-9));
  CHECK(m.coordinate(bent, Dof::bend_x) == Approx(0.3 * std::sin(pi * t)).epsilon(1e-9));
  check_refused([&] { m.add_motion(prescribed_joint("no", guide, 0.0).along(Dof::bend)); }, "'no'", "bend",
                "which has only");
  const MotionSpec plain = prescribed_joint("no", bent, 0.0);  // refined without being spent, as other specs are
  check_refused([&] { m.add_motion(plain.along(Dof::bend)); }, "'no' drives the bend of a universal joint",
                "bend_x and bend_y");
  const MotionId pose =
      m.add_motion(prescribed_pose("still", m.add_fixed_body("flyer"), [](double) { return Pose{}; }));
  check_refused([&] { m.add_sensor(drive_sensor("cell", pose, 0.1)); }, "sensor 'cell'", "'still'", "no single force");
}

TEMPLATE_TEST_CASE("a wheel driven by its speed takes hold at any angle, and a switched-off wall stands still", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId wheel = m.add_body(ball("wheel", 2.0, 0.2).moving(Vec3::Zero(), {0, 0, 30.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  REQUIRE(m.run(1.0, 1e-3));
  REQUIRE(m.coordinate(axle) == Approx(30.0));
  const MotionId drive = m.add_motion(prescribed_speed("drive", axle, Signal::ramp(30.0, 5.0, 1.0)));
  const BodyId wall = m.add_fixed_body("wall");
  const MotionId push = m.add_motion(prescribed_position("push", wall, X, Signal::ramp(0.0, 0.5, 1.0)));
  REQUIRE(m.run(1.0, 1e-3));
  CHECK(m.speed(axle) == Approx(35.0).epsilon(1e-12));
  CHECK(m.coordinate(axle) == Approx(30.0 + 32.5).epsilon(1e-12));
  CHECK(m.motion(drive).drive.force == Approx(0.2 * 5.0).epsilon(1e-9));
  CHECK(m.body(wall).velocity().x() == 0.5);
  m.switch_on(push, false);
  CHECK(m.body(wall).velocity().norm() == 0.0);
  m.set_motion(drive, 10.0);
  REQUIRE(m.step(1e-3));
  CHECK(m.speed(axle) == Approx(10.0).epsilon(1e-12));
  check_refused([&] { m.set_motion(drive, 0.0, 20.0); }, "'drive' is one of speed", "use set_motion(id, speed)");
}

TEMPLATE_TEST_CASE("a drive by speed turns as fast as it says under load, and takes the load's power", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // 100 N m on 0.01 kg m^2: left to itself for a step of 2e-4 s the wheel turns by T dt^2/(2 I) = 2e-4 rad too far or
  // too little, which over a second would be 1 rad.
  Machine<TestType> m;
  m.gravity.setZero();
  const double dt = 2e-4, load = -100.0;
  const BodyId wheel = m.add_body(ball("wheel", 2.0, 0.01).moving(Vec3::Zero(), {0, 0, 50.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const MotionId drive = m.add_motion(prescribed_speed("drive", axle, 50.0));
  m.add_load(applied_torque("load", wheel, Z, load));
  double work = 0.0;
  REQUIRE(m.run(1.0, dt, [&] { work += m.motion(drive).drive.force * m.speed(axle) * dt; }));
  // 5000 steps, each of which rounds an angle of up to 50 rad by some 1e-14.
  CHECK(m.coordinate(axle) == Approx(50.0).epsilon(1e-11));
  CHECK(m.speed(axle) == Approx(50.0).epsilon(1e-12));
  CHECK(m.motion(drive).drive.force == Approx(100.0).epsilon(1e-9));
  CHECK(work == Approx(-load * m.coordinate(axle)).epsilon(1e-3));  // but for the first step of each integrator
  // A speed that changes: the angle is its integral.
  m.set_motion(drive, Signal::sine(20.0, 3.0, 0.0, 50.0));
  REQUIRE(m.run(0.5, dt));
  const double turned = 50.0 * 0.5 + 20.0 / (6.0 * pi) * (1.0 - std::cos(6.0 * pi * 1.5)) -
                        20.0 / (6.0 * pi) * (1.0 - std::cos(6.0 * pi));
  CHECK(m.coordinate(axle) == Approx(50.0 + turned).epsilon(1e-11));
  // Switched off and on again it goes on from where the wheel is.
  m.switch_on(drive, false);
  REQUIRE(m.run(0.01, dt));
  const double before = m.coordinate(axle);
  m.set_motion(drive, 7.0);
  m.switch_on(drive);
  REQUIRE(m.run(0.1, dt));
  CHECK(m.coordinate(axle) == Approx(before + 0.7).epsilon(1e-11));
}

TEMPLATE_TEST_CASE("a drive by speed is exact in sub-steps as well", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  InWorld<TestType> w;
  const BodyId wheel = w.m.add_body(ball("wheel", 2.0, 0.01).moving(Vec3::Zero(), {0, 0, 50.0}));
  const JointId axle = w.m.add_joint(revolute("axle", w.m.ground(), wheel, {0, 0, 0}, Z));
  w.m.add_motion(prescribed_speed("drive", axle, 50.0));
  w.m.substeps = 5;
  w.start(1e-3);
  const auto load = [&] { w.m.body(wheel).apply_torque({0, 0, -100.0}); };
  for (int k = 0; k < 200; ++k) w.step(1e-3, Vec3::Zero(), load);
  CHECK(w.m.coordinate(axle) == Approx(10.0).epsilon(1e-11));
}

TEMPLATE_TEST_CASE("a drive takes hold of a hinge beside the centre of mass without pulling it apart", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // 0.9 mrad off with an arm of 0.3 m: turned about its centre of mass the hinge would part by 0.27 mm.
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId arm = m.add_body(ball("arm", 1.0, 0.01).at({0.3, 0, 0}));
  const BodyId base = m.add_body(ball("base", 3.0, 0.1));
  const JointId hinge = m.add_joint(revolute("hinge", base, arm, {0, 0, 0}, Z));
  m.add_motion(prescribed_joint("steer", hinge, 9e-4));
  REQUIRE(m.step(1e-3));
  CHECK(m.coordinate(hinge) == Approx(9e-4).epsilon(1e-12));
  CHECK(m.violation(hinge).displacement < 1e-12);
  CHECK(m.body(arm).velocity().norm() < 1e-9);
}

TEST_CASE("a motion takes values from outside every step, however fast they go") {
  // 50 rad/s in steps of 1e-3 s: 0.05 rad each, far more than a motion may be off when it takes hold.
  Machine<VelocityVerlet> m;
  const BodyId wheel = m.add_body(ball("wheel", 1.0, 0.1).moving(Vec3::Zero(), {0, 0, 50.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const MotionId drive = m.add_motion(prescribed_joint("drive", axle, Signal::held(0.0, 50.0)));
  m.design_for(1e-3);
  m.initialise(0.0, Vec3::Zero());
  for (int k = 1; k <= 300; ++k) {
    m.set_motion(drive, 0.05 * k, 50.0);
    REQUIRE(m.step(1e-3));
    CHECK(m.coordinate(axle) == Approx(0.05 * k).epsilon(1e-12));
  }
  CHECK(std::abs(m.motion(drive).drive.force) < 1e-6);  // it keeps its speed
}

TEMPLATE_TEST_CASE("values from outside are reached by all sub-steps together", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  // A slider at 1 m/s, and what is welded to it: no force acts. Positions of up to 0.3 m round by 6e-17 m, and welds
  // have up to 1 kg/h^2 = 1e8 N/m in steps of h = 1e-4 s: some 1e-8 N. A slider that made the whole way of 1 mm in its
  // first sub-step would pull at the weld with some 20 N in 2 of them, and 900 N in 10.
  const int substeps = GENERATE(1, 2, 10);
  CAPTURE(substeps);
  Machine<TestType> m;
  m.gravity.setZero();
  m.substeps = m.most_substeps = substeps;
  const BodyId slider = m.add_body(ball("slider").moving(X));
  const BodyId load = m.add_body(ball("load").at({0.2, 0, 0}).moving(X));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), slider, {0, 0, 0}, X));
  const JointId weld = m.add_joint(fixed("weld", slider, load, {0.1, 0, 0}));
  const MotionId drive = m.add_motion(prescribed_joint("drive", rail, 0.0));
  const double dt = 1e-3;
  m.set_motion(drive, dt, 1.0);  // for the end of the first step
  m.design_for(dt);
  m.initialise(0.0, m.gravity);
  CHECK(m.coordinate(rail) == 0.0);
  double pull = 0.0;
  REQUIRE(m.run(0.3, dt, [&] {
    pull = std::max(pull, std::abs(m.reaction(weld).force.x));
    CHECK(m.coordinate(rail) == Approx(m.time()).epsilon(1e-12));
    m.set_motion(drive, m.time() + dt, 1.0);
  }));
  CHECK(pull < 1e-7);
}

TEST_CASE("a driven part stays where its value is when the clock of a machine is set back") {
  const double back_to = GENERATE(0.0, 0.299, 0.2995);
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(ball("cart").moving(X));
  const MotionId drive =
      m.add_motion(prescribed_joint("drive", m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, X)), 0.0));
  const double dt = 1e-3;
  m.design_for(dt);
  m.initialise(0.0, m.gravity);
  for (int k = 1; k <= 300; ++k) {
    m.set_motion(drive, k * dt, 1.0);
    REQUIRE(m.step(dt));
  }
  m.initialise(back_to, m.gravity);
  CHECK(m.body(cart).position().x() == Approx(0.3).epsilon(1e-12));
  m.set_motion(drive, 0.3 + dt, 1.0);
  REQUIRE(m.step(dt));
  CHECK(m.body(cart).position().x() == Approx(0.3 + dt).epsilon(1e-12));
}

TEST_CASE("a belt stays in all sub-steps, and a value whose rate is 0 is jumped to in the first") {
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  m.substeps = 4;
  const BodyId belt = m.add_fixed_body("belt"), cart = m.add_body(ball("cart"));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, X));
  const MotionId run = m.add_motion(prescribed_position("run", belt, X, Signal::held(0.0, 2.0)));
  const MotionId drive = m.add_motion(prescribed_joint("drive", rail, 0.0));
  std::vector<double> at, speed, hop;
  m.add_load(custom_load("look", cart, [&](double, const Body& b) {
    at.push_back(m.body(belt).position().x());
    speed.push_back(m.body(belt).velocity().x());
    hop.push_back(b.position().x());
    return Wrench{};
  }));
  REQUIRE(m.step(1e-3));
  at.clear(), speed.clear(), hop.clear();
  m.set_motion(run, 0.0, 3.0);
  m.set_motion(drive, 5e-4, 0.0);
  REQUIRE(m.step(1e-3));
  REQUIRE(at.size() == 4);
  for (int k = 0; k < 4; ++k) {
    CHECK(at[k] == 0.0);
    CHECK(speed[k] == 3.0);
    CHECK(hop[k] == Approx(5e-4).epsilon(1e-12));
  }
  // Set once, it stays where it is in all steps after.
  m.set_motion(drive, 6e-4, 0.1);
  REQUIRE(m.run(3e-3, 1e-3));
  CHECK(m.coordinate(rail) == Approx(6e-4).epsilon(1e-12));
}

TEST_CASE("drives that repeat or contradict each other, and those that start off the mark") {
  Machine<VelocityVerlet> m;
  m.gravity = {0, 0, -10.0};
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, Z));
  const MotionId one = m.add_motion(prescribed_joint("one", guide, 0.0));
  const MotionId two = m.add_motion(prescribed_position("two", box, Z, 0.0));
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.motion(one).drive.force == Approx(30.0));  // the earlier one carries the weight
  CHECK(m.motion(two).drive.force == 0.0);
  m.set_motion(two, 2e-4, 0.0);
  REQUIRE(m.run(0.01, 1e-3));
  CHECK(std::abs(m.coordinate(guide)) < 1e-15);
  Machine<VelocityVerlet> off;
  const BodyId door = off.add_body(ball("door"));
  const JointId hinge = off.add_joint(revolute("hinge", off.ground(), door, {0, 0, 0}, Z));
  off.add_motion(prescribed_joint("opener", hinge, Signal::ramp(0.3, 1.0)));
  check_refused([&] { (void)off.step(1e-3); }, "motion 'opener' is 0.3", "starting_at");
  Machine<VelocityVerlet> still;
  const BodyId wall = still.add_fixed_body("wall");
  const JointId gap = still.add_joint(free_joint("gap", still.ground(), wall, {0, 0, 0}, Z));
  check_refused([&] { still.add_motion(prescribed_joint("push", gap, 0.0)); }, "'ground' and 'wall'", "both fixed");
}

TEMPLATE_TEST_CASE("a refused motion leaves a machine as it was", "", PredictorCorrector, VelocityVerlet) {
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), box, {0, 0, 0}, Z));
  REQUIRE(m.run(0.1, 1e-3));
  const double fallen = m.coordinate(guide), speed = m.speed(guide);
  const MotionId lift = m.add_motion(prescribed_joint("lift", guide, 0.0));
  for (int again = 0; again < 2; ++again) {
    check_refused([&] { (void)m.step(1e-3); }, "motion 'lift' is 0.0");
    CHECK(m.coordinate(guide) == fallen);
    CHECK(m.speed(guide) == speed);
    CHECK(m.time() == Approx(0.1));
  }
  // Also one that is added between two steps of a run.
  m.switch_on(lift, false);
  check_refused(
      [&] {
        (void)m.run(0.1, 1e-3, [&] {
          if (m.time() > 0.15) m.switch_on(lift);
        });
      },
      "motion 'lift' is 0.1");
  m.set_motion(lift, m.coordinate(guide));
  REQUIRE(m.run(0.05, 1e-3));
  CHECK(std::abs(m.speed(guide)) < 1e-15);  // set exactly, to rounding
}

TEST_CASE("drives of very unlike inertias are all met, in whatever order they are added") {
  // A gimbal: a yoke of 1e-5 kg m^2 between the ground and an arm of 20 kg m^2, all about one axis. The first drive
  // turns both, the second the arm alone.
  const bool yoke_first = GENERATE(true, false);
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId yoke = m.add_body(ball("yoke", 0.1, 1e-5)), arm = m.add_body(ball("arm", 50.0, 20.0));
  const JointId base = m.add_joint(revolute("base", m.ground(), yoke, {0, 0, 0}, Z));
  const JointId tip = m.add_joint(revolute("tip", yoke, arm, {0, 0, 0}, Z));
  const auto half_t2 = [](double a) {
    return Signal::function([=](double t) { return 0.5 * a * t * t; }, [=](double t) { return a * t; });
  };
  MotionId turn, swing;
  if (yoke_first) turn = m.add_motion(prescribed_joint("turn", base, half_t2(2.0)));
  swing = m.add_motion(prescribed_joint("swing", tip, half_t2(3.0)));
  if (!yoke_first) turn = m.add_motion(prescribed_joint("turn", base, half_t2(2.0)));
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.coordinate(base) == Approx(0.01).epsilon(1e-9));
  CHECK(m.coordinate(tip) == Approx(0.015).epsilon(1e-9));
  CHECK(m.motion(swing).drive.force == Approx(20.0 * 5.0).epsilon(1e-6));
  CHECK(m.motion(turn).drive.force == Approx(20.0 * 5.0 + 1e-5 * 2.0).epsilon(1e-6));
}

TEST_CASE("a drive that contradicts others through joints that give way is left out, not met by tearing them") {
  // The turn of a forearm in space is said once more, 0.5 mrad off from 0.05 s on. The hinges' axes lean by 2e-5 rad
  // under the loads, so the third drive is not exactly a sum of the first two.
  Machine<PredictorCorrector> m;
  const BodyId upper = m.add_body(ball("upper", 4.0).at({0.5, 0, 0})),
               fore = m.add_body(ball("fore", 3.0).at({1.5, 0, 0}));
  const JointId shoulder = m.add_joint(revolute("shoulder", m.ground(), upper, {0, 0, 0}, -Y));
  const JointId elbow = m.add_joint(revolute("elbow", upper, fore, {1, 0, 0}, -Y));
  const JointId gauge = m.add_joint(free_joint("gauge", m.ground(), fore, {1.5, 0, 0}, -Y));
  m.add_load(applied_force("side", upper, {0.5, 0, 0}, Y, 20.0));
  m.add_load(applied_torque("twist", upper, X, 5.0));
  const auto way = [](double t) { return 1.0 - std::cos(2.0 * pi * t); };
  m.add_motion(prescribed_joint("up", shoulder, Signal::function([=](double t) { return 0.3 * way(t); })));
  m.add_motion(prescribed_joint("bend", elbow, Signal::function([=](double t) { return 0.2 * way(t); })));
  const MotionId again = m.add_motion(prescribed_joint(
      "again", gauge, Signal::function([=](double t) { return 0.5 * way(t) + (t > 0.05 ? 5e-4 : 0.0); })));
  double opened = 0.0;
  REQUIRE(m.run(0.3, 1e-4, [&] { opened = std::max(opened, m.violation(elbow).displacement); }));
  CHECK(opened < 1e-4);  // the give of the joints
  CHECK(m.motion(again).drive.force == 0.0);
  CHECK(m.coordinate(gauge) == Approx(0.5 * way(m.time())).epsilon(1e-6));
}

TEST_CASE("the length of a distance joint and a bend cannot be prescribed, and the refusal says what can") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(ball("a").at({1, 0, 0}));
  const JointId rod = m.add_joint(distance("rod", m.ground(), {0, 0, 0}, a, {1, 0, 0}));
  const JointId socket = m.add_joint(spherical("socket", m.ground(), a, {1, 0, 0}));
  check_refused([&] { m.add_motion(prescribed_joint("reel", rod, 1.0)); },
                "'reel' drives the length of a distance joint", "leave the joint out", "prismatic joint");
  check_refused([&] { m.add_motion(prescribed_joint("tilt", socket, 0.0).along(Dof::bend)); }, "'tilt' drives the bend",
                "bend_x and bend_y");
}
