#pragma once

#include <dem/rig/bed/settle.hpp>
#include <dem/rig/direct_shear/density.hpp>
#include <dem/rig/stages.hpp>
#include <dem/soil/coordination.hpp>
#include <dem/soil/making.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

// The stages of a packing: grains are poured, shaken, and come to rest.
//
// They are made of what soil::Bed is made of (soil/making.hpp): how grains come to rest and get denser stands there.
// The whole of soil::Bed does not fit. The walls of a packing are the two halves of the box, bodies that their drives
// shake, and not a container on the ground; it has a given number of grains, and is levelled by a share of them, and
// not to a height; and its stages tell how far they are, and are kept with the run.

namespace dem::rig::direct_shear {

/// Lets the grains come to rest: their r.m.s. speed stays below the rest speed for 20 ms. `done()` is what of
/// the stage is done.
template <class Model, class Done>
void settle(Apparatus<Model>& rig, const Settings& s, Stages& stages, Done&& done) {
  rig::settle(rig.world, 2.0 * s.half_edge, s.settle_limit, "--settle-limit", stages, done);
}

/// Lets grains fall until they lie at rest. Progress is how far their middle has come down towards that of a
/// loose specimen; the last tenth is for coming to rest.
template <class Model>
void pour(Apparatus<Model>& rig, const Settings& s, double solid_height, Stages& stages) {
  const double high = mean_height(rig.world),
               low = 0.5 * solid_height / soil::solid_fraction_at(0.0, density_limits(s));
  stages.begin("pour", 1.0);
  settle(rig, s, stages, [&] { return fallen_share(rig.world, high, low); });
}

/// Shakes both halves alike along x; `strength` blends in over two periods from t0 (s), or out over one.
inline mbd::Signal shaking(const Settings& s, double t0, double t_out = 1e300) {
  const double w = 2.0 * std::numbers::pi * s.shake_frequency, period = 1.0 / s.shake_frequency, a = s.shake_amplitude;
  const auto step = [](double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); };
  return mbd::Signal::function([=](double t) {
    return a * step((t - t0) / (2.0 * period)) * (1.0 - step((t - t_out) / period)) * std::sin(w * (t - t0));
  });
}
template <class Model>
void shake(Apparatus<Model>& rig, const mbd::Signal& motion) {
  rig.world.machine().set_target(rig.shaker, motion);
  rig.world.machine().set_target(rig.shearing, motion);
}
template <class Model>
void end_shaking(Apparatus<Model>& rig, const Settings& s, double t0) {
  shake(rig, shaking(s, t0, rig.world.time()));
  run(rig.world, 1.5 / s.shake_frequency);
  shake(rig, 0.0);  // where it has come to
}

/// Makes a random packing denser: both frictions sink from their full value to zero while the box is shaken gently,
/// until the density that was asked for is reached, or, without friction, changes no more. Then friction is back.
template <class Model>
void densify(Apparatus<Model>& rig, const Settings& s, Stages& stages) {
  const double wanted = soil::solid_fraction_at(s.relative_density, density_limits(s));
  const auto measure = [&] {
    const double fraction = inner_fraction(rig, s);
    if (std::isfinite(fraction)) return fraction;
    throw Stopped(
        text("the grains lie too flat to measure their density {:g} mm away from floor and top; take more "
             "--grains or a smaller --half-edge, or let them be as they settle (--relative-density 0)",
             1e3 * measuring_margin(s)));
  };
  stages.begin("densify", 1.0);
  auto& world = rig.world;
  soil::Densifying n;
  n.start = world.time();
  const auto stage = stages.enter(world, n, [&] {
    shake(rig, shaking(s, n.start));
    rig.set_friction(n.share);
  });
  if (!stage) return shake(rig, 0.0);
  if (stage.begins()) n = {world.time(), measure(), s.densify_time};
  while (n.fraction < wanted || s.relative_density >= 1.0) {
    const bool gains = n.go_on(
        world.time(), s.densify_time, [&](double share) { rig.set_friction(share); }, measure,
        [&] { run(world, 5e-3); });
    if (!gains) break;
    stages.update(n.progress(wanted), text("solid {:.3f} of {:.3f}, mu {:.2f}", n.fraction, wanted, rig.friction()));
  }
  rig.set_friction(1.0);
  end_shaking(rig, s, n.start);
}

/// Stages of progress in make_packing: pour; then shake or densify, and settle.
inline int making_stages(const Settings& s) { return s.packing == "random" && s.relative_density == 0.0 ? 1 : 3; }

/// Pours the grains, makes them as dense as asked for, and takes them out as a packing. The walls are as high as the
/// grains need while they are poured: a collar.
template <class Model>
PackingResult make_packing(const Settings& s, const Grains<Model>& kind, std::span<const soil::Placement> grains,
                           Stages& stages) {
  const bool poured = s.packing == "poured";
  double highest = s.box_height;
  for (const auto& g : grains) highest = std::max(highest, g.position.z() + 3.0 * s.half_edge);
  const double solid = solid_height(s, kind.shape.volume());
  const double seam =
      s.seam_height > 0.0 ? s.seam_height : 0.5 * solid / soil::solid_fraction_at(0.5, density_limits(s));
  Settings pouring = s;
  pouring.stable_share = 0.8;  // a smaller share is for the test: nothing but rest is asked of a packing
  Apparatus<Model> rig(pouring, kind, {.seam = seam, .wall_top = highest, .lid_low = highest}, grains);
  rig.hold_lid();

  pour(rig, s, solid, stages);
  if (poured) {
    stages.begin("shake", s.shake_time);
    StageOfTest n{.start = rig.world.time()};
    if (const auto stage = stages.enter(rig.world, n, [&] { shake(rig, shaking(s, n.start)); })) {
      while (rig.world.time() < n.start + s.shake_time) {
        run(rig.world, 5e-3);
        stages.update(rig.world.time() - n.start);
      }
      end_shaking(rig, s, n.start);
    } else {
      shake(rig, 0.0);
    }
  } else if (s.relative_density > 0.0) {
    densify(rig, s, stages);
  }
  if (making_stages(s) > 1) {
    stages.begin("settle");
    settle(rig, s, stages, [] { return 0.0; });
  }

  PackingResult result;
  if (!poured && s.relative_density > 0.0) result.asked_density = s.relative_density;
  result.packing = {s.half_edge,
                    s.box_length,
                    s.box_width,
                    text("{}, friction {:g}{}", s.packing, rig.friction(), poured ? "" : text(", seed {}", s.seed)),
                    soil::placements(rig.world),
                    kind_of(s).name};
  result.coordination = soil::coordination(rig.world).mean();
  return result;
}

}  // namespace dem::rig::direct_shear
