#pragma once

#include "option_names.hpp"
#include "results.hpp"
#include "rig.hpp"

#include <dem/report/interrupt.hpp>
#include <dem/report/progress.hpp>
#include <dem/soil/bulk_density.hpp>
#include <dem/soil/rest.hpp>

#include <algorithm>
#include <span>
#include <stdexcept>

namespace direct_shear {

/// Ctrl-C came: what is there gets saved.
struct Interrupted {};
/// The simulation reported a problem, or a stage did not come to its end.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the rig for a time (s), at least one step.
template <class Rig>
void run(Rig& rig, double duration) {
  rig.world.prepare();
  const auto steps = std::max(1LL, std::llround(duration / rig.world.time_step()));
  if (const auto report = rig.world.run(static_cast<std::uint64_t>(steps)); !report) {
    throw Stopped(in_options(report.text));
  }
  if (dem::io::interrupted()) throw Interrupted{};
}

/// m, from walls, floor, and top or lid: so far away from them density is measured. One and a half edges.
inline double measuring_margin(const Settings& s) { return 3.0 * s.half_edge; }

/// Solid fraction of the inside of a specimen of grains of `volume` (m^3); not known of one that has no inside. Where
/// the border cuts a grain, its solid is taken as spread evenly over the cube.
inline double inner_fraction(std::span<const dem::soil::Placement> grains, double volume, const Settings& s,
                             double lid_low = -1.0) {
  const auto region = dem::soil::inner_region(grains, s.box_length, s.box_width, measuring_margin(s), lid_low);
  if (region.is_empty()) return not_known;
  return dem::soil::solid_fraction(grains, s.half_edge, region) * volume / dem::soil::cube_volume(s.half_edge);
}
template <class Rig>
double inner_fraction(const Rig& rig, const Settings& s, double lid_low = -1.0) {
  return inner_fraction(dem::soil::placements(rig.world), rig.grain_volume(), s, lid_low);
}

/// Lowers the lid, by its actuator, until it is at rest and the grains carry the load within 1 % (both for 20 ms); then
/// switches the actuator off. From there on the lid is a dead load.
template <class Rig>
void consolidate(Rig& rig, const Settings& s, dem::io::Progress& progress) {
  const double start = rig.world.time(), weight = rig.lid_weight();
  dem::soil::StaysBelow slow(s.rest_speed, 0.02), loaded(0.01, 0.02);
  for (bool done = false; !done;) {
    run(rig, 1e-3);
    const double now = rig.world.time(), force = rig.lid_force();
    const bool is_slow = slow(now, std::abs(rig.lid_speed()));
    const bool is_loaded = loaded(now, std::abs(force / weight - 1.0));
    done = is_slow && is_loaded;
    progress.update(std::clamp(force / weight, 0.0, 1.0), [&] {
      return fmt::format("{:.1f} kPa, lid {:.3g} mm/s", 1e-3 * force / s.area(), 1e3 * rig.lid_speed());
    });
    if (!done && now - start > s.consolidation_limit) {
      throw Stopped(
          fmt::format("the lid is not at rest after {:g} s: it carries {:.4g} N of {:.4g} N and moves at {:.3g} "
                      "mm/s; raise --consolidation-limit, --rest-speed or --damping",
                      s.consolidation_limit, force, weight, 1e3 * rig.lid_speed()));
    }
  }
  rig.world.machine().switch_on(rig.lid_drive, false);
}

/// The way of the top box: smoothly to full speed within the ramp time, then on.
inline dem::mbd::Signal shearing_motion(const Settings& s, double t0) {
  const double v = s.shear_speed, ramp = std::max(s.ramp_time, 1e-9);
  return dem::mbd::Signal::function(
      [=](double t) {
        const double x = std::clamp((t - t0) / ramp, 0.0, 1.0);
        return v * ramp * x * x * x * (1.0 - 0.5 * x) + v * std::max(0.0, t - t0 - ramp);
      },
      [=](double t) {
        const double x = std::clamp((t - t0) / ramp, 0.0, 1.0);
        return v * x * x * (3.0 - 2.0 * x);
      });
}

/// Moves the top box with the lid over the bottom box, and samples. Calls `look(rig)` after each sample.
template <class Rig, class Look>
void shear(Rig& rig, const Settings& s, LoadResult& result, dem::io::Progress& progress, Look&& look) {
  auto& machine = rig.world.machine();
  const double start = rig.world.time(), lid_at_start = rig.lid_low(), interval = 1e-5 / s.shear_speed;
  // Weight of the grains in the bottom box: they hang on it, but not on the plane of shear.
  double below = 0.0;
  for (const dem::ParticleId p : rig.world.particles()) {
    below += rig.world.position(p).z() < rig.shape().seam ? 1.0 : 0.0;
  }
  below *= 9.81 * s.density * rig.grain_volume();
  machine.set_target(rig.shearing, shearing_motion(s, start));
  while (rig.top_displacement() < s.travel) {
    run(rig, interval);
    const double u = rig.top_displacement();
    const double area = s.area(u);
    const auto& on_bottom = machine.sensor(rig.bottom_sensor).mean().force;
    const double drive = machine.sensor(rig.shearing_sensor).mean().force.x;
    result.samples.push_back({rig.world.time(), u, on_bottom.x / area, drive / area, rig.lid_low() - lid_at_start,
                              rig.lid_force() / area, (-on_bottom.z - below) / area});
    look(rig);
    progress.update(u, [&] { return fmt::format("{:.1f} kPa", 1e-3 * on_bottom.x / area); });
  }
  result.finished = true;
}

}  // namespace direct_shear
