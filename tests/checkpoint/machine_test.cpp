// Every kind of joint and part that a machine may have goes on from a file in every bit.

#include "scenes_to_save.hpp"

namespace {

using namespace dem::mbd;
using dem::BodyId;
using dem::JointId;
const Vec3 X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();

/// What is steered between steps.
struct Steered {
  JointId catch_joint;
  dem::CouplingId gears;
  dem::ActuatorId engine;
  dem::BrakeId brake;
  dem::ClutchId clutch;
  dem::MotionId pose;
};

/// Pendulums on joints of each kind, beside each other.
void add_pendulums(Mechanism& m) {
  using Make = JointSpec (*)(BodyId, BodyId, const Vec3&);
  const Make kinds[] = {
      [](BodyId a, BodyId b, const Vec3& p) { return fixed("fixed", a, b, p); },
      [](BodyId a, BodyId b, const Vec3& p) { return spherical("spherical", a, b, p); },
      [](BodyId a, BodyId b, const Vec3& p) { return cylindrical("cylindrical", a, b, p, Y + 0.1 * Z); },
      [](BodyId a, BodyId b, const Vec3& p) { return universal("universal", a, b, p, X, X); },
      [](BodyId a, BodyId b, const Vec3& p) { return planar("planar", a, b, p, Y); },
      [](BodyId a, BodyId b, const Vec3& p) { return point_on_line("on a line", a, b, p, Y + 0.2 * Z); },
      [](BodyId a, BodyId b, const Vec3& p) { return point_on_plane("on a plane", a, b, p, Z + 0.2 * X); },
      [](BodyId a, BodyId b, const Vec3& p) { return constant_velocity("constant velocity", a, b, p, X, X); },
      [](BodyId a, BodyId b, const Vec3& p) { return plunging_constant_velocity("plunging", a, b, p, X, X); },
      [](BodyId a, BodyId b, const Vec3& p) { return distance("distance", a, p - Vec3(0.05, 0, 0.1), b, p); }};
  double y = 1.0;
  for (const Make make : kinds) {
    const Vec3 place(0, y += 0.5, 0);
    const BodyId body = m.add_body(box_body("", {0.1, 0.05, 0.04}, 1000).at(place + Vec3(0.05, 0, 0)));
    m.add_joint(make(m.ground(), body, place));
  }
}

/// A shaft train: an engine, a clutch that slips, gears, a differential that is limited, and a brake.
void add_driveline(Mechanism& m, Steered& s) {
  const auto shaft = [&](const char* name, double x, double y) {
    const Vec3 at(x, y, 1);
    const BodyId body = m.add_body(cylinder_body(name, 0.1, 0.05, 2000).at(at).moving(Vec3::Zero(), x * Z));
    return m.add_joint(revolute(std::string("axle of ") + name, m.ground(), body, at, Z));
  };
  const JointId crank = shaft("crank", 50, 0), input = shaft("input", 1, 0), output = shaft("output", 2, 0),
                left = shaft("left", 4, 1), right = shaft("right", 4.5, -1);
  s.engine =
      m.add_actuator(engine("engine", crank, Curve{{0.0, 20.0}, {300.0, 10.0}}, Curve{{0.0, -1.0}, {300.0, -5.0}}, 0.3)
                         .idling_at(80.0));
  s.clutch = m.add_clutch(clutch("clutch", crank, input, Signal::ramp(1.0, 50.0)));
  s.gears = m.add_coupling(gear("gears", input, output, 2.0));
  const auto split = m.add_coupling(differential("differential", output, left, right, 1.0));
  m.add_clutch(limited_slip("plates", split, 0.2, 2.0));
  s.brake = m.add_brake(brake("brake", left, 0.5));
  m.add_spring(joint_spring("torsion bar", right, 20.0, 0.1));
  m.add_spring(joint_spring_table("stops", left, Curve{{-1.0, 5.0}, {1.0, -5.0}}));
}

/// Two arms on a frame with a bar between them, a spring with a table, a pose and a speed that are prescribed, and a
/// joint that is switched.
void add_suspension(Mechanism& m, Steered& s) {
  const Vec3 middle(0, -2, 0);
  const BodyId frame = m.add_body(box_body("frame", {0.5, 0.2, 0.1}, 1000).at(middle));
  m.add_joint(prismatic("guide", m.ground(), frame, middle, Z));
  BodyId arms[2];
  for (const double side : {-1.0, 1.0}) {
    const Vec3 hinge = middle + Vec3(0, 0.15 * side, 0), tip = hinge + Vec3(0, 0.3 * side, 0);
    BodyId& arm = arms[side > 0.0] =
        m.add_body(box_body("", {0.05, 0.3, 0.05}, 1000).at(hinge + Vec3(0, 0.15 * side, 0)));
    m.add_joint(revolute("", frame, arm, hinge, X));
    m.add_spring(spring_table("", m.ground(), tip - 0.3 * Z, arm, tip, 0.3,
                              Curve{{-0.1, -50.0}, {0.0, 0.0}, {0.1, 200.0}}, 5.0));
  }
  m.add_anti_roll_bar({.name = "bar",
                       .chassis = frame,
                       .left = arms[0],
                       .right = arms[1],
                       .at_left = middle - Vec3(0, 0.4, 0),
                       .at_right = middle + Vec3(0, 0.4, 0),
                       .stiffness = 500.0,
                       .damping = 1.0});
  m.add_load(applied_force("bump", arms[1], middle + Vec3(0, 0.4, 0), Z, Signal::sine(30.0, 20.0)));

  const BodyId plate = m.add_fixed_body("plate", {0, -4, 0});
  s.pose = m.add_motion(prescribed_pose("wobble", plate, [](double t) {
    return Pose{.position = {0, -4, 0.01 * std::sin(20.0 * t)},
                .rotation = Eigen::AngleAxisd(0.1 * std::sin(30.0 * t), Vec3::UnitX()).toRotationMatrix()};
  }));
  const BodyId rider = m.add_body(box_body("rider", {0.1, 0.1, 0.1}, 1000).at({0, -4, 0.1}));
  s.catch_joint = m.add_joint(fixed("catch", plate, rider, {0, -4, 0.05}));
  const BodyId wheel = m.add_body(cylinder_body("wheel", 0.1, 0.05, 2000).at({1, -4, 0}));
  m.add_motion(prescribed_speed("turn", m.add_joint(revolute("wheel", m.ground(), wheel, {1, -4, 0}, Z)),
                                Signal::smooth_step(0.0, 30.0, 0.0, 0.05)));
}

template <class Model>
struct Workshop {
  dem::World<Model> world;
  Steered steered;

  explicit Workshop(int threads)
      : world([threads] {
          dem::WorldOptions o = options({0, 0, -9.81}, 5e-5);
          o.threads = threads;
          return o;
        }()) {
    world.set_contact(sand<Model>());
    world.add_species(Sphere(1e-2));
    auto& m = world.machine();
    m.joint_tolerance = 1.0;  // m: accuracy is not what is asked here
    add_pendulums(m);
    add_driveline(m, steered);
    add_suspension(m, steered);
  }

  /// The steps up to a number, and what is done between them.
  void run_to(std::uint64_t end) {
    auto& m = world.machine();
    while (world.steps() < end) {
      const auto report = world.run(100);
      INFO(report.text);
      REQUIRE(report);
      switch (world.steps()) {
        case 200: m.switch_on(steered.catch_joint, false); break;
        case 300: m.set_ratio(steered.gears, 1.5); break;
        case 400: m.set_throttle(steered.engine, 0.8); break;
        case 500: m.switch_on(steered.catch_joint); break;
        case 600: m.set_capacity(steered.brake, 3.0); break;
        case 700: m.set_fixed(m.body_named("frame")); break;
        default: break;
      }
    }
  }
};

}  // namespace

TEMPLATE_TEST_CASE("a machine with joints and parts of every kind goes on from a file in every bit", "",
                   models::CorrectedBalls, models::VerletBalls) {
  const Folder folder;
  const std::uint64_t saved_at = GENERATE(100u, 500u, 800u);
  Workshop<TestType> whole(1), first(1), second(1);
  whole.run_to(1200);
  first.run_to(saved_at);
  dem::save(first.world, folder / "state.h5");
  dem::load(second.world, folder / "state.h5");
  CHECK(difference(first.world, second.world) == "");
  second.run_to(1200);
  CHECK(difference(whole.world, second.world) == "");
  // Nothing stands still, and the clutch slips where it is saved first.
  const auto& m = first.world.machine();
  if (saved_at == 100) CHECK(m.clutch(first.steered.clutch).is_slipping());
  for (const auto& clutch : m.parts().clutches) CHECK(clutch.torque != 0.0);
  for (const auto& spring : m.parts().springs) CHECK(spring.force != 0.0);
  for (const auto& coupling : m.parts().couplings) CHECK(coupling.multiplier != 0.0);
}
