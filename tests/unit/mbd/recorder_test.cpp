#include <vector>

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("a recorder samples joints, bodies and the user's own numbers") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("rod", {1, 0, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), b, {0, 0, 0}, Y));
  Recorder recorder(m);
  const ActuatorId servo = m.add_actuator(joint_actuator("servo", hinge, 10.0, 1.0));
  recorder.add("time_s", [&] { return m.time(); }).add(hinge).add(b).add(servo);
  REQUIRE(recorder.columns().size() == 1 + 8 + 6 + 3);
  CHECK(recorder.columns()[15] == "servo_coordinate_rad");
  CHECK(recorder.columns()[16] == "servo_speed_rad_per_s");
  CHECK(recorder.columns()[17] == "servo_torque_Nm");
  check_refused([&] { recorder.add(ActuatorId(1)); }, "an actuator that the machine does not have");
  CHECK(recorder.columns()[1] == "hinge_turn_rad");
  CHECK(recorder.columns()[3] == "hinge_force_x_N");
  int rows = 0;
  const MachineReport report = m.run(0.1, 1e-3, [&] {
    if (recorder.is_due(m.time(), 0.01)) {
      const auto row = recorder.sample();
      CHECK(row[0] == m.time());
      CHECK(row[1] == m.coordinate(hinge));
      // The actuator's numbers are those of the last force evaluation, at the predicted end of the step.
      CHECK(row[15] == Approx(m.coordinate(hinge)).margin(1e-5));
      CHECK(row[16] == m.actuator(servo).speed);
      CHECK(row[17] == m.actuator(servo).force);
      rows += 1;
    }
  });
  REQUIRE(report);
  CHECK(rows == 10);
}

TEST_CASE("columns of what slides end in other units than those of what turns") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("rod", {1, 0, 0}));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), b, {0, 0, 0}, X));
  const ActuatorId on_joint = m.add_actuator(joint_actuator("ram", guide, 10.0, 1.0));
  const ActuatorId on_points = m.add_actuator(linear_actuator("jack", m.ground(), {2, 0, 0}, b, {1, 0, 0}, 10.0, 1.0));
  const BrakeId shoe = m.add_brake(brake("shoe", guide, 5.0));
  Recorder recorder(m);
  recorder.add(on_joint).add(on_points).add(shoe);
  CHECK(recorder.columns() == std::vector<std::string>{"ram_coordinate_m", "ram_speed_m_per_s", "ram_force_N",
                                                       "jack_coordinate_m", "jack_speed_m_per_s", "jack_force_N",
                                                       "shoe_capacity_N", "shoe_force_N", "shoe_slip_speed_m_per_s"});
}

TEST_CASE("a recorder's rows begin at the start where it is asked there, and else after the first step") {
  for (const bool from_start : {true, false}) {
    Machine<SymplecticEuler> m;
    m.gravity = {0, 0, -10.0};
    const BodyId b = m.add_body(brick("b", {0, 0, 0}));
    const JointId weld = m.add_joint(fixed("weld", m.ground(), b, {0, 0, 0}));
    Recorder recorder(m);
    recorder.add("time_s", [&] { return m.time(); }).add(weld);
    std::vector<double> times, forces;
    const auto write = [&] {
      if (!recorder.is_due(m.time(), 0.01)) return;
      const auto row = recorder.sample();
      times.push_back(row[0]);
      forces.push_back(row[3]);
    };
    if (from_start) write();
    REQUIRE(m.run(0.03, 1e-3, write));
    REQUIRE(times.size() == (from_start ? 4 : 3));
    for (std::size_t k = 0; k < times.size(); ++k) {
      CHECK(times[k] == Approx(0.01 * static_cast<double>(k) + (from_start ? 0.0 : 1e-3)));
    }
    if (from_start) CHECK(forces[0] == 0.0);  // none was evaluated yet
  }
}
