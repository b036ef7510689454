#pragma once

#include "stages.hpp"

#include <dem/soil/coordination.hpp>
#include <dem/soil/rest.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

// The packing is made: grains are poured, shaken, and come to rest.

namespace direct_shear {

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
  const double high = mean_height(), low = 0.5 * solid_height / dem::soil::solid_fraction_at(0.0, density_limits(s));
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
  const double start = rig.world.time();
  const double wanted = dem::soil::solid_fraction_at(s.relative_density, density_limits(s));
  const auto measure = [&] {
    const double fraction = inner_fraction(rig, s);
    if (std::isfinite(fraction)) return fraction;
    throw Stopped(
        fmt::format("the grains lie too flat to measure their density {:g} mm away from floor and top; take more "
                    "--grains or a smaller --half-edge, or let them be as they settle (--relative-density 0)",
                    1e3 * measuring_margin(s)));
  };
  shake(rig, shaking(s, start));
  const double first = measure();
  double fraction = first, before = fraction, looked = start + s.densify_time;
  progress.begin("densify", 1.0);
  while (fraction < wanted || s.relative_density >= 1.0) {
    const double now = rig.world.time();
    const double share = std::max(0.0, 1.0 - (now - start) / s.densify_time);
    rig.set_friction(share * s.friction, share * s.wall_friction);
    run(rig, 5e-3);
    fraction = measure();
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

/// m, how high the solid of the grains would fill the box without gaps.
template <class Shape>
double solid_height(const Settings& s) {
  return static_cast<double>(s.grains) * Grain<Shape>::make(s.half_edge).volume() / s.area();
}

/// Pours the grains, makes them as dense as asked for, and takes them out as a packing. The walls are as high as the
/// grains need while they are poured: a collar.
template <class Integrator, class Shape>
PackingResult make_packing(const Settings& s, std::span<const dem::soil::Placement> grains,
                           dem::io::Progress& progress) {
  const bool poured = s.packing == "poured";
  double highest = s.box_height;
  for (const auto& g : grains) highest = std::max(highest, g.position.z() + 3.0 * s.half_edge);
  const double solid = solid_height<Shape>(s);
  const double seam =
      s.seam_height > 0.0 ? s.seam_height : 0.5 * solid / dem::soil::solid_fraction_at(0.5, density_limits(s));
  Settings pouring = s;
  pouring.stable_share = 0.8;  // a smaller share is for the test: nothing but rest is asked of a packing
  Rig<Integrator, Shape> rig(pouring, {.seam = seam, .wall_top = highest, .lid_low = highest}, grains);
  rig.hold_lid();

  pour(rig, s, solid, progress);
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
  result.packing = {
      s.half_edge,
      s.box_length,
      s.box_width,
      fmt::format("{}, friction {:g}{}", s.packing, s.friction, poured ? "" : fmt::format(", seed {}", s.seed)),
      dem::soil::placements(rig.world),
      s.shape};
  result.coordination = dem::soil::coordination(rig.world).mean();
  return result;
}

}  // namespace direct_shear
