#include "core/error_of.hpp"
#include "law/lanes.hpp"

#include <dem/law/cohesion/constant.hpp>
#include <dem/law/cohesion/contact_stress.hpp>
#include <dem/law/cohesion/dmt.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/cohesion/none.hpp>
#include <dem/law/normal/hertz.hpp>

namespace cohesion_laws_test {

using Catch::Approx;
using namespace dem::cohesion;

namespace {

constexpr double radius = 1e-4, work = 0.05, modulus = 1e8;
const JKR::Parameters<double> sticky = {work, modulus};

template <class Law>
Attraction<double> force(const typename Law::template Parameters<double>& p, double overlap,
                         typename Law::template History<double>& h) {
  return Law::force(p, NormalState<double>{overlap, 0.0, radius, 1e-8, 1e-7}, h);
}
double hertz(double overlap) {
  return overlap > 0.0 ? 4.0 / 3.0 * modulus * std::sqrt(radius * overlap) * overlap : 0.0;
}
/// The JKR curve by its parameter, the contact radius: force and overlap.
double jkr_force(double a) {
  return 4.0 * modulus * a * a * a / (3.0 * radius) - std::sqrt(8.0 * M_PI * work * modulus * a * a * a);
}
double jkr_overlap(double a) { return a * a / radius - std::sqrt(2.0 * M_PI * work * a / modulus); }
const double unit = std::cbrt(2.0 * M_PI * work * radius * radius / modulus);  // of a
const double pull_off = 1.5 * M_PI * work * radius;

}  // namespace

TEST_CASE("with Hertz's law JKR cohesion follows the JKR curve") {
  // From the pull-off at the smallest contact radius to a hundred times the adhesive overlap.
  for (const double a : {0.4 * unit, 0.5 * unit, 0.8255 * unit, unit, 1.1 * unit, 1.31 * unit, 3 * unit, 30 * unit}) {
    JKR::History<double> h = {1.0};
    const double d = jkr_overlap(a);
    // Between pull-off and a = 0.4 the overlap barely depends on a: roots are found to 1e-8 there, forces to 1e-9.
    CAPTURE(a / unit);
    CHECK(hertz(d) - force<JKR>(sticky, d, h).pull == Approx(jkr_force(a)).epsilon(1e-9).margin(1e-9 * pull_off));
  }
}

TEST_CASE("JKR's contact starts when surfaces meet and ends at the pull-off") {
  const double last = JKR::range(sticky, radius);
  CHECK(last == Approx(0.75 * std::cbrt(M_PI * M_PI * work * work * radius / (modulus * modulus))));
  JKR::History<double> h = {};
  CHECK(force<JKR>(sticky, -0.5 * last, h).pull == 0.0);  // coming: not yet
  CHECK(force<JKR>(sticky, -0.5 * last, h).grip == 0.0);
  CHECK(force<JKR>(sticky, 0.0, h).pull == Approx(8.0 / 9.0 * pull_off).epsilon(1e-9));
  CHECK(force<JKR>(sticky, 1e-6, h).pull > 0.0);
  double largest = 0.0;
  for (int n = 0; n <= 1000; ++n) largest = std::max(largest, force<JKR>(sticky, -last * n / 1001, h).pull);
  CHECK(largest == Approx(pull_off).epsilon(1e-5));  // a flat peak met to one part in a thousand of its width
  CHECK(force<JKR>(sticky, -last * 0.999999, h).pull == Approx(5.0 / 9.0 * pull_off).epsilon(2e-3));
  CHECK(force<JKR>(sticky, -last * 1.000001, h).pull == 0.0);
  CHECK(force<JKR>(sticky, -0.5 * last, h).pull == 0.0);  // and not again before the next contact
  CHECK(force<JKR>(sticky, 1e-7, h).pull > 0.0);
}

TEST_CASE("JKR limits friction by the force plus twice the pull-off force") {
  JKR::History<double> h = {};
  for (const double d : {3e-6, 1e-6, 0.0, -0.03e-6}) {
    const auto a = force<JKR>(sticky, d, h);
    CHECK(hertz(d) + a.grip == Approx((hertz(d) - a.pull) + 2 * pull_off));
  }
}

TEST_CASE("without adhesion JKR is Hertz") {
  JKR::History<double> h = {};
  for (const double d : {1e-7, 1e-6, 1e-5}) CHECK(std::abs(force<JKR>({0.0, modulus}, d, h).pull) < 1e-9 * hertz(d));
  CHECK(force<JKR>({0.0, modulus}, -1e-9, h).pull == 0.0);
  CHECK(JKR::range({0.0, modulus}, radius) == 0.0);
  CHECK(JKR::stiffness({0.0, modulus}, {1e-6, 0, radius, 1, 1}) == 0.0);
}

TEST_CASE("JKR tells how much steeper it is than Hertz") {
  for (const double d : {1e-6, 5e-6}) {
    JKR::History<double> h = {1.0};
    const double step = 1e-4 * d;
    // Central differences of second order.
    const double slope = -(force<JKR>(sticky, d + step, h).pull - force<JKR>(sticky, d - step, h).pull) / (2 * step);
    CHECK(slope > 0.0);
    CHECK(JKR::stiffness(sticky, {d, 0, radius, 1, 1}) == Approx(slope).epsilon(1e-5));
  }
}

TEST_CASE("DMT pulls with 2 pi w R in contact") {
  DMT::History<double> h;
  CHECK(force<DMT>({work}, 1e-6, h).pull == Approx(2 * M_PI * work * radius));
  CHECK(force<DMT>({work}, 1e-9, h).pull == Approx(2 * M_PI * work * radius));
  CHECK(force<DMT>({work}, 0.0, h).pull == 0.0);
  CHECK_FALSE(reaches<DMT>);
}

TEST_CASE("constant cohesion comes on over its depth") {
  Constant::History<double> h;
  CHECK(force<Constant>({2.0}, 1e-9, h).pull == 2.0);
  CHECK(force<Constant>({2.0}, 0.0, h).pull == 0.0);
  CHECK(force<Constant>({2.0, 1e-5}, 1e-6, h).pull == Approx(0.2));
  CHECK(force<Constant>({2.0, 1e-5}, 3e-5, h).pull == 2.0);
  CHECK(Constant::stiffness({2.0, 1e-5}, {1, 0, 1, 1, 1}) == Approx(2e5));
  CHECK(Constant::stiffness({2.0}, {1, 0, 1, 1, 1}) == 0.0);
  CHECK_FALSE(reaches<Constant>);
}

TEST_CASE("a constant stress pulls on the area of Hertz's circle") {
  ContactStress::History<double> h;
  // Its radius squared is R* d.
  for (const double d : {1e-9, 1e-6, 1e-5}) {
    CHECK(force<ContactStress>({3e4}, d, h).pull == Approx(3e4 * M_PI * radius * d).epsilon(1e-14));
    CHECK(force<ContactStress>({3e4}, d, h).grip == 0.0);
  }
  CHECK(force<ContactStress>({3e4}, 0.0, h).pull == 0.0);
  CHECK(force<ContactStress>({3e4}, -1e-6, h).pull == 0.0);
  CHECK(ContactStress::stiffness({3e4}, {1e-6, 0, radius, 1, 1}) == Approx(3e4 * M_PI * radius).epsilon(1e-14));
  CHECK_FALSE(reaches<ContactStress>);
  // It balances Hertz's spring where 4/3 E* sqrt(R* d) = pi s R*.
  const double stress = 1e5, even = std::pow(0.75 * M_PI * stress / modulus, 2) * radius;
  CHECK(force<ContactStress>({stress}, even, h).pull == Approx(hertz(even)).epsilon(1e-12));
}

TEST_CASE("a liquid bridge forms at first contact, weakens with the gap, and breaks") {
  const double tension = 0.072, angle = 0.3, volume = 1e-15;
  const auto p = LiquidBridge::of(tension, angle, volume);
  CHECK(p.rupture == Approx(1.15e-5));
  CHECK(LiquidBridge::range(p, radius) == p.rupture);
  CHECK(reaches<LiquidBridge>);
  LiquidBridge::History<double> h = {};
  CHECK(force<LiquidBridge>(p, -1e-6, h).pull == 0.0);
  // In contact 2 pi R g cos(angle), with R = 2 R* for two equal spheres.
  const double whole = 2 * M_PI * (2 * radius) * tension * std::cos(angle);
  CHECK(force<LiquidBridge>(p, 1e-6, h).pull == Approx(whole));
  const double s = 1e-6 * std::sqrt(2 * radius / volume);
  CHECK(force<LiquidBridge>(p, -1e-6, h).pull == Approx(whole / (1 + 1.05 * s + 2.5 * s * s)));
  CHECK(force<LiquidBridge>(p, -1.1499e-5, h).pull > 0.0);
  CHECK(force<LiquidBridge>(p, -1.1501e-5, h).pull == 0.0);
  CHECK(force<LiquidBridge>(p, -1e-6, h).pull == 0.0);
  // The slope that limits the time step is the steepest, to one percent.
  h.formed = 1.0;
  double steepest = 0.0;
  for (double gap = 0.0; gap < 1e-5; gap += 1e-9) {
    steepest =
        std::max(steepest, (force<LiquidBridge>(p, -gap, h).pull - force<LiquidBridge>(p, -gap - 1e-9, h).pull) / 1e-9);
  }
  const double stiffness = LiquidBridge::stiffness(p, {1e-6, 0, radius, 1, 1});
  CHECK(steepest <= stiffness);
  CHECK(steepest > 0.99 * stiffness);
}

TEMPLATE_TEST_CASE("every lane of a pack gets what a double gets from the cohesion laws", "", Constant, ContactStress,
                   DMT, JKR, LiquidBridge) {
  typename TestType::template Parameters<double> p;
  if constexpr (std::is_same_v<TestType, Constant>) p = {1e-5, 5e-7};
  if constexpr (std::is_same_v<TestType, ContactStress>) p = {1e5};
  if constexpr (std::is_same_v<TestType, DMT>) p = {work};
  if constexpr (std::is_same_v<TestType, JKR>) p = sticky;
  if constexpr (std::is_same_v<TestType, LiquidBridge>) p = LiquidBridge::of(0.07, 0.1, 1e-19);
  check_lanes<TestType::template Parameters, NormalState, TestType::template History>(
      p, [](const auto& q, const auto& s, auto& h) { return TestType::force(q, s, h); },
      [](auto& uniform) {
        return NormalState<double>{uniform(-0.1e-6, 0.2e-6), 0.0, uniform(0.5, 1.0) * radius, 1e-8, 1e-7};
      });
}

TEST_CASE("no cohesion is no force and no history") {
  STATIC_REQUIRE(dem::contact::field_count<None::History<double>> == 0);
  STATIC_REQUIRE_FALSE(reaches<None>);
  None::History<double> h;
  CHECK(force<None>({}, 1e-5, h).pull == 0.0);
}

TEST_CASE("cohesion constants that make no sense are refused") {
  check_refused([] { Constant::check({-1.0}); }, "cohesive force is -1 N");
  check_refused([] { Constant::check({1.0, -1.0}); }, "depth of a cohesive force is -1 m");
  check_refused([] { ContactStress::check({-1.0}); }, "adhesive stress is -1 Pa");
  check_refused([] { DMT::check({-1.0}); }, "work of adhesion is -1 J/m^2");
  check_refused([] { JKR::check({1.0, 0.0}); }, "effective modulus is 0 Pa");
  check_refused(
      [] {
        JKR::check_with({1.0, 1e6}, {2e6, 0.1});
      },
      "JKR's effective modulus is 1e+06 Pa", "Hertz's is 2e+06 Pa");
  CHECK_NOTHROW(JKR::check_with({1.0, 1e6}, {1e6, 0.1}));
  check_refused([] { LiquidBridge::check({-1.0, 1.0, 1.0}); }, "wetting tension of a liquid bridge is -1 N/m");
  check_refused([] { LiquidBridge::check({1.0, 0.0, 1.0}); }, "volume of a liquid bridge is 0 m^3");
  check_refused([] { LiquidBridge::check({1.0, 1.0, -1.0}); }, "rupture distance of a liquid bridge is -1 m");
  check_refused([] { LiquidBridge::of(0.07, 2.0, 1e-15); }, "contact angle (rad) is 2");
  CHECK_NOTHROW(LiquidBridge::check(LiquidBridge::of(0.07, 0.0, 1e-15)));
}

}  // namespace cohesion_laws_test
