// Joints that are held exactly, by projection, and not by springs.

#include <dem/mbd/solver/projected.hpp>
#include <dem/mbd/solver/rest.hpp>

#include "spatial_slider_crank.hpp"

#include <algorithm>
#include <array>

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

template <class I>
using Rigid = Machine<I, Projected>;

template <class M>
double widest_opening(const M& m) {
  double worst = 0.0;
  for (std::size_t k = 0; k < m.parts().joints.size(); ++k) {
    const Violation v = m.violation(JointId(k));
    worst = std::max({worst, v.displacement, v.rotation});
  }
  return worst;
}

constexpr JointTraits cross_slide_traits = joint_that_holds<Hold::plane, Align::locked>(
    {.name = "cross slide", .dofs = {Dof::slide_x, Dof::slide_y}, .own = Dof::slide_x, .bearing = Bearing::plate});
constexpr JointKind cross_slide{cross_slide_traits};

}  // namespace

TEMPLATE_TEST_CASE("a kind of joint that the library does not have slides two ways, and neither turns nor lifts", "",
                   Penalty, Projected) {
  Machine<VelocityVerlet, TestType> m;
  m.gravity = {1, 2, -9.81};
  const double mass = 2.0, t = 0.2;
  const BodyId top = m.add_body(brick("top", {0.1, 0.05, 0.2}, mass));
  const JointId slide = m.add_joint(joint(cross_slide, "slide", m.ground(), top, {0, 0, 0}, Z));
  const MachineReport report = m.run(t, 1e-4);
  INFO(report.text);
  REQUIRE(report);
  // Uniform acceleration, which the method has exactly. Derived springs open by some (1e-4 s)^2 g = 1e-7 m and, at this
  // lever and inertia, 1e-5 rad; the point of the joint is 0.2 m from the centre of mass.
  CHECK(m.coordinate(slide, Dof::slide_x) == Approx(0.5 * t * t).margin(1e-5));
  CHECK(m.coordinate(slide, Dof::slide_y) == Approx(t * t).margin(1e-5));
  CHECK(m.speed(slide, Dof::slide_y) == Approx(2.0 * t).epsilon(1e-2));
  CHECK(widest_opening(m) < 1e-4);
  check_refused([&] { m.coordinate(slide, Dof::turn); }, "refers to 'turn' of a cross slide");
}

TEMPLATE_TEST_CASE("a pendulum that is held exactly falls as its energy says, at whatever time step", "",
                   SymplecticEuler, VelocityVerlet, PredictorCorrector) {
  // Released level. At the bottom J w^2/2 = m g r, and the pivot carries m g + m w^2 r.
  const double mass = 2.0, r = 0.5, inertia = 0.1, g = 9.81, J = inertia + mass * r * r;
  double error[2], pull[2];
  for (const int fine : {0, 1}) {
    Rigid<TestType> m;
    const BodyId bob = m.add_body(ball("bob", mass, inertia).at({r, 0, 0}));
    const JointId pivot = m.add_joint(revolute("pivot", m.ground(), bob, {0, 0, 0}, Y));
    double fastest = 0.0, most = 0.0, open = 0.0;
    const MachineReport report = m.run(2.0, fine ? 1e-3 : 2e-3, [&] {
      fastest = std::max(fastest, std::abs(m.speed(pivot)));
      most = std::max(most, m.reaction(pivot).force.z);
      open = std::max(open, widest_opening(m));
    });
    INFO(report.text);
    REQUIRE(report);
    CHECK(m.substeps == 1);
    CHECK(open < 1e-10);
    error[fine] = std::abs(fastest / std::sqrt(2.0 * mass * g * r / J) - 1.0);
    pull[fine] = std::abs(most / (mass * g + mass * r * 2.0 * mass * g * r / J) - 1.0);
  }
  // w dt = 5e-3 at 1 ms: its square, and half a step of the reaction's change near its largest.
  CHECK(error[1] < 1e-4);
  CHECK(pull[1] < 1e-3);
}

TEMPLATE_TEST_CASE("joints that are held exactly keep momentum, angular momentum and energy", "", VelocityVerlet,
                   PredictorCorrector) {
  // Four bodies on a universal, a spherical and a revolute joint, thrown and spinning, without gravity.
  double off[2];
  for (const int fine : {0, 1}) {
    Rigid<TestType> m;
    m.gravity.setZero();
    m.given_velocities = GivenVelocities::project;
    const auto link = [&](const char* name, double x, const Vec3& v, const Vec3& w) {
      return m.add_body(given_body(name, 1.0 + x, Vec3(0.02, 0.05, 0.06)).at({x, 0, 0}).moving(v, w));
    };
    const BodyId a = link("a", 0.0, {1, 0, 0}, {1, 2, 0}), b = link("b", 0.4, {1, 0.3, 0}, {0, 0, 3});
    const BodyId c = link("c", 0.8, {1, -1, 0.5}, {2, 0, 0}), d = link("d", 1.2, {1, 0, 1}, {0, 1, 1});
    m.add_joint(universal("ab", a, b, {0.2, 0, 0}, X, X));
    m.add_joint(spherical("bc", b, c, {0.6, 0, 0}));
    m.add_joint(revolute("cd", c, d, {1.0, 0, 0}, Y));
    m.assemble();
    const auto momentum = [&] {
      Vec3 p = Vec3::Zero(), l = Vec3::Zero();
      for (const Body& x : m.bodies()) {
        if (x.fixed) continue;
        const Mat3 R = x.rotation();
        const Vec3 w = to_eigen(x.motion.angular_velocity);
        p += x.mass * x.velocity();
        l += x.mass * x.position().cross(x.velocity()) +
             R * Vec3(x.inertia[0] * w.x(), x.inertia[1] * w.y(), x.inertia[2] * w.z());
      }
      return std::pair{p, l};
    };
    const auto [p, l] = momentum();
    const double energy = energy_of(m.parts(), m.gravity).kinetic;
    REQUIRE(m.run(3.0, fine ? 1e-3 : 2e-3));
    const auto [p1, l1] = momentum();
    CHECK((p1 - p).norm() < 1e-12 * p.norm());
    CHECK((l1 - l).norm() < 2e-4 * l.norm());
    off[fine] = std::abs(energy_of(m.parts(), m.gravity).kinetic / energy - 1.0);
    CHECK(widest_opening(m) < 1e-10);
  }
  CHECK(off[1] < 1e-4);                          // spins of 3 rad/s turn by 3e-3 rad in 1 ms
  CHECK(off[1] < std::max(0.5 * off[0], 1e-7));  // of second order
}

TEST_CASE("mechanisms with joints too many and through singular positions are held") {
  // Two four-bars side by side in space, 14 constraints of which only 9 differ, through the position in which all links
  // lie on a line. The links keep their directions or turn alike: 3 q'' = 3.5 g sin(q), q from the vertical.
  double q = 0.0, w = 1.0;
  const double time = 3.0, h = 1e-5;
  for (int k = 0; k < 300000; ++k) {  // Stoermer and Verlet's rule, exact to 1e-9 here
    w += 0.5 * h * 3.5 * 9.81 / 3.0 * std::sin(q);
    q += h * w;
    w += 0.5 * h * 3.5 * 9.81 / 3.0 * std::sin(q);
  }
  Rigid<VelocityVerlet> m;
  m.gravity = {0, -9.81, 0};
  const auto rod = [&](const std::string& title, const Vec3& at, const Vec3& along, const Vec3& v, const Vec3& spin) {
    return m.add_body(
        given_body(title, 1.0, Vec3(1.0 / 12.0 * (Vec3::Ones() - along) + 1e-3 * along)).at(at).moving(v, spin));
  };
  std::array<BodyId, 3> cranks;
  JointId base;
  for (int k = 0; k <= 2; ++k) {
    cranks[k] = rod("crank " + std::to_string(k), {1.0 * k, 0.5, 0}, Y, {0.5, 0, 0}, -1.0 * Z);
    base = m.add_joint(revolute("base " + std::to_string(k), m.ground(), cranks[k], {1.0 * k, 0, 0}, Z));
  }
  for (int k = 0; k < 2; ++k) {
    const BodyId coupler = rod("coupler " + std::to_string(k), {k + 0.5, 1, 0}, X, {1, 0, 0}, Vec3::Zero());
    m.add_joint(revolute("left " + std::to_string(k), cranks[k], coupler, {1.0 * k, 1, 0}, Z));
    m.add_joint(revolute("right " + std::to_string(k), cranks[k + 1], coupler, {k + 1.0, 1, 0}, Z));
  }
  const MachineReport report = m.run(time, 1e-3);
  INFO(report.text);
  REQUIRE(report);
  CHECK(-m.coordinate(base) == Approx(q).margin(1e-4));
  CHECK(std::abs(q) > 1.5 * pi);  // it went through
  CHECK(widest_opening(m) < 1e-9);
}

TEMPLATE_TEST_CASE("gears, drives and motors act on joints that are held exactly", "", SymplecticEuler, VelocityVerlet,
                   PredictorCorrector) {
  // A motor of 3 N m turns a shaft of 0.02 kg m^2, which turns one of 0.5 kg m^2 at a fifth of its speed: it sees 0.02
  // + 0.5/25 = 0.04. The gear carries what turns the second shaft.
  Rigid<TestType> m;
  m.gravity.setZero();
  const BodyId in = m.add_body(ball("in", 1.0, 0.02)), out = m.add_body(ball("out", 5.0, 0.5).at({0, 1, 0}));
  const JointId a = m.add_joint(revolute("first", m.ground(), in, {0, 0, 0}, Z));
  const JointId b = m.add_joint(revolute("second", m.ground(), out, {0, 1, 0}, Z));
  m.add_coupling(gear("gear", b, a, 5.0));
  m.add_load(applied_torque("motor", in, Z, 3.0));
  // And a shaft that is driven at 50 rad/s against a torque of 4 N m.
  const BodyId driven = m.add_body(ball("driven", 1.0, 0.01).at({0, 2, 0}));
  const JointId c = m.add_joint(revolute("third", m.ground(), driven, {0, 2, 0}, Z));
  const MotionId drive = m.add_motion(prescribed_speed("drive", c, 50.0));
  m.add_load(applied_torque("brake", driven, Z, -4.0));
  const MachineReport report = m.run(0.5, 1e-3);
  INFO(report.text);
  REQUIRE(report);
  CHECK(std::abs(m.speed(a)) == Approx(3.0 / 0.04 * 0.5).epsilon(1e-9));
  CHECK(std::abs(m.coordinate(a)) == Approx(5.0 * std::abs(m.coordinate(b))).epsilon(1e-9));
  CHECK(std::abs(m.speed(a)) == Approx(5.0 * std::abs(m.speed(b))).epsilon(1e-9));
  CHECK(m.coordinate(c) == Approx(25.0).epsilon(1e-9));
  CHECK(m.speed(c) == Approx(50.0).epsilon(1e-9));
  CHECK(m.motion(drive).drive.force == Approx(4.0).epsilon(1e-6));
}

TEST_CASE("stops and friction of joints that are held exactly are those of joints with springs") {
  // A disc turns in a bearing of radius 0.05 m that carries its weight: mu W r = 0.1 * 2 * 9.81 * 0.05 N m brake it.
  Rigid<VelocityVerlet> m;
  const BodyId disc = m.add_body(ball("disc", 2.0, 0.01).moving({0, 0, 0}, {0, 20.0, 0}));
  const JointId axle =
      m.add_joint(revolute("axle", m.ground(), disc, {0, 0, 0}, Y).with_friction({.coefficient = 0.1, .radius = 0.05}));
  // A pendulum falls onto its stop.
  const BodyId arm = m.add_body(ball("arm", 1.0, 0.02).at({0.3, 2, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 2, 0}, Y).with_limits(-0.5, 0.5));
  REQUIRE(m.run(1.0, 1e-4));
  // The friction's spring winds up first, within milliseconds.
  CHECK(m.speed(axle) == Approx(20.0 - 0.1 * 2.0 * 9.81 * 0.05 / 0.01).epsilon(2e-3));
  REQUIRE(m.run(4.0, 1e-4));
  CHECK(m.speed(axle) == Approx(0.0).margin(1e-3));
  CHECK(m.coordinate(hinge) == Approx(0.5).margin(2e-3));
  CHECK(norm(m.reaction(hinge).torque) > 0.0);
}

TEMPLATE_TEST_CASE("a slider-crank that is held exactly is where its kinematics put it, in sub-steps too", "",
                   SymplecticEuler, VelocityVerlet, PredictorCorrector) {
  SpatialSliderCrank<TestType, Projected> s;
  s.m.given_velocities = GivenVelocities::lead;
  s.m.substeps = 3;
  double off = 0.0;
  const MachineReport report = s.m.run(1.0, 3e-3, [&] { off = std::max(off, s.off()); });
  INFO(report.text);
  CHECK(report);
  CHECK(off < 1e-9);
  CHECK(s.m.substeps == 3);
}

TEMPLATE_TEST_CASE("a world's solver holds joints exactly, with forces from outside and sub-steps", "", SymplecticEuler,
                   VelocityVerlet, PredictorCorrector) {
  // 10 N along a guide for 1 s, in 100 steps of the world: v = 5 m/s, and the guide carries the weight.
  for (const int substeps : {1, 4}) {
    InWorld<TestType, Projected> w;
    const BodyId cart = w.m.add_body(ball("cart", 2.0, 0.1));
    const JointId guide = w.m.add_joint(prismatic("guide", w.m.ground(), cart, {0, 0, 0}, X));
    w.m.substeps = substeps;
    const Vec3 g(0, 0, -9.81);
    w.start(0.01, g);
    for (int k = 0; k < 100; ++k) w.step(0.01, g, [&] { w.m.body(cart).force += Vector3<double>{10.0, 0, 0}; });
    INFO(substeps);
    CHECK(w.m.speed(guide) == Approx(5.0).epsilon(0.015));  // the first step may have no force yet
    CHECK(w.m.reaction(guide).force.z == Approx(2.0 * 9.81).epsilon(1e-9));
    CHECK(widest_opening(w.m) < 1e-10);
  }
}

TEST_CASE("joints that are given a stiffness stay springs, and those that are switched off let go") {
  Rigid<VelocityVerlet> m;
  const BodyId soft = m.add_body(ball("soft", 1.0)), firm = m.add_body(ball("firm", 1.0).at({1, 0, 0}));
  const JointId spring =
      m.add_joint(fixed("spring", m.ground(), soft, {0, 0, 0}).with_stiffness(1e4, 1e3).with_damping(100.0, 10.0));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), firm, {1, 0, 0}));
  REQUIRE(m.run(2.0, 1e-3));
  CHECK(m.violation(spring).displacement == Approx(9.81 / 1e4).epsilon(1e-6));
  CHECK(m.violation(weld).displacement < 1e-12);
  CHECK(m.reaction(weld).force.z == Approx(9.81).epsilon(1e-9));
  m.switch_on(weld, false);
  REQUIRE(m.run(0.2, 1e-3));
  CHECK(m.body(firm).velocity().z() == Approx(-9.81 * 0.2).epsilon(1e-9));
  m.switch_on(weld);
  const double z = m.body(firm).position().z();
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.body(firm).position().z() == Approx(z).margin(1e-9));
}

TEST_CASE("find_rest of a machine whose joints are held exactly") {
  Rigid<VelocityVerlet> m;
  const BodyId a = m.add_body(box_body("upper", {0.5, 0.04, 0.04}, 1000).at({0.25, 0, 0}));
  const BodyId b = m.add_body(box_body("lower", {0.5, 0.04, 0.04}, 1000).at({0.75, 0, 0}));
  const JointId top = m.add_joint(revolute("top", m.ground(), a, {0, 0, 0}, Y));
  m.add_joint(revolute("middle", a, b, {0.5, 0, 0}, Y));
  m.add_spring(spring("spring", b, {1, 0, 0}, m.ground(), {1, 0, 1}, 20.0));
  const RestReport rest = find_rest(m, 1e-3);
  INFO(rest.text);
  REQUIRE(rest);
  CHECK(widest_opening(m) < 1e-10);
  const double q = m.coordinate(top);
  REQUIRE(m.run(0.5, 1e-3));
  CHECK(m.coordinate(top) == Approx(q).margin(1e-5));
}

TEST_CASE("brakes and stops hold after find_rest what they hold in the run") {
  // A rod that a brake holds level, and a weight on a stop. Their stiffness belongs to the time step of the run: with
  // that of a shorter one the brake would shake loose, and the weight would sink after the search.
  Machine<VelocityVerlet, Projected> m;
  const BodyId rod = m.add_body(ball("rod").at({0.5, 0, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), rod, {0, 0, 0}, Y));
  const BrakeId held = m.add_brake(brake("brake", hinge, 100.0));
  const BodyId weight = m.add_body(ball("weight").at({2, 0, 0}));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), weight, {2, 0, 0}, Z).with_limits(0.0, 1.0));
  const RestReport rest = find_rest(m, 1e-3);
  INFO(rest.text);
  REQUIRE(rest);
  const double turn = m.coordinate(hinge), slide = m.coordinate(guide);
  CHECK(m.limits(guide)->stiffness * -slide == Approx(9.81).epsilon(1e-6));
  REQUIRE(m.run(2.0, 1e-3));
  // For the search the hinge was a spring, a hundred times as stiff as a derived one: it gave way by 1 % of the brake.
  CHECK(m.coordinate(hinge) == Approx(turn).epsilon(0.05));
  CHECK(m.coordinate(guide) == Approx(slide).epsilon(1e-6));
  CHECK(m.brake(held).torque == Approx(-0.5 * 9.81).epsilon(1e-6));
  CHECK(m.brake(held).history.slip_work == 0.0);
}

TEST_CASE("joints that no pose closes are named when the machine blows up") {
  // A crank of 0.2 m that is driven round, though a rod of 0.5 m ties its end to a point 0.55 m from its bearing.
  Machine<VelocityVerlet, Projected> m;
  m.gravity.setZero();
  const BodyId crank = m.add_body(ball("crank", 1.0, 0.01).at({0, 0, 0.1}));
  const JointId bearing = m.add_joint(revolute("bearing", m.ground(), crank, {0, 0, 0}, Y));
  m.add_joint(distance("rod", m.ground(), {0.45, 0, 0.3}, crank, {0, 0, 0.2}));
  m.add_motion(prescribed_joint("motor", bearing, Signal::ramp(0.0, 3.0)));
  const MachineReport report = m.run(2.0, 1e-3);
  CHECK_FALSE(report);
  CHECK_THAT(report.text, Contains("no pose closes all joints"));
}
