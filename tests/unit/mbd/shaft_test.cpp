#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

/// Two shafts bent by an angle, joined in the middle; shaft a is driven at 10 rad/s, shaft b feels a small friction.
struct Shafts {
  Machine<PredictorCorrector> m;
  JointId in, out;

  Shafts(JointKind kind, double bend, const Vec3& arm = Y) {
    const Vec3 axis_a = X, axis_b(std::cos(bend), std::sin(bend), 0);
    m.gravity.setZero();
    const BodyId a = m.add_body(
        given_body("shaft a", 1.0, Vec3(0.01, 0.01, 0.01)).at(-0.5 * axis_a).moving(Vec3::Zero(), 10.0 * axis_a));
    const BodyId b = m.add_body(
        given_body("shaft b", 1.0, Vec3(0.01, 0.01, 0.01)).at(0.5 * axis_b).moving(Vec3::Zero(), 10.0 * axis_b));
    in = m.add_joint(revolute("bearing a", m.ground(), a, -0.5 * axis_a, axis_a));
    out = m.add_joint(revolute("bearing b", m.ground(), b, 0.5 * axis_b, axis_b));
    JointSpec middle = universal("middle", a, b, {0, 0, 0}, axis_a, axis_b);
    middle.kind = kind;
    m.add_joint(middle.with_x(arm));
    m.add_motion(prescribed_joint("motor", in, Signal::ramp(0.0, 10.0)));
    m.add_actuator(joint_actuator("load", out, 0.0, 0.01));
  }
};

}  // namespace

TEST_CASE("a universal joint at 30 degrees has the known ripple: cos(b) to 1/cos(b)") {
  // The shafts are bent in the plane of X and Y. With the arm of the cross on shaft a in that plane at angle 0, shaft b
  // is fastest there; across it, slowest: ratio = cos(b) / (1 - sin(b)^2 cos(q)^2), or with the sine.
  const double bend = pi / 6;
  for (const bool in_plane : {true, false}) {
    Shafts s(JointKind::universal, bend, in_plane ? Y : Z);
    REQUIRE(s.m.run(0.2, 1e-4));  // the start is a jolt: shaft b begins at the mean speed
    double lowest = 1e9, highest = 0.0, worst = 0.0;
    REQUIRE(s.m.run(pi / 10.0 * 2, 1e-4, [&] {
      const double ratio = s.m.speed(s.out) / 10.0;
      lowest = std::min(lowest, ratio);
      highest = std::max(highest, ratio);
      const double q = 10.0 * s.m.time();
      const double exact = std::cos(bend) / (1 - std::pow(std::sin(bend) * (in_plane ? std::cos(q) : std::sin(q)), 2));
      worst = std::max(worst, std::abs(ratio - exact));
    }));
    CHECK(lowest == Approx(std::cos(bend)).epsilon(2e-4));
    CHECK(highest == Approx(1.0 / std::cos(bend)).epsilon(2e-4));
    CHECK(worst < 5e-4);
  }
}

TEST_CASE("two universal joints cancel their ripple if the yokes of the shaft between them are in line") {
  // In line the ripple goes, as the second joint is the mirror image of the first. A quarter of a turn out of line it
  // is squared: from cos(b)^2 to 1/cos(b)^2.
  const double bend = pi / 6;
  for (const bool in_line : {true, false}) {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const Vec3 along(std::cos(bend), std::sin(bend), 0), p = Vec3::Zero(), q = 0.4 * along;
    const auto shaft = [&](const char* name, const Vec3& at, const Vec3& axis) {
      return m.add_body(given_body(name, 1.0, Vec3(0.01, 0.01, 0.01)).at(at).moving(Vec3::Zero(), 10.0 * axis));
    };
    const BodyId a = shaft("in", p - 0.3 * X, X), b = shaft("middle", 0.5 * q, along), c = shaft("out", q + 0.3 * X, X);
    const JointId in = m.add_joint(revolute("bearing in", m.ground(), a, p - 0.3 * X, X));
    const JointId out = m.add_joint(revolute("bearing out", m.ground(), c, q + 0.3 * X, X));
    m.add_joint(universal("first", a, b, p, X, along).with_x(Z));
    const Vec3 yoke = along.cross(Z);  // the arm of the first cross on the middle shaft
    m.add_joint(universal("second", b, c, q, along, X).with_x(in_line ? yoke : Z));
    m.add_motion(prescribed_joint("motor", in, Signal::ramp(0.0, 10.0)));
    m.add_actuator(joint_actuator("load", out, 0.0, 0.01));
    REQUIRE(m.run(0.3, 1e-4));  // the start is a jolt, as all shafts begin at the mean speed
    double lowest = 1e9, highest = 0.0;
    REQUIRE(m.run(pi / 10.0 * 2, 1e-4, [&] {
      lowest = std::min(lowest, m.speed(out) / 10.0);
      highest = std::max(highest, m.speed(out) / 10.0);
    }));
    const double ripple = in_line ? 1.0 : std::cos(bend) * std::cos(bend);
    // The middle shaft's own ripple, some 60 rad/s^2 on 0.01 kg m^2, presses 1e-6 rad into the joints' springs.
    CHECK(lowest == Approx(ripple).epsilon(1e-3));
    CHECK(highest == Approx(1.0 / ripple).epsilon(1e-3));
  }
}

TEST_CASE("a constant-velocity joint at 30 degrees turns both shafts at the same speed") {
  Shafts s(JointKind::constant_velocity, pi / 6);
  REQUIRE(s.m.run(0.2, 1e-4));
  double worst = 0.0;
  REQUIRE(s.m.run(pi / 10.0 * 2, 1e-4, [&] { worst = std::max(worst, std::abs(s.m.speed(s.out) / 10.0 - 1.0)); }));
  CHECK(worst < 1e-6);
  CHECK(s.m.coordinate(s.out) == Approx(s.m.coordinate(s.in)).epsilon(1e-6));
}

TEST_CASE("gears turn in their ratio and see each other's inertia") {
  // Outer gears 20 : 60 teeth: ratio -1/3. A torque T on the pinion: a1 = T / (I1 + I2/9).
  Machine<PredictorCorrector> m;
  const BodyId pinion = m.add_body(given_body("pinion", 1.0, Vec3(0.02, 0.02, 0.02)));
  const BodyId wheel = m.add_body(given_body("wheel", 5.0, Vec3(0.9, 0.9, 0.9)).at({1, 0, 0}));
  const JointId p = m.add_joint(revolute("pinion axle", m.ground(), pinion, {0, 0, 0}, Z));
  const JointId w = m.add_joint(revolute("wheel axle", m.ground(), wheel, {1, 0, 0}, Z));
  const CouplingId teeth = m.add_coupling(gear("teeth", p, w, -20.0 / 60.0));
  m.add_load(applied_torque("motor", pinion, Z, 6.0));
  REQUIRE(m.run(1.0, 1e-4));
  const double a = 6.0 / (0.02 + 0.9 / 9.0);
  CHECK(m.speed(p) == Approx(a).epsilon(1e-5));
  CHECK(m.speed(w) / m.speed(p) == Approx(-1.0 / 3.0).epsilon(1e-6));
  CHECK(m.coordinate(w) / m.coordinate(p) == Approx(-1.0 / 3.0).epsilon(1e-5));  // the teeth give way by torque / k
  // The torque through the teeth on the wheel, 1/3 of the turn: I2 a / 3.
  CHECK(std::abs(m.coupling(teeth).multiplier) == Approx(0.9 * a / 3.0).epsilon(1e-4));
}

TEST_CASE("a rack slides by the pinion's radius per radian") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId pinion = m.add_body(given_body("pinion", 1.0, Vec3(0.01, 0.01, 0.01)));
  const BodyId rack = m.add_body(given_body("rack", 9.072, Vec3(0.1, 0.1, 0.1)).at({0, 0.1, 0}));
  const JointId p = m.add_joint(revolute("steering", m.ground(), pinion, {0, 0, 0}, Z));
  const JointId r = m.add_joint(prismatic("slide", m.ground(), rack, {0, 0.1, 0}, X));
  m.add_coupling(rack_and_pinion("teeth", p, r, 0.1));
  m.add_actuator(joint_actuator("hands", p, 500.0, 20.0, Signal::smooth_step(0.0, 0.9, 0.0, 0.5)));
  REQUIRE(m.run(2.0, 1e-4));
  CHECK(m.coordinate(p) == Approx(0.9).epsilon(1e-4));
  CHECK(m.coordinate(r) == Approx(0.1 * m.coordinate(p)).epsilon(1e-9));

  Machine<PredictorCorrector> n;
  n.gravity.setZero();
  const BodyId spindle =
      n.add_body(given_body("spindle", 1.0, Vec3(0.01, 0.01, 0.01)).moving(Vec3::Zero(), {5.0, 0, 0}));
  const BodyId nut = n.add_body(given_body("nut", 1.0, Vec3(0.01, 0.01, 0.01)).moving({5.0 * 0.004 / (2 * pi), 0, 0}));
  const JointId turning = n.add_joint(revolute("bearing", n.ground(), spindle, {0, 0, 0}, X));
  const JointId sliding = n.add_joint(prismatic("guide", n.ground(), nut, {0, 0, 0}, X));
  n.add_coupling(screw("thread", turning, sliding, 0.004));
  REQUIRE(n.run(4.0 * pi / 5.0, 1e-4));
  CHECK(n.coordinate(sliding) == Approx(2 * 0.004).epsilon(1e-4));
}

TEST_CASE("a differential splits the torque and shares the speed") {
  // Input at ratio 4 to the mean of two wheels; the left one is four times as heavy to turn.
  Machine<PredictorCorrector> m;
  const auto wheel = [&](const char* name, double inertia, double y) {
    const BodyId id = m.add_body(given_body(name, 1.0, Vec3(inertia, inertia, inertia)).at({0, y, 0}));
    return m.add_joint(revolute(name, m.ground(), id, {0, y, 0}, Y));
  };
  const JointId in = wheel("input", 0.01, 0.0), left = wheel("left", 0.8, 1.0), right = wheel("right", 0.2, -1.0);
  m.add_coupling(differential("differential", in, left, right, 4.0));
  m.add_load(applied_torque("engine", m.body_named("input"), Y, 3.0));
  REQUIRE(m.run(1.0, 1e-4));
  // Both wheels get the same torque, so their speeds are as 1 : 4, and the input is 4 times their mean.
  CHECK(m.speed(right) / m.speed(left) == Approx(4.0).epsilon(1e-5));
  CHECK(m.speed(in) == Approx(2.0 * (m.speed(left) + m.speed(right))).epsilon(1e-5));
  // T = I a with wheels' torque 2 (T_in - I_in a_in) each: a_in = 2 (a_l + a_r), a_l = tau/0.8, a_r = tau/0.2.
  const double tau = 2.0 * 3.0 / (1.0 + 2.0 * 0.01 * 2.0 * (1.0 / 0.8 + 1.0 / 0.2));
  CHECK(m.speed(left) == Approx(tau / 0.8).epsilon(1e-4));
}

TEST_CASE("a coupling takes the coordinates that it needs, and refuses joints that have none such") {
  Machine<PredictorCorrector> m;
  const auto body = [&](const char* name) { return m.add_body(ball(name)); };
  const JointId axle = m.add_joint(revolute("axle", m.ground(), body("a"), {0, 0, 0}, Z));
  const JointId second = m.add_joint(revolute("second", m.ground(), body("b"), {0, 0, 0}, Z));
  const JointId slide = m.add_joint(prismatic("slide", m.ground(), body("c"), {0, 0, 0}, X));
  const JointId sleeve = m.add_joint(cylindrical("sleeve", m.ground(), body("d"), {0, 0, 0}, X));
  const JointId table = m.add_joint(planar("table", m.ground(), body("e"), {0, 0, 0}, Z));
  const JointId socket = m.add_joint(universal("socket", m.ground(), body("f"), {0, 0, 0}, Z, Z));
  const auto refused = [&](const CouplingSpec& s) { return message_of([&] { m.add_coupling(s); }); };

  CHECK_THAT(refused(rack_and_pinion("teeth", slide, axle, 0.1)),
             Contains("coupling 'teeth' needs as joint 1 one that turns, but 'slide' is a prismatic joint") &&
                 Contains("exchange the joints"));
  CHECK_THAT(refused(rack_and_pinion("teeth", axle, second, 0.1)),
             Contains("needs as joint 2 one that slides, but 'second' is a revolute joint"));
  CHECK_THAT(refused(rack_and_pinion("teeth", axle, table, 0.1)), Contains("joint 2 one that slides, but 'table'"));
  CHECK_THAT(refused(gear("pair", slide, axle, 2.0)), Contains("joint 1 one that turns, but 'slide'"));
  CHECK_THAT(refused(gear("pair", axle, socket, 2.0)), Contains("joint 2 one that turns, but 'socket'"));
  CHECK_THAT(refused(screw("thread", axle, second, 0.01)), Contains("joint 2 one that slides"));
  CHECK_THAT(refused(differential("diff", axle, second, slide, 3.0)), Contains("joint 3 one that turns"));
  CouplingSpec wrong = rack_and_pinion("teeth", axle, sleeve, 0.1);
  wrong.terms[1].dof = Dof::turn;
  CHECK_THAT(refused(wrong), Contains("'sleeve' is a cylindrical joint and its turn does not"));

  // A cylindrical joint turns as a pinion and slides as a rack; other coordinates are named.
  const CouplingSpec& rack = m.coupling(m.add_coupling(rack_and_pinion("rack", axle, sleeve, 0.1))).spec;
  CHECK(rack.terms[1].dof == Dof::slide);
  const CouplingSpec& thread = m.coupling(m.add_coupling(screw("one thread", sleeve, sleeve, 0.1))).spec;
  CHECK(thread.terms[0].dof == Dof::turn);
  CHECK(thread.terms[1].dof == Dof::slide);
  CouplingSpec bevel = gear("bevel", axle, socket, 1.0);
  bevel.terms[1].dof = Dof::bend_x;
  CHECK(m.coupling(m.add_coupling(bevel)).spec.terms[1].dof == Dof::bend_x);
}
