#include "core/error_of.hpp"

#include <dem/law/friction/asperity_spring.hpp>
#include <dem/law/friction/none.hpp>

#include <limits>
#include <random>

using Catch::Approx;
using dem::Pack;
using dem::Vec3;
using dem::Vector3;
using dem::friction::AsperitySpring;
using dem::friction::TangentialState;

namespace {

using History = AsperitySpring::History<double>;
using Parameters = AsperitySpring::Parameters<double>;

constexpr double mu = 0.4, kt = 1000.0, cv = 0.5, time_step = 1e-5;

Parameters constants(double breaking_factor, double velocity_stiffness = cv) {
  return {mu, kt, velocity_stiffness, breaking_factor};
}

Vec3 force(const Parameters& p, const Vec3& velocity, double normal_force, History& h) {
  return to_eigen(AsperitySpring::force(
      p, TangentialState<double>{dem::from_eigen(velocity), normal_force, 1e-5, 1e-3, 1e-5, time_step}, h));
}

}  // namespace

TEST_CASE("below the limit friction is a spring and a velocity ramp") {
  History h = {{0, 0, 0}};
  // slip = v time_step = (3e-7, 4e-7, 0): spring 5e-4 N; ramp 0.5 * 0.05 = 0.025 N; both against the sliding.
  const Vec3 f = force(constants(0.975), {0.03, 0.04, 0}, 1.0, h);
  CHECK((f + 0.0255 * Vec3(0.6, 0.8, 0)).norm() < 1e-15);
  CHECK(h.slip.x == Approx(3e-7).epsilon(1e-14));
  CHECK(h.slip.y == Approx(4e-7).epsilon(1e-14));
}

TEST_CASE("at rest the spring alone holds") {
  History h = {{1e-4, 0, 0}};
  const Vec3 f = force(constants(0.975), Vec3::Zero(), 1.0, h);
  CHECK((f - Vec3(-0.1, 0, 0)).norm() < 1e-16);
  CHECK(h.slip.x == 1e-4);
}

TEST_CASE("a broken asperity keeps its share of the limit") {
  for (const double keeps : {0.0, 0.5, 0.975, 1.0}) {
    History h = {{5e-4, 0, 0}};  // 0.5 N, more than mu Fn = 0.4 N
    const Vec3 f = force(constants(keeps, 0.0), {1e-3, 0, 0}, 1.0, h);
    CHECK(f.x() == Approx(-keeps * 0.4).margin(1e-15));
    CHECK(h.slip.x == Approx(keeps * 4e-4).margin(1e-18));
  }
}

TEST_CASE("spring and ramp together never exceed the limit") {
  History h = {{3.9e-4, 0, 0}};  // 0.39 N, below the limit
  CHECK(force(constants(0.975), {0.01, 0, 0}, 1.0, h).x() == Approx(-0.39 - 1e-4 - 0.005));
  CHECK(force(constants(0.975), {0.1, 0, 0}, 1.0, h).x() == Approx(-0.4).epsilon(1e-15));
  // The ramp alone is capped too: 0.5 * 10 = 5 N.
  History fresh = {{0, 0, 0}};
  CHECK(force(constants(0.0), {10.0, 0, 0}, 1.0, fresh).norm() == Approx(0.4).epsilon(1e-15));
}

TEST_CASE("friction may point elsewhere than against the velocity, but within the limit") {
  History h = {{0, 3e-4, 0}};
  const Vec3 f = force(constants(0.975), {0.2, 0, 0}, 1.0, h);
  // Spring (0.002, 0.3), ramp (0.1, 0).
  CHECK((f + Vec3(0.102, 0.3, 0)).norm() < 1e-15);
  const Vec3 capped = force(constants(0.975), {0.8, 0, 0}, 1.0, h);
  CHECK(capped.norm() == Approx(0.4).epsilon(1e-15));
  CHECK(capped.y() < -0.2);  // the cap turns nothing
}

TEST_CASE("without a normal force there is no friction and no history") {
  History h = {{1e-4, 2e-4, 0}};
  CHECK(force(constants(0.975), {1.0, 0, 0}, 0.0, h) == Vec3::Zero());
  CHECK(to_eigen(h.slip) == Vec3::Zero());
  // 0/0: nothing slid, nothing pressed.
  History fresh = {{0, 0, 0}};
  CHECK(force(constants(0.975), Vec3::Zero(), 0.0, fresh) == Vec3::Zero());
  CHECK(to_eigen(fresh.slip) == Vec3::Zero());
}

TEST_CASE("dragged at constant speed, a broken spring saws and a kept one is steady") {
  const double speed = 0.4, period = mu * 1.0 / (kt * speed) / time_step;  // 100 steps from rest to the limit
  for (const double keeps : {0.0, 0.975}) {
    History h = {{0, 0, 0}};
    int breaks = 0;
    double largest = 0.0, last = 0.0, smallest_after_first = 1.0;
    const int steps = 1000;
    for (int n = 0; n < steps; ++n) {
      const double f = force(constants(keeps, 0.0), {speed, 0, 0}, 1.0, h).norm();
      if (f < last) ++breaks;
      if (breaks > 0) smallest_after_first = std::min(smallest_after_first, f);
      largest = std::max(largest, f);
      last = f;
    }
    CHECK(largest <= mu * (1 + 1e-15));
    CHECK(largest > mu * 0.98);  // one step of drag is 1 % of the limit
    CHECK(smallest_after_first == Approx(keeps * mu).margin(0.01 * mu));
    // From the kept share back to the limit.
    const double between = std::max(1.0, (1.0 - keeps) * period);
    CHECK(breaks == Approx((steps - period) / between).epsilon(0.2).margin(1.01));
  }
}

TEST_CASE("the history turns with the contact") {
  History h = {{1, 2, 3}};
  AsperitySpring::carry(h, [](const Vector3<double>& v) { return Vector3<double>{-v.y, v.x, v.z}; });
  CHECK(to_eigen(h.slip) == Vec3(-2, 1, 3));
}

TEST_CASE("every lane of a pack gets what a double gets from the friction law") {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> slip(-4e-4, 4e-4), speed(-0.4, 0.4), press(0.0, 1.5);
  const AsperitySpring::Parameters<Pack> p = {Pack(mu), Pack(kt), Pack(cv), Pack(0.975)};
  for (int trial = 0; trial < 200; ++trial) {
    const auto any = [&](auto& range) { return dem::generate([&](int) { return range(engine); }); };
    const Vector3<Pack> v = {any(speed), any(speed), any(speed)}, s = {any(slip), any(slip), any(slip)};
    const Pack fn = any(press);
    AsperitySpring::History<Pack> h = {s};
    const Vector3<Pack> f =
        AsperitySpring::force(p, TangentialState<Pack>{v, fn, Pack(1e-5), Pack(1e-3), Pack(1e-5), Pack(time_step)}, h);
    for (int k = 0; k < dem::pack_width; ++k) {
      const auto one = [&](const Vector3<Pack>& a) {
        return Vec3(dem::lane(a.x, k), dem::lane(a.y, k), dem::lane(a.z, k));
      };
      History scalar = {dem::from_eigen(one(s))};
      const Vec3 expected = force(constants(0.975), one(v), dem::lane(fn, k), scalar);
      // Fused or separate multiply-adds: a few roundings of terms below 1 N, and of 1e-3 m.
      CHECK((one(f) - expected).norm() < 8 * std::numeric_limits<double>::epsilon());
      CHECK((one(h.slip) - to_eigen(scalar.slip)).norm() < 8e-3 * std::numeric_limits<double>::epsilon());
    }
  }
}

TEST_CASE("friction constants that make no sense are refused") {
  check_refused([] { AsperitySpring::check({-0.1, 1, 1, 0}); }, "friction coefficient is -0.1");
  check_refused([] { AsperitySpring::check({0.1, -1, 1, 0}); }, "friction spring stiffness is -1 N/m");
  check_refused([] { AsperitySpring::check({0.1, 1, -1, 0}); }, "friction velocity stiffness is -1 N s/m");
  check_refused([] { AsperitySpring::check({0.1, 1, 1, 1.5}); }, "asperity breaking factor is 1.5", "between 0 and 1");
  CHECK_NOTHROW(AsperitySpring::check(constants(0.975)));
}

TEST_CASE("no friction is no force and no history") {
  STATIC_REQUIRE(dem::contact::field_count<dem::friction::None::History<double>> == 0);
  dem::friction::None::History<double> h;
  const auto f = dem::friction::None::force({}, TangentialState<double>{{1, 2, 3}, 5.0, 1e-5, 1, 1, time_step}, h);
  CHECK(to_eigen(f) == Vec3::Zero());
}
