#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("prescribed positions, turns and poses") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(ball("a").at({1, 2, 3}));
  const BodyId wheel = m.add_body(ball("wheel").at({5, 0, 0}));
  const BodyId wall = m.add_fixed_body("wall");
  const BodyId flyer = m.add_fixed_body("flyer");
  const MotionId lift = m.add_motion(prescribed_position("lift", a, Z, 0.0));
  m.add_motion(prescribed_position("push", wall, X, Signal::ramp(0.0, 0.5)));
  m.add_motion(prescribed_rotation("spin", wheel, Y, Signal::ramp(0.0, 3.0)));
  m.add_motion(prescribed_pose(
      "fly", flyer, [](double t) { return Pose{.position = Vec3(t, t * t, 0), .velocity = Vec3(1, 2 * t, 0)}; }));
  REQUIRE(m.run(1.0, 1e-3));
  CHECK(m.body(a).position().z() == 3.0);
  CHECK(m.body(a).velocity().z() == 0.0);
  CHECK(m.motion(lift).drive.force == Approx(9.81).epsilon(1e-9));  // it holds the weight
  CHECK(m.body(wall).position().x() == Approx(0.5));
  CHECK(m.body(wall).velocity().x() == Approx(0.5));
  CHECK((m.body(wheel).rotation() - Eigen::AngleAxisd(3.0, Y).toRotationMatrix()).norm() < 1e-9);
  CHECK((m.body(wheel).angular_velocity() - 3.0 * Y).norm() < 1e-12);
  CHECK((m.body(flyer).position() - Vec3(1, 1, 0)).norm() < 1e-9);
  m.switch_on(lift, false);
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.body(a).velocity().z() == Approx(-0.981).epsilon(1e-2));
  CHECK(m.motion(lift).drive.force == 0.0);
  check_refused(
      [&] {
        m.switch_on(lift);
        (void)m.step(1e-3);
      },
      "motion 'lift' is 0.0", "let its signal start there");
  // Switched on where it is, it takes the fall out of the body within one step.
  const double speed = m.body(a).velocity().z();
  m.set_motion(lift, m.body(a).position().z() - 3.0);
  REQUIRE(m.step(1e-3));
  CHECK(m.motion(lift).drive.force == Approx(-speed / 1e-3 + 9.81).epsilon(1e-9));
}

TEST_CASE("a prescribed pose that gives no velocities has those of its motion") {
  // On a circle of 0.5 m with 2 rad/s, turning with it about an axis that leans.
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  const auto pose = [&](double t) {
    return Pose{.position = 0.5 * Vec3(std::cos(2 * t), std::sin(2 * t), 0),
                .rotation = Eigen::AngleAxisd(2 * t, axis).toRotationMatrix()};
  };
  Machine<PredictorCorrector> m;
  const BodyId arm = m.add_body(ball("arm").at({0.5, 0, 0}));
  const MotionId drive = m.add_motion(prescribed_pose("fly", arm, pose));
  REQUIRE(m.run(0.3, 1e-3));
  const double t = m.time();
  // Central differences of 1e-16 m over 2e-6 s: rounding of 1e-10 m/s.
  CHECK((m.body(arm).velocity() - Vec3(-std::sin(2 * t), std::cos(2 * t), 0)).norm() < 1e-9);
  CHECK((m.body(arm).angular_velocity() - 2 * axis).norm() < 1e-9);
  // What is given counts, and no signal takes a pose's place.
  check_refused([&] { m.set_motion(drive, 0.0); }, "'fly' is a whole pose", "set_pose");
  check_refused([&] { m.set_motion(drive, 0.0, 0.0); }, "'fly' is a whole pose");
  const Vec3 here = m.body(arm).position();
  const Mat3 turned = m.body(arm).rotation();
  m.set_pose(drive, [=](double) { return Pose{.position = here, .rotation = turned, .velocity = Vec3(7, 0, 0)}; });
  REQUIRE(m.step(1e-3));
  CHECK(m.body(arm).velocity().x() == 7.0);
  CHECK(m.body(arm).angular_velocity().norm() < 1e-9);
  m.set_pose(drive, [=](double) { return Pose{.position = here + X, .rotation = turned}; });
  check_refused([&] { (void)m.step(1e-3); }, "'fly' is 1 m or rad off");
  CHECK((m.body(arm).position() - here).norm() == 0.0);
}

TEMPLATE_TEST_CASE("a pose is that of the frame in which a body was drawn, or of its principal axes", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  // A bracket whose centre of mass is off the origin of its drawing and whose axes lean in it.
  const Mat3 lean = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 tensor = lean * Vec3(0.1, 0.15, 0.2).asDiagonal() * lean.transpose();
  const Vec3 centre(0.1, -0.2, 0.3), start(1, 2, 3);
  const auto turned = [](double t) { return Mat3(Eigen::AngleAxisd(2.0 * t, Y).toRotationMatrix()); };
  const auto drawing = [=](double t) { return Pose{.position = start + t * X, .rotation = turned(t)}; };
  const bool given = GENERATE(true, false);
  Machine<TestType> m;
  const BodyId bracket = m.add_body(given_body("bracket", 2.0, tensor, centre).at(start));
  m.add_motion(prescribed_pose("fly", bracket, [=](double t) {
    Pose pose = drawing(t);
    if (given) pose.velocity = X;
    if (given) pose.angular_velocity = 2.0 * Y;
    return pose;
  }));
  // The same, of the frame in the centre of mass.
  const BodyId other = m.add_body(given_body("other", 2.0, tensor, centre).at(start));
  const Mat3 axes = m.reference_rotation(other).transpose() * m.body(other).rotation();
  const auto principal = [=](double t) {
    const Pose pose = drawing(t);
    return Pose{.position = pose.position + pose.rotation * centre, .rotation = pose.rotation * axes};
  };
  m.add_motion(prescribed_pose("fly too", other, principal, dem::BodyFrame::principal));
  REQUIRE(m.run(0.3, 1e-3));
  const double t = m.time();
  for (const BodyId b : {bracket, other}) {
    CHECK((m.reference_position(b) - (start + t * X)).norm() < 1e-12);
    CHECK((m.reference_rotation(b) - turned(t)).norm() < 1e-12);
    CHECK((m.body(b).position() - (start + t * X + turned(t) * centre)).norm() < 1e-12);
    // Central differences of 1e-16 m over 2e-6 s: rounding of 1e-10 m/s.
    CHECK((m.body(b).velocity() - (X + 2.0 * Y.cross(turned(t) * centre))).norm() < 1e-9);
    CHECK((m.body(b).angular_velocity() - 2.0 * Y).norm() < 1e-9);
  }
}

TEST_CASE("a pose in the wrong frame is refused with both frames named") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(given_body("b", 1.0, Vec3(0.1, 0.1, 0.1), {0.2, 0, 0}).at({1, 0, 0}));
  m.add_motion(prescribed_pose("fly", b, [](double) { return Pose{.position = Vec3(1.2, 0, 0)}; }));
  check_refused([&] { (void)m.step(1e-3); }, "'fly' is 0.2 m or rad off", "pose of the body's reference frame",
                "MotionSpec::frame");
}
