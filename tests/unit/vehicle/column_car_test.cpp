#include <dem/terramechanics/named_soils.hpp>
#include <dem/vehicle/column_car.hpp>
#include <dem/vehicle/humvee.hpp>

#include <cmath>

#include "catch.hpp"

using namespace dem;
using namespace dem::vehicle;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using terramechanics::known_soil;

namespace {

ColumnCarSpec car_on(const char* soil, double length) {
  return {.car = humvee({.rubber_rear = false}), .lane = {{known_soil(soil), length}}};
}

/// Means of the four wheels while the car is driven for so long (s), after the first half second.
struct MeanOfDrive {
  double sinkage = 0.0, pull = 0.0, torque = 0.0, way = 0.0;

  MeanOfDrive(ColumnCar& car, double seconds, double throttle) {
    const int rows = static_cast<int>(std::lround(seconds / ColumnCar::interval));
    double n = 0.0;
    for (int k = 0; k < rows; ++k) {
      car.advance({.throttle = throttle});
      if (k < 50) continue;
      n += 4.0;
      for (std::size_t c = 0; c < 4; ++c) {
        const WheelSample w = car.wheel(c);
        sinkage += w.sinkage, pull += w.pull, torque += w.torque;
      }
    }
    sinkage /= n, pull /= n, torque /= n;
    way = car.way();
  }
};

}  // namespace

TEST_CASE("a car is set down on soil columns with its weight on its wheels, as on hard ground") {
  ColumnCar car(car_on("dry-sand", 4.0));
  car.set_down();
  REQUIRE(car.failed.empty());
  double load = 0.0;
  for (std::size_t k = 0; k < 4; ++k) load += car.wheel(k).load;
  CHECK(load == Approx(car.weight).epsilon(0.01));  // it still swings a little
  // Columns are not mirror images of each other about the car: a row of them under a tyre more or less, 1 % of its
  // load.
  CHECK(car.wheel(0).load == Approx(car.wheel(1).load).epsilon(0.02));
  CHECK(car.wheel(0).load + car.wheel(1).load == Approx(25032.0).epsilon(0.02));  // moments of the weights
  CHECK(std::abs(car.speed()) < 0.01);
  // A wheel that is set down meets p = k z^n over its print: it sinks by less than twice what a plate of half its
  // diameter would, and by more than one of all of it.
  const auto curve = terramechanics::under(known_soil("dry-sand").soil.pressure, 0.254);
  CHECK(car.wheel(0).sinkage > curve.sinkage(12.5e3 / (0.254 * 0.97)));
  CHECK(car.wheel(0).sinkage < 2.0 * curve.sinkage(12.5e3 / (0.254 * 0.485)));
}

TEST_CASE("columns half as wide change a car's sinkage, torque and pull by less than 3 %", "[long]") {
  const auto driven = [](double spacing) {
    auto spec = car_on("dry-sand", 6.0);
    spec.spacing = spacing;
    ColumnCar car(spec);
    car.set_down();
    return MeanOfDrive(car, 2.0, 0.25);
  };
  const MeanOfDrive coarse = driven(0.05), fine = driven(0.025);
  CHECK(coarse.way > 0.1);  // a quarter of the throttle is about what the soil resists
  CHECK(coarse.sinkage == Approx(fine.sinkage).epsilon(0.03));
  CHECK(coarse.torque == Approx(fine.torque).epsilon(0.03));
  // Pull is the small difference of thrust and resistance: it is compared with the thrust.
  const double thrust = fine.torque / 0.485;
  CHECK(coarse.pull == Approx(fine.pull).margin(0.03 * thrust));
}

TEST_CASE("a car rolls from hard ground into soil, where it sinks; a sled that it is hitched to holds its speed") {
  auto spec = car_on("hard", 1.0);
  spec.lane.push_back({known_soil("dry-sand"), 5.0});
  ColumnCar car(spec);
  car.set_down();
  const double on_hard = car.wheel(0).sinkage;
  CHECK(on_hard < 0.02);  // 9 mm at rest, and what the set-down left
  car.hitch() = {.on = true, .speed = 1.0};
  while (car.failed.empty() && car.way() < 2.5) car.advance({.throttle = 0.1});
  REQUIRE(car.failed.empty());
  CHECK(car.speed() == Approx(1.0).margin(0.2));  // 2e5 N s/m: 20 kN change it by 0.1 m/s
  CHECK(car.wheel(0).sinkage > 4.0 * on_hard);
  CHECK(car.wheel(2).sinkage < 2.0 * on_hard);  // the rear wheels are not there yet
  CHECK(car.rut_depth(0, 4.7, 5.0) > 2.0 * on_hard);
}

TEST_CASE("a car on its brakes gives way on a side slope until the soil holds it, and its lower wheels carry more",
          "[long]") {
  auto spec = car_on("dry-sand", 4.0);
  spec.side_grade = 0.3;  // the left side is high; the soil's friction is 0.53
  ColumnCar car(spec);
  car.set_down();
  REQUIRE(car.failed.empty());
  CHECK(car.wheel(1).load > 1.2 * car.wheel(0).load);
  const double before = 0.5 * (car.middle_of(2).y() + car.middle_of(3).y());
  CHECK(before < -0.02);
  for (int k = 0; k < 100; ++k) car.advance({.brake = 1.0});
  // It swings on its springs by some 10 mm, and stands.
  CHECK(0.5 * (car.middle_of(2).y() + car.middle_of(3).y()) == Approx(before).margin(0.02));
}

TEST_CASE("a governor keeps the rims at a speed on soil without switching the engine on and off", "[long]") {
  ColumnCar car(car_on("dry-sand", 6.0));
  car.set_down();
  car.hitch() = {.on = true, .speed = 0.5};
  const Controls controls{.throttle = 1.0, .ease_from = 1.0, .ease_to = 1.4};
  double slowest = 1e9, fastest = 0.0, largest = 0.0, mean = 0.0;
  for (int k = 0; k < 200; ++k) {
    car.advance(controls);
    if (k < 100) continue;
    slowest = std::min(slowest, car.rim_speed()), fastest = std::max(fastest, car.rim_speed());
    const double torque = car.sample().engine_torque;
    largest = std::max(largest, torque), mean += 0.01 * torque;
  }
  REQUIRE(car.failed.empty());
  CHECK(slowest > 1.0);
  CHECK(fastest < 1.4);
  CHECK(largest < 1.3 * mean);  // a switch gives all of its torque for as much of the time as it takes
}

TEST_CASE("lanes that are none, unknown soils, and numbers that no car on columns can have are refused in words") {
  auto spec = car_on("dry-sand", 4.0);
  spec.half_width = 0.9;
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("1.8 m wide, but the car is 2.074 m wide"));
  spec.half_width = 1.6;
  spec.lane.push_back({known_soil("hard"), 0.0});
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("length of the stretch of hard is 0 m"));
  spec.lane.clear();
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("has no stretch"));
  spec = car_on("dry-sand", 4.0);
  for (const double step : {3e-4, 0.03, 0.0, -1e-4}) {
    spec.time_step = step;
    CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("fill 0.01 s evenly"));
  }
  spec.time_step = 5e-5;
  spec.set_down_speed = 0.0;
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("is set down on soil columns (m/s) is 0, but"));
  spec.set_down_speed = 0.5;
  spec.grade = std::nan("");
  CHECK_THROWS_WITH(ColumnCar(spec), ContainsSubstring("grade of a lane of soil columns (rise over run) is nan"));
  CHECK_THROWS_WITH(known_soil("mud"), ContainsSubstring("there is no soil 'mud'; these are known: dry-sand"));
}
