// How far joints open: it is watched, and reported with what would keep them closed.

#include "spatial_slider_crank.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("a machine whose joints open too far says which joint, how far, and what keeps it closed", "",
                   SymplecticEuler, VelocityVerlet, PredictorCorrector) {
  const auto run = [](int substeps, double& off) {
    SpatialSliderCrank<TestType> s;
    s.m.substeps = s.m.most_substeps = substeps;
    s.m.given_velocities = GivenVelocities::lead;
    off = 0.0;
    const MachineReport report = s.m.run(1.0, 1e-3, [&] { off = std::max(off, s.off()); });
    CHECK(report.time == Approx(1.0));  // it goes on to its end
    return report;
  };
  double off = 0.0;
  const MachineReport open = run(1, off);
  CHECK(off > 0.01);  // the slider is off by more than a centimetre
  CHECK_FALSE(open);
  CHECK(open.joint.valid());
  CHECK_THAT(open.text, Contains("joint 'crank bearing' was out of line by 0.") && Contains("allowed is 0.0001") &&
                            Contains("A time step of ") && Contains("substeps (now 1)"));
  // As many sub-steps as are named, until none are: then joints hold to 1e-4 of the machine's size of 0.5 m, and the
  // slider is where the crank's angle puts it within that size times the few joints between.
  int substeps = 1;
  MachineReport report = open;
  for (int k = 0; k < 5 && !report; ++k) {
    const auto at = report.text.find(" substeps (now");
    substeps = std::stoi(report.text.substr(report.text.rfind(' ', at - 1)));
    report = run(substeps, off);
  }
  INFO(report.text);
  CHECK(report);
  CHECK(substeps < 1000);
  CHECK(off < 1e-4);
}

TEST_CASE("the tolerance of joints is what the user says, and joints of given stiffness are not watched") {
  // A weight of 2 kg hangs on a derived weld: k = 0.5 (0.7/dt)^2 m, so it opens by 2 g dt^2/0.49 = 4.0e-5 m.
  const auto hang = [](double tolerance, bool given) {
    Machine<VelocityVerlet> m;
    m.joint_tolerance = tolerance;
    m.most_substeps = 1;
    const BodyId b = m.add_body(ball("weight", 2.0));
    JointSpec weld = fixed("weld", m.ground(), b, {0, 0, 0});
    if (given) weld = weld.with_stiffness(4.9e5, 1e4);
    m.add_joint(weld);
    return m.run(0.5, 1e-3);
  };
  CHECK(hang(0.0, false));  // 1e-4 of a diagonal of 0.77 m
  CHECK(hang(6e-5, false));
  const MachineReport open = hang(2e-5, false);
  CHECK_FALSE(open);
  CHECK_THAT(open.text, Contains("fixed joint 'weld' stood open by") && Contains("joint_tolerance, 2e-05 m"));
  CHECK(hang(2e-5, true));
  CHECK(hang(std::numeric_limits<double>::infinity(), false));
  check_refused([&] { (void)hang(-1.0, false); }, "joint_tolerance is -1 m");
}

TEMPLATE_TEST_CASE("a machine alone takes as many sub-steps as its joints need, whatever its time step is", "",
                   SymplecticEuler, VelocityVerlet, PredictorCorrector) {
  // At 1 ms without sub-steps the slider is off by centimetres (above). 5e-5 m are allowed; a joint that comes to half
  // of it is closed before it comes to the whole, and the slider hangs on a few of them.
  SpatialSliderCrank<TestType> s;
  s.m.given_velocities = GivenVelocities::lead;
  double off = 0.0;
  const MachineReport report = s.m.run(1.0, 1e-3, [&] { off = std::max(off, s.off()); });
  INFO(report.text << report.note);
  CHECK(report);
  CHECK(s.m.substeps > 10);
  CHECK(s.m.substeps < 300);  // 207 if it starts with 100, which keep all closed for a third of a turn
  CHECK_THAT(report.note, Contains("substeps instead of 1, to keep its joints within joint_tolerance"));
  CHECK(off < 2e-4);
}

TEST_CASE("a machine that needs no sub-steps takes none") {
  Machine<VelocityVerlet> m;
  const BodyId rod = m.add_body(box_body("rod", {1, 0.1, 0.1}, 1000).at({0.5, 0, 0}));
  m.add_joint(revolute("hinge", m.ground(), rod, {0, 0, 0}, Y));
  const MachineReport report = m.run(1.0, 1e-4);
  CHECK(report);
  CHECK(report.note.empty());
  CHECK(m.substeps == 1);
}

TEST_CASE("what holds is not jolted when sub-steps are raised for another joint") {
  // A gear of ratio 2 under 50 N m, which a brake of 30 N m holds with 25. Far from it a ball joint is loaded until
  // sub-steps are needed: gear and brake get some hundred times as stiff, and nothing of theirs moves or slips.
  Machine<VelocityVerlet> m;
  m.gravity.setZero();
  const BodyId in = m.add_body(ball("in")), out = m.add_body(ball("out").at({1, 0, 0}));
  const JointId i = m.add_joint(revolute("i", m.ground(), in, {0, 0, 0}, Z));
  const JointId o = m.add_joint(revolute("o", m.ground(), out, {1, 0, 0}, Z));
  const CouplingId g = m.add_coupling(gear("gear", i, o, 2.0));
  const BrakeId held = m.add_brake(brake("brake", o, 30.0));
  m.add_load(applied_torque("torque", in, Z, Signal::smooth_step(0.0, 50.0, 0.0, 0.3)));
  const BodyId other = m.add_body(ball("other").at({3, 0, 0}));
  m.add_joint(spherical("joint", m.ground(), other, {3, 0, 0}));
  m.add_load(applied_force("pull", other, {3, 0, 0}, -Z, Signal::smooth_step(0.0, 2e4, 1.0, 1.1)));
  REQUIRE(m.run(1.0, 1e-3));
  const int substeps = m.substeps;
  double most = 0.0, fastest = 0.0;
  REQUIRE(m.run(0.5, 1e-3, [&] {
    most = std::max(most, std::abs(m.coupling(g).multiplier));
    fastest = std::max(fastest, std::abs(m.speed(i)));
  }));
  CHECK(m.substeps > 10 * substeps);
  CHECK(most == Approx(25.0).epsilon(1e-9));
  CHECK(fastest < 1e-9);
  CHECK(m.brake(held).history.slip_work == 0.0);
}
