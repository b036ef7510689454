// A line that pulls holds its bodies across it as well: with its tension over its length, like a string.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

namespace {

constexpr double tension = 1e4, length = 1.0, soft = 10.0;  // N, m, N/m

/// Pulls (or pushes, where the force is negative) with a force that hardly changes with the length.
void add_line(Mechanism& m, const std::string& name, bool ram, BodyId wall, const Vec3& at_wall, BodyId b,
              const Vec3& at_b, double force) {
  if (ram) {
    m.add_actuator(linear_actuator(name, wall, at_wall, b, at_b, soft, 0.0, length - force / soft));
  } else {
    m.add_spring({.name = name,
                  .a = wall,
                  .b = b,
                  .at_a = at_wall,
                  .at_b = at_b,
                  .force_over_length = Curve::line(-force + soft * length, -soft)});
  }
}

/// A ball between two walls, held along x by two lines at `arm` (m) on both sides of its centre.
template <class I>
struct Strung {
  Machine<I> m;
  BodyId ball;

  Strung(double mass, double inertia, double arm, bool ram, double force = tension) {
    m.gravity.setZero();
    ball = m.add_body(test::ball("ball", mass, inertia));
    add_line(m, "left", ram, m.ground(), {-arm - length, 0, 0}, ball, {-arm, 0, 0}, force);
    add_line(m, "right", ram, m.ground(), {arm + length, 0, 0}, ball, {arm, 0, 0}, force);
  }
  /// The most that the ball moves across the lines (m) in 2000 steps, from 1 um off.
  double swing(double dt) {
    m.body(ball).motion.position.y = 1e-6;
    m.allow_unstable_time_step = true;
    double most = 0.0;
    for (int k = 0; k < 2000 && m.step(dt); ++k) most = std::max(most, std::abs(m.body(ball).motion.position.y));
    return most;
  }
};

}  // namespace

TEMPLATE_TEST_CASE("taut soft lines limit the time step by their tension", "", SymplecticEuler, VelocityVerlet,
                   PredictorCorrector) {
  // Two lines on 1 kg: omega^2 = 2 T/(L m) across, a thousand times 2 k/m along.
  const double omega = std::sqrt(2.0 * tension / length);
  for (const bool ram : {false, true}) {
    CAPTURE(ram);
    Strung<TestType> s(1.0, 0.1, 0.0, ram);
    const StableTimeStep limit = s.m.stable_time_step();
    CHECK_THAT(limit.limited_by, Contains("left"));
    // As for one such spring; the bisection ends at 2^-24 of its range.
    CHECK(limit.dt == Approx(dem::mbd::detail::largest_stable_step<TestType>(omega * omega, 0.0)).epsilon(1e-6));
    // Swings reach 1/sqrt(1 - 0.95^2) = 3.2 of where they start just below the limit, and grow without end above it.
    CHECK(s.swing(0.95 * limit.dt) < 1e-5);
    CHECK(Strung<TestType>(1.0, 0.1, 0.0, ram).swing(1.05 * limit.dt) > 1e-3);
  }
}

TEST_CASE("taut lines limit the time step the same after forces were found") {
  Strung<VelocityVerlet> s(1.0, 0.1, 0.0, true);
  const double before = s.m.stable_time_step().dt;
  REQUIRE(s.m.run(0.1, 1e-3));
  CHECK(s.m.stable_time_step().dt == Approx(before).epsilon(1e-12));
}

TEST_CASE("a line that pushes limits the time step by its stiffness alone") {
  // The limit is 2/omega; what stays bounded by a hundred times its start for 400 steps ends 1e-4 below it.
  for (const bool ram : {false, true}) {
    const Strung<SymplecticEuler> s(1.0, 0.1, 0.0, ram, -tension);
    CHECK(s.m.stable_time_step().dt == Approx(2.0 / std::sqrt(2.0 * soft)).epsilon(1.5e-4));
  }
  // A force that is cut pulls with no more than that.
  Machine<SymplecticEuler> m;
  const BodyId b = m.add_body(ball("ball"));
  m.add_actuator(
      linear_actuator("ram", m.ground(), {-length, 0, 0}, b, {0, 0, 0}, soft, 0.0, -1e3).with_max_force(200.0));
  CHECK(m.stable_time_step().dt == Approx(2.0 / std::sqrt(200.0 / length)).epsilon(1.5e-4));
}

TEST_CASE("a taut line turns what it pulls at an arm towards itself") {
  // A turn by theta moves the end, at the arm r, by r theta across the line, which is r theta (1 + r/L) off its own
  // direction: omega^2 = 2 T r (1 + r/L)/I. The bound has the ball's displacement as well: 2 T/(L m), 1e-4 of it.
  const double arm = 0.1, mass = 1e3, inertia = 1e-2;
  const double omega2 = 2.0 * tension * arm * (1.0 + arm / length) / inertia;
  for (const bool ram : {false, true}) {
    Strung<SymplecticEuler> s(mass, inertia, arm, ram);
    const double dt = s.m.stable_time_step().dt;
    CHECK(dt <= 2.0 / std::sqrt(omega2));
    CHECK(dt > (1.0 - 1e-3) * 2.0 / std::sqrt(omega2));
    s.m.body(s.ball).motion.angular_velocity = {0, 0, 1e-6};
    s.m.allow_unstable_time_step = true;
    const auto turn_speed = [](Machine<SymplecticEuler>& m, BodyId b, double step) {
      double most = 0.0;
      for (int k = 0; k < 2000 && m.step(step); ++k)
        most = std::max(most, std::abs(m.body(b).motion.angular_velocity.z));
      return most;
    };
    CHECK(turn_speed(s.m, s.ball, 0.95 * dt) < 1e-5);
    Strung<SymplecticEuler> other(mass, inertia, arm, ram);
    other.m.allow_unstable_time_step = true;
    other.m.body(other.ball).motion.angular_velocity = {0, 0, 1e-6};
    CHECK(turn_speed(other.m, other.ball, 1.05 * dt) > 1e-3);
  }
}
