#pragma once

#include <dem/vehicle/vehicle.hpp>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace dem::vehicle {

/// Options of the Humvee of the thesis, chapter 6.
struct HumveeOptions {
  double sprung_mass = 4430.0;  ///< kg, with ballast; the bare vehicle has 2086.52 kg and what hangs on its chassis
  bool rubber_rear = true;      ///< rear ball joints of rubber, as Table 6.2 counts them; else spherical joints
  EngineSpec::Kind engine = EngineSpec::Kind::motor;
  bool low_range = false;  ///< of the transfer case, with gears
};

/// Names of engines, for command lines.
inline std::vector<std::string> engine_names() { return {"motor", "gears", "low-range", "actuator"}; }
inline constexpr const char* engine_words =
    "motor (no gears), gears (a diesel with six), low-range (the same), actuator (holds a speed, as in the thesis)";

/// The options with an engine of that name. Throws Error for a name that is none.
DEM_SETUP inline HumveeOptions with_engine(HumveeOptions o, const std::string& name) {
  const auto names = engine_names();
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    fail("there is no engine '{}'; give motor, gears, low-range or actuator", name);
  }
  using Kind = EngineSpec::Kind;
  o.engine = name == "actuator" ? Kind::actuator : name == "motor" ? Kind::motor : Kind::geared;
  o.low_range = name == "low-range";
  return o;
}

/// The Humvee of the thesis with the points, masses, springs and shocks of the public HMMWV data of Project Chrono
/// (from TACOM TR-13337). 34 bodies; 3 prismatic, 16 revolute, 6 spherical and 4 constant-velocity joints; 5 rotational
/// actuators (Table 6.2). These alone would leave 75 degrees of freedom. What holds the rest, and is not in the table:
/// 4 bushings (rear ball joints), 2 distance joints (rear toe links), 2 universal joints (tie rods on the rack), 4
/// universal joints (half shafts), 6 sleeves (differentials), 5 gears.
///
/// Not in any source and chosen here: masses of the shafts, tyre constants, the curve of the engine beyond its peak
/// torque. Ballast scales mass and inertia of the chassis alike, about the same centre. A spindle is part of its
/// knuckle. The origin is the middle between the axles. Throws Error for a sprung mass below that of the parts on the
/// chassis.
DEM_SETUP inline VehicleSpec humvee(const HumveeOptions& o = {}) {
  VehicleSpec s;
  const double axle = 1.688965;
  const WishbonePoints front = {.wheel = Vec3(-.040, .910, -.026),
                                .knuckle = Vec3(-.040, .751, -.026),
                                .upper_front = Vec3(-.048, .446, .245),
                                .upper_back = Vec3(-.268, .478, .196),
                                .upper_ball = Vec3(-.053, .716, .215),
                                .lower_front = Vec3(.223, .307, 0),
                                .lower_back = Vec3(-.223, .307, 0),
                                .lower_ball = Vec3(-.036, .787, -.118),
                                .rod_inner = Vec3(-.250, .448, .054),
                                .rod_outer = Vec3(-.176, .821, -.016),
                                .spring_chassis = Vec3(.104, .510, .197),
                                .spring_arm = Vec3(.097, .543, -.047),
                                .shock_chassis = Vec3(.104, .498, .323),
                                .shock_arm = Vec3(.097, .543, -.047)};
  const WishbonePoints rear = {.wheel = Vec3(.036, .910, -.026),
                               .knuckle = Vec3(.036, .751, -.026),
                               .upper_front = Vec3(.349, .462, .228),
                               .upper_back = Vec3(.077, .462, .224),
                               .upper_ball = Vec3(.036, .716, .216),
                               .lower_front = Vec3(.223, .307, 0),
                               .lower_back = Vec3(-.223, .307, 0),
                               .lower_ball = Vec3(-.036, .787, -.118),
                               .rod_inner = Vec3(.223, .416, .059),
                               .rod_outer = Vec3(.170, .821, -.009),
                               .spring_chassis = Vec3(-.104, .502, .256),
                               .spring_arm = Vec3(-.097, .543, -.047),
                               .shock_chassis = Vec3(-.104, .498, .323),
                               .shock_arm = Vec3(-.097, .544, -.038)};
  // A spring that is longer than its free length has lost its seat and does not pull.
  const auto spring = [](std::vector<std::pair<double, double>> table) {
    std::vector<std::pair<double, double>> points = {{-1.0, 0.0}, {0.0, 0.0}};
    points.insert(points.end(), table.begin(), table.end());
    return mbd::Curve(std::move(points));
  };
  s.front.points = front.shifted({axle, 0, 0});
  s.rear.points = rear.shifted({-axle, 0, 0});
  for (DoubleWishboneSpec* w : {&s.front, &s.rear}) {
    // The source says 0.06276 and 0.8938 about z, more than any body of these other moments has.
    w->upper_arm = {5.813, Vec3(0.03, 0.03, 0.06)};
    w->lower_arm = {23.965, Vec3(0.4, 0.4, 0.8)};
    // Upright and spindle, 0.159 m apart along y, about the place of the upright; the offset is in neither source.
    w->knuckle = {19.450 + 14.705, Vec3(0.1656 + 0.04117, 0.1934 + 0.07352, 0.04367 + 0.04117)};
  }
  s.front.spring_free_length = 0.339;
  s.front.spring_force = spring({{.02, 3630}, {.04, 8992}, {.06, 17818}, {.08, 31841}, {.10, 52792}, {.12, 82403}});
  s.front.shock = 19015.6;
  s.rear.spring_free_length = 0.382;
  s.rear.spring_force = spring({{.02, 8021}, {.04, 19869}, {.06, 39372}, {.08, 70357}, {.10, 116651}, {.12, 182082}});
  s.rear.shock = 36725.2;
  s.rear.upper_ball.is_rubber = s.rear.lower_ball.is_rubber = o.rubber_rear;

  const double wheel = 50.0, of_chrono = 18.8 + 37.6;  // kg: the inertia of rim and tyre, scaled with the mass
  s.wheel.mass = {wheel, (wheel / of_chrono) * Vec3(3.84, 6.69, 3.84)};
  s.wheel.brake = 4000.0;

  s.steering.rod_inner = s.front.points.rod_inner;
  s.steering.rod_outer = s.front.points.rod_outer;
  s.steering.rack = round_part(9.072, 0.025, 0.896, 1);
  s.steering.pinion = round_part(2.0, 0.1, 0.04, 0);
  s.steering.rod = {6.0, Vec3(0.5, 0.05, 0.5)};  // 0.05 about the rod
  s.steering.pinion_radius = 0.1;

  DrivelineSpec& d = s.driveline;
  for (AxleSpec* a : {&d.front, &d.rear}) {
    a->pinion = round_part(6.0, 0.05, 0.2, 0);
    a->cage = round_part(25.0, 0.1, 0.2, 1);
    a->side_shaft = round_part(5.0, 0.05, 0.25, 1);
    a->half_shaft = round_part(8.0, 0.03, 0.5, 1);
    a->ratio = 5.0;
  }
  d.front.middle = Vec3(s.front.points.wheel.x(), 0, s.front.points.wheel.z());
  d.rear.middle = Vec3(s.rear.points.wheel.x(), 0, s.rear.points.wheel.z());
  d.front.outer = s.front.points.knuckle;
  d.rear.outer = s.rear.points.knuckle;
  // Both pinions lie between the axles.
  d.front.pinion_ahead = -0.12;
  d.rear.pinion_ahead = 0.12;
  d.shaft = round_part(20.0, 0.05, 3.0, 0);
  d.shaft_middle = Vec3(0, 0, s.front.points.wheel.z());
  d.engine.kind = o.engine;
  if (o.engine == EngineSpec::Kind::geared) {
    // N m over rpm at full throttle, ratios and speeds of shifting of Project Chrono's HMMWV_EngineSimpleMap.json and
    // HMMWV_AutomaticTransmissionSimpleMap.json, the rotor's moment of HMMWV_EngineShafts.cpp. Beyond 2,500 rpm the
    // torque falls to nothing. Chosen here: a dry clutch in place of a converter, the rotor's mass, and the time from
    // shift to shift.
    const std::pair<double, double> map[] = {{0, 309},    {800, 382},  {900, 490},  {1000, 579}, {1100, 650},
                                             {1200, 706}, {1300, 746}, {1400, 774}, {1500, 789}, {1600, 793},
                                             {1700, 788}, {1800, 774}, {1900, 754}, {2000, 728}, {2100, 697},
                                             {2200, 664}, {2300, 628}, {2400, 593}, {2500, 558}, {2617, 0}};
    constexpr double rpm = std::numbers::pi / 30.0;  // rad/s
    std::vector<std::pair<double, double>> torque;
    for (const auto& [speed, of_shaft] : map) torque.emplace_back(speed * rpm, of_shaft);
    d.engine.torque = mbd::Curve(std::move(torque));
    d.engine.drag = {{0, 0}, {100 * rpm, 0}, {1000 * rpm, -50}, {2000 * rpm, -70}, {3000 * rpm, -90}};
    d.engine.rotor = {80.0, Vec3(1.1, 4.0, 4.0)};
    d.engine.idle = 800.0 * rpm;
    d.engine.clutch_speed = 1500.0 * rpm;
    d.engine.clutch_torque = 1000.0;
    for (const double ratio : {0.1708, 0.2791, 0.4218, 0.6223, 1.0173, 1.5361}) d.engine.gears.push_back(1.0 / ratio);
    // Low range of the vehicle's transfer case, New Process Gear 242, which locks front and rear as one shaft does
    // here.
    d.engine.transfer = o.low_range ? 2.72 : 1.0;
    d.engine.shift_up = 2225.0 * rpm;
    d.engine.shift_down = 1000.0 * rpm;
    d.engine.shift_wait = 0.3;
  } else {
    // Peak torque at rest, falling to nothing at 1600 rad/s, behind a fixed gear.
    d.engine.torque = {{0, 793}, {1600, 0}};
    d.engine.gears = {1.0 / 0.3};
  }
  d.engine.largest_torque = 793.0 / 0.3;
  d.engine.speed_gain = 200.0;  // N m s/rad; 500 ask for steps of 3e-5 s

  const double rotor = o.engine == EngineSpec::Kind::geared ? d.engine.rotor.mass : 0.0;
  const double on_chassis = rotor + s.steering.rack.mass + s.steering.pinion.mass + d.shaft.mass +
                            2.0 * (d.front.pinion.mass + d.front.cage.mass + 2.0 * d.front.side_shaft.mass);
  if (!(o.sprung_mass > on_chassis)) {
    fail("the sprung mass is {:g} kg, but must exceed {:g} kg, that of the shafts and the steering on the chassis",
         o.sprung_mass, on_chassis);
  }
  const double bare = 2086.52, mass = o.sprung_mass - on_chassis;
  s.chassis = {mass, (mass / bare) * Vec3(1078.52, 2955.66, 3570.20)};
  s.chassis_centre = Vec3(0.056, 0, 0.213);
  return s;
}

}  // namespace dem::vehicle
