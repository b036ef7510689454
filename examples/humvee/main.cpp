// The Humvee of the thesis by itself on hard ground: at rest, driving off, braking, turning, held on a slope.
//
//   humvee                    # all scenes, results in the folder humvee
//   humvee brake out/brake    # one scene: rest, launch, brake, turn, turn_free or slope; the folder may also follow
//                             # --output. turn_free: the front axle is not driven
//   humvee tyres              # pneumatic tyres on a plate: load over deflection
//
// Each scene of the car writes <scene>.csv (100 rows a second, with units) and plots of speed, loads and wheel travel,
// and prints what was measured beside what was expected.

#include <dem/io/csv.hpp>

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "humvee.hpp"
#include "pictures.hpp"
#include "tyres.hpp"

namespace {

using namespace hard_ground;

struct Line {
  std::string what;
  double measured, expected;
  std::string unit;
};
using Lines = std::vector<Line>;

/// Lets the car come to rest on its brakes.
bool settle(Car& car, double seconds) {
  return car.drive(seconds, [](Car& c) {
    c.now = {.brake = 1.0};
    return true;
  });
}

/// Loads against the moments of the weights about the contacts, height against the springs' own answer in the test.
Lines rest(Car& car) {
  settle(car, 5.0);
  const auto& m = car.machine;
  double moment = 0.0;  // of the weights about the contacts of the rear wheels
  const double rear = 0.5 * (car.vehicle.wheels[2].tyre->contact.x() + car.vehicle.wheels[3].tyre->contact.x());
  const double front = 0.5 * (car.vehicle.wheels[0].tyre->contact.x() + car.vehicle.wheels[1].tyre->contact.x());
  for (const dem::Body& b : m.bodies()) moment += b.mass * 9.81 * (b.position().x() - rear);
  const double on_front = moment / (front - rear);
  return {{"load on the front axle", car.load(0), on_front, "N"},
          {"load on the rear axle", car.load(1), car.weight() - on_front, "N"},
          {"height of the chassis' origin", car.position().z(), 0.0, "m"},
          {"speed left", car.speed(), 0.0, "m/s"}};
}

/// Full throttle from rest to 60 km/h.
Lines launch(Car& car) {
  if (!settle(car, 3.0)) return {};
  const double goal = 60.0 / 3.6;
  const double start = car.machine.time(), from = car.position().x();
  double reached = 0.0, ran = 0.0;
  car.drive(40.0, [&](Car& c) {
    c.now = {.throttle = 1.0};
    reached = c.machine.time() - start;
    ran = c.position().x() - from;
    return c.speed() < goal;
  });
  // From the curve: the torque at the wheels moves the car and all that turns with it. Tyres slip, so the engine turns
  // faster than the car's way tells: by push/(kx L) of four tyres.
  const auto& v = car.vehicle;
  const auto& m = car.machine;
  double mass = 0.0, turning = 0.0;
  for (const dem::Body& b : m.bodies()) mass += b.mass;
  const double ratio = v.spec.driveline.front.ratio;
  double radius = v.spec.tyre.radius;
  for (const auto& w : v.wheels) radius -= 0.25 * w.tyre->deflection;
  turning += 4.0 * (v.spec.wheel.mass.inertia.y() + v.spec.driveline.front.half_shaft.inertia.y() +
                    v.spec.driveline.front.side_shaft.inertia.y());
  turning +=
      2.0 * (v.spec.driveline.front.cage.inertia.y() + ratio * ratio * v.spec.driveline.front.pinion.inertia.x());
  turning += ratio * ratio * v.spec.driveline.shaft.inertia.x();
  const double inertia = mass + turning / (radius * radius);
  const auto& e = v.driveline.spec;
  double time = 0.0, speed = 0.0, slip = 0.0;
  std::size_t gear = 0;
  const double dt = 1e-3, grip = 0.8 * mass * 9.81;
  while (speed < goal) {
    const double shaft = speed / (1.0 - slip) / radius * ratio;
    if (shaft * e.gears[gear] * e.transfer > e.shift_up && gear + 1 < e.gears.size()) ++gear;
    const double total = e.gears[gear] * e.transfer;
    const double push = std::min(grip, e.torque.held_outside()(shaft * total) * total * ratio / radius);
    slip = push / (4.0 * v.spec.tyre.tread_stiffness * v.spec.tyre.relaxation_length);
    speed += dt * push / inertia;
    time += dt;
  }
  return {{"0 to 60 km/h", reached, time, "s"}, {"way", ran, 0.0, "m"}};
}

/// All wheels locked at 60 km/h on a road of friction 0.5.
Lines brake(Car& car) {
  const auto hold = [](Car& c) {
    c.now = {};
    return true;
  };
  if (!car.drive(3.0, hold)) return {};
  double t0 = 0, x0 = 0, v0 = 0, t1 = 0, v1 = 0, x1 = 0;
  car.drive(10.0, [&](Car& c) {
    c.now = {.brake = 1.0};
    const double v = c.speed(), t = c.machine.time();
    if (t0 == 0.0 && v < 14.0) t0 = t, v0 = v, x0 = c.position().x();
    if (v > 1.0) t1 = t, v1 = v, x1 = c.position().x();
    return v > 0.0 && t < t1 + 2.0;
  });
  return {{"mean deceleration over time", (v0 - v1) / (t1 - t0), 0.5 * 9.81, "m/s^2"},
          {"mean deceleration over way", (v0 * v0 - v1 * v1) / (2.0 * (x1 - x0)), 0.5 * 9.81, "m/s^2"}};
}

/// Circles at a fixed steering: radius over lateral acceleration.
Lines turn(Car& car) {
  if (!settle(car, 2.0)) return {};
  dem::vehicle::SpeedHold hold{.gain = 0.3, .integral = 0.1};
  Lines lines;
  const double wheelbase = car.vehicle.spec.wheelbase();
  for (const double wanted : {2.0, 4.0, 6.0}) {
    double yaw = 0.0, sideways = 0.0, samples = 0.0, run = 0.0, steer = 0.0, front = 0.0, rear = 0.0;
    double pulls[2] = {};
    const double begin = car.machine.time();
    car.drive(10.0, [&](Car& c) {
      c.now = hold(c.speed(), wanted, 0.01);
      c.now.steer = 0.3;
      if (c.machine.time() > begin + 6.0) {
        const auto& b = c.machine.body(c.vehicle.chassis);
        // Speed of the middle of the rear axle, along the car.
        yaw += b.angular_velocity().z();
        run += c.speed();
        sideways += c.speed() * b.angular_velocity().z();
        // Ackermann: the cotangent of the middle is the mean of both.
        const double left = steer_of(c.machine, c.vehicle, 0), right = steer_of(c.machine, c.vehicle, 1);
        steer += 2.0 / (1.0 / std::tan(left) + 1.0 / std::tan(right));
        const auto& w = c.vehicle.wheels;
        front += 0.5 * (w[0].tyre->slip_angle + w[1].tyre->slip_angle);
        rear += 0.5 * (w[2].tyre->slip_angle + w[3].tyre->slip_angle);
        for (std::size_t axle : {0, 1}) pulls[axle] += w[2 * axle].tyre->pull + w[2 * axle + 1].tyre->pull;
        samples += 1.0;
      }
      return true;
    });
    const double radius = run / yaw, tangent = steer / samples;
    lines.push_back({fmt::format("radius at {:g} m/s ({:.2f} m/s^2 sideways)", wanted, sideways / samples), radius,
                     wheelbase / tangent, "m"});
    // The paths of the axles' middles lead round a centre: the same radius, if the tyres' slip angles explain it.
    front /= samples, rear /= samples;
    lines.push_back({"  the same from the paths of the axles, by their slip angles", radius,
                     wheelbase / (std::tan(std::atan(tangent) + front) - std::tan(rear)), "m"});
    lines.push_back({"  slip angle of the front axle, to the left", front * 180.0 / std::numbers::pi, 0.0, "deg"});
    lines.push_back({"  slip angle of the rear axle", rear * 180.0 / std::numbers::pi, 0.0, "deg"});
    lines.push_back({"  pull of the front tyres", pulls[0] / samples, 0.0, "N"});
    lines.push_back({"  pull of the rear tyres", pulls[1] / samples, 0.0, "N"});
  }
  return lines;
}

/// Brakes on a slope of 30 % for a minute.
Lines slope(Car& car) {
  if (!settle(car, 5.0)) return {};
  const double from = car.position().x();
  settle(car, 55.0);
  return {{"way in 55 s", car.position().x() - from, 0.0, "m"},
          {"load on the front axle", car.load(0), 0.0, "N"},
          {"load on the rear axle", car.load(1), 0.0, "N"}};
}

struct Scene {
  const char* name;
  Setup setup;
  Lines (*run)(Car&);
};

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words;
  for (int k = 1; k < argc; ++k) {
    if (std::string(argv[k]) != "--output") words.emplace_back(argv[k]);
  }
  const std::string wanted = !words.empty() ? words[0] : "all", folder = words.size() > 1 ? words[1] : "humvee";
  const std::vector<Scene> scenes = {{"rest", {}, rest},
                                     {"launch", {}, launch},
                                     {"brake", {.speed = 60.0 / 3.6, .friction = 0.5}, brake},
                                     {"turn", {}, turn},
                                     {"turn_free", {.free_front = true}, turn},
                                     {"slope", {.slope = 0.3}, slope}};
  bool found = wanted == "all" || wanted == "tyres";
  try {
    if (found) press_tyres(folder);
    for (const Scene& scene : scenes) {
      if (wanted != "all" && wanted != scene.name) continue;
      found = true;
      Car car(scene.setup);
      const auto clock = std::chrono::steady_clock::now();
      const std::clock_t cpu = std::clock();
      const Lines lines = scene.run(car);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
      const double computed = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
      if (!car.failed.empty()) fmt::print(stderr, "{}: {}\n", scene.name, car.failed);
      fmt::print("\n{}\n", scene.name);
      for (const Line& l : lines) {
        fmt::print("  {:<46} {:12.5f}", l.what, l.measured);
        if (l.expected != 0.0) {
          fmt::print("  expected {:12.5f}  {:+.3f} %", l.expected, 100.0 * (l.measured / l.expected - 1.0));
        }
        fmt::print(" {}\n", l.unit);
      }
      const EnergyBalance& e = car.energy;
      fmt::print(
          "  energy, J: gained {:.1f}; engine {:.1f}, brakes {:.1f}, tyres {:.1f}, springs and shocks {:.1f}, "
          "steering {:.1f}; left over {:.1f}, {:.3f} % of {:.0f}\n",
          e.gained, e.engine, e.brakes, e.tyres, e.springs, e.steering, e.left_over(), 100.0 * e.error(), e.throughput);
      fmt::print("  widest joint {:.3f} mm ({}), most crooked {:.3f} mrad\n", 1e3 * car.widest, car.widest_joint,
                 1e3 * car.crooked);
      fmt::print("  {:.2f} s driven in {:.2f} s of computing on one core (clock {:.2f} s): {:.2f} of real time\n",
                 car.machine.time(), computed, seconds, computed / car.machine.time());
      dem::io::CsvWriter csv(folder + "/" + scene.name + ".csv", car.columns);
      for (const auto& row : car.rows) csv.row(row);
      draw(car, folder, scene.name);
      if (!car.failed.empty()) return 1;
    }
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  if (!found) {
    fmt::print(stderr, "there is no scene '{}': all, tyres, rest, launch, brake, turn, turn_free or slope\n", wanted);
    return 2;
  }
  fmt::print("\nresults in {}\n", folder);
}
