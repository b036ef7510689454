#include "core/error_of.hpp"

#include <dem/law/normal/penalty.hpp>

#include <limits>
#include <random>

using Catch::Approx;
using dem::Pack;
using dem::contact::NormalState;
using dem::contact::Penalty;

namespace {

const Penalty::Parameters<double> sand = {2000.0, 0.015, 0.05};  // K, C, Sp of the thesis

double force(double overlap, double approach, const Penalty::Parameters<double>& p = sand) {
  Penalty::History<double> none;
  return Penalty::force(p, NormalState<double>{overlap, approach, 1e-3, 1e-5, 1e-5}, none);
}

}  // namespace

TEST_CASE("the penalty law damps fully while approaching and by the separation factor while parting") {
  CHECK(force(1e-5, 0.0) == Approx(0.02).epsilon(1e-14));             // K d
  CHECK(force(1e-5, 0.2) == Approx(0.02 + 0.003).epsilon(1e-14));     // + C d'
  CHECK(force(1e-5, -0.2) == Approx(0.02 - 0.00015).epsilon(1e-14));  // - Sp C d'
  CHECK(force(1e-5, -0.2, {2000.0, 0.015, 0.0}) == Approx(0.02).epsilon(1e-14));
  CHECK(force(1e-5, -0.2, {2000.0, 0.015, 1.0}) == Approx(0.017).epsilon(1e-14));
}

TEST_CASE("the penalty law never pulls") {
  // K d = 2e-4 N against Sp C d' = 7.5e-4 N.
  CHECK(force(1e-7, -1.0) == 0.0);
  // Just before and after the force changes its sign, at d' = -K d / (Sp C) = -0.2667 m/s.
  CHECK(force(1e-7, -0.266) > 0.0);
  CHECK(force(1e-7, -0.267) == 0.0);
}

TEST_CASE("the penalty law tells the time step its slopes") {
  const NormalState<double> state = {1e-5, 0.0, 1e-3, 1e-5, 1e-5};
  CHECK(Penalty::stiffness(sand, state) == Approx((force(2e-5, 0.0) - force(1e-5, 0.0)) / 1e-5));
  CHECK(Penalty::damping(sand, state) == Approx(force(1e-5, 1.0) - force(1e-5, 0.0)));
}

TEST_CASE("every lane of a pack gets what a double gets from the penalty law") {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> overlap(0.0, 1e-5), speed(-1.5, 1.5);
  for (int trial = 0; trial < 200; ++trial) {
    const Pack d = dem::generate([&](int) { return overlap(engine); });
    const Pack v = dem::generate([&](int) { return speed(engine); });
    const Penalty::Parameters<Pack> p = {Pack(2000.0), Pack(0.015), Pack(0.05)};
    Penalty::History<Pack> none;
    const Pack f = Penalty::force(p, NormalState<Pack>{d, v, Pack(1e-3), Pack(1e-5), Pack(1e-5)}, none);
    for (int k = 0; k < dem::pack_width; ++k) {
      const double x = dem::lane(d, k), u = dem::lane(v, k);
      // The same operations in the same order, but the compiler may fuse a multiply and an add in one of them: one
      // rounding of the largest term, which cancellation may make large beside the sum.
      const double ulp = std::numeric_limits<double>::epsilon() * (2000.0 * x + 0.015 * std::abs(u));
      CHECK(std::abs(dem::lane(f, k) - force(x, u)) <= ulp);
    }
  }
}

TEST_CASE("penalty constants that make no sense are refused") {
  check_refused([] { Penalty::check({0.0, 0.0, 1.0}); }, "normal stiffness is 0 N/m", "greater than zero");
  check_refused([] { Penalty::check({-5.0, 0.0, 1.0}); }, "normal stiffness is -5 N/m");
  check_refused([] { Penalty::check({1.0, -0.1, 1.0}); }, "normal damping is -0.1 N s/m");
  check_refused([] { Penalty::check({1.0, 0.0, 1.1}); }, "separation damping factor is 1.1", "between 0 and 1");
  check_refused([] { Penalty::check({1.0, 0.0, -0.1}); }, "separation damping factor is -0.1");
  CHECK_NOTHROW(Penalty::check(sand));
}
