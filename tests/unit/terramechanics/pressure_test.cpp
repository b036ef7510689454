#include <dem/terramechanics/soil.hpp>

#include <cmath>
#include <limits>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("Bekker's law gives the plate table of Mojave Martian Simulant") {
  // kPa under plates of 30, 50 and 70 mm, to the three digits that the table has.
  const double table[4][4] = {
      {5, 21.0, 14.2, 11.3}, {10, 55.3, 37.4, 29.8}, {20, 146, 98.8, 78.6}, {30, 258, 174, 139}};
  const double widths[3] = {0.03, 0.05, 0.07};
  for (const auto& row : table) {
    for (int k = 0; k < 3; ++k) {
      const double p = under(mojave_martian_simulant.pressure, widths[k]).pressure(1e-3 * row[0]);
      CHECK(1e-3 * p == Approx(row[k + 1]).epsilon(5e-3));
    }
  }
}

TEST_CASE("the sand P1 carries k at a sinkage of its plate's width, under any plate") {
  for (const double width : {0.01, 0.03, 0.16}) {
    const PressureCurve curve = under(melanz_sand.pressure, width);
    CHECK(curve.pressure(0.03) == Approx(2.54e5).epsilon(1e-13));
    CHECK(curve.pressure(0.06) == Approx(2.54e5 * std::pow(2.0, 1.387)).epsilon(1e-13));
  }
}

TEST_CASE("Reece's law is Bekker's where the exponent is 1, and scales with the width where there is no cohesion") {
  const Reece reece = {.k_c = 30.0, .k_phi = 50.0, .n = 1.0, .cohesion = 2000.0, .unit_weight = 16e3};
  const Bekker same = {.k_c = 2000.0 * 30.0, .k_phi = 16e3 * 50.0, .n = 1.0};
  for (const double b : {0.03, 0.1, 0.4}) {
    for (const double z : {0.001, 0.02}) {
      CHECK(reece.under(b).pressure(z) == Approx(same.under(b).pressure(z)).epsilon(1e-13));
    }
  }
  // Of a frictional soil the whole failure zone scales: twice the plate at twice the sinkage has twice the pressure.
  const Reece sand = {.k_c = 0.0, .k_phi = 50.0, .n = 0.7, .cohesion = 0.0, .unit_weight = 16e3};
  CHECK(sand.under(0.2).pressure(0.02) == Approx(2.0 * sand.under(0.1).pressure(0.01)).epsilon(1e-13));
}

TEST_CASE("sinkage, slope and work of a pressure curve belong to its pressure") {
  for (const double n : {0.5, 1.0, 1.4}) {
    const PressureCurve curve = {3e5, n};
    const double z = 0.013, h = 1e-6;
    CHECK(curve.sinkage(curve.pressure(z)) == Approx(z).epsilon(1e-13));
    // Central differences: the third derivative over z^2 is of order 1, so the error is (h/z)^2 = 6e-9.
    CHECK(curve.slope(z) == Approx((curve.pressure(z + h) - curve.pressure(z - h)) / (2 * h)).epsilon(1e-7));
    CHECK(curve.pressure(z) == Approx((curve.work(z + h) - curve.work(z - h)) / (2 * h)).epsilon(1e-7));
    CHECK(curve.pressure(0.0) == 0.0);
    CHECK(curve.pressure(-0.01) == 0.0);
    CHECK(curve.work(-0.01) == 0.0);
  }
}

TEST_CASE("shear stress starts with the slope strength over K and ends at the strength") {
  const JanosiHanamoto shear = {.cohesion = 600.0, .friction_angle = radians(35.0), .displacement = 0.6e-3};
  const double p = 20e3, strength = 600.0 + 20e3 * std::tan(radians(35.0));
  CHECK(shear.strength(p) == Approx(strength).epsilon(1e-14));
  CHECK(shear.stress(p, 1.0) == shear.strength(p));  // 1 - exp(-1667) is 1
  CHECK(shear.stress(p, std::numeric_limits<double>::infinity()) == shear.strength(p));
  CHECK(shear.stress(p, 0.6e-3) == Approx(strength * (1.0 - std::exp(-1.0))).epsilon(1e-14));
  CHECK(shear.stress(p, 1e-12) / 1e-12 == Approx(strength / 0.6e-3).epsilon(1e-8));  // j/K = 2e-9
  CHECK(shear.stress(p, -0.6e-3) == shear.stress(p, 0.6e-3));
}

TEST_CASE("the named soils are soils") {
  CHECK_NOTHROW(check_soil(melanz_sand));
  CHECK_NOTHROW(check_soil(mojave_martian_simulant));
}

TEST_CASE("constants that no soil has are refused in words") {
  const double nan = std::nan("");
  const auto with = [](auto&& change) {
    Soil soil = mojave_martian_simulant;
    change(soil);
    return soil;
  };
  const auto bekker = [&](double k_c, double k_phi, double n) {
    return with([&](Soil& s) { s.pressure = Bekker{k_c, k_phi, n}; });
  };
  for (const double n : {0.0, -1.0, nan, 11.0}) {
    CHECK_THROWS_WITH(check_soil(bekker(1e3, 1e6, n)), ContainsSubstring("exponent n of Bekker"));
  }
  CHECK_THROWS_WITH(check_soil(bekker(-1e3, 1e6, 1.0)), ContainsSubstring("k_c = -1000"));
  CHECK_THROWS_WITH(check_soil(bekker(1e3, -1e6, 1.0)), ContainsSubstring("must not be negative"));
  CHECK_THROWS_WITH(check_soil(bekker(0.0, 0.0, 1.0)), ContainsSubstring("not both zero"));
  CHECK_THROWS_WITH(check_soil(bekker(nan, 1e6, 1.0)), ContainsSubstring("nan"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) {
                      s.pressure = WongReece{1e5, 1.0, 0.0};
                    })),
                    ContainsSubstring("plate width"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) {
                      s.pressure = Reece{10.0, 0.0, 1.0, 0.0, 16e3};
                    })),
                    ContainsSubstring("zero for every plate"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) {
                      s.pressure = Reece{10.0, 50.0, 1.0, 500.0, 16e3};
                    })),
                    ContainsSubstring("a soil has one"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.shear.friction_angle = 35.0; })),
                    ContainsSubstring("radians(35) is 35 degrees"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.shear.friction_angle = -0.1; })), ContainsSubstring("-0.1 rad"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.shear.cohesion = -1.0; })), ContainsSubstring("cohesion"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.shear.displacement = 0.0; })), ContainsSubstring("K of the soil"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.a1 = 0.6; })), ContainsSubstring("a0 + a1 of the soil is 1.03"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.exit_angle = 0.2; })), ContainsSubstring("exit angle"));
  CHECK_THROWS_WITH(check_soil(with([](Soil& s) { s.exit_share = 1.2; })), ContainsSubstring("exit share"));
  CHECK_THROWS_WITH(check_soil(with([&](Soil& s) { s.unloading_stiffness = nan; })),
                    ContainsSubstring("unloading stiffness"));
}
