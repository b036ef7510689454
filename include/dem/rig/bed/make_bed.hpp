#pragma once
// The stages of a bed: grains are rained, made dense, levelled by the lid, and come to rest.
//
// They are made of what soil::Bed is made of (soil/making.hpp): how grains come to rest, are shaken, get denser and
// carry a lid stands there. The whole of soil::Bed does not fit. Walls are solid boxes, of which two rigs move a half
// and one has none along x; the grains are counted, so that those of a file are the same; and the stages tell how far
// they are, and are kept with the run.

#include <dem/rig/bed/bed.hpp>
#include <dem/rig/bed/settle.hpp>
#include <dem/rig/bed/surface_profile.hpp>
#include <dem/soil/lattice.hpp>
#include <dem/soil/making.hpp>

#include <vector>

namespace dem::rig {

/// How high the walls must be (m): ten edges above the highest grain, as a bed rebounds when the lid goes, and machines
/// push heaps.
inline double walls_for(const soil::Packing& p, const GrainSettings& grains) {
  double highest = 0.0;
  for (const auto& g : p.grains) highest = std::max(highest, g.position.z());
  return highest + 10.0 * grains.edge();
}

/// Makes a bed denser: friction sinks to zero while the bed is shaken between two of its walls, until the density that
/// was asked for is reached or, without friction, changes no more. Shaking is done by gravity, which turns to and fro:
/// in the frame of the box that is the same as a box that shakes.
template <class Model>
void densify(Bed<Model>& bed, Stages& stages) {
  const BedSettings& s = bed.settings();
  auto& world = bed.world;
  const double wanted = soil::solid_fraction_at(s.relative_density, bed.grains().limits);
  stages.begin("densify", 1.0);
  soil::Densifying n;
  const auto stage = stages.enter(world, n, [&] { bed.set_friction(n.share); });
  if (!stage) return;
  if (stage.begins()) n = {world.time(), bed.solid_fraction(), s.densify_time};
  if (!std::isfinite(n.first)) {
    throw Stopped(
        text("the bed is too flat to measure its density {:g} mm away from floor and top; take a deeper "
             "--bed-depth, a smaller --half-edge, or let it be as it settles (--relative-density 0)",
             1e3 * bed.margin()));
  }
  const Vec3 gravity(0.0, 0.0, -9.81);
  const soil::Shaking shaking{gravity, Bed<Model>::is_endless ? Vec3::UnitY() : Vec3::UnitX(), s.shake_amplitude,
                              s.shake_frequency};
  while (n.fraction < wanted) {
    const bool gains = n.go_on(
        world.time(), s.densify_time, [&](double share) { bed.set_friction(share); },
        [&] { return bed.solid_fraction(); },
        [&] { shaking.run(world, n.start, [&](double seconds) { run(world, seconds); }); });
    if (!gains) break;
    stages.update(n.progress(wanted), text("solid {:.3f} of {:.3f}", n.fraction, wanted));
  }
  world.set_gravity(gravity);
  bed.set_friction(1.0);
}

/// Takes the highest grains off, presses the bed flat with the lid until the grains carry its weight within 2 % and it
/// rests (both for 10 ms), and takes the lid off. Sets bed.level to the mean height of the surface then. Single grains
/// stand out of it: the lid had stood on those, some grain's edge higher.
template <class Model>
void level(Bed<Model>& bed, double strike_off, Stages& stages) {
  const BedSettings& s = bed.settings();
  auto& world = bed.world;
  stages.begin("level", 1.0);
  NoNumbers none;
  if (const auto stage = stages.enter(world, none)) {
    std::vector<GrainId> by_height = world.grains();
    std::stable_sort(by_height.begin(), by_height.end(),
                     [&](GrainId a, GrainId b) { return world.position(a).z() > world.position(b).z(); });
    by_height.resize(static_cast<std::size_t>(strike_off * static_cast<double>(by_height.size())));
    for (const GrainId p : by_height) world.remove_grain(p);
    if (!by_height.empty()) run(world, 1e-6);  // they go with the next step
  }
  const double weight = bed.lid_weight();
  soil::Pressing n{world.time(), s.lid_speed};
  if (const auto stage = stages.enter(world, n, [&] { bed.add_lid(); })) {
    while (!n.done) {
      run(world, 1e-3);
      const double force = world.machine().sensor(bed.lid_sensor).mean().force.z;
      n.look(world.time(), force / weight, world.machine().body(bed.lid).velocity().z());
      stages.update(std::clamp(force / weight, 0.0, 1.0), text("{:.0f} Pa on the lid", force / bed.area()));
      if (!n.done && world.time() - n.start > s.stage_limit) {
        throw Stopped(
            text("the lid is not at rest after {:g} s: it carries {:.4g} N of {:.4g} N; raise --stage-limit or "
                 "--damping",
                 s.stage_limit, force, weight));
      }
    }
  }
  settle(
      world, bed.grains().edge(), s.stage_limit, "--stage-limit", stages, [] { return 1.0; },
      [&] { bed.take_lid_off(); });
  const SurfaceProfile surface = surface_profile(soil::placements(world), bed.grains().half_edge, -0.5 * s.length,
                                                 0.5 * s.length, -0.5 * s.width, 0.5 * s.width);
  bed.level = mean_surface(std::span(&surface, 1));
}

/// Stages of progress in make_bed.
inline int bed_stages(const BedSettings& s) { return 2 + (s.is_rained() && s.relative_density > 0.0 ? 2 : 0); }

/// A levelled bed of these grains, which come to rest first.
template <class Model>
Bed<Model> make_bed(const BedSettings& s, const GrainSettings& grains, const typename Model::Shape& shape, bool halves,
                    const soil::Packing& start, Stages& stages) {
  const bool made = s.is_rained();
  Bed<Model> bed(s, grains, shape, {.halves = halves, .wall_top = walls_for(start, grains)}, start.grains);
  const auto kept = stages.keep("bed", bed);
  stages.begin(made ? "rain" : "settle", 1.0);
  const double high = mean_height(bed.world), low = 0.5 * s.depth;
  const double fall_speed = made ? s.fall_speed : 0.0;
  const double fall = fall_speed > 0.0 ? 2.0 * high / fall_speed : 0.0;  // s
  settle(
      bed.world, grains.edge(), s.stage_limit + fall, "--stage-limit", stages,
      [&] { return made ? fallen_share(bed.world, high, low) : 0.0; }, [] {}, fall_speed);
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
          text("rained{}, seed {}, relative density {:g} asked for, levelled{}", fall_text(s), s.seed,
               s.relative_density, Bed<Model>::is_endless ? text(", {}", repeating_note) : ""),
          soil::placements(bed.world),
          "cube8"};
}

/// How many grains are rained into a bed. Throws Error if they do not fit into the box, or into the machine with so
/// many `copies` of the bed, for runs side by side. A grain takes 1.9 to 2.4 kB in a bed of 200,000 to 450,000 cubes,
/// and 1.4 kB in a copy.
inline std::uint64_t affordable_grains(const BedSettings& s, const GrainSettings& grains, double volume,
                                       int copies = 0) {
  const std::uint64_t count = grains_in(s, grains, volume);
  const std::string what =
      copies > 1 ? text("{} grains, in {} runs side by side,", count, copies) : text("{} grains", count);
  require_memory((2000.0 + 1400.0 * copies) * static_cast<double>(count), what.c_str(),
                 copies > 1 ? "take fewer --threads, larger grains (--half-edge) or a smaller bed"
                            : "take larger grains (--half-edge) or a smaller bed");
  return count;
}

/// The grains of a bed before they are rained. Throws Error if they do not fit into the box or the machine.
inline soil::Packing bed_grains(const BedSettings& s, const GrainSettings& grains, double volume,
                                double bounding_radius) {
  const std::uint64_t count = affordable_grains(s, grains, volume);
  soil::Packing p{grains.half_edge, s.length, s.width, {}, {}, "cube8"};
  p.grains = soil::random_lattice(count, grains.half_edge, s.length, s.width, s.seed, 0.05, bounding_radius);
  return p;
}

}  // namespace dem::rig
