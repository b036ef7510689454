#include <array>
#include <random>
#include <vector>

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

constexpr std::array all_kinds = {JointKind::fixed,          JointKind::spherical,         JointKind::revolute,
                                  JointKind::cylindrical,    JointKind::prismatic,         JointKind::planar,
                                  JointKind::universal,      JointKind::constant_velocity, JointKind::point_on_line,
                                  JointKind::point_on_plane, JointKind::distance,          JointKind::bushing};

Mat3 turned(const Vec3& angle) { return to_eigen(rotation_from_vector(from_eigen(angle))); }

JointSpec joint_of(JointKind kind, BodyId a, BodyId b) {
  const Vec3 at(0.5, 0.1, -0.2), axis = Vec3(1, 2, -1).normalized();
  JointSpec s =
      kind == JointKind::distance ? distance("j", a, at, b, at + Vec3(0.3, 0, 0.4)) : joint(kind, "j", a, b, at, axis);
  if (kind == JointKind::bushing) {
    s = bushing("j", a, b, at, axis, {1000, 2000, 3000}, {1, 2, 3}, {100, 500, 120}, {1, 2, 3});
  }
  return kind == JointKind::bushing ? s : s.with_stiffness(2000.0, 300.0).with_damping(5.0, 2.0);
}

}  // namespace

TEST_CASE("without damping, every joint's force is the gradient of its energy") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double size) { return Vec3(size * Vec3(uniform(random), uniform(random), uniform(random))); };
  for (const JointKind kind : all_kinds) {
    Machine<PredictorCorrector> m;
    const BodyId a = m.add_body(brick("a", {0, 0, 0}).at({0, 0, 0}, turned({0.3, 0.2, -0.4})));
    const BodyId b = m.add_body(brick("b", {1, 0, 0}).at({1, 0, 0}, turned({-0.1, 0.5, 0.2})));
    JointSpec spec = joint_of(kind, a, b);
    if (kind != JointKind::bushing) spec = spec.with_damping(0.0, 0.0);
    spec.bushing_damping.setZero();
    spec.bushing_rotational_damping.setZero();
    m.add_joint(spec);
    m.design_for(1e-3);
    // Somewhere off the assembled pose.
    m.body(b).motion.position += from_eigen(vector(0.05));
    m.body(b).motion.rotation = from_eigen(Mat3(turned(vector(0.2)) * m.body(b).rotation()));
    m.initialise(0.0, Vec3::Zero());
    const Vec3 f = to_eigen(m.body(b).force), t = to_eigen(m.body(b).torque);
    INFO(name_of(kind));
    // Force and counterforce, and their moments about the origin.
    CHECK((f + to_eigen(m.body(a).force)).norm() < 1e-10);
    const Vec3 moment = t + m.body(b).position().cross(f) + to_eigen(m.body(a).torque) +
                        m.body(a).position().cross(to_eigen(m.body(a).force));
    CHECK(moment.norm() < 1e-10);
    const double h = 1e-5;
    const auto energy = [&](const Vec3& shift, const Vec3& turn) {
      Body moved = m.body(b);
      moved.motion.position += from_eigen(shift);
      moved.motion.rotation = from_eigen(Mat3(turned(turn) * moved.rotation()));
      return elastic_energy(m.parts().joints[0], m.body(a), moved);
    };
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = Vec3::Unit(k), none = Vec3::Zero();
      // Central differences of order h^2 = 1e-10 on energies of order 10.
      CHECK(f[k] == Approx((energy(-h * e, none) - energy(h * e, none)) / (2 * h)).margin(1e-4));
      CHECK(t[k] == Approx((energy(none, -h * e) - energy(none, h * e)) / (2 * h)).margin(1e-4));
    }
  }
}

TEST_CASE("dampers of a joint take energy from whatever it holds") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double size) { return Vec3(size * Vec3(uniform(random), uniform(random), uniform(random))); };
  for (const JointKind kind : all_kinds) {
    Machine<PredictorCorrector> m;
    const Vec3 va = vector(1.0), wa = vector(1.0), vb = vector(1.0), wb = vector(1.0);
    const BodyId a = m.add_body(brick("a", {0, 0, 0}).moving(va, wa));
    const BodyId b = m.add_body(brick("b", {1, 0, 0}).moving(vb, wb));
    JointSpec spec = joint_of(kind, a, b);
    m.add_joint(spec);
    m.design_for(1e-3);
    m.initialise(0.0, Vec3::Zero());  // at the assembled pose the springs are at rest: only the dampers act
    const auto power = [&](BodyId id) {
      const Body& body = m.body(id);
      return to_eigen(body.force).dot(body.velocity()) + to_eigen(body.torque).dot(body.angular_velocity());
    };
    INFO(name_of(kind));
    // Constants of 1 to 5 against held speeds of order 1: watts, however the random speeds fall.
    CHECK(power(a) + power(b) < -0.01);
  }
}

TEST_CASE("a revolute joint is two spherical joints on a line") {
  // Half the stiffness at +-h each gives the same force as one revolute joint with kr = k h^2.
  const double k = 4000.0, h = 0.1;
  const auto build = [&](bool revolute_joint) {
    Machine<PredictorCorrector> m;
    const BodyId a = m.ground(), b = m.add_body(brick("b", {1, 0, 0}));
    if (revolute_joint) {
      m.add_joint(revolute("r", a, b, {0, 0, 0}, Z).with_stiffness(k, k * h * h).with_damping(0, 0));
    } else {
      m.add_joint(spherical("s1", a, b, h * Z).with_stiffness(k / 2, 0).with_damping(0, 0));
      m.add_joint(spherical("s2", a, b, -h * Z).with_stiffness(k / 2, 0).with_damping(0, 0));
    }
    m.body(b).motion.position += {0.01, 0.02, -0.03};
    m.body(b).motion.rotation = from_eigen(turned({0.2, -0.1, 0.5}));
    m.initialise(0.0, Vec3::Zero());
    return m.body(b);
  };
  const Body one = build(true), two = build(false);
  CHECK((to_eigen(one.force) - to_eigen(two.force)).norm() < 1e-10);
  CHECK((to_eigen(one.torque) - to_eigen(two.torque)).norm() < 1e-10);
}

TEST_CASE("a joint leaves its free coordinates alone and holds the others") {
  // A push along and a twist about every axis: what is free moves as a free body would, what is held does not.
  struct Case {
    JointKind kind;
    std::array<bool, 6> is_free;  // x y z, about x y z
  };
  const Case cases[] = {
      {JointKind::fixed, {0, 0, 0, 0, 0, 0}},         {JointKind::spherical, {0, 0, 0, 1, 1, 1}},
      {JointKind::revolute, {0, 0, 0, 0, 0, 1}},      {JointKind::cylindrical, {0, 0, 1, 0, 0, 1}},
      {JointKind::prismatic, {0, 0, 1, 0, 0, 0}},     {JointKind::planar, {1, 1, 0, 0, 0, 1}},
      {JointKind::universal, {0, 0, 0, 1, 1, 0}},     {JointKind::constant_velocity, {0, 0, 0, 1, 1, 0}},
      {JointKind::point_on_line, {0, 0, 1, 1, 1, 1}}, {JointKind::point_on_plane, {1, 1, 0, 1, 1, 1}}};
  for (const Case& c : cases) {
    for (int k = 0; k < 6; ++k) {
      Machine<PredictorCorrector> m;
      m.gravity.setZero();
      const BodyId b = m.add_body(given_body("b", 2.0, Vec3(0.1, 0.1, 0.1)));
      m.add_joint(joint(c.kind, "j", m.ground(), b, {0, 0, 0}, Z));
      const Vec3 axis = Vec3::Unit(k % 3);
      if (k < 3) {
        m.add_load(applied_force("push", b, {0, 0, 0}, axis, 4.0));
      } else {
        m.add_load(applied_torque("twist", b, axis, 0.2));
      }
      REQUIRE(m.run(0.1, 1e-4));
      // Free: a t^2/2 = 2 0.01/2 either way. Held: force over stiffness, k > 1e6 N/m and > 1e5 N m/rad.
      const double moved =
          k < 3 ? m.body(b).position()[k]
                : 0.5 * (m.body(b).rotation() - m.body(b).rotation().transpose())((k + 2) % 3, (k + 1) % 3);
      INFO(name_of(c.kind) << ", direction " << k);
      if (c.is_free[static_cast<std::size_t>(k)]) {
        CHECK(moved == Approx(0.01).epsilon(1e-3));
      } else {
        CHECK(std::abs(moved) < 1e-5);
      }
    }
  }
}

TEST_CASE("a joint carries the weight, and says so") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("b", {0.4, 0, 0}, 3.0));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), b, {0, 0, 0}));
  REQUIRE(m.run(0.5, 1e-4));
  const Wrench r = m.reaction(weld);
  CHECK(r.force.z == Approx(3.0 * 9.81).epsilon(1e-6));
  CHECK(r.torque.y == Approx(-3.0 * 9.81 * 0.4).epsilon(1e-6));
  const Violation v = m.violation(weld);
  CHECK(v.displacement == Approx(3.0 * 9.81 / m.joint(weld).k).epsilon(1e-3));
  CHECK(v.rotation == Approx(3.0 * 9.81 * 0.4 / m.joint(weld).kr).epsilon(1e-3));
}

TEST_CASE("a bushing gives way as its springs say, in each direction") {
  const Vec3 k(1e4, 2e4, 4e4), kr(100, 200, 400);
  for (int i = 0; i < 6; ++i) {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId b = m.add_body(given_body("b", 1.0, Vec3(0.01, 0.01, 0.01)));
    m.add_joint(bushing("rubber", m.ground(), b, {0, 0, 0}, Z, k, Vec3(200, 200, 200), kr, Vec3(2, 2, 2)));
    const Vec3 n = Vec3::Unit(i % 3);  // with z along Z the joint's axes are the global ones
    if (i < 3) {
      m.add_load(applied_force("push", b, {0, 0, 0}, n, 10.0));
    } else {
      m.add_load(applied_torque("twist", b, n, 0.1));
    }
    REQUIRE(m.run(0.3, 1e-4));
    if (i < 3) {
      CHECK(m.body(b).position().dot(n) == Approx(10.0 / k[i]).epsilon(1e-6));
    } else {
      const Mat3 r = m.body(b).rotation();
      const Vec3 angle = 0.5 * Vec3(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
      CHECK(angle.dot(n) == Approx(0.1 / kr[i - 3]).epsilon(1e-5));
    }
  }
}

TEST_CASE("a bushing's twist about one axis meets that axis's constant at any angle") {
  // The constants break the triangle inequality, which a sum of springs between axes could not.
  const Vec3 kr(100, 1000, 120);
  for (int i = 0; i < 3; ++i) {
    for (const double twist : {0.3, -2.5}) {
      Machine<PredictorCorrector> m;
      const BodyId b = m.add_body(brick("b", {0, 0, 0}));
      m.add_joint(bushing("rubber", m.ground(), b, {0, 0, 0}, Z, {1e4, 1e4, 1e4}, {0, 0, 0}, kr, {0, 0, 0}));
      m.body(b).motion.rotation = from_eigen(turned(twist * Vec3::Unit(i)));
      m.initialise(0.0, Vec3::Zero());
      CHECK((to_eigen(m.body(b).torque) + kr[i] * twist * Vec3::Unit(i)).norm() < 1e-9);
      CHECK(energy_of(m.parts(), Vec3::Zero()).elastic == Approx(0.5 * kr[i] * twist * twist));
    }
  }
}

TEST_CASE("x of a joint's frame is the global one as far as it can be, or as given") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("b", {0, 0, 0}));
  int count = 0;
  const auto axes = [&](JointSpec s) {
    s.name = std::to_string(count++);
    const Axes a = m.joint(m.add_joint(s)).axes_a;
    return std::array{to_eigen(a.x), to_eigen(a.y), to_eigen(a.z)};
  };
  const auto bush = [&](const Vec3& z) { return joint(JointKind::planar, "", m.ground(), b, {0, 0, 0}, z); };
  CHECK(axes(bush(Z)) == std::array{X, Y, Z});
  CHECK(axes(bush(-Z))[0] == X);
  CHECK(axes(bush(Y))[0] == X);
  CHECK(axes(bush(X))[0] == Y);
  CHECK((axes(bush(Vec3(1, 0, 1)))[0] - Vec3(1, 0, -1).normalized()).norm() < 1e-15);
  // No jump for an axis that is a little off.
  CHECK((axes(bush(Vec3(1e-9, -1e-9, -1)))[0] - X).norm() < 1e-8);
  CHECK((axes(bush(Vec3(1, 1e-9, -1e-9)))[0] - Y).norm() < 1e-8);
  CHECK((axes(bush(Z).with_x(Vec3(3, 4, 5)))[0] - Vec3(0.6, 0.8, 0)).norm() < 1e-15);
  check_refused([&] { m.add_joint(bush(Z).with_x(2 * Z)); }, "x axis of planar joint", "across it");
  check_refused([&] { m.add_joint(bush(Z).with_x(Vec3::Zero())); }, "x axis of planar joint", "needs a length");
}

TEST_CASE("the angle of a hinge counts on over whole turns, to the last digits") {
  Machine<SymplecticEuler> m;
  m.gravity.setZero();
  const BodyId wheel = m.add_body(given_body("wheel", 1.0, Vec3(0.1, 0.1, 0.2)).moving(Vec3::Zero(), {0, 0, -40.0}));
  const JointId hinge = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z).starting_at(1.0));
  REQUIRE(m.run(10.0, 1e-3));
  CHECK(m.coordinate(hinge) == Approx(1.0 - 400.0).epsilon(1e-12));
  CHECK(m.speed(hinge) == Approx(-40.0).epsilon(1e-12));
}

TEST_CASE("stops catch a joint that turns and one that slides") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId arm = m.add_body(given_body("arm", 1.0, Vec3(0.1, 0.1, 0.1)).moving(Vec3::Zero(), {0, 0, 3.0}));
  const BodyId cart = m.add_body(given_body("cart", 2.0, Vec3(0.1, 0.1, 0.1)).at({0, 5, 0}).moving({0, 0, -1.0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 0, 0}, Z).with_limits(-1.0, 0.5));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 5, 0}, Z)
                                        .with_limits({.lower = -0.2, .upper = 0.3, .stiffness = 2e5, .damping = 0.0}));
  m.add_load(applied_torque("twist", arm, Z, 5.0));
  double lowest = 0.0;
  REQUIRE(m.run(1.0, 1e-4, [&] { lowest = std::min(lowest, m.coordinate(guide)); }));
  CHECK(m.coordinate(hinge) == Approx(0.5).margin(1e-4));
  CHECK(m.limits(hinge)->force == Approx(-5.0).epsilon(1e-3));
  // Undamped stops give the speed back, here twice; the deepest point is v sqrt(m/k). Entering a stop within a step
  // costs an error of order omega dt = 0.03 in the force of that step, 1e-3 in the speed.
  CHECK(lowest == Approx(-0.2 - std::sqrt(2.0 / 2e5)).epsilon(1e-4));
  CHECK(m.speed(guide) == Approx(-1.0).epsilon(1e-3));
}

TEST_CASE("a joint's reaction counts its stops and its friction") {
  // A guide along x that is pressed into its stop with 4 N, while its bearing carries 20 N across.
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId cart = m.add_body(given_body("cart", 2.0, Vec3(0.1, 0.1, 0.1)));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), cart, {0, 0, 0}, X).with_limits(-1.0, 0.0));
  m.add_load(applied_force("push", cart, {0, 0, 0}, X, 4.0));
  m.add_load(applied_force("weight", cart, {0, 0, 0}, -Z, 20.0));
  const SensorId cell = m.add_sensor(joint_sensor("cell", guide, 0.0));
  // A disc that 3 N m try to turn, held by a brake of 0.5 1000 N 0.02 m = 10 N m; and one held by a stop.
  const BodyId disc = m.add_body(given_body("disc", 2.0, Vec3(0.1, 0.1, 0.1)).at({0, 3, 0}));
  const JointId brake = m.add_joint(revolute("brake", m.ground(), disc, {0, 3, 0}, Z)
                                        .with_friction({.coefficient = 0.5, .radius = 0.02, .preload = 1000.0}));
  const BodyId arm = m.add_body(given_body("arm", 2.0, Vec3(0.1, 0.1, 0.1)).at({0, 6, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 6, 0}, Z).with_limits(-1.0, 0.0));
  m.add_load(applied_torque("twist disc", disc, Z, 3.0));
  m.add_load(applied_torque("twist arm", arm, Z, 3.0));
  REQUIRE(m.run(1.0, 1e-4));
  // At rest, so the reactions balance the loads; what still swings is below 1e-3 of them.
  CHECK(m.reaction(guide).force.x == Approx(-4.0).epsilon(1e-3));
  CHECK(m.reaction(guide).force.z == Approx(20.0).epsilon(1e-3));
  CHECK(m.sensor(cell).latest().force.x == Approx(-4.0).epsilon(1e-3));
  CHECK(m.reaction(brake).torque.z == Approx(-3.0).epsilon(1e-3));
  CHECK(m.reaction(hinge).torque.z == Approx(-3.0).epsilon(1e-3));
}
