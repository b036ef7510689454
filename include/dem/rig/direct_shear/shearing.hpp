#pragma once

#include <dem/rig/direct_shear/apparatus.hpp>
#include <dem/rig/direct_shear/results.hpp>
#include <dem/rig/smooth_start.hpp>
#include <dem/rig/stages.hpp>
#include <dem/soil/rest.hpp>

#include <algorithm>
#include <cmath>

// The stages of the test: the lid is lowered until the grains carry it, and the top box is moved.

namespace dem::rig::direct_shear {

/// When a test looks at its apparatus.
enum class Moment { start, sample, end };

/// Lowers the lid, by its actuator, until it is at rest and the grains carry the load within 1 % (both for 20 ms); then
/// switches the actuator off. From there on the lid is a dead load. Calls done() at the end of the stage.
template <class Model, class Done>
void consolidate(Apparatus<Model>& rig, const Settings& s, Stages& stages, Done&& done) {
  const double weight = rig.lid_weight();
  StageOfTest n{.start = rig.world.time(), .slow = {s.rest_speed, 0.02}, .loaded = {0.01, 0.02}};
  const auto stage = stages.enter(rig.world, n);
  if (!stage) return;
  while (!n.done) {
    run(rig.world, 1e-3);
    const double now = rig.world.time(), force = rig.lid_force();
    const bool is_slow = n.slow(now, std::abs(rig.lid_speed()));
    const bool is_loaded = n.loaded(now, std::abs(force / weight - 1.0));
    n.done = is_slow && is_loaded;
    stages.update(std::clamp(force / weight, 0.0, 1.0),
                  text("{:.1f} kPa, lid {:.3g} mm/s", 1e-3 * force / s.area(), 1e3 * rig.lid_speed()));
    if (!n.done && now - n.start > s.consolidation_limit) {
      throw Stopped(
          text("the lid is not at rest after {:g} s: it carries {:.4g} N of {:.4g} N and moves at {:.3g} "
               "mm/s; raise --consolidation-limit, --rest-speed or --damping",
               s.consolidation_limit, force, weight, 1e3 * rig.lid_speed()));
    }
  }
  rig.world.machine().switch_on(rig.lid_drive, false);
  done();
}

/// Moves the top box with the lid over the bottom box, and samples. Calls `look(moment)` as it starts, after each
/// sample, and at the end.
template <class Model, class Look>
void shear(Apparatus<Model>& rig, const Settings& s, LoadResult& result, Stages& stages, Look&& look) {
  auto& machine = rig.world.machine();
  const double interval = 1e-5 / s.shear_speed;
  StageOfTest n{.start = rig.world.time(), .lid = rig.lid_low()};
  const auto stage = stages.enter(
      rig.world, n, [&] { machine.set_target(rig.shearing, smooth_start(s.shear_speed, s.ramp_time, n.start)); });
  if (!stage) return;
  if (stage.begins()) {
    // Weight of the grains in the bottom box: they hang on it, but not on the plane of shear.
    for (const GrainId p : rig.world.grains()) {
      n.below += rig.world.position(p).z() < rig.height().seam ? 1.0 : 0.0;
    }
    n.below *= 9.81 * s.density * rig.grain_volume();
    look(Moment::start);
  }
  while (rig.top_displacement() < s.travel) {
    run(rig.world, interval);
    const double u = rig.top_displacement();
    const double area = s.area(u);
    const auto& on_bottom = machine.sensor(rig.bottom_sensor).mean().force;
    const double drive = machine.sensor(rig.shearing_sensor).mean().force.x;
    result.samples.push_back({rig.world.time(), u, on_bottom.x / area, drive / area, rig.lid_low() - n.lid,
                              rig.lid_force() / area, (-on_bottom.z - n.below) / area});
    look(Moment::sample);
    stages.update(u, text("{:.1f} kPa", 1e-3 * on_bottom.x / area));
  }
  result.finished = true;
  look(Moment::end);
}

}  // namespace dem::rig::direct_shear
