// The Humvee of the thesis by itself on hard ground: at rest, driving off, braking, turning, held on a slope.
//
//   humvee                    # all scenes, results in the folder humvee
//   humvee brake out/brake    # one scene; the folder may also follow --output, with a scene or without
//   humvee tyres              # pneumatic tyres on a plate: load over deflection
//
// Scenes: rest; launch (0 to 60 km/h), launch_gears (with the diesel and its gears), launch_actuator (with the single
// actuator of the thesis); brake; turn (a tight circle); understeer (a wide one, ever faster); turn_free and
// understeer_free (the front axle is not driven); slope (30 %, on the brakes); bumps (a road of heights).
//
// Each scene of the car writes <scene>.csv (100 rows a second, with units) and plots of speed, loads and wheel travel,
// and prints what was measured beside what was expected.

#include <dem/io/csv.hpp>
#include <dem/rig/launcher.hpp>

#include <fmt/format.h>

#include <array>
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
  const double rear = 0.5 * (car.tyre(2).contact.x() + car.tyre(3).contact.x());
  const double front = 0.5 * (car.tyre(0).contact.x() + car.tyre(1).contact.x());
  for (const dem::Body& b : m.bodies()) moment += b.mass * 9.81 * (b.position().x() - rear);
  const double on_front = moment / (front - rear);
  return {{"load on the front axle", car.load(0), on_front, "N"},
          {"load on the rear axle", car.load(1), car.weight() - on_front, "N"},
          {"height of the chassis' origin", car.position().z(), 0.0, "m"},
          {"speed left", car.speed(), 0.0, "m/s"}};
}

/// An engine at full throttle on a bench: its curve, and with gears its rotor, clutch and shifts.
struct EngineOnBench {
  const dem::vehicle::EngineSpec& e;
  std::size_t gear = 0;
  double since_shift = 1e3, rotor = e.idle;  ///< s; rad/s

  /// N m, at a speed of the shaft (rad/s), dt (s) after the last call.
  double at_shaft(double shaft, double dt) {
    using Kind = dem::vehicle::EngineSpec::Kind;
    if (e.kind == Kind::actuator) return e.largest_torque;
    if (e.kind == Kind::motor) return e.torque.held_outside()(shaft * e.ratio(0)) * e.ratio(0);
    since_shift += dt;
    if (shaft * e.ratio(gear) > e.shift_up && since_shift > e.shift_wait && gear + 1 < e.gears.size()) {
      ++gear, since_shift = 0.0;
    }
    // The clutch, as a damper that holds no more than it can.
    const double input = shaft * e.ratio(gear), closed = (rotor - e.idle) / (e.clutch_speed - e.idle);
    const double most = e.clutch_torque * std::clamp(closed, 0.0, 1.0);
    const double passed = std::clamp(100.0 * (rotor - input), -most, most);
    rotor += dt * (e.torque.held_outside()(rotor) - passed) / e.rotor.inertia.x();
    return passed * e.ratio(gear);
  }
};

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
  for (std::size_t k = 0; k < 4; ++k) radius -= 0.25 * car.tyre(k).deflection;
  turning += 4.0 * (v.spec.wheel.mass.inertia.y() + v.spec.driveline.front.half_shaft.inertia.y() +
                    v.spec.driveline.front.side_shaft.inertia.y());
  turning +=
      2.0 * (v.spec.driveline.front.cage.inertia.y() + ratio * ratio * v.spec.driveline.front.pinion.inertia.x());
  turning += ratio * ratio * v.spec.driveline.shaft.inertia.x();
  const double inertia = mass + turning / (radius * radius);
  const auto& e = v.driveline.engine.spec;
  const double grip = 0.8 * mass * 9.81;
  EngineOnBench bench{e, {}};
  double time = 0.0, speed = 0.0, slip = 0.0;
  for (const double dt = 1e-4; speed < goal; time += dt) {
    const double torque = bench.at_shaft(speed / (1.0 - slip) / radius * ratio, dt);
    const double push = std::min(grip, torque * ratio / radius);
    const double length = v.spec.tyre.relaxation_length, steady = push / (4.0 * v.spec.tyre.tread_stiffness * length);
    slip += std::min(1.0, dt * std::max(0.5, speed) / length) * (steady - slip);
    speed += dt * push / inertia;
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
        front += 0.5 * (c.tyre(0).slip_angle + c.tyre(1).slip_angle);
        rear += 0.5 * (c.tyre(2).slip_angle + c.tyre(3).slip_angle);
        for (std::size_t axle : {0U, 1U}) pulls[axle] += c.tyre(2 * axle).pull + c.tyre(2 * axle + 1).pull;
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

/// A wide circle at ever higher speeds: by how much more the wheels must be turned than by Ackermann, over the
/// acceleration to the side.
Lines understeer(Car& car) {
  if (!settle(car, 5.0)) return {};
  dem::vehicle::SpeedHold hold{.gain = 0.3, .integral = 0.1};
  Lines lines;
  const double wheelbase = car.vehicle.spec.wheelbase(), on_front = car.load(0), on_rear = car.load(1);
  double n = 0.0, sa = 0.0, sd = 0.0, ss = 0.0, sr = 0.0, saa = 0.0, sad = 0.0, sas = 0.0, sar = 0.0;
  for (const double wanted : {4.0, 7.0, 9.0, 11.0, 12.5}) {
    double yaw = 0.0, run = 0.0, steer = 0.0, behind = 0.0, drift = 0.0, samples = 0.0;
    const double begin = car.machine.time();
    car.drive(12.0, [&](Car& c) {
      c.now = hold(c.speed(), wanted, 0.01);
      c.now.steer = 0.08;
      if (c.machine.time() > begin + 8.0) {
        yaw += c.machine.body(c.vehicle.chassis).angular_velocity().z();
        run += c.speed();
        const double left = steer_of(c.machine, c.vehicle, 0), right = steer_of(c.machine, c.vehicle, 1);
        steer += std::atan(2.0 / (1.0 / std::tan(left) + 1.0 / std::tan(right)));
        behind += 0.5 * (steer_of(c.machine, c.vehicle, 2) + steer_of(c.machine, c.vehicle, 3));
        drift += 0.5 * (c.tyre(2).slip_angle + c.tyre(3).slip_angle - c.tyre(0).slip_angle - c.tyre(1).slip_angle);
        samples += 1.0;
      }
      return true;
    });
    const double radius = run / yaw, sideways = run * yaw / (samples * samples);
    const double more = steer / samples - std::atan(wheelbase / radius);
    drift /= samples, behind /= samples;
    lines.push_back({fmt::format("radius at {:g} m/s ({:.2f} m/s^2 sideways)", wanted, sideways), radius,
                     wheelbase / std::tan(steer / samples), "m"});
    lines.push_back({"  steered beyond Ackermann; by tyres and roll", 1e3 * more, 1e3 * (drift + behind), "mrad"});
    n += 1.0, sa += sideways, sd += more, ss += drift, sr += behind, saa += sideways * sideways;
    sad += sideways * more, sas += sideways * drift, sar += sideways * behind;
  }
  // A linear bicycle: m (b/L/Cf - a/L/Cr), as the axles' loads over g are those masses.
  const auto& tyre = car.vehicle.spec.tyre;
  const double stiffness = 2.0 * tyre.lateral_stiffness * tyre.relaxation_length;
  const double linear = (on_front - on_rear) / (9.81 * stiffness), below = n * saa - sa * sa;
  lines.push_back({"understeer gradient", 1e3 * (n * sad - sa * sd) / below, 0.0, "mrad/(m/s^2)"});
  lines.push_back(
      {"  of it by the slip angles of the tyres", 1e3 * (n * sas - sa * ss) / below, 1e3 * linear, "mrad/(m/s^2)"});
  lines.push_back(
      {"  of it by rear wheels that turn as the car rolls", 1e3 * (n * sar - sa * sr) / below, 0.0, "mrad/(m/s^2)"});
  return lines;
}

/// Brakes on a slope of 30 % for a minute.
Lines slope(Car& car) {
  if (!settle(car, 5.0)) return {};
  const double from = car.position().x();
  settle(car, 10.0);
  const double later = car.position().x();
  settle(car, 50.0);
  return {{"way in 60 s", car.position().x() - from, 0.0, "m"},
          {"of it in the last 50 s", car.position().x() - later, 0.0, "m"},
          {"speed left", car.speed(), 0.0, "m/s"},
          {"load on the front axle", car.load(0), 0.0, "N"},
          {"load on the rear axle", car.load(1), 0.0, "N"}};
}

/// Half a sine of 0.1 m over 1.5 m, across both tracks at 6 m and under the left wheels only at 14 m.
double bump(double x, double y) {
  const auto half_sine = [&](double from) {
    const double at = (x - from) / 1.5;
    return at > 0.0 && at < 1.0 ? 0.1 * std::sin(std::numbers::pi * at) : 0.0;
  };
  return half_sine(6.0) + (y > 0.0 ? half_sine(14.0) : 0.0);
}
std::shared_ptr<const dem::vehicle::RoadHeights> bumpy_road() {
  return std::make_shared<dem::vehicle::RoadHeights>(dem::vehicle::RoadHeights::of(-5.0, -2.0, 40.0, 4.0, 0.05, bump));
}

/// Over two bumps at 3 m/s.
Lines bumps(Car& car) {
  if (!settle(car, 3.0)) return {};
  dem::vehicle::SpeedHold hold{.gain = 0.3, .integral = 0.1};
  const auto& m = car.machine;
  const auto lift = [&] {  // kg m/s, upward
    double sum = 0.0;
    for (const dem::Body& b : m.bodies()) sum += b.mass * b.velocity().z();
    return sum;
  };
  double pushed = 0.0, roll = 0.0, highest = 0.0, lowest = 0.0;
  std::array<double, 4> at_rest;
  for (std::size_t k = 0; k < 4; ++k) at_rest[k] = travel_of(m, car.vehicle, k);
  const double began = m.time(), before = lift();
  car.each_step = [&](double dt) {
    for (const auto& w : car.vehicle.wheels) pushed += dt * m.load(w.road).wrench.force.z;
  };
  car.drive(11.0, [&](Car& c) {
    c.now = hold(c.speed(), 3.0, 0.01);
    roll = std::max(roll, std::abs(attitude_of(m, c.vehicle).x()));
    for (std::size_t k = 0; k < 4; ++k) {
      const double travel = travel_of(m, c.vehicle, k) - at_rest[k];
      highest = std::max(highest, travel), lowest = std::min(lowest, travel);
    }
    return true;
  });
  const double time = m.time() - began;
  return {{"mean of what the road carries", (pushed - lift() + before) / time, car.weight(), "N"},
          {"way", car.position().x(), 0.0, "m"},
          {"largest roll", roll * 180.0 / std::numbers::pi, 0.0, "deg"},
          {"wheel travel from rest, up", highest, 0.0, "m"},
          {"wheel travel from rest, down", lowest, 0.0, "m"}};
}

struct Scene {
  const char* name;
  Setup setup;
  Lines (*run)(Car&);
};

/// What the command line asks for.
struct Request {
  std::string scene = "all", folder = "humvee_output";
};

/// A scene and a folder, or the folder after --output. Throws Error for other options and further words.
Request request_of(const std::vector<std::string>& words) {
  Request r;
  bool has_scene = false, has_folder = false;
  const auto take_folder = [&](const std::string& folder) {
    if (has_folder) dem::fail("'{}' is a second folder; give one, as a second word or after --output", folder);
    r.folder = folder, has_folder = true;
  };
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == "--output") {
      if (k + 1 == words.size()) dem::fail("--output has no folder; give one, as --output humvee_output");
      take_folder(words[++k]);
    } else if (words[k] == "--help") {
      return {.scene = words[k]};
    } else if (words[k].starts_with("-")) {
      dem::fail("there is no option '{}'; give a scene, and --output with a folder", words[k]);
    } else if (!has_scene) {
      r.scene = words[k], has_scene = true;
    } else {
      take_folder(words[k]);
    }
  }
  return r;
}

}  // namespace

int main(int argc, char** argv) {
  if (!dem::rig::may_run("humvee", argv[0])) return 1;
  Request request;
  try {
    request = request_of({argv + 1, argv + argc});
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
  const std::string &wanted = request.scene, &folder = request.folder;
  using Kind = dem::vehicle::EngineSpec::Kind;
  const std::vector<Scene> scenes = {
      {"rest", {}, rest},
      {"launch", {}, launch},
      {"launch_gears", {.options = {.rubber_rear = false, .engine = Kind::geared}}, launch},
      {"launch_actuator", {.options = {.rubber_rear = false, .engine = Kind::actuator}}, launch},
      {"brake", {.speed = 60.0 / 3.6, .friction = 0.5}, brake},
      {"turn", {}, turn},
      {"turn_free", {.free_front = true}, turn},
      {"understeer", {}, understeer},
      {"understeer_free", {.free_front = true}, understeer},
      {"slope", {.slope = 0.3}, slope},
      {"bumps", {.heights = bumpy_road()}, bumps}};
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
        fmt::print("  {:<50} {:12.5f}", l.what, l.measured);
        if (l.expected != 0.0) {
          fmt::print("  expected {:12.5f}  {:+.3f} %", l.expected, 100.0 * (l.measured / l.expected - 1.0));
        }
        fmt::print(" {}\n", l.unit);
      }
      const EnergyBalance& e = car.energy;
      fmt::print(
          "  energy, J: gained {:.1f}; engine {:.1f}, brakes {:.1f}, tyres {:.1f}, springs and shocks {:.1f}, "
          "steering {:.1f}, clutch {:.1f}; left over {:.1f}, {:.3f} % of {:.0f}\n",
          e.gained, e.engine, e.brakes, e.tyres, e.springs, e.steering, e.clutch, e.left_over(), 100.0 * e.error(),
          e.throughput);
      fmt::print("  widest joint {:.3f} mm ({}), most crooked {:.3f} mrad ({}); {} {:g} mm and {:g} mrad\n",
                 1e3 * car.widest, car.widest_joint, 1e3 * car.crooked, car.crooked_joint,
                 car.is_closed() ? "within" : "BEYOND", 1e3 * Car::widest_allowed, 1e3 * Car::crooked_allowed);
      fmt::print("  {:.2f} s driven in {:.2f} s of computing on one core (clock {:.2f} s): {:.2f} of real time\n",
                 car.machine.time(), computed, seconds, computed / car.machine.time());
      dem::io::CsvWriter csv(folder + "/" + scene.name + ".csv", car.columns);
      for (const auto& row : car.rows) csv.row(row);
      csv.flush();
      draw(car, folder, scene.name);
      if (!car.failed.empty() || !car.is_closed()) return 1;
    }
  } catch (const dem::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  if (!found) {
    const bool helps = wanted == "--help";
    std::string names = "all, tyres";
    for (const Scene& scene : scenes) names += std::string(", ") + scene.name;
    if (helps) fmt::print("A Humvee on hard ground: humvee <scene> --output <folder>\nScenes: {}\n", names);
    else fmt::print(stderr, "there is no scene '{}'; give {}\n", wanted, names);
    return helps ? 0 : 2;
  }
  fmt::print("\nresults in {}\n", folder);
}
