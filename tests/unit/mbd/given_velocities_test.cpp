// Velocities that joints do not allow: what becomes of them at the start.

#include "spatial_slider_crank.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("velocities that do not fit the joints are changed by the least kinetic energy, and the report says so") {
  // Two equal balls on a rod of given length, one thrown across it, one at rest along it: only the speeds along the rod
  // have to agree. 1 m/s along the rod, on one of two equal masses, becomes 0.5 m/s for both, half of the energy.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(ball("a").moving({1, 2, 0})), b = m.add_body(ball("b").at({1, 0, 0}));
  m.add_joint(distance("rod", a, {0, 0, 0}, b, {1, 0, 0}));
  const MachineReport report = m.run(0.0, 1e-4);
  CHECK(report);
  CHECK_THAT(report.note, Contains("The given velocities did not fit the joints: body '") &&
                              Contains("the kinetic energy from 2.5 to 2.25 J"));
  CHECK((m.body(a).velocity() - Vec3(0.5, 2, 0)).norm() < 1e-14);
  CHECK((m.body(b).velocity() - Vec3(0.5, 0, 0)).norm() < 1e-14);
  CHECK(m.assembly().kinetic_of_change == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("a crank that is given a speed takes its rod and slider along, or is refused") {
  // With `lead` the crank keeps its speed, and the start is that of the kinematics: the slider moves at its rate, by
  // differences of its closed form. Without gravity and friction the energy is then kept.
  SpatialSliderCrank<VelocityVerlet> s;
  using C = SpatialSliderCrank<VelocityVerlet>;
  s.m.given_velocities = GivenVelocities::lead;
  s.m.assemble();
  constexpr double h = 1e-5;
  CHECK(s.m.speed(s.bearing) == Approx(C::speed).epsilon(1e-5));
  CHECK(s.m.speed(s.guide) == Approx(C::speed * (s.slider_at(h) - s.slider_at(-h)) / (2 * h)).epsilon(1e-5));
  const double start = s.kinetic();
  s.m.substeps = 200;
  REQUIRE(s.m.run(0.2, 1e-3));
  // The energy in motion goes to the joints' springs and dampers by shares of their openings alone.
  CHECK(s.kinetic() == Approx(start).epsilon(2e-3));

  // Projected, the crank and what hangs on it share its momentum: what a stop in the joints leaves of the energy, which
  // is the square of the generalised momentum over the generalised mass.
  SpatialSliderCrank<VelocityVerlet> p;
  const double given = p.kinetic();
  const AssemblyReport& report = p.m.assemble();
  CHECK(report.has_changed());
  CHECK(report.kinetic_before == Approx(given));
  CHECK(report.kinetic_after == Approx(given * given / start).epsilon(1e-5));
  CHECK(report.kinetic_after < 0.1 * given);

  SpatialSliderCrank<VelocityVerlet> r;
  r.m.given_velocities = GivenVelocities::refuse;
  check_refused([&] { (void)r.m.step(1e-4); }, "the given velocities do not fit the joints", "body '",
                "given_velocities be project or lead");

  SpatialSliderCrank<VelocityVerlet> kept;
  kept.m.given_velocities = GivenVelocities::keep;
  REQUIRE(kept.m.run(0.0, 1e-4));
  CHECK(kept.m.speed(kept.bearing) == C::speed);
}

TEST_CASE("velocities that fit the joints stay as they are, to the last bit") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId b = m.add_body(ball("b").at({1, 0, 0}).moving({0, 0, -0.3}, {0, 0.3, 0}));
  m.add_joint(revolute("hinge", m.ground(), b, {0, 0, 0}, Y));
  const MachineReport report = m.run(0.0, 1e-4);
  CHECK(report.note.empty());
  CHECK(m.body(b).velocity() == Vec3(0, 0, -0.3));
  CHECK_FALSE(m.assembly().has_changed());
}

TEST_CASE("couplings and prescribed motions take their shares of velocities that are given") {
  // A gear of ratio 2: w_out = 2 w_in. Inertia of 0.1 each and 3 rad/s on the input alone: the momentum 0.1 * 3 on the
  // generalised mass 0.1 (1 + 4) leaves 0.6 rad/s.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId in = m.add_body(ball("in").moving({0, 0, 0}, {0, 0, 3})), out = m.add_body(ball("out").at({1, 0, 0}));
  const JointId i = m.add_joint(revolute("i", m.ground(), in, {0, 0, 0}, Z));
  const JointId o = m.add_joint(revolute("o", m.ground(), out, {1, 0, 0}, Z));
  m.add_coupling(gear("gear", i, o, 2.0));
  m.assemble();
  CHECK(m.speed(i) == Approx(0.6).epsilon(1e-12));
  CHECK(m.speed(o) == Approx(1.2).epsilon(1e-12));
}

TEST_CASE("assemble() before the first step knows how fast drives turn") {
  // The wheel is driven at 3 rad/s and the gear of ratio 2 takes its shaft along, as the first step would have it.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId in = m.add_body(ball("in")), out = m.add_body(ball("out").at({1, 0, 0}));
  const JointId i = m.add_joint(revolute("i", m.ground(), in, {0, 0, 0}, Z));
  const JointId o = m.add_joint(revolute("o", m.ground(), out, {1, 0, 0}, Z));
  m.add_coupling(gear("gear", i, o, 2.0));
  const MotionId drive = m.add_motion(prescribed_speed("drive", i, 3.0));
  CHECK(m.assemble().has_changed());
  CHECK(m.speed(i) == Approx(3.0).epsilon(1e-12));
  CHECK(m.speed(o) == Approx(6.0).epsilon(1e-12));
  REQUIRE(m.run(0.1, 1e-3));
  CHECK(m.speed(o) == Approx(6.0).epsilon(1e-9));
  CHECK(std::abs(m.motion(drive).drive.force) < 1e-9);  // nothing had to be brought up to speed
}
