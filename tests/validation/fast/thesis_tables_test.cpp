#include "catch.hpp"

#include <dem/rig/direct_shear/evaluate.hpp>
#include <dem/terramechanics/mohr_coulomb.hpp>
#include <dem/terramechanics/slip.hpp>

#include <cmath>
#include <numbers>
#include <vector>

// Tables of the thesis: the angle of its shear strengths, and the speeds of its wheel.

namespace thesis_tables_test {

using Catch::Approx;
using namespace dem::rig::direct_shear;
using namespace dem::terramechanics;

TEST_CASE("the thesis's table 3.3 gives its angle") {
  const std::vector<double> sigma = {16895.0, 44145.0, 71395.0}, tau = {13483.02778, 33794.4444, 56128.88889};
  const double degrees = 180.0 / std::numbers::pi;
  CHECK(degrees * fit_mohr_coulomb(sigma, tau, Intercept::zero).friction_angle == Approx(38.04).margin(0.05));
}

TEST_CASE("the thesis's table 3.3 is fitted with the thesis's angle") {
  Campaign c;
  for (const Reference& row : thesis) {
    LoadResult r;
    r.normal_at_maximum = row.normal_stress;
    r.maximum = row.maximum;
    r.finished = true;
    c.loads.push_back(r);
  }
  // Five digits of the angle are printed there, of stresses with three.
  CHECK(180.0 / std::numbers::pi * fit(c).origin->friction_angle == Approx(thesis_angle_deg).margin(0.05));
  CHECK(thesis_maximum(16.9e3) == thesis[0].maximum);
  CHECK(std::isnan(thesis_maximum(17.5e3)));
}

TEST_CASE("the thesis's table of speeds is slip by the wheel's speed") {
  using D = SlipDefinition;
  // 17 degrees a second, 0.13 m: at s = 0.7 the carriage has 0.3 of the rim's speed, and its eq. 42 gives 7/3 for that.
  const double omega = 0.29671, r = 0.13, v = 0.3 * omega * r;
  CHECK(slip_of(omega, r, v, D::wheel_speed).value == Approx(0.7));
  CHECK(slip_of(omega, r, v, D::travel_speed).value == Approx(7.0 / 3.0));
  CHECK(slip_of(omega, r, v, D::larger_speed).value == Approx(0.7));
  CHECK(slip_of(omega, r, 1.7 * omega * r, D::wheel_speed).value == Approx(-0.7));
  CHECK(slip_of(omega, r, 1.7 * omega * r, D::larger_speed).value == Approx(-0.7 / 1.7));
}

}  // namespace thesis_tables_test
