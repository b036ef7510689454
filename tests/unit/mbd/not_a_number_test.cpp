#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

const double no_number = std::nan("");

/// Nothing until t = 0.05 s, from then on a number that is none.
double breaks(double t) { return t > 0.05 ? std::sqrt(-t) : 0.0; }

/// What is said of a free body after `change` gave the machine something that breaks at 0.05 s.
template <class I, class Change>
MachineReport report_of(Change&& change) {
  Machine<I> m;
  m.gravity.setZero();
  const BodyId a = m.add_body(brick("a", {0, 0, 0}));
  change(m, a);
  return m.run(0.1, 1e-3);
}

}  // namespace

TEMPLATE_TEST_CASE("a NaN in any component of a force or torque stops the machine at once", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // Alone, so that no other part of the motion gives it away: torques about the principal axes turn nothing else.
  for (int component = 0; component < 6; ++component) {
    const MachineReport report = report_of<TestType>([&](auto& m, BodyId a) {
      m.add_load(custom_load("wind", a, [=](double t, const Body&) {
        double all[6] = {};
        all[component] = breaks(t);
        return Wrench{{all[0], all[1], all[2]}, {all[3], all[4], all[5]}};
      }));
    });
    INFO("component " << component);
    CHECK_FALSE(report);
    CHECK_THAT(report.text, Contains("body 'a' blew up") && Contains("load 'wind' is not a number"));
    CHECK(report.time < 0.053);  // two steps of 1 ms: that in which it breaks, and one until it is felt
  }
  const MachineReport twist = report_of<TestType>([](auto& m, BodyId a) {
    m.add_load(applied_torque("twist", a, Z, Signal::function(breaks, [](double) { return 0.0; })));
  });
  CHECK_THAT(twist.text, Contains("size of load 'twist' is not a number"));
}

TEMPLATE_TEST_CASE("a NaN of any part of a machine reaches the report", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  const auto hinged = [](auto& m, BodyId a) { return m.add_joint(revolute("hinge", m.ground(), a, {0, 0, 0}, Z)); };
  const auto signal = Signal::function(breaks, [](double) { return 0.0; });
  CHECK_FALSE(report_of<TestType>([&](auto& m, BodyId a) {
    m.add_actuator(joint_actuator("servo", hinged(m, a), 10.0, 0.1, signal).with_max_force(1.0));
  }));
  CHECK_FALSE(
      report_of<TestType>([&](auto& m, BodyId a) { m.add_motion(prescribed_joint("drive", hinged(m, a), signal)); }));
  CHECK_FALSE(report_of<TestType>([&](auto& m, BodyId a) { m.add_motion(prescribed_position("lift", a, Z, signal)); }));
  CHECK_FALSE(report_of<TestType>([&](auto& m, BodyId a) { m.add_motion(prescribed_rotation("turn", a, Z, signal)); }));
}

TEMPLATE_TEST_CASE("a pose with a NaN anywhere is reported, whichever speeds come with it", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  const auto report_with = [](auto&& spoil) {
    Machine<TestType> m;
    const BodyId plate = m.add_fixed_body("plate");
    m.add_motion(prescribed_pose("carry", plate, [=](double t) {
      Pose pose{{0, 0, 0}, Mat3::Identity(), Vec3(Vec3::Zero()), Vec3(Vec3::Zero())};
      if (t > 0.05) spoil(pose);
      return pose;
    }));
    return m.run(0.1, 1e-3);
  };
  CHECK(report_with([](Pose&) {}));
  const MachineReport place = report_with([](Pose& p) { p.position.y() = no_number; });
  CHECK_FALSE(place);
  CHECK_THAT(place.text, Contains("body 'plate' blew up") && Contains("value of motion 'carry' is not a number"));
  CHECK_FALSE(report_with([](Pose& p) { p.rotation(1, 2) = no_number; }));
  CHECK_FALSE(report_with([](Pose& p) { p.velocity->z() = no_number; }));
  CHECK_FALSE(report_with([](Pose& p) { p.angular_velocity->x() = no_number; }));
}

TEST_CASE("a body that was put nowhere by hand is reported, be it free or fixed") {
  for (const bool fixed : {false, true}) {
    for (int what = 0; what < 4; ++what) {
      Machine<VelocityVerlet> m;
      m.gravity.setZero();
      const BodyId a = fixed ? m.add_fixed_body("a") : m.add_body(brick("a", {0, 0, 0}));
      REQUIRE(m.step(1e-3));
      auto& motion = m.body(a).motion;
      (what == 0   ? motion.position.y
       : what == 1 ? motion.velocity.y
       : what == 2 ? motion.angular_velocity.y
                   : motion.rotation.row1.z) = no_number;
      INFO("fixed " << fixed << ", part " << what);
      CHECK_THAT(m.step(1e-3).text, Contains("body 'a' blew up"));
    }
  }
}

TEST_CASE("a speed above the largest one is reported, turning or not") {
  for (const Vec3& v : {Vec3(2e5, 0, 0), Vec3(0, 0, 0)}) {
    Machine<VelocityVerlet> m;
    m.add_body(brick("a", {0, 0, 0}).moving(v, v.x() > 0.0 ? Vec3(0, 0, 0) : Vec3(0, 0, 2e5)));
    CHECK_FALSE(m.step(1e-9));
  }
}

TEST_CASE("a run of more steps than doubles count is refused, and of less than half of one") {
  Machine<VelocityVerlet> m;
  m.add_body(brick("a", {0, 0, 0}));
  for (const double time : {1e20, 1e300}) {
    check_refused([&] { (void)m.run(time, 1e-3); }, "time to run", "must be at most 9e15 steps");
  }
  check_refused([&] { (void)m.run(HUGE_VAL, 1e-3); }, "time to run is inf s");
  check_refused([&] { (void)m.run(4e-4, 1e-3); }, "less than half of a time step of 0.001 s");
  CHECK(m.time() == 0.0);
  CHECK_FALSE(m.is_initialised());  // not laid out for a step that is not taken
  REQUIRE(m.run(3e-3, 1e-3));
  CHECK(m.time() == Approx(3e-3));
}
