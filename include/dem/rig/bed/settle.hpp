#pragma once

#include <dem/rig/stages.hpp>
#include <dem/soil/rest.hpp>

namespace dem::rig {

/// What coming to rest has come to.
struct Settling {
  double start;  ///< s
  soil::StaysBelow at_rest;
  double speed = 1e300;  ///< m/s, r.m.s.
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("at_rest", at_rest), v("speed", speed, "m/s");
  }
};

/// Enters a stage in which the grains of a world come to rest: their r.m.s. speed stays below that of rest
/// (soil::rest_speed of their size, m) for 20 ms. `done()` is what of the stage is done. Throws Stopped if that takes
/// longer than `limit` (s); `option` is what sets the limit. `set_up()` as for Stages::enter.
template <class World, class Done, std::invocable SetUp>
void settle(World& world, double size, double limit, const char* option, Stages& stages, Done&& done, SetUp&& set_up) {
  const double rest = soil::rest_speed(size);
  Settling n{world.time(), {rest, 0.02}};
  const auto stage = stages.enter(world, n, set_up);
  if (!stage) return;
  while (!n.at_rest(world.time(), n.speed)) {
    if (world.time() - n.start > limit) {
      throw Stopped(text(
          "the grains are not at rest after {:g} s: their r.m.s. speed is {:.3g} mm/s, rest is below {:.3g}; raise "
          "{} or --damping",
          limit, 1e3 * n.speed, 1e3 * rest, option));
    }
    run(world, 2e-3);
    n.speed = soil::rms_speed(world);
    stages.update(done(), text("{:.2f} s, grains at {:.2g} mm/s", world.time(), 1e3 * n.speed));
  }
}
template <class World, class Done>
void settle(World& world, double size, double limit, const char* option, Stages& stages, Done&& done) {
  settle(world, size, limit, option, stages, done, [] {});
}

/// The mean height (m) of a world's grains.
template <class World>
double mean_height(const World& world) {
  double sum = 0.0;
  for (const auto p : world.particles()) sum += world.position(p).z();
  return sum / static_cast<double>(world.particle_count());
}

}  // namespace dem::rig
