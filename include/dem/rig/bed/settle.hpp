#pragma once

#include <dem/rig/stages.hpp>
#include <dem/soil/rest.hpp>

namespace dem::rig {

/// Lets the grains of a world come to rest: their r.m.s. speed stays below that of rest (soil::rest_speed of their
/// size, m) for 20 ms. `done()` is what of the stage is done. Throws Stopped if that takes longer than `limit` (s);
/// `option` is what sets the limit.
template <class World, class Done>
void settle(World& world, double size, double limit, const char* option, Stages& stages, Done&& done) {
  const double rest = soil::rest_speed(size), start = world.time();
  soil::StaysBelow at_rest(rest, 0.02);
  for (double speed = 1e300; !at_rest(world.time(), speed);) {
    if (world.time() - start > limit) {
      throw Stopped(text(
          "the grains are not at rest after {:g} s: their r.m.s. speed is {:.3g} mm/s, rest is below {:.3g}; raise "
          "{} or --damping",
          limit, 1e3 * speed, 1e3 * rest, option));
    }
    run(world, 2e-3);
    speed = soil::rms_speed(world);
    stages.update(done(), text("{:.2f} s, grains at {:.2g} mm/s", world.time(), 1e3 * speed));
  }
}

/// The mean height (m) of a world's grains.
template <class World>
double mean_height(const World& world) {
  double sum = 0.0;
  for (const auto p : world.particles()) sum += world.position(p).z();
  return sum / static_cast<double>(world.particle_count());
}

}  // namespace dem::rig
