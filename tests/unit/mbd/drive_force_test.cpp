// The forces that drives put on their bodies, and report.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("a joint's drive moves its body a where b is fixed", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  // The coordinate is that of the ground seen from the box, so the box goes the other way, and a force that makes the
  // coordinate grow pushes the box back.
  Machine<TestType> m;
  const BodyId box = m.add_body(ball("box", 3.0)), crank = m.add_body(ball("crank", 2.0, 0.3).at({0.5, 3, 0}));
  const JointId guide = m.add_joint(prismatic("guide", box, m.ground(), {0, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", guide, Signal::sine(0.01, 2.0)));
  const JointId hinge = m.add_joint(revolute("hinge", crank, m.ground(), {0, 3, 0}, Y));
  const MotionId turn = m.add_motion(prescribed_joint("turn", hinge, Signal::smooth_step(0.0, 1.0, 0.0, 0.5)));
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  for (int k = 0; k < 3000; ++k) REQUIRE(m.step(dt));
  const double t = m.time(), middle = t - dt / 2;
  CHECK(m.coordinate(guide) == Approx(0.01 * std::sin(w * t)).epsilon(1e-12));
  // The axis is the box's, which tilts and sags in its guide by 1e-6: of second order.
  CHECK(m.body(box).position().x() == Approx(-0.01 * std::sin(w * t)).epsilon(1e-9));
  CHECK(m.motion(drive).drive.force == Approx(-3.0 * 0.01 * w * w * std::sin(w * middle)).epsilon(1e-3));
  CHECK((m.body(m.ground()).position()).norm() == 0.0);
  // The crank, I = 0.3 + 2 0.5^2 about the hinge, turns by -angle about Y; its weight m g r cos(angle) pulls it towards
  // +Y, that is against the coordinate.
  const double s = middle / 0.5, angle = s * s * s * (10 - s * (15 - 6 * s));
  const double acceleration = 60.0 * s * (1 - s) * (1 - 2 * s) / 0.25;
  const double inertial = (0.3 + 2.0 * 0.25) * acceleration, weight = 2.0 * 9.81 * 0.5 * std::cos(angle);
  // The hinge pulls the centre of mass along less than a step late, and the torque changes by 550 N m/s.
  CHECK(m.motion(turn).drive.force == Approx(inertial + weight).margin(550.0 * dt));
}

TEMPLATE_TEST_CASE("a drive between two free bodies pushes both, and keeps momentum", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const double dt = 1e-4, w = 2.0 * pi * 2.0;
  // 3 kg and 1 kg on a slide: the coordinate is shared as 1 : 3. The drive carries the reduced mass of 3/4 kg.
  const BodyId a = m.add_body(ball("a", 3.0)), b = m.add_body(ball("b", 1.0).at({0.2, 0, 0}));
  const JointId slide = m.add_joint(prismatic("slide", a, b, {0.1, 0, 0}, X));
  const MotionId drive = m.add_motion(prescribed_joint("drive", slide, Signal::sine(0.01, 2.0)));
  // 0.3 and 0.1 kg m^2 on a hinge.
  const BodyId c = m.add_body(ball("c", 1.0, 0.3).at({0, 3, 0})), d = m.add_body(ball("d", 1.0, 0.1).at({0, 3, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", c, d, {0, 3, 0}, Z));
  m.add_motion(prescribed_joint("turn", hinge, Signal::ramp(0.0, 2.0)));
  // An arm swung about a hinge that is off both centres of mass, which wobbles about all axes.
  const BodyId e = m.add_body(brick("e", {0, 6, 0}, 2.0)), f = m.add_body(brick("f", {0.3, 6.1, 0.2}, 1.0));
  const JointId wrist = m.add_joint(revolute("wrist", e, f, {0.1, 6, 0.05}, Vec3(1, 2, 3)));
  m.add_motion(prescribed_joint("swing", wrist, Signal::smooth_step(0.0, 1.0, 0.0, 0.3)));
  REQUIRE(m.run(0.3, dt));
  const double t = m.time(), q = 0.01 * std::sin(w * t);
  CHECK(m.coordinate(slide) == Approx(q).epsilon(1e-12));
  CHECK(m.body(a).position().x() == Approx(-q / 4).epsilon(1e-9));
  CHECK(m.body(b).position().x() == Approx(0.2 + 0.75 * q).epsilon(1e-9));
  CHECK(m.motion(drive).drive.force == Approx(-0.75 * 0.01 * w * w * std::sin(w * (t - dt / 2))).epsilon(1e-3));
  CHECK(m.coordinate(hinge) == Approx(2.0 * t).epsilon(1e-12));
  CHECK(m.body(c).angular_velocity().z() == Approx(-0.5).epsilon(1e-9));
  CHECK(m.body(d).angular_velocity().z() == Approx(1.5).epsilon(1e-9));
  CHECK(m.coordinate(wrist) == Approx(1.0).epsilon(1e-9));
  const Body &body_e = m.body(e), &body_f = m.body(f);
  CHECK((body_e.mass * body_e.velocity() + body_f.mass * body_f.velocity()).norm() < 1e-12);
  // Angular momentum to first order in dt, of terms of order 0.04 kg m^2 5 rad/s: they pass through it and come to
  // rest.
  CHECK((angular_momentum(body_e) + angular_momentum(body_f)).norm() < 1e-4);
  CHECK(m.violation(wrist).displacement < 1e-4);
}

TEST_CASE("a drive on a driven carrier counts the carrier's acceleration") {
  // The carrier of a lift falls with 3 m/s^2 while the cage is held still in it: the drive feels m (g - 3).
  Machine<PredictorCorrector> m;
  const BodyId carrier = m.add_body(ball("carrier", 5.0)), cage = m.add_body(ball("cage", 2.0));
  const JointId rail = m.add_joint(prismatic("rail", m.ground(), carrier, {0, 0, 0}, Z));
  const JointId guide = m.add_joint(prismatic("guide", carrier, cage, {0, 0, 0}, Z));
  const auto fall = [](double t) { return -1.5 * t * t; };
  const MotionId falls =
      m.add_motion(prescribed_joint("fall", rail, Signal::function(fall, [](double t) { return -3.0 * t; })));
  const MotionId hold = m.add_motion(prescribed_joint("hold", guide, 0.0));
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.body(cage).position().z() == Approx(-1.5 * 0.25));
  CHECK(m.motion(hold).drive.force == Approx(2.0 * (9.81 - 3.0)).epsilon(1e-9));
  CHECK(m.motion(falls).drive.force == Approx(7.0 * (9.81 - 3.0)).epsilon(1e-9));  // it carries both
}

TEMPLATE_TEST_CASE("drives of an arm carry what hangs on them, in whatever order they are added", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // Two links of 1 m, held still at 30 and 75 degrees above the horizontal. Statics: the elbow carries the forearm's
  // weight at half its length, the shoulder both weights. The joints sag by m g / k, some 1e-6 m.
  const bool shoulder_first = GENERATE(true, false);
  const double q1 = pi / 6, q2 = 5 * pi / 12;
  const Vec3 elbow_at(std::cos(q1), 0, std::sin(q1)), hand = elbow_at + Vec3(std::cos(q2), 0, std::sin(q2));
  Machine<TestType> m;
  const BodyId upper = m.add_body(ball("upper", 4.0).at(0.5 * elbow_at));
  const BodyId fore = m.add_body(ball("fore", 3.0).at(0.5 * (elbow_at + hand)));
  const JointId shoulder = m.add_joint(revolute("shoulder", m.ground(), upper, {0, 0, 0}, -Y));
  const JointId elbow = m.add_joint(revolute("elbow", upper, fore, elbow_at, -Y));
  MotionId up, bend;
  if (shoulder_first) up = m.add_motion(prescribed_joint("up", shoulder, 0.0));
  bend = m.add_motion(prescribed_joint("bend", elbow, 0.0));
  if (!shoulder_first) up = m.add_motion(prescribed_joint("up", shoulder, 0.0));
  REQUIRE(m.run(0.5, 1e-4));
  const double g = 9.81, at_elbow = 3.0 * g * 0.5 * std::cos(q2);
  CHECK(m.motion(bend).drive.force == Approx(at_elbow).epsilon(1e-4));
  CHECK(m.motion(up).drive.force == Approx(at_elbow + (4.0 * 0.5 + 3.0) * g * std::cos(q1)).epsilon(1e-4));
  CHECK(std::abs(m.coordinate(shoulder)) < 1e-14);
  CHECK(std::abs(m.coordinate(elbow)) < 1e-14);
  CHECK(m.reaction(shoulder).force.z == Approx(7.0 * g).epsilon(1e-4));
  // A drive that is switched off carries nothing: the arm falls, and only the elbow is still held.
  m.switch_on(up, false);
  REQUIRE(m.run(0.05, 1e-4));
  CHECK(m.motion(up).drive.force == 0.0);
  CHECK(m.coordinate(shoulder) < -1e-3);
  CHECK(std::abs(m.coordinate(elbow)) < 1e-14);
}

TEMPLATE_TEST_CASE("a drive pulls where the joint is, and leaves the body free to turn", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  const double g = 9.81, a = 4.0;
  const auto speeding_up = Signal::function([=](double t) { return 0.5 * a * t * t; }, [=](double t) { return a * t; });
  SECTION("a pendulum on a rail hangs at atan(a / g) while the rail drives it with a constant acceleration") {
    const double tilt = std::atan2(a, g), length = 0.4;
    Machine<TestType> m;
    const BodyId bob = m.add_body(ball("bob", 2.0, 0.01).at(length * Vec3(-std::sin(tilt), 0, -std::cos(tilt))));
    const JointId rail = m.add_joint(joint(JointKind::point_on_line, "rail", m.ground(), bob, {0, 0, 0}, X));
    const MotionId drive = m.add_motion(prescribed_joint("drive", rail, speeding_up));
    REQUIRE(m.run(1.0, 1e-4));
    CHECK(m.coordinate(rail) == Approx(0.5 * a).epsilon(1e-12));
    // It starts with the rail unloaded: the sag, m g / k = 1e-5 m, makes it swing by sqrt(2 g sag) / l / 5 rad/s.
    CHECK((m.body(bob).rotation() - Mat3::Identity()).norm() < 5e-3);
    CHECK(m.motion(drive).drive.force == Approx(2.0 * a).epsilon(2e-2));
  }
  SECTION("a plate in a plane, pulled beside its centre of mass") {
    // F (1/m + r^2/I) = a at the start; the plate turns by 1e-3 rad in 0.01 s.
    const double r = 0.3, inertia = 0.1;
    Machine<TestType> m;
    m.gravity.setZero();
    const BodyId plate = m.add_body(ball("plate", 2.0, inertia));
    JointSpec in_plane = joint(JointKind::planar, "floor", m.ground(), plate, {0, r, 0}, Z);
    const JointId floor = m.add_joint(in_plane.with_x(X));
    const MotionId pull = m.add_motion(prescribed_joint("pull", floor, speeding_up).along(Dof::slide_x));
    REQUIRE(m.run(0.01, 1e-5));
    const double force = a / (1.0 / 2.0 + r * r / inertia);
    CHECK(m.motion(pull).drive.force == Approx(force).epsilon(1e-3));
    CHECK(m.body(plate).velocity().x() == Approx(force / 2.0 * 0.01).epsilon(1e-3));
    CHECK(m.body(plate).angular_velocity().z() == Approx(-force * r / inertia * 0.01).epsilon(1e-3));
    CHECK(m.coordinate(floor, Dof::slide_x) == Approx(0.5 * a * 1e-4).epsilon(1e-12));
  }
}

TEST_CASE("a carriage that is driven in one direction feels the drives of what it carries") {
  // The carriage goes up with 2 m/s^2 and hangs on a spring beside; its arm is swung about the upright axis, and the
  // carriage, free to turn, turns back.
  Machine<VelocityVerlet> m;
  const BodyId carriage = m.add_body(ball("carriage", 5.0, 0.3)), arm = m.add_body(ball("arm", 1.0, 0.1));
  const JointId axle = m.add_joint(revolute("axle", carriage, arm, {0, 0, 0}, Z));
  const MotionId lift =
      m.add_motion(prescribed_position("lift", carriage, Z, Signal::function([](double t) { return t * t; })));
  m.add_motion(prescribed_joint("swing", axle, Signal::smooth_step(0.0, 1.0, 0.0, 0.3)));
  REQUIRE(m.run(0.2, 1e-4));
  const double turned = -0.25 * m.coordinate(axle);  // 0.3 and 0.1 kg m^2 share the swing
  CHECK(m.body(carriage).rotation()(1, 0) == Approx(std::sin(turned)).epsilon(1e-6));
  CHECK(m.body(carriage).position().z() == Approx(0.04).epsilon(1e-12));
  CHECK(m.motion(lift).drive.force == Approx(6.0 * (9.81 + 2.0)).epsilon(1e-3));
}
