#include <dem/terramechanics/named_soils.hpp>
#include <dem/vehicle/column_car.hpp>
#include <dem/vehicle/humvee.hpp>
#include <dem/vehicle/ring_tyre.hpp>
#include <dem/vehicle/tyre_press.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"

using namespace dem;
using namespace dem::vehicle;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("an inflated ring keeps its radius: air and tension are in balance") {
  RingTyreSpec s;
  s.pressure = 2.5e5;
  TyrePress press(s);
  for (int k = 0; k < 20; ++k) press.step();
  const mbd::Mechanism& m = press.machine();
  // The free length of the belt is such that air and tension are in balance.
  for (const BodyId b : press.tyre().segments)
    CHECK((m.body(b).position() - m.body(press.tyre().rim).position()).norm() == Approx(0.475).margin(1e-4));
  // A segment's middle lies higher than the circle by no more than 0.475 (1 - cos(pi/48)) = 1.0 mm.
  CHECK(deflection_of(m, press.tyre()) == Approx(0.0).margin(1.1e-3));
}

TEST_CASE("a ring tyre is as stiff as Rhyne's formula says, and presses about as hard as its air") {
  for (const double pressure : {1.0e5, 1.7e5, 2.5e5}) {
    CAPTURE(pressure);
    RingTyreSpec s;
    s.pressure = pressure;
    const double d = 0.0325;
    const auto [f, length] = TyrePress(s).at(d);
    // The sidewalls' two constants were chosen for 1 and 2.5 bar. The formula has one stiffness for all deflections,
    // the ring gets stiffer by a sixth from 10 to 33 mm: half of that is allowed.
    CHECK(f / d == Approx(rhyne_stiffness(pressure, s.width, s.radius, s.rim_radius)).epsilon(0.08));
    // Of a flat strip as long as the chord that the deflection cuts off: less, as the belt leaves the plate's edge
    // slowly; the sidewalls carry the rest.
    const double chord = 2.0 * std::sqrt(2.0 * s.radius * d);
    CHECK(length > 0.4 * chord);
    CHECK(length < chord);
    const double on_patch = f / (length * s.width);
    CHECK(on_patch > 0.7 * pressure);
    CHECK(on_patch < 1.3 * pressure);
  }
}

TEST_CASE("Rhyne's formula gives 35 kg/mm for a tyre of 317 mm on a rim of 419 mm at 250 kPa") {
  // 0.00028 * 250 * sqrt((1.03 - 0.004 * 82) * 317 * (317 * 82 / 50 + 419)) + 3.45, aspect ratio 260/317 = 82 %.
  CHECK(rhyne_stiffness(2.5e5, 0.317, 0.2095 + 0.82 * 0.317, 0.2095) == Approx(9810.0 * 35.4).epsilon(0.005));
}

TEST_CASE("a car on ring tyres stands with its weight on them, and sinks less than on rigid ones", "[long]") {
  ColumnCarSpec spec{.car = humvee({.rubber_rear = false}), .lane = {{terramechanics::known_soil("dry-sand"), 2.0}}};
  ColumnCar rigid(spec);
  rigid.set_down();
  spec.ring = RingTyreSpec{.pressure = 5e4};
  ColumnCar car(spec);
  car.set_down();
  REQUIRE(car.failed.empty());
  double load = 0.0;
  for (std::size_t k = 0; k < 4; ++k) load += car.wheel(k).load;
  CHECK(car.weight == Approx(rigid.weight).epsilon(1e-9));
  // Belt and rim turn like the wheel that they are made from.
  const double whole = spec.car.wheel.mass.inertia.y(), belt = 20.0 * 0.475 * 0.475;
  CHECK(car.spec().car.wheel.mass.inertia.y() + belt == Approx(whole).epsilon(1e-9));
  CHECK(load == Approx(car.weight).epsilon(0.05));  // it swings longer than on rigid tyres
  // The rut is what the belt pressed, without the tyre's deflection. Under the rigid wheels the soil carries some 107
  // kPa in the middle of the print; the ring presses with its air and some of its carcass.
  const double at = car.middle_of(0).x();
  const double rut = car.rut_depth(0, at - 0.05, at + 0.05);
  CHECK(rut < 0.9 * rigid.rut_depth(0, at - 0.05, at + 0.05));
  // A ring is deeper than its rut by as much as a rigid tyre is, some millimetres: its sinkage is that of the tread.
  // Told by the undeformed wheel it would be deeper by the deflection, 88 mm.
  const double deeper = rigid.wheel(0).sinkage - rigid.rut_depth(0, at - 0.05, at + 0.05);
  CHECK(car.wheel(0).sinkage - rut == Approx(deeper).margin(5e-3));
  CHECK(car.wheel(0).deflection > 0.04);
  CHECK(rigid.wheel(0).deflection == 0.0);
}

TEST_CASE("ring tyres that cannot be are refused in words") {
  RingTyreSpec s;
  s.pressure = 3e6;
  CHECK_THROWS_WITH(check_ring_tyre(s), ContainsSubstring("would stretch the belt"));
  s.pressure = 2.0;  // bar
  CHECK_THROWS_WITH(check_ring_tyre(s), ContainsSubstring("is 2 Pa, but must be 0 or lie between 1e3 and 2e6"));
  s.pressure = 3e6;
  s.belt_stiffness = 1e8;
  CHECK_THROWS_WITH(check_ring_tyre(s), ContainsSubstring("is 3e+06 Pa, but must be 0 or lie between 1e3 and 2e6"));
  for (const double pressure : {0.0, 1e3, 2e6}) {
    s.pressure = pressure;
    CHECK_NOTHROW(check_ring_tyre(s));
  }
  s = {};
  s.rim_radius = 0.5;
  CHECK_THROWS_WITH(check_ring_tyre(s), ContainsSubstring("rim of a ring tyre has a radius of 0.5 m"));
  s = {};
  s.segments = 3;
  CHECK_THROWS_WITH(check_ring_tyre(s), ContainsSubstring("segments of a ring tyre"));
  ColumnCarSpec spec{.car = humvee(), .lane = {{terramechanics::known_soil("dry-sand"), 2.0}}};
  spec.ring = RingTyreSpec{.mass = 45.0};
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("weighs 45 kg"));
  spec.ring = RingTyreSpec{.segments = 200};
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("too long for the ring tyres"));
}
