#include "mbd_test.hpp"

#include <limits>

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("the stable time step names the part that limits it, and is one") {
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(given_body("a", 2.0, Vec3(1, 1, 1)));
  const BodyId b = m.add_body(given_body("b", 2.0, Vec3(1, 1, 1)).at({1, 0, 0}).moving({0, 1e-3, 0}));
  m.add_spring(spring("soft", a, {0, 0, 0}, b, {1, 0, 0}, 10.0));
  m.add_joint(point_on_plane("stiff", a, b, {0.5, 0, 0}, X).with_stiffness(1e6, 0).with_damping(0, 0));
  const StableTimeStep limit = m.stable_time_step();
  CHECK(limit.limited_by == "point-on-plane joint 'stiff'");
  // Two masses of 2 kg and one spring of 1e6 N/m along their line: omega = 1000 rad/s, limit 2/omega. The bound that
  // sums over a body's parts knows the soft spring too, which takes 5e-6 off.
  CHECK(limit.dt == Approx(2e-3).epsilon(1e-3));
  CHECK(limit.dt < 2e-3 * (1 + 1e-4));
}

TEST_CASE("the bound of a bent universal joint follows the shaft that its cross turns") {
  // Bent about the cross's arm on the ground, the joint holds the rotation about the shaft of b, which is easy to turn:
  // omega^2 = kr/I_z, limit 2/omega. The bound adds the soft spring in the point, 1e-4 of it.
  const double kr = 1e4, axial = 1e-3;
  for (const double bend : {0.0, 60.0, 80.0}) {
    Machine<SymplecticEuler> m;
    m.gravity.setZero();
    const Vec3 shaft(0, -std::sin(bend * pi / 180), std::cos(bend * pi / 180));
    const Mat3 pose = Eigen::AngleAxisd(bend * pi / 180, X).toRotationMatrix();
    const BodyId b = m.add_body(given_body("b", 1.0, Vec3(0.1, 0.1, axial)).at({0, 0, 0}, pose));
    m.add_joint(universal("cross", m.ground(), b, {0, 0, 0}, Z, shaft).with_stiffness(1.0, kr).with_damping(0, 0));
    CHECK(m.stable_time_step().dt == Approx(2.0 * std::sqrt(axial / kr)).epsilon(2e-4));
  }
}

TEST_CASE("derived stiffness is stable with room to spare, for every integrator") {
  const auto room = [](auto machine) {
    machine.joint_tolerance = std::numeric_limits<double>::infinity();  // it may give way, but not blow up
    const BodyId ground = machine.ground();
    BodyId last = ground;
    for (int k = 0; k < 5; ++k) {
      const BodyId link =
          machine.add_body(box_body("link " + std::to_string(k), {0.3, 0.05, 0.05}, 7800).at({0.3 * k + 0.15, 0, 0}));
      machine.add_joint(revolute("hinge " + std::to_string(k), last, link, {0.3 * k, 0, 0}, k % 2 ? Y : Z));
      last = link;
    }
    const MachineReport report = machine.run(0.5, 1e-4);
    CHECK(report.ok);
    return machine.stable_time_step().dt / 1e-4;
  };
  CHECK(room(Machine<SymplecticEuler>{}) > 1.5);
  CHECK(room(Machine<VelocityVerlet>{}) > 1.5);
  CHECK(room(Machine<PredictorCorrector>{}) > 1.5);
}

TEST_CASE("a machine that blows up says which body, when, and what to change") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("pendulum bob", {1, 0, 0}));
  m.add_joint(spherical("pivot", m.ground(), b, {0, 0, 0}).with_stiffness(1e8, 0).with_damping(0, 0));
  check_refused([&] { (void)m.run(1.0, 1e-2); }, "time step 0.01 s", "largest stable one", "spherical joint 'pivot'",
                "allow_unstable_time_step");
  m.allow_unstable_time_step = true;
  const MachineReport report = m.run(1.0, 1e-2);
  CHECK_FALSE(report.ok);
  CHECK(report.body == b);
  CHECK(report.time < 1.0);
  CHECK_THAT(report.text, Contains("body 'pendulum bob' blew up at t = ") && Contains("spherical joint 'pivot'") &&
                              Contains("smaller time step"));
}

TEST_CASE("a blow-up at a stable time step is not blamed on it, and a NaN is named") {
  const auto report_of = [](auto&& build) {
    Machine<PredictorCorrector> m;
    const BodyId cart = m.add_body(brick("cart", {0, 0, 0}));
    const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X));
    build(m, cart, guide);
    const MachineReport report = m.run(0.1, 1e-4);
    CHECK_FALSE(report.ok);
    return report.text;
  };
  const auto nan = Signal::function([](double t) { return t > 0.05 ? std::sqrt(-t) : 0.0; });
  CHECK_THAT(report_of([](auto& m, BodyId b, JointId) {
               m.add_load(applied_force("push", b, {0, 0, 0}, X, 1e12));
             }),
             Contains("The time step, 0.0001 s, was stable at the start of the run (up to ") &&
                 Contains("check the applied forces"));
  CHECK_THAT(report_of([&](auto& m, BodyId, JointId j) {
               m.add_actuator(joint_actuator("ram", j, 1e3, 10.0, nan).with_max_force(5.0));
             }),
             Contains("body 'cart' blew up at t = 0.0") &&
                 Contains("set point of actuator 'ram' is not a number: check the function"));
  CHECK_THAT(report_of([&](auto& m, BodyId b, JointId) { m.add_load(applied_torque("twist", b, X, nan)); }),
             Contains("size of load 'twist' is not a number"));
  CHECK_THAT(report_of([&](auto& m, BodyId, JointId) {
               m.add_motion(prescribed_position("lift", m.add_fixed_body("wall"), Z, nan));
             }),
             Contains("body 'wall' blew up") && Contains("value of motion 'lift' is not a number"));
}

TEMPLATE_TEST_CASE("a guide that slides along a moving body stays stable", "", SymplecticEuler, VelocityVerlet,
                   PredictorCorrector) {
  // A cube of 1 kg and 1/600 kg m^2 that slides over 1 m on a rail of its own: the force acts on the ground's point, so
  // a newton moves the cube by 1/m + L^2/I, 600 times as far at the end as at assembly.
  for (const bool rail_on_cube : {true, false}) {
    Machine<TestType> m;
    m.gravity.setZero();
    const BodyId cube = m.add_body(box_body("cube", {0.1, 0.1, 0.1}, 1000).moving({1, 0, 0}, {0, 1e-3, 0}));
    const JointId rail = m.add_joint(rail_on_cube ? prismatic("rail", cube, m.ground(), {0, 0, 0}, X)
                                                  : prismatic("rail", m.ground(), cube, {0, 0, 0}, X));
    const auto energy = [&] { return energy_of(m.parts(), m.gravity).sum(); };
    const double start = energy();
    double highest = 0.0;
    REQUIRE(m.run(0.0, 1e-4));
    const double k = m.joint(rail).k;
    REQUIRE(m.run(1.0, 1e-4, [&] { highest = std::max(highest, energy()); }));
    CHECK(std::abs(m.coordinate(rail)) == Approx(1.0).epsilon(1e-6));
    CHECK(highest <= start * (1.0 + 1e-12));  // to rounding
    // The spin is stopped by the rail, the speed is left: 1e-6 of it may have gone into the turn at the start.
    CHECK(energy() == Approx(0.5).epsilon(1e-6));
    // As derived for the lever that there was up to 64 steps, 6.4 mm, ago.
    CHECK(m.joint(rail).k == Approx(rail_on_cube ? k / 601.0 : k).epsilon(0.015));
    CHECK(m.stable_time_step().dt > 1.5e-4);  // the room that derived joints have
  }
}

TEMPLATE_TEST_CASE("a rod that is assembled near its dead centre stays stable", "", SymplecticEuler, VelocityVerlet,
                   PredictorCorrector) {
  // At the dead centre a newton along the rod moves the crank by 1/m = 1 m/s^2, a quarter of a turn later by
  // 1/m + r^2/I = 101.
  for (const bool crank_first : {true, false}) {
    Machine<TestType> m;
    m.joint_tolerance = std::numeric_limits<double>::infinity();  // it may give way, but not blow up
    m.gravity.setZero();
    const BodyId crank = m.add_body(ball("crank", 1.0, 1e-4).moving({0, 0, 0}, {0, 0, 20.0}));
    const BodyId slider = m.add_body(ball("slider", 1.0, 0.01).at({0.4, 0, 0}));
    const JointId hinge = m.add_joint(revolute("hinge", m.ground(), crank, {0, 0, 0}, Z));
    m.add_joint(prismatic("guide", m.ground(), slider, {0.4, 0, 0}, X));
    m.add_joint(crank_first ? distance("rod", crank, {0.1, 0, 0}, slider, {0.4, 0, 0})
                            : distance("rod", slider, {0.4, 0, 0}, crank, {0.1, 0, 0}));
    const auto energy = [&] { return energy_of(m.parts(), m.gravity).sum(); };
    const double start = energy();
    double highest = 0.0;
    REQUIRE(m.run(2.0, 1e-4, [&] { highest = std::max(highest, energy()); }));
    CHECK(m.coordinate(hinge) > pi);  // past the other dead centre
    // Euler's energy swings by half of v a dt m, here 1e-3 of it; the dampers and the lowering take some.
    CHECK(highest < 1.001 * start);
    CHECK(energy() > 0.9 * start);
  }
}

TEST_CASE("stops, friction and couplings of a guide are lowered with it, and given values are left alone") {
  // A sledge on a plane of its own: at a lever of 0.5 m a newton across it moves it by 1/m + L^2/I = 1 + 2.5 m/s^2.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId sledge = m.add_body(ball("sledge").moving({1, 0, 0})), other = m.add_body(ball("other").at({0, 3, 0}));
  const JointId plane = m.add_joint(
      planar("plane", sledge, m.ground(), {0, 0, 0}, Z)
          .with_limits(Dof::slide_y, -0.1, 0.1)
          .with_limits({.lower = -0.7, .upper = 0.7, .stiffness = 100.0, .damping = 1.0, .dof = Dof::slide_x})
          .with_friction({.coefficient = 1e-6}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), other, {0, 3, 0}, Z));
  const CouplingId belt = m.add_coupling({"belt", {{plane, 1.0, Dof::slide_y}, {hinge, 0.1}}});
  CouplingSpec stiff_belt = {"stiff belt", {{plane, 1.0, Dof::slide_y}, {hinge, 0.1}}};
  stiff_belt.stiffness = 1e4;
  stiff_belt.damping = 1.0;
  const CouplingId stiff = m.add_coupling(stiff_belt);
  REQUIRE(m.run(0.0, 1e-4));
  const double stop = m.limits(plane, Dof::slide_y)->stiffness, rub = m.friction(plane)->law.stiffness;
  const double pull = m.coupling(belt).k, hinge_k = m.joint(hinge).k;
  REQUIRE(m.run(0.5, 1e-4));
  CHECK(m.limits(plane, Dof::slide_y)->stiffness == Approx(stop / 3.5).epsilon(0.02));  // up to 6.4 mm late
  CHECK(m.friction(plane)->law.stiffness == Approx(rub / 3.5).epsilon(0.02));
  CHECK(m.coupling(belt).k < 0.9 * pull);
  CHECK(m.limits(plane, Dof::slide_x)->stiffness == 100.0);
  CHECK(m.coupling(stiff).k == 1e4);
  CHECK(m.joint(hinge).k == hinge_k);
  // Nothing is raised again on the way back.
  m.body(sledge).motion.velocity.x = -1.0;
  REQUIRE(m.run(0.4, 1e-4));
  CHECK(m.limits(plane, Dof::slide_y)->stiffness == Approx(stop / 3.5).epsilon(0.02));
}

TEST_CASE("the report of a blow-up knows the step that joints were derived for last") {
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId wheel = m.add_body(ball("wheel"));
  m.add_joint(revolute("hinge", m.ground(), wheel, {0, 0, 0}, Z));
  m.add_load(custom_load("push", wheel, [](double t, const Body&) {
    return Wrench{{t < 0.1 ? 0.0 : 1e300, 0, 0}, {}};
  }));
  REQUIRE(m.run(0.05, 1e-4));
  const MachineReport report = m.run(1.0, 1e-3);  // ten times as long, and stable: the hinge is derived anew
  CHECK_FALSE(report.ok);
  CHECK_THAT(report.text, Contains("was stable at the start of the run") && Contains("check the applied forces"));
}

TEMPLATE_TEST_CASE("a given stiffness that gets too stiff in another pose is named, with the time", "", SymplecticEuler,
                   VelocityVerlet, PredictorCorrector) {
  // omega^2 = k (1/m + L^2/I) + kr/I = 1e6 (1 + 600 L^2) + 6e6: at 1e-4 s more than 4/dt^2 = 4e8 from L = 0.8 m on.
  Machine<TestType> m;
  m.gravity.setZero();
  const BodyId cube = m.add_body(box_body("cube", {0.1, 0.1, 0.1}, 1000).moving({1, 0, 0}, {0, 1e-3, 0}));
  m.add_joint(prismatic("rail", cube, m.ground(), {0, 0, 0}, X).with_stiffness(1e6, 1e4).with_damping(0, 0));
  const MachineReport report = m.run(2.0, 1e-4);
  CHECK_FALSE(report.ok);
  CHECK(report.time > 0.8);
  CHECK_THAT(report.text, Contains("was stable at the start of the run, but in the pose at t = 0.8") &&
                              Contains("the stable one was ") && Contains("limited by prismatic joint 'rail'"));
}
