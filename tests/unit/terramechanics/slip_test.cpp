#include <dem/terramechanics/slip.hpp>

#include <cmath>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using D = SlipDefinition;

TEST_CASE("the definitions of slip describe the same motion") {
  const double r = 0.13, omega = 0.3;
  for (const double ratio : {0.3, 0.999, 1.0, 1.001, 1.7, 4.0}) {  // v/(omega r)
    const double v = ratio * omega * r;
    for (const D from : {D::wheel_speed, D::travel_speed, D::larger_speed}) {
      const Slip slip = slip_of(omega, r, v, from);
      CHECK(slip.speed_ratio() == Approx(ratio).epsilon(1e-14));
      for (const D to : {D::wheel_speed, D::travel_speed, D::larger_speed}) {
        CHECK(slip.as(to).value == Approx(slip_of(omega, r, v, to).value).epsilon(1e-12).margin(1e-15));
        CHECK(slip.as(to).definition == to);
      }
    }
  }
}

TEST_CASE("slip on the spot is known by two definitions, a locked wheel by none of the laws") {
  CHECK(slip_of(1.0, 0.1, 0.0, D::wheel_speed).value == 1.0);
  CHECK(slip_of(1.0, 0.1, 0.0, D::larger_speed).value == 1.0);
  CHECK(slip_of(0.0, 0.1, 1.0, D::larger_speed).value == -1.0);
  CHECK_NOTHROW(check_slip({1.0, D::wheel_speed}));
  CHECK_NOTHROW(check_slip({-5.0, D::wheel_speed}));
  CHECK_NOTHROW(check_slip({5.0, D::travel_speed}));
  CHECK_THROWS_WITH(check_slip({1.1, D::wheel_speed}), ContainsSubstring("1 - v/(omega r)"));
  CHECK_THROWS_WITH(check_slip({-1.0, D::travel_speed}), ContainsSubstring("omega r/v - 1"));
  CHECK_THROWS_WITH(check_slip({-1.0, D::larger_speed}), ContainsSubstring("locked"));
  CHECK_THROWS_WITH(check_slip({std::nan(""), D::wheel_speed}), ContainsSubstring("slip is nan"));
  CHECK_THROWS_WITH(slip_of(0.0, 0.1, 0.0, D::wheel_speed), ContainsSubstring("neither turns nor travels"));
  CHECK_THROWS_WITH(slip_of(-1.0, 0.1, 0.0, D::wheel_speed), ContainsSubstring("spin of the wheel"));
}
