// Where the energy of a machine goes.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

/// A crank that is driven, a wheel geared to it, a block on a spring with a damper, a pendulum on a bushing that runs
/// into a stop, and a wheel that slips against a clutch.
template <class I>
struct Works : Machine<I> {
  Works() {
    Machine<I>& m = *this;
    const BodyId crank = m.add_body(ball("crank", 2.0, 0.05).moving(Vec3::Zero(), {0, 5.0, 0}));
    const BodyId wheel = m.add_body(ball("wheel", 2.0, 0.2).at({1, 0, 0}).moving(Vec3::Zero(), {0, -2.5, 0}));
    const JointId c = m.add_joint(revolute("crank", m.ground(), crank, {0, 0, 0}, Y));
    const JointId w = m.add_joint(revolute("wheel", m.ground(), wheel, {1, 0, 0}, Y));
    m.add_coupling(gear("gear", c, w, -0.5));
    m.add_actuator(joint_actuator("motor", c, 30.0, 0.2, Signal::sine(1.0, 2.0, 0.0, 0.5)));
    const BodyId disc = m.add_body(ball("disc", 1.0, 0.05).at({1, 0.5, 0}));
    m.add_joint(revolute("disc", m.ground(), disc, {1, 0.5, 0}, Y));
    m.add_clutch(clutch("clutch", wheel, disc, {1, 0.25, 0}, Y, 0.15));

    const BodyId block = m.add_body(ball("block", 4.0).at({0, 0, -1}));
    m.add_joint(prismatic("guide", m.ground(), block, {0, 0, -1}, Z));
    m.add_spring(spring("spring", m.ground(), {0, 0, 0}, block, {0, 0, -1}, 900.0, 6.0));
    m.add_load(applied_force("push", block, {0, 0, -1}, X + Z, Signal::sine(15.0, 3.0)));

    const BodyId bob = m.add_body(ball("bob", 1.5, 0.01).at({3.4, 0, 0}));
    const BodyId post = m.add_body(ball("post", 5.0, 0.5).at({3, 0, 0}));
    m.add_joint(bushing("rubber", m.ground(), post, {3, 0, 0}, Z, Vec3(4e4, 4e4, 4e4), Vec3(20, 20, 20),
                        Vec3(900, 900, 900), Vec3(2, 2, 2)));
    m.add_joint(revolute("hinge", post, bob, {3, 0, 0}, Y)
                    .with_limits(JointLimits{.lower = -1.0, .upper = 1.2, .stiffness = 3e3, .damping = 5.0})
                    .with_friction({.coefficient = 0.05, .radius = 0.02}));
  }
};

}  // namespace

TEMPLATE_TEST_CASE("the energy balance of a machine closes, and the better the smaller the step is", "",
                   PredictorCorrector, VelocityVerlet) {
  double error[2], turned_over = 0.0;
  for (const int fine : {0, 1}) {
    const double dt = fine ? 1e-4 : 2e-4;
    Works<TestType> m;
    m.joint_tolerance = 1.0;  // m: what goes into joints is counted, however far they give way
    m.design_for(dt);
    m.initialise(0.0, m.gravity);
    EnergyBalance balance(m, m.gravity);
    const double kinetic = balance.energy().kinetic;
    double worst = 0.0;
    REQUIRE(m.run(1.5, dt, [&] {
      balance.follow(m.time());
      worst = std::max(worst, std::abs(balance.error()));
    }));
    error[fine] = worst;
    // Everything took part: joules went into heat, springs, and came from the motor and the load.
    const Energy e = balance.energy();
    CHECK(balance.heat() > 1.0);
    CHECK(std::abs(balance.work_of_drives()) > 0.5);
    CHECK(std::abs(balance.work_of_loads()) > 0.05);
    CHECK(e.springs > 1e-3);
    turned_over = balance.heat() + std::abs(balance.work_of_drives()) + kinetic;
  }
  // Velocity Verlet shows dampers the speed of half a step before, which is a share omega dt/2 of their power: at 1e-4
  // s up to 1e-3 on the stop and the rubber, some 50 to 150 rad/s, which take half of the joules.
  CHECK(error[1] < 5e-4 * turned_over);
  CHECK(error[1] < 0.75 * error[0]);
}

TEMPLATE_TEST_CASE("contacts count by their work, prescribed motions by that of their drives", "", PredictorCorrector,
                   VelocityVerlet) {
  // A ball that bounces on a floor which takes energy from it, and a body whose pose is prescribed.
  InWorld<TestType> w;
  const double k = 1e4, c = 5.0, dt = 1e-4;
  const BodyId ball_id = w.m.add_body(ball("ball", 1.0).at({0, 0, 0.3}));
  const BodyId shaker = w.m.add_body(ball("shaker", 2.0).at({2, 0, 0}));
  w.m.add_motion(prescribed_pose("shake", shaker, [](double t) {
    return Pose{.position = {2.0 + 0.05 * std::sin(20 * t), 0, 0}, .velocity = Vec3(std::cos(20 * t), 0, 0)};
  }));
  const BodyId load = w.m.add_body(ball("load", 1.0).at({3, 0, 0}));
  w.m.add_spring(spring("link", shaker, {2, 0, 0}, load, {3, 0, 0}, 300.0, 1.0));
  w.m.add_joint(prismatic("rail", w.m.ground(), load, {3, 0, 0}, X));
  const BodyId driven = w.m.add_body(ball("driven", 1.0, 0.3).at({0, 4, 0}).moving(Vec3::Zero(), {0, 0, 6.0}));
  const JointId axle = w.m.add_joint(revolute("axle", w.m.ground(), driven, {0, 4, 0}, Z));
  w.m.add_motion(prescribed_speed("drive", axle, Signal::ramp(6.0, 2.0)));
  w.m.add_load(applied_torque("brake", driven, Z, -4.0));
  const Vec3 g(0, 0, -9.81);
  w.start(dt, g);
  EnergyBalance balance(w.m, g);
  const auto floor = [&] {
    Body& b = w.m.body(ball_id);
    if (b.motion.position.z < 0.0) b.force.z += -k * b.motion.position.z - c * b.motion.velocity.z;
  };
  double worst = 0.0;
  for (int i = 0; i < 10000; ++i) {
    w.step(dt, g, floor);
    balance.follow(w.solver.time());
    worst = std::max(worst, std::abs(balance.error()));
  }
  CHECK(balance.work_of_contacts() < -0.3);  // what the floor took
  CHECK(balance.work_of_loads() == Approx(-4.0 * 7.0).epsilon(1e-3));
  CHECK(balance.work_of_drives() > 28.0);
  // Where the ball meets the floor or leaves it, the damper's 12 N at 2.4 m/s set in within a step: half a step of
  // their power, 1.4 mJ, at each of four bounces.
  CHECK(worst < 4 * 0.5 * 12 * 2.4 * dt);
}

TEMPLATE_TEST_CASE("a driven hinge beside the centre of mass stands under load, and makes no heat", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // An arm of 10 kg turns at 0.5 rad/s about its end, against 100 N m: 95 J go through the drive. What the hinge gives
  // way by, F/k with F = m r w^2, turns with the arm. Symplectic Euler has the speeds of half a step before, r w^2 dt/2
  // off. A drive that turned the arm about another point than its load does would leave r T dt/(2 I) = 0.03 m/s, which
  // its damper takes 1.4 J for.
  Machine<TestType> m;
  m.joint_tolerance = 1.0;  // m: the step stays as it is
  m.gravity.setZero();
  const double dt = 1e-3, r = 0.5, speed = 0.5;
  const BodyId arm =
      m.add_body(box_body("arm", {1, 0.1, 0.1}, 1000).at({r, 0, 0}).moving({0, r * speed, 0}, {0, 0, speed}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 0, 0}, Z));
  m.add_motion(prescribed_joint("turn", hinge, Signal::ramp(0.0, speed)));
  m.add_load(applied_torque("load", arm, Z, Signal::ramp(0.0, 500.0, 0.0, 0.2)));
  REQUIRE(m.step(dt));
  EnergyBalance balance(m, m.gravity, m.time());
  double fastest = 0.0;
  REQUIRE(m.run(2.0, dt, [&] {
    balance.follow(m.time());
    if (m.time() > 1.5) fastest = std::max(fastest, m.body(arm).point_velocity(-r * X).norm());
  }));
  const double behind = std::is_same_v<TestType, SymplecticEuler> ? 0.5 * r * speed * speed * dt : 0.0;
  CHECK(fastest < behind + 2.0 * 10.0 * r * speed * speed / m.joint(hinge).k * speed);
  CHECK(balance.work_of_loads() == Approx(100.0 * speed * 1.9).epsilon(2e-3));  // to a step in 2 s
  CHECK(balance.heat() < 1e-6 * balance.work_of_loads());
  // Symplectic Euler's drive has its mean force half a step late: half of 50 W in a step.
  CHECK(std::abs(balance.error()) < (behind > 0.0 ? 0.51 * 50.0 * dt : 1e-5));
}

TEST_CASE("springs from tables store what was put into them") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(ball("b").at({0, 0, 1}));
  // Free at 1.5 m, 100 N/m until 0.5 m shorter, then 1000 N/m.
  m.add_spring(spring_table("s", m.ground(), {0, 0, 0}, b, {0, 0, 1}, 1.5, {{0.0, 0.0}, {0.5, 50.0}, {1.0, 550.0}}));
  m.add_spring(spring("l", m.ground(), {1, 0, 0}, b, {0, 0, 1}, 200.0, 0.0, 3.0));
  const double l = std::sqrt(2.0);
  CHECK(energy_of(m.parts(), Vec3::Zero()).springs == Approx(12.5 + 100.0 * (3.0 - l) * (3.0 - l)));
  m.body(b).motion.position = {0, 0, 0.6};
  const double l2 = std::sqrt(1.36);
  CHECK(energy_of(m.parts(), Vec3::Zero()).springs ==
        Approx(12.5 + 0.4 * 0.5 * (50.0 + 450.0) + 100.0 * (3.0 - l2) * (3.0 - l2)));
}
