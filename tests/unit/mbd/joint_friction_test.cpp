#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("joint friction: sticks below its limit, slides with it, and stops a wheel on time") {
  const double mu = 0.3;
  for (const double slope : {0.25, 0.4}) {  // tan of the incline, below and above mu
    Machine<PredictorCorrector> m;
    const double angle = std::atan(slope);
    m.gravity = 9.81 * Vec3(std::sin(angle), 0, -std::cos(angle));
    const BodyId cart = m.add_body(given_body("cart", 2.0, Vec3(0.1, 0.1, 0.1)));
    const JointId guide =
        m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X).with_friction({.coefficient = mu}));
    REQUIRE(m.run(1.0, 1e-4));
    if (slope < mu) {
      CHECK(std::abs(m.coordinate(guide)) < 1e-4);
      CHECK(m.friction(guide)->force.x == Approx(-2.0 * 9.81 * std::sin(angle)).epsilon(1e-3));
    } else {
      const double a = 9.81 * (std::sin(angle) - mu * std::cos(angle));
      CHECK(m.speed(guide) == Approx(a).epsilon(5e-3));  // the start, while friction builds up, is not Coulomb's
    }
  }
  // A wheel of 2 kg m^2 at 10 rad/s on a bearing of 0.05 m under 40 kg: mu m g r = 5.886 N m stops it in 3.398 s.
  Machine<SymplecticEuler> m;
  const BodyId wheel = m.add_body(given_body("wheel", 40.0, Vec3(1.5, 2.0, 1.5)).moving(Vec3::Zero(), {0, 10, 0}));
  const JointId axle =
      m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Y).with_friction({.coefficient = mu, .radius = 0.05}));
  const double torque = mu * 40.0 * 9.81 * 0.05;
  REQUIRE(m.run(2.0, 1e-4));
  CHECK(m.speed(axle) == Approx(10.0 - torque / 2.0 * 2.0).epsilon(1e-3));
  REQUIRE(m.run(2.0, 1e-4));
  CHECK(std::abs(m.speed(axle)) < 1e-3);
  // A brake is a preload: with 1000 N more on top of the 392 N of weight it is 3.5 times as strong; a
  // torque below its limit, 20.9 N m, moves nothing.
  m.set_friction_preload(axle, 1000.0);
  m.add_load(applied_torque("drive", wheel, Y, 15.0));
  REQUIRE(m.run(1.0, 1e-4));
  CHECK(std::abs(m.speed(axle)) < 1e-3);
}

TEST_CASE("friction stops what slides on a plane or along a line, and what turns in a ball joint") {
  // 2 m/s under mu g: a way of v^2 / (2 mu g) in the direction of the start, at rest after v / (mu g) = 0.68 s.
  const double mu = 0.3, speed = 2.0, way = speed * speed / (2.0 * mu * 9.81);
  for (const JointKind kind : {JointKind::planar, JointKind::point_on_plane, JointKind::point_on_line}) {
    INFO(name_of(kind));
    const bool on_line = kind == JointKind::point_on_line;
    const Vec3 along = on_line ? X : Vec3(0.6, 0.8, 0.0);
    Machine<PredictorCorrector> m;
    const BodyId puck = m.add_body(given_body("puck", 2.0, Vec3(0.1, 0.1, 0.1)).moving(speed * along));
    const JointId table = m.add_joint(
        joint(kind, "table", m.ground(), puck, {0, 0, 0}, on_line ? X : Z).with_friction({.coefficient = mu}));
    REQUIRE(m.run(0.2, 1e-4));
    // The start, while the springs of friction and of the joint build up, is not Coulomb's.
    CHECK((m.body(puck).velocity() - (speed - 0.2 * mu * 9.81) * along).norm() < 5e-3 * speed);
    CHECK((to_eigen(m.friction(table)->force) + mu * 2.0 * 9.81 * along).norm() < 5e-3 * mu * 2.0 * 9.81);
    REQUIRE(m.run(1.0, 1e-4));
    CHECK((m.body(puck).position() - way * along).norm() < 5e-3 * way);
    CHECK(m.body(puck).velocity().norm() < 1e-3);
  }
  // mu times 100 N on a ball of 0.02 m radius brakes 0.1 kg m^2 with 0.5 100 0.02 / 0.1 = 10 rad/s^2, about any axis.
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const Vec3 axis = Vec3(1, 2, 2) / 3.0;
  const BodyId rod = m.add_body(given_body("rod", 1.0, Vec3(0.1, 0.1, 0.1)).moving({0, 0, 0}, 2.0 * axis));
  m.add_joint(spherical("socket", m.ground(), rod, {0, 0, 0})
                  .with_friction({.coefficient = 0.5, .radius = 0.02, .preload = 100.0}));
  REQUIRE(m.run(0.1, 1e-4));
  CHECK((m.body(rod).angular_velocity() - axis).norm() < 0.01);  // as above
  REQUIRE(m.run(0.4, 1e-4));
  CHECK(m.body(rod).angular_velocity().norm() < 0.01);
}

TEST_CASE("a planar joint with a bearing radius rubs its rotation too, and a guide refuses one") {
  // mu m g on a ring of 0.05 m brakes 0.1 kg m^2 by 0.3 2 9.81 0.05 / 0.1 = 2.943 rad/s^2.
  const double mu = 0.3, brake = mu * 2.0 * 9.81 * 0.05 / 0.1;
  for (const double radius : {0.0, 0.05}) {
    Machine<PredictorCorrector> m;
    const BodyId top = m.add_body(given_body("top", 2.0, Vec3(0.1, 0.1, 0.1)).moving({0, 0, 0}, {0, 0, 2}));
    const JointId table = m.add_joint(
        planar("table", m.ground(), top, {0, 0, 0}, Z).with_friction({.coefficient = mu, .radius = radius}));
    REQUIRE(m.run(0.5, 1e-4));
    // The start, while the springs of friction and of the joint build up, is not Coulomb's.
    CHECK(m.speed(table) == Approx(radius > 0.0 ? 2.0 - 0.5 * brake : 2.0).margin(5e-3 * 2.0));
    REQUIRE(m.run(0.5, 1e-4));
    CHECK(m.speed(table) == Approx(radius > 0.0 ? 0.0 : 2.0).margin(0.01));
  }
  Machine<PredictorCorrector> m;
  const BodyId cart = m.add_body(ball("cart"));
  check_refused(
      [&] {
        m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X).with_friction({.coefficient = mu, .radius = 1}));
      },
      "JointFriction::radius", "'guide'", "only the sliding", "leave the radius out");
}

TEST_CASE("the lever of a joint's friction turns the torque that it carries into bearing forces") {
  // A guide under 2 kg that also holds 4 N m: bearings 0.1 m apart carry 40 N more, but only where a lever is given.
  const double mu = 0.3, weight = 2.0 * 9.81;
  for (const double lever : {0.0, 0.1}) {
    const double normal = weight + (lever > 0.0 ? 4.0 / lever : 0.0);
    Machine<PredictorCorrector> m;
    const BodyId cart = m.add_body(given_body("cart", 2.0, Vec3(0.1, 0.1, 0.1)));
    const JointId guide = m.add_joint(
        prismatic("guide", m.ground(), cart, {0, 0, 0}, X).with_friction({.coefficient = mu, .lever = lever}));
    m.add_load(applied_torque("tilt", cart, Y, 4.0));
    m.add_load(applied_force("pull", cart, {0, 0, 0}, X, mu * normal + 2.0));  // 2 N more than friction: 1 m/s^2
    REQUIRE(m.run(1.0, 1e-4));
    CHECK(m.speed(guide) == Approx(1.0).epsilon(0.02));  // the start, while friction builds up, is not Coulomb's
    CHECK(m.friction(guide)->force.x == Approx(-mu * normal).epsilon(1e-3));
  }
}

TEMPLATE_TEST_CASE("a guide that sticks swings on its asperities without loss", "", PredictorCorrector, VelocityVerlet,
                   SymplecticEuler) {
  // 1 kg on 1e4 N/m: 0.2 rad a step, ten swings. What the predictor-corrector loses of a spring, 5e-5 a step, is 1.6 %;
  // samples meet the peaks within cos(0.1), 0.5 %. A spring that is stretched by the newest speed alone loses 1e-2 a
  // step.
  Machine<TestType> m;
  m.gravity = Vec3::Zero();
  const BodyId cart = m.add_body(given_body("cart", 1.0, Vec3(0.1, 0.1, 0.1)).moving(1e-3 * X, Vec3::Zero()));
  const JointFriction rubbing = {.coefficient = 0.5, .preload = 1000.0, .stiffness = 1e4, .velocity_stiffness = 0.0};
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X).with_friction(rubbing));
  double largest = 0.0;
  for (int k = 0; k < 314; ++k) {
    REQUIRE(m.step(2e-3));
    if (k >= 282) largest = std::max(largest, std::abs(m.speed(guide)));
  }
  CHECK(largest > 0.95e-3);
  CHECK(largest < 1.02e-3);
}

TEST_CASE("friction in several directions limits the time step by all of them together") {
  // The point is a = 0.1 m beside the centre of mass. A force across that arm moves it by 1/m + a^2/I = 2 m/s^2 per
  // newton; a torque on the bearing of r = 0.1 m by r^2/I = 1, and the point by a r/I = 1 as well. Of the matrix of the
  // two, the largest eigenvalue is (3 + sqrt 5)/2 = 2.618, not 2. The joint itself has next to no stiffness.
  const double k = 1e4, arm = 0.1;
  const auto make = [&](Machine<SymplecticEuler>& m, JointKind kind, const Vec3& axis) {
    m.gravity.setZero();
    const BodyId b = m.add_body(ball("b", 1.0, 0.01).at({-arm, 0, 0}).moving({0, 0, 0}, 1e-6 * axis));
    m.add_joint(
        joint(kind, "table", m.ground(), b, {0, 0, 0}, axis)
            .with_stiffness(1e-3, 1e-3)
            .with_damping(0, 0)
            .with_friction(
                {.coefficient = 1.0, .radius = arm, .preload = 1e6, .stiffness = k, .velocity_stiffness = 0.0}));
    return b;
  };
  Machine<SymplecticEuler> m;
  make(m, JointKind::planar, Z);
  const StableTimeStep limit = m.stable_time_step();
  CHECK_THAT(limit.limited_by, Contains("friction of planar joint 'table'"));
  // 400 steps of the bisection end 1e-4 below the limit.
  CHECK(limit.dt == Approx(2.0 / std::sqrt(k * 0.5 * (3.0 + std::sqrt(5.0)))).epsilon(1.5e-4));
  for (const double share : {0.95, 1.05}) {
    Machine<SymplecticEuler> run;
    run.allow_unstable_time_step = true;
    const BodyId b = make(run, JointKind::planar, Z);
    double most = 0.0;
    for (int step = 0; step < 1000 && run.step(share * limit.dt); ++step)
      most = std::max(most, std::abs(run.body(b).motion.angular_velocity.z));
    CHECK((share < 1.0 ? most < 1e-5 : most > 1e-3));
  }
  // A sleeve whose axis misses the centre of mass has its turn and its slide apart: the slide is 1/m + a^2/I = 2, and
  // its torque is across the axis.
  Machine<SymplecticEuler> sleeve;
  make(sleeve, JointKind::cylindrical, Z);
  CHECK(sleeve.stable_time_step().dt == Approx(2.0 / std::sqrt(2.0 * k)).epsilon(1.5e-4));
  // With other moments about axes that lie askew the two are one: I^-1 has 1/2 (100 - 50) = 25 between z and y.
  Machine<SymplecticEuler> askew;
  askew.gravity.setZero();
  const Mat3 pose = Eigen::AngleAxisd(0.25 * pi, X).toRotationMatrix();
  const BodyId b = askew.add_body(given_body("b", 1.0, Vec3(0.02, 0.01, 0.02)).at({-arm, 0, 0}, pose));
  askew.add_joint(
      cylindrical("sleeve", askew.ground(), b, {0, 0, 0}, Z)
          .with_stiffness(1e-3, 1e-3)
          .with_damping(0, 0)
          .with_friction(
              {.coefficient = 1.0, .radius = arm, .preload = 1e6, .stiffness = k, .velocity_stiffness = 0.0}));
  // Slide: 1 + a^2 75 = 1.75; turn: r^2 75 = 0.75; between them a r 25 = 0.25: eigenvalue 1.25 + sqrt(0.25 + 0.0625).
  CHECK(askew.stable_time_step().dt == Approx(2.0 / std::sqrt(k * (1.25 + std::sqrt(0.3125)))).epsilon(1.5e-4));
}
