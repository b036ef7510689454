#pragma once
// The stages of a bed: grains are rained, made dense, levelled by the lid, and come to rest.

#include <dem/rig/bed/bed.hpp>
#include <dem/rig/bed/settle.hpp>
#include <dem/soil/lattice.hpp>

#include <numbers>
#include <vector>

namespace dem::rig {

/// How high the walls must be (m): above the highest grain.
inline double walls_for(const soil::Packing& p, const GrainSettings& grains) {
  double highest = 0.0;
  for (const auto& g : p.grains) highest = std::max(highest, g.position.z());
  return highest + 3.0 * grains.half_edge;
}

/// What making a bed denser has come to.
struct Densifying {
  double start = 0.0, looked = 0.0;                           ///< s
  double first = std::nan(""), fraction = 0.0, before = 0.0;  ///< solid fractions
  double share = 1.0;                                         ///< of friction
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("looked", looked, "s"), v("first", first), v("fraction", fraction);
    v("before", before), v("share", share);
  }
};

/// What lowering the lid has come to.
struct Lowering {
  double start = 0.0;  ///< s
  soil::StaysBelow slow, loaded;
  bool done = false;
  template <class V>
  void fields(V& v) {
    v("start", start, "s"), v("slow", slow), v("loaded", loaded), v("done", done);
  }
};

/// Makes a bed denser: friction sinks to zero while the bed is shaken between two of its walls, until the density that
/// was asked for is reached or, without friction, changes no more. Shaking is done by gravity, which turns to and fro:
/// in the frame of the box that is the same as a box that shakes.
template <class Model>
void densify(Bed<Model>& bed, Stages& stages) {
  const BedSettings& s = bed.settings();
  const double wanted = soil::solid_fraction_at(s.relative_density, soil::cube8_limits);
  stages.begin("densify", 1.0);
  Densifying n;
  const auto stage = stages.enter(bed.world, n, [&] { bed.set_friction(n.share); });
  if (!stage) return;
  if (stage.begins()) {
    const double first = bed.solid_fraction(), start = bed.world.time();
    n = {.start = start, .looked = start + s.densify_time, .first = first, .fraction = first, .before = first};
  }
  if (!std::isfinite(n.first)) {
    throw Stopped(
        text("the bed is too flat to measure its density {:g} mm away from floor and top; take a deeper "
             "--bed-depth, a smaller --half-edge, or let it be as it settles (--relative-density 0)",
             1e3 * bed.margin()));
  }
  const double w = 2.0 * std::numbers::pi * s.shake_frequency;
  while (n.fraction < wanted) {
    const double now = bed.world.time();
    n.share = std::max(0.0, 1.0 - (now - n.start) / s.densify_time);
    bed.set_friction(n.share);
    for (int k = 0; k < 5; ++k) {
      const double at = bed.world.time() - n.start, grown = std::min(1.0, at * s.shake_frequency / 2.0);
      const double shake = grown * s.shake_amplitude * w * w * std::sin(w * at);
      bed.world.set_gravity(Bed<Model>::is_endless ? Vec3(0.0, shake, -9.81) : Vec3(shake, 0.0, -9.81));
      run(bed.world, 1e-3);
    }
    n.fraction = bed.solid_fraction();
    if (now - n.looked >= 0.2) {
      if (n.fraction < n.before + 1e-3) break;
      n.before = n.fraction;
      n.looked = now;
    }
    stages.update(std::clamp(std::max(1.0 - n.share, (n.fraction - n.first) / (wanted - n.first)), 0.0, 1.0),
                  text("solid {:.3f} of {:.3f}", n.fraction, wanted));
  }
  bed.world.set_gravity(Vec3(0.0, 0.0, -9.81));
  bed.set_friction(1.0);
}

/// Takes the highest grains off, presses the bed flat with the lid until the grains carry its weight within 2 % and it
/// rests (both for 10 ms), and takes the lid off. Sets bed.level.
template <class Model>
void level(Bed<Model>& bed, double strike_off, Stages& stages) {
  const BedSettings& s = bed.settings();
  auto& world = bed.world;
  stages.begin("level", 1.0);
  NoNumbers none;
  if (const auto stage = stages.enter(world, none)) {
    std::vector<ParticleId> by_height = world.particles();
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](ParticleId a, ParticleId b) { return world.position(a).z() > world.position(b).z(); });
    by_height.resize(static_cast<std::size_t>(strike_off * static_cast<double>(by_height.size())));
    for (const ParticleId p : by_height) world.remove_particle(p);
    if (!by_height.empty()) run(world, 1e-6);  // they go with the next step
  }
  const double weight = bed.lid_weight();
  Lowering n{world.time(), {0.01 * s.lid_speed, 0.01}, {0.02, 0.01}};
  if (const auto stage = stages.enter(world, n, [&] { bed.add_lid(); })) {
    while (!n.done) {
      run(world, 1e-3);
      const double force = world.machine().sensor(bed.lid_sensor).mean().force.z;
      const double speed = world.machine().body(bed.lid).velocity().z();
      const bool is_slow = n.slow(world.time(), std::abs(speed));
      n.done = n.loaded(world.time(), std::abs(force / weight - 1.0)) && is_slow;
      stages.update(std::clamp(force / weight, 0.0, 1.0), text("{:.0f} Pa on the lid", force / bed.area()));
      if (!n.done && world.time() - n.start > s.stage_limit) {
        throw Stopped(
            text("the lid is not at rest after {:g} s: it carries {:.4g} N of {:.4g} N; raise --stage-limit or "
                 "--damping",
                 s.stage_limit, force, weight));
      }
    }
    bed.level = bed.lid_low();
  }
  settle(
      world, bed.grains().edge(), s.stage_limit, "--stage-limit", stages, [] { return 1.0; },
      [&] { bed.take_lid_off(); });
}

/// Stages of progress in make_bed.
inline int bed_stages(const BedSettings& s) { return 2 + (s.file.empty() && s.relative_density > 0.0 ? 2 : 0); }

/// A levelled bed of these grains, which come to rest first.
template <class Model>
Bed<Model> make_bed(const BedSettings& s, const GrainSettings& grains, const typename Model::Shape& shape, bool halves,
                    const soil::Packing& start, Stages& stages) {
  const bool made = s.file.empty();
  Bed<Model> bed(s, grains, shape, {.halves = halves, .wall_top = walls_for(start, grains)}, start.grains);
  const auto kept = stages.keep("bed", bed);
  stages.begin(made ? "rain" : "settle", 1.0);
  const double high = mean_height(bed.world), low = 0.5 * s.depth;
  settle(bed.world, grains.edge(), s.stage_limit, "--stage-limit", stages, [&] {
    return made ? 0.9 * std::clamp((high - mean_height(bed.world)) / std::max(high - low, 1e-9), 0.0, 1.0) : 0.0;
  });
  if (made && s.relative_density > 0.0) {
    densify(bed, stages);
    stages.begin("settle");
    settle(bed.world, grains.edge(), s.stage_limit, "--stage-limit", stages, [] { return 0.0; });
  }
  level(bed, made ? s.strike_off : 0.0, stages);
  return bed;
}

/// By which the file of a bed says that it repeats itself.
inline constexpr const char* repeating_note = "repeats itself along x";

/// The grains of a bed as they are, for a file.
template <class Model>
soil::Packing packing_of(const Bed<Model>& bed) {
  const BedSettings& s = bed.settings();
  return {bed.grains().half_edge,
          s.length,
          s.width,
          text("rained, seed {}, relative density {:g} asked for, levelled{}", s.seed, s.relative_density,
               Bed<Model>::is_endless ? text(", {}", repeating_note) : ""),
          soil::placements(bed.world),
          "cube8"};
}

/// The grains of a bed before they are rained. Throws Error if they do not fit into the box or the machine.
inline soil::Packing bed_grains(const BedSettings& s, const GrainSettings& grains, double volume,
                                double bounding_radius) {
  const std::uint64_t count = grains_in(s, volume);
  require_memory(1000.0 * static_cast<double>(count), text("{} grains", count).c_str(),
                 "take larger grains (--half-edge) or a smaller bed");
  soil::Packing p{grains.half_edge, s.length, s.width, {}, {}, "cube8"};
  p.grains = soil::random_lattice(count, grains.half_edge, s.length, s.width, s.seed, 0.05, bounding_radius);
  return p;
}

}  // namespace dem::rig
