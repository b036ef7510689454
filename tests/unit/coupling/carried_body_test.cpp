// A body whose whole motion is prescribed is met as the fixed ground is: with an endless mass.

#include "catch.hpp"
#include "core/error_of.hpp"
#include "worlds.hpp"

#include <dem/geometry/box/box.hpp>

#include <cmath>
#include <utility>

namespace {

using dem::BodyId;
using dem::Vec3;
using dem::mbd::box_body;
using models::Linear;

enum class Plate { fixed, posed, driven, turns, free };

constexpr double radius = 0.05, density = 1000.0, restitution = 0.5, fall = 0.1, up = 0.3;
constexpr double stiffness = 1e5, time_step = 1e-5;
const double mass = density * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius;

struct Drop {
  dem::World<models::LinearModel> world;
  BodyId plate, ball;
  dem::MotionId held = {};

  /// A ball that flies at 0.1 m/s at a cubic plate of the same mass, which moves at `rise` (m/s) towards it.
  explicit Drop(Plate kind, double rise, double dt = time_step) : world(options(dt)) {
    world.set_contact({Linear::with_restitution(stiffness, restitution), {0.0, stiffness, 0.0}});
    auto& m = world.machine();
    const double edge = std::cbrt(mass / density);
    const auto spec = box_body("plate", {edge, edge, edge}, density).at({0, 0, -0.5 * edge});
    plate = kind == Plate::fixed ? m.add_fixed_body("plate", {0, 0, -0.5 * edge}) : m.add_body(spec);
    ball = m.add_body(dem::mbd::given_body("ball", mass, Vec3::Constant(0.4 * mass * radius * radius))
                          .at({0, 0, 1.1 * radius})
                          .moving({0, 0, -fall}));
    world.add_body_contact(world.add_surface(ball, dem::surface::Sphere(radius)),
                           world.add_surface(plate, dem::surface::Box({edge, edge, edge})));
    drive(kind, rise, -0.5 * edge);
  }

  static dem::WorldOptions options(double dt) {
    dem::WorldOptions o;
    o.gravity = Vec3::Zero();
    o.time_step = dt;
    o.threads = 1;
    return o;
  }
  void drive(Plate kind, double rise, double height) {
    auto& m = world.machine();
    if (kind == Plate::posed) {
      held = m.add_motion(dem::mbd::prescribed_pose("pose", plate, [=](double t) {
        return dem::mbd::Pose{
            .position = Vec3(0, 0, height + rise * t), .velocity = Vec3(0, 0, rise), .angular_velocity = Vec3(0, 0, 0)};
      }));
    }
    if (kind != Plate::driven && kind != Plate::turns) return;
    held = m.add_motion(dem::mbd::prescribed_rotation("turn", plate, Vec3(1, 1, 0), 0.0));
    m.add_motion(dem::mbd::prescribed_position("z", plate, Vec3(0, 0, 1), dem::mbd::Signal::ramp(0.0, rise)));
    m.add_motion(dem::mbd::prescribed_position("y", plate, Vec3(0, 1, 0), 0.0));
    // A direction that lies in the plane of the others holds nothing more.
    const Vec3 third = kind == Plate::driven ? Vec3(1, 0, 1) : Vec3(0, 1, 1);
    m.add_motion(
        dem::mbd::prescribed_position("third", plate, third, dem::mbd::Signal::ramp(0.0, std::sqrt(0.5) * rise)));
  }
  double speed_after() {
    REQUIRE(world.run_for(0.15));
    return world.machine().body(ball).velocity().z();
  }
};

}  // namespace

TEST_CASE("a ball rebounds from a plate that is carried as from a fixed one") {
  // The restitution is that of the ball's own mass. Half a swing lasts pi sqrt(m/k), 720 steps of omega dt = 4.4e-3;
  // the damper's jump at the first touch is met to a part of a step, which is less than omega dt of the speed. If the
  // plate counted with its mass, the dashpot would have sqrt(1/2) of its size, and the restitution would be 0.60.
  const double from_fixed = Drop(Plate::fixed, 0.0).speed_after();
  CHECK(from_fixed == Approx(restitution * fall).epsilon(5e-3));
  CHECK(Drop(Plate::posed, 0.0).speed_after() == from_fixed);  // the same bits
  // Drives take back what the contact does within each step: rounding is left.
  CHECK(Drop(Plate::driven, 0.0).speed_after() == Approx(from_fixed).epsilon(1e-9));
  // Seen from a plate that rises it comes in faster and leaves as much faster.
  for (const Plate kind : {Plate::posed, Plate::driven}) {
    CHECK(Drop(kind, up).speed_after() == Approx(up + restitution * (fall + up)).epsilon(5e-3));
  }
}

TEST_CASE("a grain rebounds from a plate that is carried as from a fixed one") {
  const auto speed_after = [](Plate kind) {
    Drop d(kind, 0.0);
    d.world.machine().body(d.ball).motion.position.x = 1.0;  // out of the way
    const auto grain = d.world.add_grain(
        {d.world.add_species(dem::shape::Sphere(radius), {.density = density}), {0, 0, 1.1 * radius}, {0, 0, -fall}});
    REQUIRE(d.world.run_for(0.15));
    return d.world.velocity(grain).z();
  };
  const double from_fixed = speed_after(Plate::fixed);
  CHECK(from_fixed == Approx(restitution * fall).epsilon(5e-3));  // as above
  CHECK(speed_after(Plate::posed) == from_fixed);
  CHECK(speed_after(Plate::driven) == Approx(from_fixed).epsilon(1e-9));
}

TEST_CASE("the stable time step of contacts knows which bodies are carried") {
  const auto stable = [](Plate kind) { return Drop(kind, 0.0).world.stable_time_step().dt; };
  const double of_fixed = stable(Plate::fixed), of_free = stable(Plate::free);
  // 1/m + R^2/I at the corner of the box about the ball, 3 r^2 off: 1 + 3/0.4 = 8.5 of 1/m; at the corner of the cube:
  // 1 + (3/4)/(1/6) = 5.5 of 1/m. A ball counts twice its law's spring and dashpot (body_stability.hpp).
  const auto limit = [](double inverse_masses, double dashpot_mass) {
    const double ratio = Linear::with_restitution(stiffness, restitution).damping_ratio, w = inverse_masses / mass;
    const double b = 2.0 * ratio * std::sqrt(stiffness * dashpot_mass) * w;
    return 2.0 / (std::sqrt(2.0 * stiffness * w + b * b) + b);
  };
  CHECK(of_fixed == Approx(limit(8.5, mass)).epsilon(1e-9));
  CHECK(of_free == Approx(limit(8.5 + 5.5, 0.5 * mass)).epsilon(1e-9));
  CHECK(stable(Plate::posed) == of_fixed);
  CHECK(stable(Plate::driven) == of_fixed);
  CHECK(stable(Plate::turns) == of_free);  // it may still move along x

  // Let go, the body has a mass again. A step that was given is refused then, one that was chosen is lowered.
  for (const Plate kind : {Plate::posed, Plate::driven}) {
    Drop given(kind, 0.0, 0.9 * of_fixed);
    REQUIRE(given.world.run(2));
    given.world.machine().switch_on(given.held, false);
    check_refused([&] { (void)given.world.run(1); }, "above the largest stable one", "body 'ball' on body 'plate'");
    given.world.set_time_step(0.9 * of_free);
    CHECK(given.world.run(1));
    Drop chosen(kind, 0.0, 0.0);
    // A lamp of 1 kg is pulled at, by 100 N; what bears it does not feel that the step is lowered.
    auto& m = chosen.world.machine();
    const BodyId lamp = m.add_body(dem::mbd::given_body("lamp", 1.0, Vec3::Constant(0.01)).at({5, 0, 0}));
    const auto hook = m.add_joint(dem::mbd::fixed("hook", m.ground(), lamp, {5, 0, 0}));
    m.add_load(dem::mbd::custom_load("pull", lamp, [](double, const dem::Body&) {
      return dem::Wrench{{0, 0, -100}, {0, 0, 0}};
    }));
    REQUIRE(chosen.world.run(200));
    CHECK(chosen.world.time_step() == 0.5 * of_fixed);
    m.switch_on(chosen.held, false);
    for (int k = 0; k < 10; ++k) {
      REQUIRE(chosen.world.run(1));
      CHECK(m.reaction(hook).force.z == Approx(100.0).epsilon(1e-3));
    }
    CHECK(chosen.world.time_step() == 0.5 * of_free);
  }

  // The same where a law lets it go within a run.
  Drop in_run(Plate::posed, 0.0, 0.0);
  const auto release = [&](double t, const dem::Body&) {
    if (t > 2.5 * 0.5 * of_fixed) in_run.world.machine().switch_on(in_run.held, false);
    return dem::Wrench{};
  };
  in_run.world.machine().add_load(dem::mbd::custom_load("release", in_run.ball, release));
  REQUIRE(in_run.world.run(6));
  CHECK(in_run.world.time_step() == 0.5 * of_free);
}

TEST_CASE("two bodies that are carried still feel each other") {
  // The plate rises into a ball that stands: k times the overlap, and the dashpot of the masses that they have, m/2 of
  // two equal ones, at the speed that is given.
  Drop d(Plate::posed, up);
  d.world.machine().add_motion(dem::mbd::prescribed_pose("stand", d.ball, [](double) {
    return dem::mbd::Pose{
        .position = Vec3(0, 0, 1.1 * radius), .velocity = Vec3(0, 0, 0), .angular_velocity = Vec3(0, 0, 0)};
  }));
  REQUIRE(d.world.run_for(0.02));
  // The newest forces are those at the end of the newest step.
  const double overlap = up * d.world.time() - 0.1 * radius;
  const auto law = Linear::with_restitution(stiffness, restitution);
  const double force = stiffness * overlap + 2.0 * law.damping_ratio * std::sqrt(stiffness * 0.5 * mass) * up;
  CHECK(d.world.state().body_contacts.pairs[0].force.z == Approx(force).epsilon(1e-9));
}
