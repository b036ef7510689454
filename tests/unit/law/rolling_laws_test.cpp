#include "core/error_of.hpp"
#include "law/lanes.hpp"

#include <dem/law/rolling/constant_torque.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/law/rolling/none.hpp>
#include <dem/law/rolling/sum.hpp>
#include <dem/law/rolling/torsion.hpp>

namespace rolling_laws_test {

using Catch::Approx;
using dem::Vec3;
using namespace dem::rolling;
using Both = Sum<ElasticPlastic, Torsion>;

namespace {

constexpr double dt = 1e-5, radius = 0.01, mass = 0.1;

/// The normal is z; `spin` is that of i relative to j.
RollingState<double> state(const Vec3& spin, double normal_force) {
  return {{0, 0, 1}, {spin.x(), spin.y(), 0}, spin.z(), normal_force, radius, mass, dt};
}
template <class Law, class P, class H>
Vec3 torque(const P& p, const Vec3& spin, double normal_force, H& h) {
  return to_eigen(Law::torque(p, state(spin, normal_force), h));
}
const dem::contact::NormalState<double> contact = {1e-5, 0, radius, mass, dt};

}  // namespace

TEST_CASE("the rolling spring turns, is damped, and slips at mu_r R Fn") {
  const ElasticPlastic::Parameters<double> p = {0.2, 1e5, 0.3};
  const double k = 1e5 * radius * radius, c = ElasticPlastic::damping(p, contact);
  CHECK(ElasticPlastic::stiffness(p, contact) == Approx(k));
  CHECK(c == Approx(2 * 0.3 * std::sqrt(k * 1.4 * mass * radius * radius)));  // a ball rolling on a plane: 7/5 m r^2
  ElasticPlastic::History<double> h = {};
  const Vec3 spin(0.03, 0.04, 5.0);  // twisting is none of its business
  const Vec3 first = torque<ElasticPlastic>(p, spin, 1.0, h);
  CHECK((first + (k * dt + c) * Vec3(0.03, 0.04, 0)).norm() < 1e-15);
  for (int n = 0; n < 10000; ++n) torque<ElasticPlastic>(p, spin, 1.0, h);
  const double limit = 0.2 * radius;
  CHECK((torque<ElasticPlastic>(p, spin, 1.0, h) + limit * Vec3(0.6, 0.8, 0)).norm() < 1e-15);
  CHECK(k * to_eigen(h.angle).norm() == Approx(limit));
  CHECK((torque<ElasticPlastic>(p, Vec3::Zero(), 1.0, h) + limit * Vec3(0.6, 0.8, 0)).norm() < 1e-15);  // holds
  CHECK(torque<ElasticPlastic>(p, spin, 0.0, h) == Vec3::Zero());
}

TEST_CASE("the constant torque opposes rolling and never turns it round") {
  const ConstantTorque::Parameters<double> p = {0.2};
  ConstantTorque::History<double> h;
  CHECK((torque<ConstantTorque>(p, {30, 40, 9}, 1.0, h) + 0.2 * radius * Vec3(0.6, 0.8, 0)).norm() < 1e-15);
  CHECK(torque<ConstantTorque>(p, Vec3::Zero(), 1.0, h) == Vec3::Zero());
  // A ball that nearly stands would be turned round by the whole torque; it is stopped by the step instead.
  const double inertia = 0.4 * mass * radius * radius, slow = 0.1 * 0.2 * radius / inertia * dt;
  CHECK(torque<ConstantTorque>(p, {slow, 0, 0}, 1.0, h).x() == Approx(-inertia * slow / dt));
  // The torque acts for a whole step, also where histories move on by half of one.
  RollingState<double> half = state({slow, 0, 0}, 1.0);
  half.time_step = 0.5 * dt;
  CHECK(ConstantTorque::torque(p, half, h).x == Approx(-inertia * slow / dt));
}

TEST_CASE("the twisting spring acts about the normal and slips at mu_t R Fn") {
  const Torsion::Parameters<double> p = {0.1, 1e5, 0.5};
  const double k = 1e5 * radius * radius, c = Torsion::damping(p, contact);
  CHECK(c == Approx(2 * 0.5 * std::sqrt(k * 0.4 * mass * radius * radius)));
  Torsion::History<double> h = {};
  const Vec3 first = torque<Torsion>(p, {7, 8, -0.05}, 1.0, h);
  CHECK((first - Vec3(0, 0, (k * dt + c) * 0.05)).norm() < 1e-15);
  for (int n = 0; n < 10000; ++n) torque<Torsion>(p, {7, 8, -0.05}, 1.0, h);
  CHECK(torque<Torsion>(p, {7, 8, -0.05}, 1.0, h).z() == Approx(0.1 * radius));
  CHECK(k * h.angle == Approx(-0.1 * radius));
  CHECK(torque<Torsion>(p, {0, 0, 0}, 1.0, h).z() == Approx(0.1 * radius));
  CHECK(torque<Torsion>(p, {0, 0, 1}, 0.0, h) == Vec3::Zero());
}

TEST_CASE("a sum of rolling laws is both of them, with both histories") {
  STATIC_REQUIRE(dem::contact::field_count<Both::History<double>> == 4);
  STATIC_REQUIRE(dem::contact::field_count<Sum<ConstantTorque, Torsion>::History<double>> == 1);
  STATIC_REQUIRE(dem::contact::field_count<None::History<double>> == 0);
  const Both::Parameters<double> p = {{0.2, 1e5, 0.3}, {0.1, 1e5, 0.5}};
  Both::History<double> both = {};
  ElasticPlastic::History<double> rolls = {};
  Torsion::History<double> twists = {};
  for (int n = 0; n < 5; ++n) {
    const Vec3 spin(0.1 * n, 0.2, 0.3);
    const Vec3 apart = torque<ElasticPlastic>(p.first, spin, 1.0, rolls) + torque<Torsion>(p.second, spin, 1.0, twists);
    CHECK(torque<Both>(p, spin, 1.0, both) == apart);
  }
  CHECK(both.ElasticPlastic::History<double>::angle.y == rolls.angle.y);
  CHECK(both.Torsion::History<double>::angle == twists.angle);
  Both::carry(both, [](const dem::Vector3<double>& v) { return -v; });
  CHECK(both.ElasticPlastic::History<double>::angle.y == -rolls.angle.y);
  CHECK(both.Torsion::History<double>::angle == twists.angle);  // a twist is the same from both sides
  CHECK(Both::stiffness(p, contact) == Approx(2e5 * radius * radius));
}

TEMPLATE_TEST_CASE("every lane of a pack gets what a double gets from the rolling laws", "", ConstantTorque,
                   ElasticPlastic, Torsion, Both) {
  typename TestType::template Parameters<double> p;
  if constexpr (std::is_same_v<TestType, ConstantTorque>) p = {0.2};
  if constexpr (std::is_same_v<TestType, ElasticPlastic>) p = {0.2, 1e5, 0.3};
  if constexpr (std::is_same_v<TestType, Torsion>) p = {0.2, 1e5, 0.3};
  if constexpr (std::is_same_v<TestType, Both>) p = {{0.2, 1e5, 0.3}, {0.1, 1e5, 0.3}};
  check_lanes<TestType::template Parameters, RollingState, TestType::template History>(
      p, [](const auto& q, const auto& s, auto& h) { return TestType::torque(q, s, h); },
      [](auto& uniform) {
        return RollingState<double>{
            {0, 0, 1}, {uniform(-9, 9), uniform(-9, 9), 0}, uniform(-9, 9), uniform(0, 1), radius, mass, dt};
      });
}

TEST_CASE("rolling constants that make no sense are refused") {
  check_refused([] { ConstantTorque::check({-0.1}); }, "rolling coefficient is -0.1");
  check_refused([] { ElasticPlastic::check({0.1, 0, 0}); }, "rolling stiffness is 0 N/m");
  check_refused([] { ElasticPlastic::check({0.1, 1, -1}); }, "rolling damping ratio is -1");
  check_refused([] { Torsion::check({-0.1, 1, 1}); }, "twisting coefficient is -0.1");
  check_refused([] { Torsion::check({0.1, -1, 1}); }, "twisting stiffness is -1 N/m");
  check_refused([] { Both::check({{0.1, 1, 1}, {0.1, 1, -1}}); }, "twisting damping ratio is -1");
  CHECK_NOTHROW(Both::check({{0.1, 1, 1}, {0.1, 1, 1}}));
}

}  // namespace rolling_laws_test
