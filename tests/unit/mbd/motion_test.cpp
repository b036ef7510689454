#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("a pendulum keeps its energy", "", PredictorCorrector, VelocityVerlet) {
  // 1 kg, 1 m, released horizontal, 10 s: less than 5e-5 J is asked for, 3.7e-6 J was measured. The joint's springs
  // count: at the bottom they hold (30 N)^2 / 2k = 7e-4 J, k = 6.1e5 N/m at dt = 2e-5 s, and open by 30 N / k = 5e-5 m.
  Machine<TestType> m;
  const BodyId bob = m.add_body(given_body("bob", 1.0, Vec3(1e-3, 1e-3, 1e-3)).at({1, 0, 0}));
  const JointId pivot = m.add_joint(revolute("pivot", m.ground(), bob, {0, 0, 0}, Y));
  const auto energy = [&] { return energy_of(m.parts(), m.gravity).sum(); };
  const double start = energy();
  double worst = 0.0;
  REQUIRE(m.run(10.0, 2e-5, [&] { worst = std::max(worst, std::abs(energy() - start)); }));
  CHECK(worst < 5e-5);
  CHECK(m.violation(pivot).displacement < 1e-4);
}

TEST_CASE("a pendulum's period at 90 degrees is that of the elliptic integral") {
  // T = 4 K(sin(45 deg)) sqrt(I / m g l), I about the pivot.
  Machine<PredictorCorrector> m;
  const double inertia = 0.05;
  const BodyId bob = m.add_body(given_body("bob", 1.0, Vec3(inertia, inertia, inertia)).at({1, 0, 0}));
  const JointId pivot = m.add_joint(revolute("pivot", m.ground(), bob, {0, 0, 0}, Y));
  const double period = 4.0 * std::comp_ellint_1(std::sqrt(0.5)) * std::sqrt((1.0 + inertia) / 9.81);
  double last = 0.0, first_zero = -1.0, second_zero = -1.0;  // of the speed, at the turning points
  const double dt = 2e-5;
  REQUIRE(m.run(1.2 * period, dt, [&] {
    const double speed = m.speed(pivot), t = m.time();
    if (t > 0.1 && last * speed < 0.0) {
      const double zero = t - dt * speed / (speed - last);
      (first_zero < 0.0 ? first_zero : second_zero) = zero;
    }
    last = speed;
  }));
  // The joint gives way by up to 30 N / 2.9e7 N/m = 1e-6 m, half of which counts in the period.
  CHECK(second_zero == Approx(period).epsilon(3e-6));
  CHECK(first_zero == Approx(period / 2).epsilon(3e-6));
}

TEST_CASE("a heavy top in steady precession goes round at the closed form's rate") {
  // m g h = (C w3 - A' W cos(tilt)) W, A' = A + m h^2: choose W and the tilt, and spin it accordingly.
  const double mass = 0.5, h = 0.1, A = 4e-4, C = 6e-4, W = 2.0, tilt = 0.5, g = 9.81;
  const double spin = (mass * g * h + (A + mass * h * h) * W * W * std::cos(tilt)) / (C * W);
  const Mat3 pose = Eigen::AngleAxisd(tilt, Y).toRotationMatrix();
  const Vec3 axis = pose * Z;
  const Vec3 w = W * Z + (spin - W * std::cos(tilt)) * axis;
  Machine<PredictorCorrector> m;
  const BodyId top = m.add_body(given_body("top", mass, Vec3(A, A, C)).at(h * axis, pose).moving(w.cross(h * axis), w));
  m.add_joint(spherical("tip", m.ground(), top, {0, 0, 0}));
  double turns = 0.0, last = 0.0, highest = 0.0, lowest = 10.0;
  REQUIRE(m.run(2.0 * pi / W, 2e-5, [&] {
    const Vec3 e = m.body(top).rotation() * Z;
    const double azimuth = std::atan2(e.y(), e.x());
    turns += std::remainder(azimuth - last, 2.0 * pi);
    last = azimuth;
    highest = std::max(highest, std::acos(e.z()));
    lowest = std::min(lowest, std::acos(e.z()));
  }));
  // The tip's spring starts unloaded, which sets off a nutation of order (m g / k) / h < 1e-5.
  CHECK(turns == Approx(2.0 * pi).epsilon(1e-4));
  CHECK(highest == Approx(tilt).margin(1e-4));
  CHECK(lowest == Approx(tilt).margin(1e-4));
}

TEST_CASE("a weight on a massless rod circles as a conical pendulum") {
  // tan(tilt) = w^2 r / g, tension = m g / cos(tilt).
  const double length = 0.8, tilt = 0.6, r = length * std::sin(tilt), w = std::sqrt(9.81 * std::tan(tilt) / r);
  Machine<PredictorCorrector> m;
  const BodyId bob = m.add_body(
      given_body("bob", 2.0, Vec3(1e-3, 1e-3, 1e-3)).at({r, 0, -length * std::cos(tilt)}).moving({0, w * r, 0}));
  const JointId rod = m.add_joint(distance("rod", m.ground(), {0, 0, 0}, bob, {r, 0, -length * std::cos(tilt)}));
  REQUIRE(m.run(2.0 * pi / w, 5e-5));
  // The rod starts unloaded and stretches by m g / (k cos(tilt)), 8e-8 of its length, and swings about that. The round
  // ends within half a step, on a way of v dt = 9e-5 m.
  CHECK(m.body(bob).position().norm() == Approx(length).epsilon(2e-7));
  CHECK((m.body(bob).position() - Vec3(r, 0, -length * std::cos(tilt))).norm() < 4.5e-5);
  const Vec3 tension = to_eigen(m.reaction(rod).force);
  CHECK(tension.norm() == Approx(2.0 * 9.81 / std::cos(tilt)).epsilon(1e-3));
  CHECK(tension.z() > 0.0);
}

TEST_CASE("an unloaded chain of free bodies keeps momentum and angular momentum") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  BodyId last;
  for (int k = 0; k < 4; ++k) {
    const BodyId link = m.add_body(
        brick("link " + std::to_string(k), {1.0 * k, 0, 0}).moving({0.1 * k, 0.3, -0.2 * k}, {0.5, -1.0 * k, 0.7}));
    if (k > 0)
      m.add_joint(joint(k == 1   ? JointKind::spherical
                        : k == 2 ? JointKind::revolute
                                 : JointKind::universal,
                        "joint " + std::to_string(k), last, link, {k - 0.5, 0, 0}, X));
    last = link;
  }
  const auto sums = [&] {
    Vec3 p = Vec3::Zero(), l = Vec3::Zero();
    for (const Body& b : m.bodies()) {
      p += b.mass * b.velocity();
      l += angular_momentum(b);
    }
    return std::pair{p, l};
  };
  const auto [p0, l0] = sums();
  REQUIRE(m.run(1.0, 1e-4));
  const auto [p1, l1] = sums();
  CHECK((p1 - p0).norm() < 1e-11);
  CHECK((l1 - l0).norm() < 1e-5);  // second order in dt: (5 rad/s 1e-4)^2 a step, summed
}

namespace {

struct SubstepEnergy {
  double worst = 0.0;  ///< largest change in 100 oscillations, relative to the energy at the start
  double drift = 0.0;  ///< mean of the last 20 oscillations to that of the first 20, minus 1
};

/// A stiff little machine (two bodies, one joint) that hangs on a soft undamped spring which a "world" evaluates once a
/// step, as it does the grains.
template <class I>
SubstepEnergy substep_energy(int substeps, double omega_dt) {
  InWorld<I> world;
  Mechanism& m = world.m;
  m.substeps = substeps;
  const double k = 1000.0, mass = 2.0, omega = std::sqrt(k / mass), dt = omega_dt / omega;
  const BodyId a = m.add_body(given_body("a", 1.0, Vec3(0.1, 0.1, 0.1)).moving({0.5, 0, 0}));
  const BodyId b = m.add_body(given_body("b", 1.0, Vec3(0.1, 0.1, 0.1)).at({0, 0.3, 0}).moving({0.5, 0, 0}));
  m.add_joint(fixed("weld", a, b, {0, 0.15, 0}));
  m.add_joint(prismatic("guide", m.ground(), a, {0, 0, 0}, X));
  world.start(dt);
  const auto spring_on_bodies = [&] {
    for (const BodyId id : {a, b}) {
      m.body(id).force += {-0.5 * k * m.body(id).motion.position.x, 0, 0};
    }
  };
  const auto energy = [&] {
    return energy_of(m.parts(), Vec3::Zero()).sum() + 0.25 * k *
                                                          (m.body(a).position().x() * m.body(a).position().x() +
                                                           m.body(b).position().x() * m.body(b).position().x());
  };
  const double start = energy();
  SubstepEnergy result;
  double first = 0.0, last = 0.0;
  const int steps = static_cast<int>(100 * 2 * pi / omega_dt);
  for (int s = 0; s < steps; ++s) {
    world.step(dt, Vec3::Zero(), spring_on_bodies);
    const double now = energy() / start;
    result.worst = std::max(result.worst, std::abs(now - 1.0));
    if (s < steps / 5) first += now;
    if (s >= steps - steps / 5) last += now;
  }
  result.drift = last / first - 1.0;
  return result;
}

}  // namespace

TEST_CASE("a function of the user reads a sensor in every substep, and trials are not sampled") {
  // A push that follows what a load cell feels. The world calls the machine twice a step, with two stages in a substep.
  InWorld<PredictorCorrector> world;
  Mechanism& m = world.m;
  m.substeps = 2;
  const BodyId block = m.add_body(given_body("block", 2.0, Vec3(0.1, 0.1, 0.1)));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), block, {0, 0, 0}));
  const double dt = 1e-4, window = 20 * dt;
  const SensorId cell = m.add_sensor(joint_sensor("cell", weld, window));
  const SensorId felt = m.add_sensor(contact_sensor("felt", block, window));
  m.add_load(applied_force("push", block, {0, 0, 0}, X, Signal::function([&](double) {
                             return 10.0 + 0.5 * (6.0 - std::abs(m.sensor(cell).mean().force.x));
                           })));
  world.start(dt);
  double latest = 0.0;
  for (int s = 0; s < 5000; ++s) {
    for (int stage = 0; stage < 2; ++stage) {
      world.stage(stage, dt, Vec3::Zero(), [&] { m.body(block).apply({0, 0.01 * s, 0}, {0, 0, 0}); });
      if (stage == 0) CHECK(m.sensor(felt).latest().force.y == latest);  // a trial adds nothing
    }
    latest = m.sensor(felt).latest().force.y;
  }
  // f = 10 + (6 - f) / 2: a mean of 20 steps fed back with half of it settles at a rate of some 1/window.
  CHECK(std::abs(m.sensor(cell).mean().force.x) == Approx(13.0 / 1.5).epsilon(1e-6));
}

TEST_CASE("sensors go on after a function of the user threw within a trial") {
  InWorld<PredictorCorrector> world;
  Mechanism& m = world.m;
  m.substeps = 2;
  const BodyId block = m.add_body(given_body("block", 2.0, Vec3(0.1, 0.1, 0.1)));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), block, {0, 0, 0}));
  const SensorId cell = m.add_sensor(joint_sensor("cell", weld, 0.0));
  bool fails = false;
  m.add_load(applied_force("push", block, {0, 0, 0}, X, Signal::function([&](double) {
                             if (fails) throw std::runtime_error("no such file");
                             return 10.0;
                           })));
  const double dt = 1e-4;
  world.start(dt);
  fails = true;
  CHECK_THROWS_WITH(world.stage(0, dt, Vec3::Zero(), [] {}), "no such file");
  fails = false;
  m.substeps = 1;
  world.start(dt);
  for (int s = 0; s < 5000; ++s) world.step(dt, Vec3::Zero(), [] {});
  CHECK(std::abs(m.sensor(cell).latest().force.x) == Approx(10.0).epsilon(1e-3));  // the weld's spring has settled
}

TEMPLATE_TEST_CASE("substeps keep the energy that goes to and fro between grains and machine", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // Forces that are merely held over a step would feed in (omega dt)^2/2 a step: at omega dt = 0.02 and 31416 steps
  // that is a factor of exp(6). Two stages: what is left is of fourth order a step, 0.02^4 = 1.6e-7, times a factor
  // near 1. One stage: the energy swings by omega dt/2 = 1 % with symplectic Euler, less with Verlet.
  CHECK(substep_energy<TestType>(8, 0.02).worst < (std::is_same_v<TestType, SymplecticEuler> ? 0.0102 : 0.01));
}

TEMPLATE_TEST_CASE("substeps keep the energy at long steps", "", SymplecticEuler, VelocityVerlet) {
  // Symplectic maps: p^2/2 + q^2/2 - (omega dt) p q/2 is kept, so the energy swings between 1/(1 + omega dt/2) and
  // 1/(1 - omega dt/2) of that, but stays. The means of 20 oscillations catch each swing in other phases, which is some
  // thousandths. Forces that are extrapolated would feed in (omega dt)^4/3 a step: a factor of 1.2 at 0.1, and no end
  // of it at 0.3.
  const int substeps = GENERATE(2, 8);
  for (const double omega_dt : {0.1, 0.3, 1.0}) {
    CAPTURE(substeps, omega_dt);
    const SubstepEnergy found = substep_energy<TestType>(substeps, omega_dt);
    CHECK(found.worst < omega_dt / (1 - 0.5 * omega_dt));
    CHECK(std::abs(found.drift) < 0.01);
  }
}
