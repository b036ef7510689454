#pragma once

#include "results.hpp"
#include "rig.hpp"

#include <dem/io/interrupt.hpp>
#include <dem/io/progress.hpp>
#include <dem/soil/bulk_density.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/soil/lattice.hpp>
#include <dem/soil/relative_density.hpp>
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
  if (const auto report = rig.world.run(static_cast<std::uint64_t>(steps)); !report) throw Stopped(report.text);
  if (dem::io::interrupted()) throw Interrupted{};
}

/// Solid fraction of the inside of a specimen of grains of `volume` (m^3), one and a half edges away from walls, floor,
/// and top or lid. Where the border cuts a grain, its solid is taken as spread evenly over the cube.
inline double inner_fraction(std::span<const dem::soil::Placement> grains, double volume, const Settings& s,
                             double lid_low = -1.0) {
  const auto region = dem::soil::inner_region(grains, s.box_length, s.box_width, 3.0 * s.half_edge, lid_low);
  return dem::soil::solid_fraction(grains, s.half_edge, region) * volume / dem::soil::cube_volume(s.half_edge);
}
template <class Rig>
double inner_fraction(const Rig& rig, const Settings& s, double lid_low = -1.0) {
  return inner_fraction(dem::soil::placements(rig.world), rig.grain_volume(), s, lid_low);
}

/// Lets the grains come to rest: their r.m.s. speed stays below the rest speed for 20 ms. `done()` tells the progress.
template <class Rig, class Done>
void settle(Rig& rig, const Settings& s, dem::io::Progress& progress, Done&& done) {
  const double limit = dem::soil::rest_speed(2.0 * s.half_edge), start = rig.world.time();
  dem::soil::StaysBelow at_rest(limit, 0.02);
  for (double speed = 1e300; !at_rest(rig.world.time(), speed);) {
    if (rig.world.time() - start > s.settle_limit) {
      throw Stopped(
          fmt::format("the grains are not at rest after {:g} s: their r.m.s. speed is {:.3g} mm/s, rest is below "
                      "{:.3g}; raise --settle-limit or --damping",
                      s.settle_limit, 1e3 * speed, 1e3 * limit));
    }
    run(rig, 2e-3);
    speed = dem::soil::rms_speed(rig.world);
    progress.update(done(),
                    [&] { return fmt::format("{:.2f} s, grains at {:.2g} mm/s", rig.world.time(), 1e3 * speed); });
  }
}

/// Lets grains fall until they lie at rest. Progress is how far their middle has come down towards that of a
/// loose specimen; the last tenth is for coming to rest.
template <class Rig>
void pour(Rig& rig, const Settings& s, double solid_height, dem::io::Progress& progress) {
  const auto mean_height = [&] {
    double sum = 0.0;
    for (const auto p : rig.world.particles()) sum += rig.world.position(p).z();
    return sum / static_cast<double>(rig.world.particle_count());
  };
  const double high = mean_height(), low = 0.5 * solid_height / dem::soil::solid_fraction_at(0.0);
  progress.begin("pour", 1.0);
  settle(rig, s, progress,
         [&] { return 0.9 * std::clamp((high - mean_height()) / std::max(high - low, 1e-9), 0.0, 1.0); });
}

/// Shakes both halves alike along x; `strength` blends in over two periods from t0 (s), or out over one.
inline dem::mbd::Signal shaking(const Settings& s, double t0, double t_out = 1e300) {
  const double w = 2.0 * std::numbers::pi * s.shake_frequency, period = 1.0 / s.shake_frequency, a = s.shake_amplitude;
  const auto step = [](double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); };
  return dem::mbd::Signal::function([=](double t) {
    return a * step((t - t0) / (2.0 * period)) * (1.0 - step((t - t_out) / period)) * std::sin(w * (t - t0));
  });
}
template <class Rig>
void shake(Rig& rig, const dem::mbd::Signal& motion) {
  rig.world.machine().set_target(rig.shaker, motion);
  rig.world.machine().set_target(rig.shearing, motion);
}
template <class Rig>
void end_shaking(Rig& rig, const Settings& s, double t0) {
  shake(rig, shaking(s, t0, rig.world.time()));
  run(rig, 1.5 / s.shake_frequency);
}

/// Makes a random packing denser: both frictions sink from their full value to zero while the box is shaken gently,
/// until the density that was asked for is reached, or, without friction, changes no more. Then friction is back.
template <class Rig>
void densify(Rig& rig, const Settings& s, dem::io::Progress& progress) {
  const double start = rig.world.time(), wanted = dem::soil::solid_fraction_at(s.relative_density);
  shake(rig, shaking(s, start));
  const double first = inner_fraction(rig, s);
  double fraction = first, before = fraction, looked = start + s.densify_time;
  progress.begin("densify", 1.0);
  while (fraction < wanted || s.relative_density >= 1.0) {
    const double now = rig.world.time();
    const double share = std::max(0.0, 1.0 - (now - start) / s.densify_time);
    rig.set_friction(share * s.friction, share * s.wall_friction);
    run(rig, 5e-3);
    fraction = inner_fraction(rig, s);
    if (now - looked >= 0.2) {  // five periods of 25 Hz
      if (fraction < before + 1e-3) break;
      before = fraction;
      looked = now;
    }
    // Of the two ways for it to end, the one that is nearer.
    progress.update(std::clamp(std::max(1.0 - share, (fraction - first) / (wanted - first)), 0.0, 1.0), [&] {
      return fmt::format("solid {:.3f} of {:.3f}, mu {:.2f}", fraction, wanted, share * s.friction);
    });
  }
  rig.set_friction(s.friction, s.wall_friction);
  end_shaking(rig, s, start);
}

/// Stages of progress in make_packing: pour; then shake or densify, and settle.
inline int making_stages(const Settings& s) { return s.packing == "random" && s.relative_density == 0.0 ? 1 : 3; }

/// Pours the grains, makes them as dense as asked for, and takes them out as a packing. The walls are as high as the
/// grains need while they are poured: a collar.
template <class Integrator, class Shape>
PackingResult make_packing(const Settings& s, dem::io::Progress& progress) {
  const bool poured = s.packing == "poured";
  const auto grain = Grain<Shape>::make(s.half_edge);
  const auto grains = poured ? dem::soil::tilted_block(s.grains, s.half_edge, s.box_length, s.box_width,
                                                       s.tilt_deg * std::numbers::pi / 180.0)
                             : dem::soil::random_lattice(s.grains, s.half_edge, s.box_length, s.box_width, s.seed, 0.05,
                                                         grain.bounding_radius());
  double highest = s.box_height;
  for (const auto& g : grains) highest = std::max(highest, g.position.z() + 3.0 * s.half_edge);
  const double solid_height = static_cast<double>(s.grains) * grain.volume() / s.area();
  const double seam = s.seam_height > 0.0 ? s.seam_height : 0.5 * solid_height / dem::soil::solid_fraction_at(0.5);
  Settings pouring = s;
  pouring.stable_share = 0.8;
  Rig<Integrator, Shape> rig(pouring, {.seam = seam, .wall_top = highest, .lid_low = highest}, grains);
  rig.hold_lid();

  pour(rig, s, solid_height, progress);
  if (poured) {
    progress.begin("shake", s.shake_time);
    const double start = rig.world.time();
    shake(rig, shaking(s, start));
    while (rig.world.time() < start + s.shake_time) {
      run(rig, 5e-3);
      progress.update(rig.world.time() - start);
    }
    end_shaking(rig, s, start);
  } else if (s.relative_density > 0.0) {
    densify(rig, s, progress);
  }
  if (making_stages(s) > 1) {
    progress.begin("settle");
    settle(rig, s, progress, [] { return 0.0; });
  }

  PackingResult result;
  if (!poured && s.relative_density > 0.0) result.asked_density = s.relative_density;
  result.packing = {s.half_edge,
                    s.box_length,
                    s.box_width,
                    fmt::format("{}, friction {:g}, seed {}", s.packing, s.friction, s.seed),
                    dem::soil::placements(rig.world),
                    s.shape};
  result.coordination = dem::soil::coordination(rig.world).mean();
  return result;
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
