#include "core/error_of.hpp"
#include "law/impact.hpp"
#include "law/lanes.hpp"

#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>

namespace restitution_test {

using Catch::Approx;
using namespace dem::contact;

namespace {

// Alumina of Chung and Ooi's third test: r = 2.5 mm, 3.9 m/s on a plane.
const ElasticPair alumina = elastic_pair({3.8e11, 0.23});
const double radius = 2.5e-3, mass = 4000.0 * 4.0 / 3.0 * M_PI * radius * radius * radius;

}  // namespace

TEST_CASE("the damping ratio and the restitution are each other's inverse") {
  for (const bool may_pull : {false, true}) {
    double last = -1.0;
    for (const double e : {1.0, 0.999, 0.8, 0.5, 0.135335, 0.1353, 0.1, 0.01}) {
      const double b = damping_ratio_of(e, may_pull);
      CAPTURE(e, may_pull, b);
      CHECK(restitution_of(b, may_pull) == Approx(e).epsilon(1e-9));
      CHECK(b > last);
      last = b;
    }
  }
  CHECK(damping_ratio_of(1.0) == 0.0);
  CHECK(restitution_of(1.0) == Approx(std::exp(-2.0)).epsilon(1e-12));  // critical damping, never pulling
  CHECK(restitution_of(1.5, true) == 0.0);
  // The two sides of critical damping meet.
  CHECK(restitution_of(1.0 - 2e-6) == Approx(restitution_of(1.0 + 2e-6)).epsilon(1e-5));
}

TEST_CASE("a rebound has the restitution that was asked for, at every speed and size") {
  for (const bool may_pull : {false, true}) {
    for (const double e : {0.2, 0.4, 0.6, 0.8, 0.9, 1.0}) {
      CAPTURE(e, may_pull);
      for (const double speed : {0.01, 3.9}) {
        const auto linear = LinearSpringDashpot::with_restitution(1e6, e, may_pull);
        const Rebound a = impact<LinearSpringDashpot>(linear, mass, radius, speed, 1e-5);
        // Some 6e4 steps of first order each: 2e-4 of the speed.
        CHECK(a.restitution == Approx(e).margin(2e-4));
        if (!may_pull) CHECK(a.lowest_force >= 0.0);
        CHECK((a.lowest_force < 0.0) == (may_pull && e < 1.0));
        const auto hertz = Hertz::with_restitution(alumina, e, may_pull);
        const double depth = hertz_overlap(alumina, {radius, mass, speed});
        const Rebound b = impact<Hertz>(hertz, mass, radius, speed, depth);
        CHECK(b.restitution == Approx(e).margin(2e-4));
        CHECK((b.lowest_force < 0.0) == (may_pull && e < 1.0));
      }
      const auto hertz = Hertz::with_restitution(alumina, e, may_pull);
      CHECK(impact<Hertz>(hertz, 1e3 * mass, 10 * radius, 1.0, 1e-4).restitution == Approx(e).margin(2e-4));
    }
  }
}

TEST_CASE("Hertz's contact and its stand-ins meet the closed forms of an impact") {
  const Impact i = {radius, mass, 3.9};
  const double depth = hertz_overlap(alumina, i);
  const Rebound hertz = impact<Hertz>({alumina.modulus, 0.0}, mass, radius, 3.9, depth);
  // The peaks are flat: they are met to second order in the step; the times to two steps of 6e4.
  CHECK(hertz.peak_overlap == Approx(depth).epsilon(1e-4));
  CHECK(hertz.peak_force ==
        Approx(4.0 / 3.0 * alumina.modulus * std::sqrt(radius) * std::pow(depth, 1.5)).epsilon(1e-4));
  CHECK(hertz.duration == Approx(2.9432 * depth / 3.9).epsilon(1e-4));  // Johnson 1985, eq. 11.24
  const double soft = stiffness_of_equal_energy(alumina, i), fast = stiffness_of_equal_time(alumina, i);
  CHECK(impact<LinearSpringDashpot>({soft, 0.0}, mass, radius, 3.9, depth).peak_overlap == Approx(depth).epsilon(1e-4));
  CHECK(impact<LinearSpringDashpot>({fast, 0.0}, mass, radius, 3.9, depth).duration ==
        Approx(hertz.duration).epsilon(2e-4));
  // Equal energy in the field's form: 16/15 sqrt(R) E* (15 m v^2/(16 sqrt(R) E*))^(1/5).
  const double a = std::sqrt(radius) * alumina.modulus;
  CHECK(soft == Approx(16.0 / 15.0 * a * std::pow(15.0 * mass * 3.9 * 3.9 / (16.0 * a), 0.2)).epsilon(1e-12));
}

TEST_CASE("moduli of pairs") {
  const Solid steel = {2.1e11, 0.3}, rubber = {1e7, 0.5};
  CHECK(steel.shear() == Approx(2.1e11 / 2.6));
  const ElasticPair same = elastic_pair(steel), mixed = elastic_pair(steel, rubber);
  CHECK(same.modulus == Approx(0.5 * 2.1e11 / (1 - 0.09)));
  CHECK(same.shear == Approx(2.1e11 / 2.6 / (2 * 1.7)));
  CHECK(mixed.modulus == elastic_pair(rubber, steel).modulus);
  CHECK(mixed.modulus == Approx(1e7 / 0.75).epsilon(1e-4));  // the soft one decides
  check_refused([] { elastic_pair({0.0, 0.3}); }, "Young's modulus is 0 Pa");
  check_refused([] { elastic_pair({1e9, 0.6}); }, "Poisson ratio is 0.6");
  check_refused([&] { hertz_overlap(same, {1.0, 1.0, 0.0}); }, "speed of an impact is 0 m/s");
}

TEST_CASE("every lane of a pack gets what a double gets from the damped normal laws") {
  const auto state_of = [](auto& uniform) {
    return NormalState<double>{uniform(0.0, 1e-5), uniform(-1.0, 1.0), 1e-3, uniform(1e-6, 1e-5), 1e-6};
  };
  const auto force = []<class P, class S, class H>(const P& p, const S& s, H& h) {
    if constexpr (requires { p.modulus; }) {
      return Hertz::force(p, s, h);
    } else {
      return LinearSpringDashpot::force(p, s, h);
    }
  };
  for (const bool pull : {false, true}) {
    check_lanes<LinearSpringDashpot::Parameters, NormalState, LinearSpringDashpot::History>(
        LinearSpringDashpot::with_restitution(1e4, 0.3, pull), force, state_of);
    check_lanes<Hertz::Parameters, NormalState, Hertz::History>(Hertz::with_restitution(alumina, 0.3, pull), force,
                                                                state_of);
  }
}

TEST_CASE("the slopes that limit the time step are those of the force") {
  const Hertz::Parameters<double> p = {1e9, 0.3};
  NormalState<double> s = {1e-5, 0.5, 1e-3, 1e-5, 1e-6};
  Hertz::History<double> none;
  // Central differences of second order, h = 1e-4 of the argument: 1e-7.
  const auto f = [&](double d, double v) {
    NormalState<double> t = s;
    t.overlap = d;
    t.approach_speed = v;
    return Hertz::force(p, t, none);
  };
  s.approach_speed = 0.0;
  CHECK(Hertz::stiffness(p, s) == Approx((f(1.0001e-5, 0.0) - f(0.9999e-5, 0.0)) / 2e-9).epsilon(1e-6));
  CHECK(Hertz::damping(p, s) == Approx(f(1e-5, 1.0) - f(1e-5, 0.0)).epsilon(1e-9));
  const LinearSpringDashpot::Parameters<double> q = {1e4, 0.3};
  LinearSpringDashpot::History<double> h;
  CHECK(LinearSpringDashpot::stiffness(q, s) == Approx(1e4));
  CHECK(LinearSpringDashpot::damping(q, s) == Approx(2 * 0.3 * std::sqrt(1e4 * 1e-5)));
  s.approach_speed = 1.0;
  CHECK(LinearSpringDashpot::force(q, s, h) == Approx(1e4 * 1e-5 + LinearSpringDashpot::damping(q, s)));
}

TEST_CASE("damped normal laws refuse constants that make no sense") {
  check_refused([] { damping_ratio_of(0.0); }, "coefficient of restitution is 0", "between 0.01 and 1");
  check_refused([] { damping_ratio_of(1.1); }, "coefficient of restitution is 1.1");
  check_refused([] { LinearSpringDashpot::check({0.0, 0.1}); }, "normal stiffness is 0 N/m");
  check_refused([] { LinearSpringDashpot::check({1.0, -0.1}); }, "normal damping ratio is -0.1");
  check_refused([] { LinearSpringDashpot::check({1.0, 0.1, 2.0}); }, "may_pull", "is 2");
  check_refused([] { Hertz::check({-1.0, 0.1}); }, "effective modulus is -1 Pa");
  CHECK_NOTHROW(Hertz::check(Hertz::with_restitution(alumina, 0.5)));
}

}  // namespace restitution_test
