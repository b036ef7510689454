#pragma once
// What a bed is made by: grains rain, come to rest, get denser, and are pressed by a lid. Each stage is a struct that
// is gone on with a little at a time, so that the caller may report, stop, save and go on in between: one that is made
// again with the same arguments and gets its fields() back goes on. `run(seconds)` runs the world.

#include <dem/math/vector.hpp>
#include <dem/soil/fall_speed.hpp>
#include <dem/soil/rest.hpp>
#include <dem/soil/solid_layers.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

namespace dem::soil {

/// Grains fall out of an inlet, which is open meanwhile, until there are enough of them.
struct Raining {
  double start = 0.0;   ///< s
  double wanted = 0.0;  ///< m^3, solid volume of all grains at the end
  double solid = 0.0;   ///< m^3, of those that are there

  /// Whether there are enough.
  [[nodiscard]] bool is_done() const { return solid >= wanted; }
  template <class World, std::invocable<double> Run>
  void go_on(const World& world, Run&& run) {
    run(2e-3);
    solid = solid_volume(world);
  }
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("wanted", wanted, "m^3"), v("solid", solid, "m^3");
  }
};

/// Grains come to rest: their r.m.s. speed stays below that of rest for 20 ms.
struct Settling {
  double start;       ///< s
  double rest;        ///< m/s, the speed of rest
  double fall_speed;  ///< m/s, for limit_fall(); 0: they fall freely
  StaysBelow slow;
  double speed = 1e300;  ///< m/s, r.m.s.

  Settling(double now, double rest_speed, double most_fall_speed = 0.0)
      : start(now), rest(rest_speed), fall_speed(most_fall_speed), slow(rest_speed, 0.02) {}

  /// Looks at the speed, before the first go_on() and after each: true when they rest.
  [[nodiscard]] bool look(double time) { return slow(time, speed); }
  template <class World, std::invocable<double> Run>
  void go_on(World& world, Run&& run) {
    run(2e-3);
    if (fall_speed > 0.0) limit_fall(world, fall_speed);
    speed = rms_speed(world);
  }
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("at_rest", slow), v("speed", speed, "m/s");
  }
};

/// To and fro along a direction, by gravity: in the frame of a container that is the same as a container that shakes.
struct Shaking {
  Vec3 gravity;      ///< m/s^2, at rest
  Vec3 direction;    ///< of length 1
  double amplitude;  ///< m
  double frequency;  ///< Hz
  /// At a time (s) from its start. It grows for two periods.
  [[nodiscard]] Vec3 gravity_at(double time) const {
    const double w = 2.0 * std::numbers::pi * frequency, grown = std::min(1.0, time * frequency / 2.0);
    return gravity + (grown * amplitude * w * w * std::sin(w * time)) * direction;
  }
  /// Runs 5 ms; `start` (s) is when it began.
  template <class World, std::invocable<double> Run>
  void run(World& world, double start, Run&& run_for) const {
    for (int k = 0; k < 5; ++k) {
      world.set_gravity(gravity_at(world.time() - start));
      run_for(1e-3);
    }
  }
};

/// Grains get denser: friction sinks to zero while they are shaken.
struct Densifying {
  double start = 0.0, looked = 0.0;                                                       ///< s
  double first = std::numeric_limits<double>::quiet_NaN(), fraction = 0.0, before = 0.0;  ///< solid fractions
  double share = 1.0;                                                                     ///< of friction

  Densifying() = default;
  /// Starts now, with this solid fraction. Friction goes to zero in `duration` (s).
  Densifying(double now, double solid, double duration)
      : start(now), looked(now + duration), first(solid), fraction(solid), before(solid) {}

  /// Runs 5 ms with less friction; `run_shaken()` does. False: without friction the solid fraction has grown by less
  /// than 0.001 in 0.2 s.
  template <std::invocable<double> SetFriction, std::invocable SolidFraction, std::invocable RunShaken>
  bool go_on(double now, double duration, SetFriction&& set_friction, SolidFraction&& solid_fraction,
             RunShaken&& run_shaken) {
    share = std::max(0.0, 1.0 - (now - start) / duration);
    set_friction(share);
    run_shaken();
    fraction = solid_fraction();
    if (now - looked < 0.2) return true;
    if (fraction < before + 1e-3) return false;
    before = fraction;
    looked = now;
    return true;
  }
  /// From 0 to 1, how near its end is: of the two ways for it to end, `wanted` or no friction, the one that is nearer.
  [[nodiscard]] double progress(double wanted) const {
    return std::clamp(std::max(1.0 - share, (fraction - first) / (wanted - first)), 0.0, 1.0);
  }
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("looked", looked, "s"), v("first", first), v("fraction", fraction);
    v("before", before), v("share", share);
  }
};

/// A lid or a wheel sinks onto grains until they carry its load within 2 % and it rests, both for 10 ms.
struct Pressing {
  double start;  ///< s
  StaysBelow slow, loaded = {0.02, 0.01};
  bool done = false;

  /// It comes down at `speed` (m/s), and rests below a hundredth of that.
  Pressing(double now, double speed) : start(now), slow(0.01 * speed, 0.01) {}

  /// Looks at the share of the load that is carried, and at the speed (m/s): after each millisecond.
  void look(double time, double carried, double speed) {
    const bool is_slow = slow(time, std::abs(speed));
    done = loaded(time, std::abs(carried - 1.0)) && is_slow;
  }
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("slow", slow), v("loaded", loaded), v("done", done);
  }
};

}  // namespace dem::soil
