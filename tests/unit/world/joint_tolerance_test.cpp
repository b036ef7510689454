// The sub-steps of a machine in a world are chosen by how far its joints may open.

#include "catch.hpp"
#include "worlds.hpp"

#include <dem/dem.hpp>

#include <algorithm>

namespace {

using dem::BodyId, dem::JointId, dem::Vec3;
using models::Balls, models::CorrectedBalls, models::VerletBalls;

const Vec3 X = Vec3::UnitX(), Z = Vec3::UnitZ();

/// A corner of a car on double wishbones: 1,000 kg on a vertical guide, wishbones of 5 kg, a wheel carrier of 40 kg, a
/// spring from the lower wishbone to the body, a damper, and a tyre of 2e5 N/m.
template <class Model>
struct QuarterCar {
  static constexpr double g = 9.81, tyre = 2e5, mass = 1000.0 + 2 * 5.0 + 40.0;

  dem::World<Model> world{dem::WorldOptions{.time_step = 1e-3}};
  BodyId body, carrier;
  std::vector<JointId> joints;

  QuarterCar() {
    using namespace dem::mbd;
    Mechanism& m = world.machine();
    body = m.add_body(given_body("body", 1000.0, Vec3(300, 300, 300)).at({0, 0, 0.6}));
    const BodyId lower = m.add_body(given_body("lower wishbone", 5.0, Vec3(0.05, 0.1, 0.1)).at({0, 0.4, 0.2}));
    const BodyId upper = m.add_body(given_body("upper wishbone", 5.0, Vec3(0.05, 0.1, 0.1)).at({0, 0.45, 0.5}));
    carrier = m.add_body(given_body("carrier", 40.0, Vec3(1, 1, 1)).at({0, 0.7, 0.35}));
    const auto keep = [&](JointId j) { joints.push_back(j); };
    keep(m.add_joint(prismatic("guide", m.ground(), body, {0, 0, 0.6}, Z)));
    keep(m.add_joint(revolute("lower bearing", body, lower, {0, 0.2, 0.2}, X)));
    keep(m.add_joint(revolute("upper bearing", body, upper, {0, 0.3, 0.5}, X)));
    keep(m.add_joint(spherical("lower ball", lower, carrier, {0, 0.65, 0.2})));
    keep(m.add_joint(spherical("upper ball", upper, carrier, {0, 0.65, 0.5})));
    keep(m.add_joint(distance("tie rod", body, {0.15, 0.25, 0.3}, carrier, {0.15, 0.65, 0.3})));
    m.add_spring(spring("spring", lower, {0, 0.5, 0.2}, body, {0, 0.35, 0.7}, 4e5));
    m.add_spring(spring("damper", carrier, {0, 0.65, 0.4}, body, {0, 0.6, 0.9}, 0.0, 1.5e4));
    // The tyre pushes up at the wheel's foot, beside the carrier; its damper stands for rubber.
    m.add_load(custom_load("tyre", carrier, [](double, const dem::Body& b) {
      const Vec3 foot = b.point({0, 0.05, -0.35});
      const double push = std::max(0.0, -tyre * foot.z() - 1.2e4 * b.velocity().z());
      return dem::Wrench{{0, 0, push}, dem::from_eigen(Vec3((foot - b.position()).cross(Vec3(0, 0, push))))};
    }));
  }
  double opening() {
    double most = 0.0;
    for (const JointId j : joints) most = std::max(most, world.machine().violation(j).displacement);
    return most;
  }
};

}  // namespace

// 1e-4 of the machine's diagonal, 1.9 m: bodies count as far as their radius of gyration reaches. At one step of 1 ms
// the joints stood open by centimetres, and the report was well.
TEMPLATE_TEST_CASE("a heavy car on light wishbones keeps its joints closed as it drops on its tyre", "", Balls,
                   VerletBalls, CorrectedBalls) {
  QuarterCar<TestType> car;
  double worst = 0.0;
  const auto report = car.world.run(150, [&] {
    worst = std::max(worst, car.opening());
    return true;
  });
  INFO(report.text << report.note);
  REQUIRE(report);
  CHECK(report.note.find("substeps instead of 1, to keep its joints") != std::string::npos);
  CHECK(report.note.find("that needs most") != std::string::npos);
  CHECK(worst < 1.9e-4);
}

TEST_CASE("a heavy car on light wishbones comes to rest on its tyre with closed joints, or says that it does not") {
  QuarterCar<VerletBalls> car;
  REQUIRE(car.world.run(4000));
  CHECK(car.opening() < 1.9e-4);
  // The tyre carries the car's weight, to what is left of its swing after 4 s.
  const double foot = car.world.machine().body(car.carrier).point({0, 0.05, -0.35}).z();
  CHECK(-car.tyre * foot == Approx(car.mass * car.g).epsilon(2e-3));

  // Held to four sub-steps, the same car says so.
  QuarterCar<VerletBalls> forced;
  forced.world.machine().substeps = forced.world.machine().most_substeps = 4;
  const auto report = forced.world.run(1500);
  CHECK(report.problem == dem::StepReport::Problem::joint);
  CHECK(report.text.find("substeps (now 4), keeps it; or raise joint_tolerance") != std::string::npos);
}

TEST_CASE("sub-steps of a machine are raised while it runs, as the load on a joint grows") {
  // Without gravity nothing is known of the load before: a force that grows to 100 kN in a tenth of a second draws a
  // body of 1 kg from a guide across it. In the end the guide gives way by a share of what is allowed.
  dem::World<VerletBalls> world({.gravity = {0, 0, 0}, .time_step = 1e-3});
  auto& m = world.machine();
  const BodyId cart = m.add_body(dem::mbd::given_body("cart", 1.0, Vec3(0.1, 0.1, 0.1)));
  const JointId guide = m.add_joint(dem::mbd::prismatic("guide", m.ground(), cart, {0, 0, 0}, X));
  m.add_load(dem::mbd::applied_force(
      "pull", cart, {0, 0, 0}, Z, dem::mbd::Signal::function([](double t) { return 1e5 * std::min(1.0, t / 0.1); })));
  const double allowed = 1e-4 * 2.0 * std::sqrt(0.3);  // the diagonal of a cube of +- 0.316 m
  double worst = 0.0;
  const auto report = world.run(300, [&] {
    worst = std::max(worst, m.violation(guide).displacement);
    return true;
  });
  INFO(report.text << report.note);
  REQUIRE(report);
  CHECK(m.substeps > 50);
  // The force of the first step, 1 kN, already opens the guide by 4 mm; then it closes and stays so.
  CHECK(m.violation(guide).displacement < allowed);
  CHECK(m.reaction(guide).force.z == Approx(-1e5).epsilon(1e-6));
  // Never lowered, and the same again.
  const int substeps = m.substeps;
  REQUIRE(world.run(100));
  CHECK(m.substeps == substeps);
}

TEST_CASE("a heavy car on light wishbones needs no sub-steps if its joints are held exactly") {
  QuarterCar<models::HeldBalls> car;
  double worst = 0.0;
  const auto watch = [&] {
    worst = std::max(worst, car.opening());
    return true;
  };
  const auto report = car.world.run(4000, watch);
  INFO(report.text << report.note);
  REQUIRE(report);
  CHECK(car.world.machine().substeps == 1);
  CHECK(worst < 1e-10);
  const double foot = car.world.machine().body(car.carrier).point({0, 0.05, -0.35}).z();
  CHECK(-car.tyre * foot == Approx(car.mass * car.g).epsilon(2e-3));
  // The guide keeps its direction, and the lower ball joint carries what the tyre does but for the other parts' weight.
  CHECK(car.world.machine().violation(JointId(0)).rotation < 1e-10);
}
