#include "core/error_of.hpp"
#include "law/impact.hpp"
#include "law/lanes.hpp"

#include <dem/law/normal/hysteretic.hpp>

using Catch::Approx;
using namespace dem::contact;

namespace {
double force(Hysteretic::History<double>& h, double overlap, const Hysteretic::Parameters<double>& p = {1000, 4000}) {
  return Hysteretic::force(p, NormalState<double>{overlap, 0.0, 1e-3, 1e-5, 1e-6}, h);
}
}  // namespace

TEST_CASE("a hysteretic contact loads along one line and unloads along a steeper one") {
  Hysteretic::History<double> h = {};
  CHECK(force(h, 1e-5) == Approx(0.01));
  CHECK(force(h, 2e-5) == Approx(0.02));
  CHECK(force(h, 1.75e-5) == Approx(0.01));  // k2 (d - d0), d0 = 2e-5 (1 - 1/4) = 1.5e-5
  CHECK(force(h, 1.5e-5) == Approx(0.0).margin(1e-15));
  CHECK(force(h, 1e-5) == 0.0);              // an imprint, no pull
  CHECK(force(h, 1.75e-5) == Approx(0.01));  // back along the steep line
  CHECK(force(h, 3e-5) == Approx(0.03));     // and on along the first
  CHECK(h.largest_overlap == 3e-5);
  Hysteretic::History<double> elastic = {};
  for (const double d : {3e-5, 1e-5, 2e-5}) CHECK(force(elastic, d, {1000, 1000}) == Approx(1000 * d));
}

TEST_CASE("a hysteretic contact rebounds with sqrt(k1/k2) at every speed") {
  for (const double e : {0.2, 0.5, 0.9, 1.0}) {
    const auto p = Hysteretic::with_restitution(1000.0, e);
    CHECK(p.unloading_stiffness == Approx(1000.0 / (e * e)));
    for (const double speed : {0.01, 1.0}) {
      // Some 6e4 steps of first order.
      CHECK(impact<Hysteretic>(p, 1e-5, 1e-3, speed, 1e-5).restitution == Approx(e).margin(1e-4));
    }
  }
}

TEST_CASE("every lane of a pack gets what a double gets from the hysteretic law") {
  check_lanes<Hysteretic::Parameters, NormalState, Hysteretic::History>(
      {1000.0, 3000.0}, [](const auto& p, const auto& s, auto& h) { return Hysteretic::force(p, s, h); },
      [](auto& uniform) {
        return NormalState<double>{uniform(0.0, 1e-5), 0.0, 1e-3, 1e-5, 1e-6};
      });
}

TEST_CASE("hysteretic constants that make no sense are refused") {
  check_refused([] { Hysteretic::check({0.0, 1.0}); }, "loading stiffness is 0 N/m");
  check_refused([] { Hysteretic::check({2.0, 1.0}); }, "unloading stiffness is 1 N/m", "at least", "2 N/m");
  check_refused([] { Hysteretic::with_restitution(1.0, 1.5); }, "coefficient of restitution is 1.5");
  CHECK_NOTHROW(Hysteretic::check({1.0, 1.0}));
}
