// What machines say when something is refused or goes wrong.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

/// The time step that a refusal names.
double named_step(const std::string& text) {
  const std::string before = "largest stable one, ";
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + before.size()));
}

/// A light wheel on a derived hinge of an arm, with a strut of given stiffness and damping.
template <class I>
Machine<I> wheel_on_strut() {
  Machine<I> m;
  const BodyId arm = m.add_body(box_body("arm", {0.5, 0.05, 0.05}, 1000).at({0.25, 0, 0}));
  const BodyId wheel = m.add_body(given_body("wheel", 0.5, Vec3(0.01, 0.01, 0.01)).at({0.5, 0, 0}));
  m.add_joint(revolute("pivot", m.ground(), arm, {0, 0, 0}, Y));
  m.add_joint(revolute("axle", arm, wheel, {0.5, 0, 0}, Y));
  m.add_spring(spring("strut", m.ground(), {0.5, 0, 0.4}, wheel, {0.5, 0, 0.01}, 1e5, 800.0));
  return m;
}

}  // namespace

TEMPLATE_TEST_CASE("the stable step that a refusal names is accepted when it is taken, and the strut is to blame", "",
                   SymplecticEuler, VelocityVerlet, PredictorCorrector) {
  Machine<TestType> m = wheel_on_strut<TestType>();
  const std::string text = message_of([&] { (void)m.step(5e-2); });
  CHECK_THAT(text, Contains("(spring 'strut')"));
  const double named = named_step(text);
  CHECK(named < 5e-2);
  CHECK_NOTHROW((void)m.step(named));
  // And not for nothing small: a step that is 1 % longer is refused.
  Machine<TestType> again = wheel_on_strut<TestType>();
  CHECK_THROWS_AS((void)again.step(1.01 * named), Error);
}

TEST_CASE("couplings that lock a shaft are refused, those that agree or give way are not") {
  const auto start = [](double second_ratio, bool elastic) {
    Machine<VelocityVerlet> m;
    const BodyId a = m.add_body(ball("a")), b = m.add_body(ball("b").at({1, 0, 0}));
    const JointId i = m.add_joint(revolute("in", m.ground(), a, {0, 0, 0}, Z));
    const JointId o = m.add_joint(revolute("out", m.ground(), b, {1, 0, 0}, Z));
    m.add_coupling(gear("first", i, o, 2.0));
    CouplingSpec second = gear("second", i, o, second_ratio);
    if (elastic) second.stiffness = 100.0;
    m.add_coupling(second);
    (void)m.run(0.0, 1e-4);
  };
  check_refused([&] { start(3.0, false); }, "joint '", "'first', 'second'", "leave it no turn", "check the ratios");
  CHECK_NOTHROW(start(2.0, false));
  CHECK_NOTHROW(start(3.0, true));
}

TEST_CASE("gears that lock a shaft are refused when they are switched on or changed, and not before the next step") {
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a").moving({0, 0, 0}, {0, 0, 1})), b = m.add_body(ball("b").at({1, 0, 0}));
  const JointId i = m.add_joint(revolute("in", m.ground(), a, {0, 0, 0}, Z));
  const JointId o = m.add_joint(revolute("out", m.ground(), b, {1, 0, 0}, Z));
  const CouplingId first = m.add_coupling(gear("first", i, o, 2.0));
  const CouplingId second = m.add_coupling(gear("second", i, o, 3.0).switched_off());
  REQUIRE(m.run(0.01, 1e-3));
  const double speed = m.speed(i);
  m.switch_on(second);
  for (int k = 0; k < 2; ++k) check_refused([&] { (void)m.step(1e-3); }, "'first', 'second'", "leave it no turn");
  CHECK(m.speed(i) == speed);  // nothing has moved
  m.switch_on(first, false);   // in whatever order a gear is changed
  CHECK_NOTHROW((void)m.step(1e-3));
  m.set_ratio(first, 3.0);
  m.switch_on(first);
  CHECK_NOTHROW((void)m.step(1e-3));
  m.set_ratio(second, 2.5);
  check_refused([&] { (void)m.step(1e-3); }, "'first', 'second'");
}

TEST_CASE("friction of a joint that has no bearing is refused for that reason") {
  Machine<VelocityVerlet> m;
  const BodyId a = m.add_body(ball("a"));
  const JointSpec turns = free_joint("gauge", m.ground(), a, {0, 0, 0}, Z).with_friction({.coefficient = 0.1});
  const std::string text = message_of([&] { m.add_joint(turns); });
  CHECK_THAT(text, Contains("'gauge' has friction") && Contains("no bearing surface"));
  CHECK_THAT(text, !Contains("nothing in it slides"));  // it turns, and slides
}

TEST_CASE("a blow-up that follows from a folded joint says so") {
  // A rod on a hinge about z, pushed about x by more than the hinge's derived stiffness can hold at this step: it folds
  // over, turns ever faster, and flies apart.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  m.largest_speed = 1e3;
  m.most_substeps = 1;  // more of them would hold it for longer
  const BodyId rod = m.add_body(ball("rod", 1.0, 0.01));
  m.add_joint(revolute("hinge", m.ground(), rod, {0, 0, 0}, Z));
  m.add_load(applied_torque("push", rod, X, Signal::function([](double t) { return 2e4 * t; })));
  const MachineReport report = m.run(10.0, 1e-3);
  CHECK_FALSE(report);
  CHECK(report.body == rod);
  CHECK_THAT(report.text, Contains("body 'rod' blew up") && Contains("revolute joint 'hinge' had folded: at t = ") &&
                              Contains("deg apart") && Contains("substeps (now 1)"));
}

TEST_CASE("what is hardly meant is noted, and stops nothing") {
  Machine<VelocityVerlet> m;
  const BodyId a = m.add_body(box_body("rod", {1, 0.1, 0.1}, 100).at({0.5, 0, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), a, {0, 0, 0}, Y));
  m.add_joint(revolute("again", m.ground(), a, {0, 0, 0}, Y));
  m.add_joint(point_on_plane("one way", m.ground(), a, {0.5, 0, 0}, X));
  m.add_joint(point_on_plane("the other", m.ground(), a, {0.5, 0, 0}, Z));
  m.add_actuator(joint_actuator("idle", hinge, 0.0, 0.0));
  CHECK_THAT(m.run(1e-2, 1e-3).note, Contains("Actuator 'idle' has no gain and is no motor: it does nothing."));

  m.add_motion(prescribed_joint("turn", hinge, Signal(m.coordinate(hinge))));
  m.add_motion(prescribed_joint("second", hinge, Signal(m.coordinate(hinge))));
  m.add_actuator(joint_actuator("motor", hinge, 10.0, 1.0));
  const MachineReport report = m.run(1e-2, 1e-3);
  CHECK(report);
  CHECK_THAT(report.note, Contains("Joints 'hinge' and 'again' hold the same bodies at the same point"));
  CHECK_THAT(report.note, !Contains("'one way'"));  // they hold two directions
  CHECK_THAT(report.note, Contains("Motions 'turn' and 'second' prescribe the same coordinate of joint 'hinge'"));
  CHECK_THAT(report.note,
             Contains("Actuator 'motor' acts on joint 'hinge', whose coordinate motion 'turn' prescribes"));
}

TEST_CASE("a body that nothing holds is noted where there is gravity") {
  for (const double g : {0.0, -9.81}) {
    Machine<VelocityVerlet> m;
    m.gravity = {0, 0, g};
    const BodyId first = m.add_body(ball("first")), second = m.add_body(ball("second").at({3, 0, 0}));
    const std::string note = m.run(1e-2, 1e-3).note;
    if (g == 0.0) CHECK(note.empty());
    else CHECK_THAT(note, Contains("Nothing holds body 'first' and 1 more: it falls freely."));
    m.add_spring(spring("rope", m.ground(), {0, 0, 1}, first, {0, 0, 0}, 1e3, 10.0));
    m.add_load(applied_force("lift", second, {3, 0, 0}, Z, 1.0));
    CHECK_THAT(m.run(1e-2, 1e-3).note, !Contains("Nothing holds"));
  }
}

TEST_CASE("a time to run of less than half a step is refused") {
  Machine<VelocityVerlet> m;
  m.add_body(ball("ball"));
  check_refused([&] { (void)m.run(1e-4, 1.0); }, "time to run is 0.0001 s", "time step of 1 s");
  CHECK(m.run(0.0, 1e-3));
  REQUIRE(m.run(0.1, 3e-4));
  CHECK(m.run(0.1 - m.time(), 3e-4));  // a third of a step is left of the time
}

TEST_CASE("what a load adds to its machine is refused, and leaves nothing behind") {
  for (const double at : {0.0, 5e-3}) {  // s: as the first forces are found, and within a step
    Machine<VelocityVerlet> m;
    const BodyId a = m.add_body(ball("a")), b = m.add_body(ball("b").at({1, 0, 0}));
    std::vector<std::string> said;
    m.add_load(custom_load("adds", a, [&](double t, const Body&) {
      if (t >= at && said.empty()) {
        said.push_back(message_of([&] { m.add_body(ball("c")); }));
        said.push_back(message_of([&] { m.add_spring(spring("s", a, {0, 0, 0}, b, {1, 0, 0}, 10.0)); }));
        said.push_back(message_of([&] {
          m.add_joint(revolute("j", a, b, {0, 0, 0}, Y).with_limits({.lower = -1.0, .upper = 1.0}));
        }));
        said.push_back(message_of([&] { m.add_motion(prescribed_position("p", a, Y, Signal(0.0))); }));
      }
      return Wrench{};
    }));
    REQUIRE(m.run(1e-2, 1e-3));
    REQUIRE(said.size() == 4);
    for (const std::string& text : said) CHECK_THAT(text, Contains("added to a machine within a step"));
    const Parts& parts = m.parts();
    CHECK(parts.bodies.size() == parts.built.size());
    CHECK(parts.joints.size() + parts.joint_specs.size() + parts.limits.size() + parts.springs.size() == 0);
    CHECK(parts.motions.empty());
    CHECK_NOTHROW(m.add_spring(spring("s", a, {0, 0, 0}, b, {1, 0, 0}, 10.0)));  // between steps
  }
}
