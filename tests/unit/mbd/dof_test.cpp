// The coordinates of joints that have several, or none of their own: read, stopped, driven, coupled, braked.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

/// A universal joint between ground and a shaft, straight along z at assembly, then bent by hand: first about x of the
/// ground's frame, then about y of the body's.
struct Bent {
  Machine<PredictorCorrector> machine;
  BodyId shaft;
  JointId cross;

  Bent(double about_x, double about_y) {
    machine.gravity.setZero();
    shaft = machine.add_body(given_body("shaft", 1.0, Vec3(0.1, 0.1, 0.1)));
    cross = machine.add_joint(universal("cross", machine.ground(), shaft, {0, 0, 0}, Z, Z));
    machine.body(shaft).motion.rotation = from_eigen(Mat3(turn(about_x, X) * turn(about_y, Y)));
  }
};

}  // namespace

TEST_CASE("a universal joint reports the two angles of its cross, their speeds and its bend") {
  for (const double x : {-1.2, -0.3, 0.0, 0.7}) {
    for (const double y : {-0.9, 0.0, 0.4, 1.3}) {
      Bent u(x, y);
      CHECK(u.machine.coordinate(u.cross, Dof::bend_x) == Approx(x).margin(1e-14));
      CHECK(u.machine.coordinate(u.cross, Dof::bend_y) == Approx(y).margin(1e-14));
      // The angle between the shafts: cos = cos x cos y. Near 0 the arc cosine is good to the root of rounding only.
      CHECK(u.machine.coordinate(u.cross, Dof::bend) == Approx(std::acos(std::cos(x) * std::cos(y))).margin(2e-8));
      // Angular velocity 2 about x and 3 about yb: those are the speeds.
      auto& body = u.machine.body(u.shaft);
      const Vec3 yb = turn(x, X) * Y;
      body.motion.angular_velocity = from_eigen(Vec3(body.rotation().transpose() * (2.0 * X + 3.0 * yb)));
      CHECK(u.machine.speed(u.cross, Dof::bend_x) == Approx(2.0).epsilon(1e-13));
      CHECK(u.machine.speed(u.cross, Dof::bend_y) == Approx(3.0).epsilon(1e-13));
    }
  }
}

TEST_CASE("a planar joint and a point on a plane report where they are, along x and y of body a's frame") {
  Machine<PredictorCorrector> m;
  const BodyId puck = m.add_body(brick("puck", {0, 0, 0}));
  const JointId table = m.add_joint(planar("table", m.ground(), puck, {0, 0, 0}, Z));
  m.body(puck).motion.position = {0.3, -0.2, 0};
  m.body(puck).motion.velocity = {1, 2, 0};
  CHECK(m.coordinate(table, Dof::slide_x) == Approx(0.3));
  CHECK(m.coordinate(table, Dof::slide_y) == Approx(-0.2));
  CHECK(m.speed(table, Dof::slide_x) == Approx(1.0));
  CHECK(m.speed(table, Dof::slide_y) == Approx(2.0));
}

TEST_CASE("a distance joint reports its length, and nothing may drive it") {
  Machine<PredictorCorrector> m;
  const BodyId bob = m.add_body(brick("bob", {3, 0, 4}));
  const JointId rod = m.add_joint(distance("rod", m.ground(), {0, 0, 0}, bob, {3, 0, 4}));
  m.body(bob).motion.velocity = {1, 2, 0};
  CHECK(m.coordinate(rod) == Approx(5.0));
  CHECK(m.speed(rod) == Approx(0.6));
  check_refused([&] { m.add_actuator(joint_actuator("ram", rod, 1, 1)); }, "'ram'", "length of a distance joint");
  // Joints without a coordinate of their own say which they have.
  const JointId ball = m.add_joint(spherical("ball", m.ground(), bob, {3, 0, 4}));
  CHECK(m.coordinate(ball, Dof::bend) == Approx(0.0).margin(1e-12));
  check_refused([&] { m.coordinate(ball); }, "'ball'", "name one of its degrees of freedom: bend");
  check_refused([&] { m.speed(rod, Dof::slide); }, "'slide' of a distance joint", "only: length");
}

TEST_CASE("stops hold the slide of a cylindrical joint, the cone of a ball joint and a universal joint's arms") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId rod = m.add_body(brick("rod", {0, 0, 0})),
               ball = m.add_body(given_body("ball", 1.0, Vec3(0.03, 0.03, 0.03)).at({0, 3, 0})),
               shaft = m.add_body(brick("shaft", {0, 6, 0}));
  const JointId sleeve = m.add_joint(
      cylindrical("sleeve", m.ground(), rod, {0, 0, 0}, Z).with_limits(-10.0, 10.0).with_limits(Dof::slide, -0.1, 0.2));
  const JointId socket =
      m.add_joint(spherical("socket", m.ground(), ball, {0, 3, 0}).with_limits(Dof::bend, -1.0, 0.5));
  const JointId cross =
      m.add_joint(universal("cross", m.ground(), shaft, {0, 6, 0}, Z, Z).with_limits(Dof::bend_y, -0.3, 0.4));
  m.add_load(applied_force("push", rod, {0, 0, 0}, Z, 4.0));
  m.add_load(applied_torque("tilt", ball, Vec3(1, 1, 0), 3.0));
  m.add_load(applied_torque("twist", shaft, Y, -2.0));
  REQUIRE(m.run(3.0, 1e-3));
  // At rest against its stop each coordinate is at the limit, less what the load presses into the derived spring, and
  // the stop's force balances the load.
  CHECK(m.coordinate(sleeve, Dof::slide) == Approx(0.2).margin(1e-4));
  CHECK(m.limits(sleeve, Dof::slide)->force == Approx(-4.0).epsilon(1e-3));
  CHECK(m.limits(sleeve)->force == 0.0);
  CHECK(m.coordinate(socket, Dof::bend) == Approx(0.5).margin(1e-3));
  CHECK(m.limits(socket, Dof::bend)->force == Approx(-3.0).epsilon(1e-2));
  CHECK(m.coordinate(cross, Dof::bend_y) == Approx(-0.3).margin(1e-3));
  CHECK(m.limits(cross, Dof::bend_y)->force == Approx(2.0).epsilon(1e-2));
}

TEST_CASE(
    "an actuator drives the slide of a cylindrical joint, and a screw couples it with the turn of the same joint") {
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId nut = m.add_body(given_body("nut", 1.0, Vec3(0.01, 0.01, 0.01)));
  const JointId thread = m.add_joint(cylindrical("thread", m.ground(), nut, {0, 0, 0}, Z));
  const double lead = 0.1;  // m per rad
  const CouplingId coupling = m.add_coupling(screw("screw thread", thread, thread, 2.0 * pi * lead));
  // The nut turns as it slides: its inertia counts as m + J/lead^2 = 2 kg. On 8 N/m with 8 N s/m that is the critically
  // damped oscillator of 2 rad/s, x = 0.05 (1 - (1 + 2 t) exp(-2 t)).
  m.add_actuator(joint_actuator("push", thread, 8.0, 8.0, 0.05).along(Dof::slide));
  REQUIRE(m.run(1.0, 1e-3));
  const double expected = 0.05 * (1.0 - 3.0 * std::exp(-2.0));
  // Half of the push, at most 0.2 N, goes through the screw's spring, which gives way by that over its stiffness.
  const double give = 0.2 / m.coupling(coupling).k;
  CHECK(give < 3e-4 * expected);
  CHECK(m.coordinate(thread, Dof::slide) == Approx(expected).epsilon(1e-3));  // the step adds an error of order dt
  CHECK(m.coordinate(thread) * lead == Approx(m.coordinate(thread, Dof::slide)).margin(give));
}

TEST_CASE("friction brakes the bending of a universal joint") {
  // Moment of inertia 0.1 kg m^2 about any axis, preload 100 N on a radius of 0.02 m, mu 0.5: 1 N m brakes 2 rad/s in
  // 0.2 s over 0.2 rad. No weight; what the joint carries is the centripetal force of a body at the joint's point:
  // none.
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId shaft = m.add_body(given_body("shaft", 1.0, Vec3(0.1, 0.1, 0.1)));
  const JointId cross = m.add_joint(universal("cross", m.ground(), shaft, {0, 0, 0}, Z, Z)
                                        .with_friction({.coefficient = 0.5, .radius = 0.02, .preload = 100.0}));
  m.body(shaft).motion.angular_velocity = {2.0, 0, 0};
  REQUIRE(m.run(0.1, 1e-4));
  CHECK(m.speed(cross, Dof::bend_x) == Approx(1.0).epsilon(0.01));  // the spring takes some steps to build up
  REQUIRE(m.run(0.4, 1e-4));
  CHECK(std::abs(m.speed(cross, Dof::bend_x)) < 0.01);
  CHECK(m.coordinate(cross, Dof::bend_x) == Approx(0.2).epsilon(0.02));
}

TEST_CASE("friction is stable in each of its directions, and a bushing's damper without a spring is no stiff one") {
  // A sleeve of 1 mm radius on a body that is 0.1 m large: what is soft for its turning is stiff for its sliding, which
  // the derived spring has to know. A kick along and about the axis dies away.
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId rod = m.add_body(given_body("rod", 1.0, Vec3(0.01, 0.01, 0.01)).moving({0, 0, 0.02}, {0, 0, 0.3}));
  const JointId sleeve = m.add_joint(cylindrical("sleeve", m.ground(), rod, {0, 0, 0}, Z)
                                         .with_friction({.coefficient = 0.3, .radius = 1e-3, .preload = 10.0}));
  REQUIRE(m.run(2.0, 1e-3));
  CHECK(std::abs(m.coordinate(sleeve, Dof::slide)) < 0.02);
  CHECK(std::abs(m.speed(sleeve, Dof::slide)) < 1e-3);

  // A damper of 10 N s/m on 1 kg needs steps below 2 m/c = 0.2 s, with or without a spring beside it.
  Machine<SymplecticEuler> soft;
  const BodyId block = soft.add_body(brick("block", {0, 0, 0}));
  soft.add_joint(bushing("mount", soft.ground(), block, {0, 0, 0}, Z, {100, 0, 0}, {0, 10, 0}, {0, 0, 0}, {0, 0, 0}));
  CHECK(soft.stable_time_step().dt > 0.05);
  CHECK(soft.stable_time_step().dt <= 0.21);
  CHECK_THAT(message_of([&] {
               soft.add_joint(
                   bushing("bad", soft.ground(), block, {0, 0, 0}, Z, {100, 0, 0}, {0, -1, 0}, {0, 0, 0}, {0, 0, 0}));
             }),
             Contains("is -1"));
}

TEST_CASE("the turn of a bent free joint has the speed at which it changes") {
  // A wheel that spins, steers and nods: the turn's rate by central differences over 2e-5 s, with an error of
  // (w dt)^2/6 = 3e-8 of w.
  for (const double bend : {0.0, 10.0, 30.0, 60.0, 120.0}) {
    INFO(bend << " degrees");
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const Mat3 steered = Eigen::AngleAxisd(bend * pi / 180, X).toRotationMatrix();
    const Vec3 spin = steered * Vec3(0, 0, 20) + Vec3(0, 3, 0) + Vec3(2, 0, 0);
    const BodyId wheel = m.add_body(ball("wheel").at({0, 0, 0}, steered).moving({0, 0, 0}, spin));
    // The joint's axis on the wheel is the wheel's own: assembled straight in the reference pose.
    const JointId gauge = m.add_joint(free_joint("gauge", m.ground(), wheel, {0, 0, 0}, Z));
    m.parts().joints[gauge.index()].axes_b = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    REQUIRE(m.step(1e-5));
    const double before = m.coordinate(gauge);
    REQUIRE(m.step(1e-5));
    const double speed = m.speed(gauge);
    REQUIRE(m.step(1e-5));
    CHECK(speed == Approx((m.coordinate(gauge) - before) / 2e-5).epsilon(1e-6));
    if (bend > 0.0 && bend < 90.0) {
      Machine<PredictorCorrector> steady;
      steady.gravity.setZero();
      const BodyId disc =
          steady.add_body(ball("disc").at({0, 0, 0}, steered).moving({0, 0, 0}, steered * Vec3(0, 0, 100)));
      const JointId count = steady.add_joint(free_joint("count", steady.ground(), disc, {0, 0, 0}, Z));
      steady.parts().joints[count.index()].axes_b = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      const double start = steady.coordinate(count);
      REQUIRE(steady.run(10.0, 1e-3));
      // About its own axis, at a steady bend: the turn is its spin, and no whole turn is lost.
      CHECK(steady.coordinate(count) - start == Approx(1000.0).epsilon(1e-6));
    }
  }
}
