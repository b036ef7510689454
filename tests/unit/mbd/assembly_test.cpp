#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("wrong assemblies are refused in words") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(brick("crank", {0, 0, 0}));
  const BodyId b = m.add_body(brick("rod", {1, 0, 0}));
  const ConnectionId pin = m.add_connection("pin", a, {0.5, 0, 0});
  const ConnectionId eye = m.add_connection("eye", b, {0.51, 0, 0});
  const auto refused = [&](const JointSpec& s) { return message_of([&] { m.add_joint(s); }); };

  CHECK_THAT(refused(joint(JointKind::revolute, "big end", pin, eye)),
             Contains("the points of revolute joint 'big end' do not meet") && Contains("0.01 m apart") &&
                 Contains("allowed is 1e-06 m") && Contains("raise the joint's tolerance"));
  CHECK_THAT(refused(revolute("big end", a, a, {0, 0, 0}, Z)), Contains("joins body 'crank' to itself"));
  CHECK_THAT(refused(revolute("big end", a, BodyId(7), {0, 0, 0}, Z)),
             Contains("revolute joint 'big end' names body 7, but the machine has 2 (0 to 1)"));
  CHECK_THAT(refused(revolute("big end", a, BodyId(), {0, 0, 0}, Z)), Contains("was never added"));
  CHECK_THAT(refused(revolute("big end", a, b, {0, 0, 0}, {0, 0, 0})), Contains("needs a length"));
  JointSpec crooked = revolute("big end", a, b, {0.5, 0, 0}, Z);
  crooked.axis_b = Vec3(0, 0.1, 1);
  CHECK_THAT(refused(crooked), Contains("axes of revolute joint 'big end' are 0.0996") && Contains("rad apart"));
  CHECK_THAT(refused(revolute("big end", a, b, {0.5, 0, 0}, Z).with_limits(1.0, -1.0)),
             Contains("limits of revolute joint 'big end' are 1 to -1"));
  CHECK_THAT(refused(spherical("ball", a, b, {0.5, 0, 0}).with_limits(0, 1)), Contains("no coordinate of its own"));
  CHECK_THAT(refused(revolute("pin", a, b, {0.5, 0, 0}, Z).with_limits(Dof::slide, 0, 1)),
             Contains("'slide' of a revolute joint") && Contains("only: turn"));
  CHECK_THAT(refused(fixed("weld", a, b, X).with_limits(Dof::turn, 0, 1)), Contains("no coordinate free"));
  CHECK_THAT(refused(revolute("pin", a, b, {0.5, 0, 0}, Z).with_limits(0, 1).with_limits(0, 2)),
             Contains("two pairs of limits"));
  CHECK_THAT(refused(distance("rod", a, X, b, X)), Contains("need a distance"));
  CHECK_THAT(refused(universal("cross", a, b, X, X, -X)), Contains("bent by 180 deg"));
  CHECK_THAT(refused(fixed("weld", a, b, X).with_stiffness(-1.0, 1.0)),
             Contains("stiffness of fixed joint 'weld' is -1 N/m"));
  CHECK_THAT(refused(fixed("weld", a, b, X).with_friction({.coefficient = 0.1})), Contains("no bearing surface"));
  CHECK_THAT(refused(bushing("rubber", a, b, X, Z, X, X, X, X).with_stiffness(1e5, 1e3)),
             Contains("bushing 'rubber' was given a stiffness or damping") && Contains("give them to bushing(...)"));
  CHECK_THAT(refused(free_joint("gauge", a, b, X, Z).with_damping(1.0, 1.0)),
             Contains("free joint 'gauge' was given") && Contains("it holds nothing"));
  CHECK_THAT(refused(free_joint("gauge", a, b, Vec3(0, HUGE_VAL, 0), Z)), Contains("must be finite"));
  CHECK_THAT(refused(bushing("rubber", a, b, X, Z, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero())),
             Contains("has no stiffness at all"));

  CHECK_THAT(message_of([&] { m.add_actuator(linear_actuator("ram", a, X, BodyId(9), Y, 1, 1)); }),
             Contains("actuator 'ram' names body 9, but the machine has 2"));
  CHECK_THAT(message_of([&] { m.add_actuator(linear_actuator("ram", a, X, b, X, 1, 1)); }),
             Contains("two points of actuator 'ram' are 0 m apart"));
  CHECK_THAT(message_of([&] { m.add_actuator(joint_actuator("ram", JointId(3), 1, 1)); }),
             Contains("names a joint that the machine does not have"));
  CHECK_THAT(message_of([&] { m.add_actuator(linear_actuator("ram", a, X, b, Y, -1, 1)); }),
             Contains("position gain of actuator 'ram' is -1"));
  CHECK_THAT(message_of([&] { m.add_spring(spring("coil", a, X, b, Y, -5)); }),
             Contains("stiffness of a spring is -5"));
  CHECK_THAT(message_of([&] { m.add_connection("pin", BodyId(5), X); }),
             Contains("connection point 'pin' names body 5"));
  const JointId ball = m.add_joint(spherical("ball", a, b, {0.5, 0, 0}));
  CHECK_THAT(message_of([&] { m.add_actuator(joint_actuator("ram", ball, 1, 1)); }),
             Contains("actuator 'ram'") && Contains("name one of its degrees of freedom: bend"));
  CHECK_THAT(message_of([&] { m.add_coupling({"gear", {{ball, 1.0}}}); }), Contains("needs at least 2"));
  CHECK_THAT(message_of([&] { m.add_sensor(joint_sensor("cell", JointId(4), 0.1)); }),
             Contains("sensor 'cell' measures joint 4, but the machine has 1 of them"));
  CHECK_THAT(message_of([&] { m.add_sensor(contact_sensor("cell", BodyId(), 0.1)); }),
             Contains("sensor 'cell' measures body (never added)"));
  CHECK_THAT(message_of([&] { m.set_friction_preload(ball, 1.0); }), Contains("has no friction to preload"));
  CHECK_THAT(message_of([&] { m.initialise(0.0, Vec3::Zero()); }),
             Contains("the stiffness of spherical joint 'ball' is to be derived") && Contains("design_for(dt)"));
  CHECK_THAT(message_of([&] { (void)m.step(0.0); }), Contains("time step is 0 s"));
  m.substeps = 0;
  CHECK_THAT(message_of([&] { m.design_for(1e-3); }), Contains("substeps are 0"));
}

TEST_CASE("a joint whose points and axes nearly meet starts at rest, in the middle of the gap") {
  for (const JointKind kind :
       {JointKind::fixed, JointKind::revolute, JointKind::spherical, JointKind::cylindrical, JointKind::prismatic,
        JointKind::planar, JointKind::point_on_line, JointKind::point_on_plane, JointKind::universal}) {
    INFO(name_of(kind));
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId a = m.add_body(brick("a", {0, 0, 0})), b = m.add_body(brick("b", {1, 0, 0}));
    JointSpec s = joint(kind, "j", a, b, {0.5, 0, 0}, Z);
    s.at_b = Vec3(0.501, -0.0005, 0.0007);  // 1.3 mm
    if (kind != JointKind::universal) s.axis_b = Vec3(0, 1e-3, 1.0);
    s.tolerance = 2e-3;
    const JointId j = m.add_joint(s);
    REQUIRE(m.step(1e-5));
    // Rounding of 1e-16 m times the derived stiffness, which is below 1e10 N/m.
    CHECK(norm(m.reaction(j).force) < 1e-5);
    CHECK(norm(m.reaction(j).torque) < 1e-5);
    CHECK(m.violation(j).displacement < 1e-15);
    CHECK(m.violation(j).rotation < 1e-15);
    // What is free keeps its gap.
    const bool slides_z = traits_of(kind).hold == Hold::line;
    const bool slides_xy = traits_of(kind).hold == Hold::plane;
    if (slides_z) CHECK(m.coordinate(j, Dof::slide) == Approx(0.0007).epsilon(2e-3));  // the axis leans by 5e-4
    if (slides_xy) CHECK(m.coordinate(j, Dof::slide_x) == Approx(0.001).epsilon(2e-3));
  }
}

TEST_CASE("starting_at sets a turn or a slide, and is refused where nothing can start elsewhere") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(brick("a", {0, 0, 0}));
  const auto at = [&](JointKind kind) { return joint(kind, name_of(kind), m.ground(), a, {0, 0, 0}, Z); };
  const JointId sleeve = m.add_joint(at(JointKind::cylindrical).starting_at(0.3).starting_at(Dof::slide, 0.02));
  CHECK(m.coordinate(sleeve) == Approx(0.3));
  CHECK(m.coordinate(sleeve, Dof::slide) == Approx(0.02));
  const JointId wire = m.add_joint(at(JointKind::point_on_line).starting_at(0.05));
  CHECK(m.coordinate(wire) == Approx(0.05));
  const auto refused = [&](const JointSpec& s) { return message_of([&] { m.add_joint(s); }); };
  CHECK_THAT(refused(at(JointKind::spherical).starting_at(0.1)),
             Contains("spherical joint 'spherical joint'") && Contains("no coordinate of its own"));
  CHECK_THAT(refused(at(JointKind::universal).starting_at(0.1)), Contains("bend_x, bend_y"));
  CHECK_THAT(refused(at(JointKind::fixed).starting_at(0.1)), Contains("no coordinate free"));
  CHECK_THAT(refused(at(JointKind::planar).starting_at(Dof::slide_x, 0.1)),
             Contains("its slide_x a value") && Contains("move a body"));
  CHECK_THAT(refused(distance("rod", m.ground(), X, a, Y).starting_at(2.0)), Contains("its length a value"));
}

TEST_CASE("limits of a bushing or a free joint need a time step, too") {
  for (const bool rubber : {true, false}) {
    Machine<PredictorCorrector> m;
    const BodyId a = m.add_body(brick("a", {0, 0, 0}));
    const Vec3 k(100, 100, 100), none = Vec3::Zero();
    const JointSpec s = rubber ? bushing("buffer", m.ground(), a, {0, 0, 0}, Z, k, none, none, none)
                               : free_joint("buffer", m.ground(), a, {0, 0, 0}, Z);
    m.add_joint(s.with_limits(Dof::slide, -0.1, 0.1));
    check_refused([&] { m.initialise(0.0, m.gravity); }, "limits of 'buffer'", "design_for(dt)");
    m.design_for(1e-3);
    m.initialise(0.0, m.gravity);
    CHECK(m.limits(JointId(0), Dof::slide)->stiffness > 0.0);
  }
}

TEST_CASE("connection points that meet are joined, wherever the bodies are") {
  Machine<PredictorCorrector> m;
  const Mat3 turn = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  const BodyId a = m.add_body(brick("a", {0, 0, 0}).at({1, 2, 3}, turn));
  const BodyId b = m.add_body(brick("b", {0, 0, 0}));
  const ConnectionId pa = m.add_connection_in_reference("pa", a, {-1, -2, 0});
  const ConnectionId pb = m.add_connection("pb", b, m.connection_position(pa));
  const JointId j = m.add_joint(joint(JointKind::spherical, "j", pa, pb));
  CHECK(m.violation(j).displacement < 1e-14);
  CHECK((m.connection_position(pa) - (Vec3(1, 2, 3) + turn * Vec3(-1, -2, 0))).norm() < 1e-14);
}

TEST_CASE("bodies and joints can be added while a machine runs") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(brick("a", {0, 0, 0}));
  m.add_joint(fixed("weld", m.ground(), a, {0, 0, 0}));
  CHECK_FALSE(m.is_initialised());
  REQUIRE(m.run(0.1, 1e-4));
  CHECK(m.is_initialised());
  const BodyId b = m.add_body(brick("b", {0.5, 0, 0}));
  const JointId second = m.add_joint(fixed("second", a, b, {0.2, 0, 0}));
  CHECK_FALSE(m.is_initialised());
  REQUIRE(m.run(0.5, 1e-4));
  CHECK(m.time() == Approx(0.6));
  CHECK(m.reaction(second).force.z == Approx(9.81).epsilon(1e-5));
}

TEST_CASE("a body that is set free or fixed while a machine runs has its joints derived anew") {
  // The weld of 10 kg to a fixed anvil of 10 g is far too stiff once the anvil is free: kept, it would blow up.
  Machine<SymplecticEuler> m;
  m.joint_tolerance = 1.0;  // the weld of the anvil that falls gives way, as its derived stiffness is that of 10 g
  const BodyId anvil = m.add_body(given_body("anvil", 0.01, Vec3(1e-5, 1e-5, 1e-5)));
  const BodyId block = m.add_body(given_body("block", 10.0, Vec3(0.1, 0.1, 0.1)).at({0.1, 0, 0}));
  m.set_fixed(anvil);
  m.add_joint(fixed("weld", anvil, block, {0, 0, 0}));
  REQUIRE(m.run(0.1, 1e-4));
  const double welded = m.joint(JointId(0)).k;
  m.set_fixed(anvil, false);
  CHECK_FALSE(m.is_initialised());
  REQUIRE(m.run(0.1, 1e-4));
  CHECK(m.joint(JointId(0)).k < welded / 100.0);
  CHECK(m.body(block).velocity().z() == Approx(-0.981).epsilon(1e-3));  // they fall together
  CHECK(m.body(anvil).velocity().z() == Approx(-0.981).epsilon(1e-3));
  m.set_fixed(anvil);
  CHECK(m.body(anvil).velocity().norm() == 0.0);
  REQUIRE(m.run(0.1, 1e-4));
  const BodyId wall = m.add_fixed_body("wall");
  m.body(wall).mass = 0.0;
  check_refused([&] { m.set_fixed(wall, false); }, "mass of body 'wall'");
  CHECK(m.body(wall).fixed);
}

TEST_CASE("a machine alone takes its substeps, and derives for them") {
  // A weight that hangs on a derived joint: k = 0.5 (0.7/h)^2 of one mass, so four substeps make it 16 times as stiff.
  const auto hang = [](int substeps) {
    Machine<SymplecticEuler> m;
    m.substeps = m.most_substeps = substeps;
    const BodyId b = m.add_body(given_body("b", 2.0, Vec3(0.1, 0.1, 0.1)));
    const JointId weld = m.add_joint(fixed("weld", m.ground(), b, {0, 0, 0}));
    REQUIRE(m.run(0.5, 1e-3));
    CHECK(m.time() == Approx(0.5));
    CHECK(m.reaction(weld).force.z == Approx(2.0 * 9.81).epsilon(1e-6));
    return m.violation(weld).displacement;
  };
  CHECK(hang(1) / hang(4) == Approx(16.0).epsilon(1e-6));

  // Changed between runs, they are derived for anew; a step that is too large for one is none for eight.
  Machine<SymplecticEuler> m;
  m.most_substeps = 1;  // none but those that are given
  const BodyId b = m.add_body(given_body("b", 2.0, Vec3(0.1, 0.1, 0.1)));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), b, {0, 0, 0}));
  REQUIRE(m.run(0.01, 1e-3));
  const double k = m.joint(weld).k;
  m.substeps = 4;
  CHECK_FALSE(m.is_initialised());
  REQUIRE(m.run(0.01, 1e-3));
  CHECK(m.joint(weld).k == Approx(16.0 * k));
  CHECK(m.time() == Approx(0.02));
  const BodyId c = m.add_body(given_body("c", 2.0, Vec3(0.1, 0.1, 0.1)).at({1, 0, 0}));
  m.add_spring(spring("stiff", m.ground(), {0.5, 0, 0}, c, {1, 0, 0}, 2e8));  // 1e4 rad/s: 2e-4 s
  m.substeps = 1;
  for (int again = 0; again < 2; ++again) {
    check_refused([&] { (void)m.step(1e-3); }, "spring 'stiff'", "raise substeps (now 1)");
  }
  m.substeps = 8;
  CHECK(m.step(1e-3));
  check_refused([&] { (void)m.run(1.0, -1e-3); }, "time step", "-0.001");
  check_refused([&] { (void)m.run(-1.0, 1e-3); }, "time to run is -1 s");
  check_refused([&] { (void)m.run(std::nan(""), 1e-3); }, "time to run is nan s");
}

TEST_CASE("joints that cannot be meant are refused") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(brick("a", {0, 0, 0}));
  const BodyId wall = m.add_fixed_body("wall");
  const auto refused = [&](const JointSpec& s) { return message_of([&] { m.add_joint(s); }); };
  CHECK_THAT(
      refused(revolute("hinge", m.ground(), a, X, Z).with_limits(0.5, 1.0)),
      Contains("limits of revolute joint 'hinge' are 0.5 to 1, but its turn starts at 0") && Contains("starting_at"));
  m.add_joint(revolute("hinge", m.ground(), a, X, Z).starting_at(0.7).with_limits(0.5, 1.0));
  CHECK_THAT(refused(revolute("nan", m.ground(), a, X, Z).starting_at(std::nan(""))),
             Contains("turn of revolute joint 'nan' starts at nan"));
  JointSpec rod = distance("rod", m.ground(), Vec3::Zero(), a, X);
  rod.length = 1.001;
  CHECK_THAT(refused(rod), Contains("is 1.001 m long, but its points are 1 m apart") && Contains("under load"));
  rod.tolerance = 0.01;
  CHECK(m.joint(m.add_joint(rod)).length == 1.001);
  CHECK_THAT(refused(fixed("bolt", m.ground(), wall, X)), Contains("'ground' and 'wall', which are both fixed"));
  m.add_joint(free_joint("gauge", m.ground(), wall, X, Z));
  // `own` is another name for a coordinate, not another coordinate.
  CHECK_THAT(refused(revolute("pin", m.ground(), a, X, Z).with_limits(-1, 1).with_limits(Dof::turn, -1, 2)),
             Contains("two pairs of limits for its turn"));
  const JointId slide = m.add_joint(prismatic("slide", m.ground(), a, X, X).with_limits(-1, 1));
  CHECK(m.limits(slide, Dof::slide) == m.limits(slide));
  CHECK(m.limits(slide) != nullptr);
  check_refused([&] { m.add_coupling({"gear", {{slide, 1.0}, {slide, 2.0, Dof::slide}}}); }, "same coordinate twice");
  CHECK_THAT(refused(revolute("dry", m.ground(), a, X, Z).with_friction({.coefficient = 0.1})),
             Contains("JointFriction::radius") && Contains("'dry' is 0 m"));
  CouplingSpec teeth = rack_and_pinion("teeth", JointId(0), slide, 2.0);
  teeth.stiffness = -1.0;
  check_refused([&] { m.add_coupling(teeth); }, "stiffness of coupling 'teeth' is -1");
}

TEST_CASE("parts without a name get one, and no two of a kind have the same") {
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(brick("a", {0, 0, 0})), b = m.add_body(brick("b", {1, 0, 0}));
  const JointId slide = m.add_joint(prismatic("", m.ground(), a, {0, 0, 0}, X));
  const JointId other = m.add_joint(prismatic("same", m.ground(), b, {1, 0, 0}, X));
  CHECK(m.parts().joint_specs[0].name == "joint 0");
  CHECK(m.actuator(m.add_actuator(joint_actuator("", slide, 1, 1))).spec.name == "actuator 0");
  CHECK(m.load(m.add_load(applied_force("", a, {0, 0, 0}, X, 1.0))).spec.name == "load 0");
  CHECK(m.spring(m.add_spring(spring("", a, {0, 0, 0}, b, {1, 0, 0}, 1.0))).spec.name == "spring 0");
  CHECK(m.coupling(m.add_coupling({"", {{slide, 1.0}, {other, 1.0}}})).spec.name == "coupling 0");
  // A name may be had once by each kind.
  m.add_actuator(joint_actuator("same", slide, 1, 1));
  m.add_load(applied_force("same", a, {0, 0, 0}, X, 1.0));
  m.add_spring(spring("same", a, {0, 0, 0}, b, {1, 0, 0}, 1.0));
  m.add_coupling({"same", {{slide, 1.0}, {other, 1.0}}});
  check_refused([&] { m.add_joint(fixed("same", a, b, X)); }, "two joints are named 'same'", "rename one");
  check_refused([&] { m.add_actuator(joint_actuator("same", slide, 1, 1)); }, "two actuators are named 'same'");
  check_refused([&] { m.add_load(applied_force("same", a, {0, 0, 0}, X, 1.0)); }, "two loads are named 'same'");
  check_refused([&] { m.add_spring(spring("same", a, {0, 0, 0}, b, {1, 0, 0}, 1.0)); }, "two springs are named");
  m.add_connection("same", a, X);
  check_refused([&] { m.add_connection("same", b, X); }, "two connection points are named 'same'");
  m.add_motion(prescribed_joint("same", slide, 0.0));
  check_refused([&] { m.add_motion(prescribed_joint("same", other, 0.0)); }, "two prescribed motions are named");
  m.add_sensor(joint_sensor("same", slide, 0.1));
  check_refused([&] { m.add_sensor(joint_sensor("same", other, 0.1)); }, "two sensors are named");
  check_refused([&] { m.add_coupling({"same", {{slide, 1.0}, {other, 1.0}}}); }, "two couplings are named");
}

TEST_CASE("an id of another machine is refused by every accessor") {
  Machine<PredictorCorrector> m;
  m.add_body(brick("a", {0, 0, 0}));
  check_refused([&] { m.body(BodyId(7)); }, "body 7 is asked for", "added so far: 1");
  check_refused([&] { m.coordinate(JointId(1)); }, "joint 1");
  check_refused([&] { m.reaction(JointId()); }, "the joint that is asked for has an id that was never set");
  check_refused([&] { m.violation(JointId(2)); }, "joint 2");
  check_refused([&] { m.limits(JointId(2)); }, "joint 2");
  check_refused([&] { m.set_friction_preload(JointId(2), 1.0); }, "joint 2");
  check_refused([&] { m.actuator(ActuatorId(0)); }, "actuator 0");
  check_refused([&] { m.set_target(ActuatorId(0), 1.0); }, "actuator 0");
  check_refused([&] { m.set_throttle(ActuatorId(0), 1.0); }, "actuator 0");
  check_refused([&] { m.switch_on(MotionId(3)); }, "prescribed motion 3");
  check_refused([&] { m.set_load(LoadId(1), 1.0); }, "load 1");
  check_refused([&] { m.load(LoadId(1)); }, "load 1");
  check_refused([&] { m.spring(SpringId(0)); }, "spring 0");
  check_refused([&] { m.coupling(CouplingId(0)); }, "coupling 0");
  check_refused([&] { m.sensor(SensorId(0)); }, "sensor 0");
  check_refused([&] { m.connection_position(ConnectionId(0)); }, "connection point 0");
}

TEST_CASE("references to bodies outlast the ground, which is made when it is first asked for") {
  for (const int count : {1, 2, 3, 4, 5, 8, 9}) {
    Mechanism m;
    for (int k = 0; k < count; ++k) m.add_body(brick(dem::text("brick {}", k), {2.0 * k, 0, 0}));
    const Mechanism copy_of = m;
    Mechanism copied = m, assigned;
    assigned = copy_of;
    for (Mechanism* one : {&m, &copied, &assigned}) {
      const Body& first = one->body(BodyId(0));
      CHECK(one->ground() == BodyId(static_cast<std::size_t>(count)));
      CHECK(&first == &one->body(BodyId(0)));
    }
  }
}
