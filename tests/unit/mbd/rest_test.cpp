// Static equilibrium.

#include "mbd_test.hpp"

#include <dem/mbd/solver/rest.hpp>

#include <algorithm>

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("a quarter car comes to rest on its spring and its tyre") {
  // The tyre carries all, the strut all but the wheel: both to 1e-6. Gravity is balanced, so nothing moves afterwards.
  Machine<VelocityVerlet> m;
  constexpr double g = 9.81, tyre = 2e5, spring_rate = 3e4;
  const BodyId body = m.add_body(given_body("body", 400.0, Vec3(100, 100, 100)).at({0, 0, 0.8}));
  const BodyId wheel = m.add_body(given_body("wheel", 40.0, Vec3(1, 1, 1)).at({0, 0, 0.35}));
  m.add_joint(prismatic("guide", m.ground(), body, {0, 0, 0.8}, Z));
  m.add_joint(prismatic("strut", body, wheel, {0, 0, 0.6}, Z));
  const SpringId strut = m.add_spring(spring("spring", wheel, {0, 0, 0.4}, body, {0, 0, 0.7}, spring_rate, 2e3));
  const LoadId foot = m.add_load(custom_load("tyre", wheel, [](double, const Body& b) {
    return Wrench{{0, 0, std::max(0.0, tyre * (0.35 - b.position().z()))}, {0, 0, 0}};
  }));
  const RestReport rest = find_rest(m, 1e-4);
  INFO(rest.text);
  REQUIRE(rest);
  CHECK(rest.share < 1e-9);
  CHECK(m.load(foot).wrench.force.z == Approx(440.0 * g).epsilon(1e-6));
  CHECK(m.spring(strut).force == Approx(400.0 * g).epsilon(1e-6));
  CHECK(m.spring(strut).length == Approx(0.3 - 400.0 * g / spring_rate).epsilon(1e-6));
  const Vec3 at = m.body(body).position();
  REQUIRE(m.run(0.5, 1e-4));
  CHECK((m.body(body).position() - at).norm() < 1e-9);
}

TEST_CASE("a belt stands while a rest is looked for, and runs on afterwards") {
  // A weight of 1 kg hangs on a lift by a spring with a damper, which would hold 10 N of the 9.81 N if the lift ran.
  Machine<VelocityVerlet> m;
  const BodyId lift = m.add_body(fixed_body("lift").moving({0, 0, 1.0}, {0, 0, 0.5}));
  const BodyId weight = m.add_body(ball("weight").at({0, 0, -1.0}));
  m.add_spring(spring("rope", lift, {0, 0, 0}, weight, {0, 0, -1.0}, 1e3, 10.0));
  const RestReport rest = find_rest(m, 1e-4);
  INFO(rest.text);
  REQUIRE(rest);
  CHECK(m.body(weight).position().z() == Approx(-1.0 - 9.81 / 1e3).epsilon(1e-9));
  CHECK(m.body(weight).velocity() == Vec3::Zero());
  CHECK(m.body(lift).velocity() == Vec3(0, 0, 1.0));
  CHECK(m.body(lift).angular_velocity() == Vec3(0, 0, 0.5));
}

TEST_CASE("a linkage finds the pose of least energy, and what has nothing to rest on says so") {
  // A pendulum of two rods, released sideways, hangs down: its hinges carry its weight.
  Machine<PredictorCorrector> m;
  const BodyId a = m.add_body(box_body("upper", {0.5, 0.04, 0.04}, 1000).at({0.25, 0, 0}));
  const BodyId b = m.add_body(box_body("lower", {0.5, 0.04, 0.04}, 1000).at({0.75, 0, 0}));
  const JointId top = m.add_joint(revolute("top", m.ground(), a, {0, 0, 0}, Y));
  const JointId middle = m.add_joint(revolute("middle", a, b, {0.5, 0, 0}, Y));
  const RestReport rest = find_rest(m, 1e-4);
  INFO(rest.text);
  REQUIRE(rest);
  CHECK(std::abs(m.coordinate(top)) == Approx(pi / 2).epsilon(1e-6));
  CHECK(std::abs(m.coordinate(middle)) < 1e-6);
  CHECK(m.reaction(top).force.z == Approx(2 * 0.8 * 9.81).epsilon(1e-6));

  Machine<PredictorCorrector> falling;
  const BodyId stone = falling.add_body(ball("stone"));
  const RestReport none = find_rest(falling, 1e-4);
  CHECK_FALSE(none);
  CHECK(none.moved > 1.0);
  CHECK(falling.body(stone).position() == Vec3::Zero());  // it is put back
  CHECK_THAT(none.text, Contains("no rest was found") && Contains("body 'stone'") && Contains("nothing to rest on"));

  Machine<PredictorCorrector> windy;  // a NaN is no rest, however small the other forces are
  const BodyId sail = windy.add_body(ball("sail"));
  windy.add_body(ball("stone"));
  windy.add_load(custom_load("wind", sail, [](double, const Body&) { return Wrench{{0, std::nan(""), 0}, {}}; }));
  const RestReport nowhere = find_rest(windy, 1e-4);
  CHECK_FALSE(nowhere);
  CHECK_THAT(nowhere.text, Contains("body 'sail' are not finite") && Contains("load 'wind' is not a number"));

  const JointId other = m.add_joint(free_joint("gauge", m.ground(), b, {0, 0, 0}, Y));
  m.add_motion(prescribed_joint("turn", middle, Signal::held(m.coordinate(middle), 0.0)));
  check_refused([&] { (void)find_rest(m, 1e-4); }, "prescribed motion 'turn'");
  CHECK(other.valid());
}
