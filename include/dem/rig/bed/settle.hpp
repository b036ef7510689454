#pragma once

#include <dem/rig/stages.hpp>
#include <dem/soil/making.hpp>

#include <algorithm>

namespace dem::rig {

/// Enters a stage in which the grains of a world come to rest: soil::Settling of their size (m). `done()` is what of
/// the stage is done. Throws Stopped if that takes longer than `limit` (s); `option` is what sets the limit. `set_up()`
/// as for Stages::enter. Where `fall_speed` (m/s) is above 0, the grains fall no faster.
template <class World, class Done, std::invocable SetUp>
void settle(World& world, double size, double limit, const char* option, Stages& stages, Done&& done, SetUp&& set_up,
            double fall_speed = 0.0) {
  soil::Settling n{world.time(), soil::rest_speed(size), fall_speed};
  const auto stage = stages.enter(world, n, set_up);
  if (!stage) return;
  while (!n.look(world.time())) {
    if (world.time() - n.start > limit) {
      throw Stopped(text(
          "the grains are not at rest after {:g} s: their r.m.s. speed is {:.3g} mm/s, rest is below {:.3g}; raise "
          "{} or --damping",
          limit, 1e3 * n.speed, 1e3 * n.rest, option));
    }
    n.go_on(world, [&](double seconds) { run(world, seconds); });
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
  for (const auto p : world.grains()) sum += world.position(p).z();
  return sum / static_cast<double>(world.grain_count());
}

/// How much of it is done that grains fall: how far their mean height has come down from `high` towards `low` (m). The
/// last tenth is for coming to rest.
template <class World>
double fallen_share(const World& world, double high, double low) {
  return 0.9 * std::clamp((high - mean_height(world)) / std::max(high - low, 1e-9), 0.0, 1.0);
}

}  // namespace dem::rig
