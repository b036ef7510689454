#pragma once

#include <dem/rig/affordable.hpp>
#include <dem/rig/direct_shear/density.hpp>
#include <dem/soil/lattice.hpp>

#include <algorithm>
#include <numbers>
#include <span>
#include <vector>

// What a run starts from, and all that can be refused of it without a step.

namespace dem::rig::direct_shear {

/// Throws Error if the grains stand out of the box; returns the height (m) that they reach.
inline double require_in_box(std::span<const soil::Placement> grains, const Settings& s, double bounding_radius) {
  double highest = 0.0;
  for (const auto& g : grains) highest = std::max(highest, g.position.z());
  highest += bounding_radius;
  if (highest > s.box_height) {
    fail(
        "the specimen is {:.1f} mm tall, but the box {:.1f} mm; take fewer grains, a denser packing, or a higher "
        "--box-height",
        1e3 * highest, 1e3 * s.box_height);
  }
  return highest;
}

/// The grains as they are before they are poured: a random cloud or a tilted block. Throws Error if they do not fit.
inline std::vector<soil::Placement> lattice(const Settings& s, double bounding_radius) {
  if (s.packing == "poured") {
    return soil::tilted_block(s.grains, s.half_edge, s.box_length, s.box_width, s.tilt_deg * std::numbers::pi / 180.0);
  }
  return soil::random_lattice(s.grains, s.half_edge, s.box_length, s.box_width, s.seed, 0.05, bounding_radius);
}

/// Throws Error if the grains cannot have place in the box or in memory, or, where they are made as dense as asked for,
/// are too few for a density to be measured. `volume` (m^3) is that of a grain.
inline void check_amount(const Settings& s, double volume) {
  const double solid = solid_height(s, volume);
  if (solid > s.box_height) {
    fail(
        "{} grains fill the box {:.1f} mm high even without gaps, but --box-height is {:.1f} mm; take fewer --grains, "
        "or a higher box",
        s.grains, 1e3 * solid, 1e3 * s.box_height);
  }
  // A place, the state of a grain, and the contacts of a bed: what spheres take at the least.
  constexpr double bytes = 1000.0;
  require_memory(bytes * static_cast<double>(s.grains), text("{} grains", s.grains).c_str(),
                 "take fewer --grains, or larger ones (--half-edge)");
  if (s.packing != "random" || s.relative_density == 0.0) return;
  // Nine tenths of the centres lie below the top of the region. Densifying starts from the loosest.
  const double h = s.half_edge, high = solid / soil::solid_fraction_at(0.0, density_limits(s)),
               top = h + 0.9 * (high - 2.0 * h);
  const double least = std::min({s.box_length, s.box_width, top});
  if (least > 2.0 * measuring_margin(s)) return;
  fail(
      "--relative-density is {:g}, but {} grains in a box of {:g} x {:g} mm, about {:.1f} mm high, are too few to "
      "measure a density {:g} mm away from the walls; take more --grains or a smaller --half-edge, or let the packing "
      "be as it settles (--relative-density 0)",
      s.relative_density, s.grains, 1e3 * s.box_length, 1e3 * s.box_width, 1e3 * high, 1e3 * measuring_margin(s));
}

/// Throws Error for a --time-step that is above the largest stable one of any of the run's apparatuses, unless insisted
/// on, and for one that is so short that the run would have no end. No grain is needed for that, only what grains there
/// will be.
template <class Model>
void check_time_step(Settings s, const Grains<Model>& kind) {
  const bool insisted = s.allow_unstable_time_step;
  s.allow_unstable_time_step = true;  // the world takes it, and is asked
  const auto check = [&](double lid_mass, double duration, const char* what, const char* what_to_change) {
    Apparatus<Model> rig(
        s, kind, {.seam = 0.5 * s.box_height, .wall_top = s.box_height, .lid_mass = lid_mass, .lid_low = s.box_height},
        {});
    rig.world.prepare();
    require_steps(
        duration, rig.world.time_step(), what,
        text("take larger grains (--half-edge), a longer --time-step, a lower --stiffness or {}", what_to_change)
            .c_str());
    const auto limit = rig.world.stable_time_step();
    if (insisted || rig.world.time_step() <= limit.dt) return;
    fail(
        "--time-step is {:g} s, but must be at most {:.4g} s, the largest stable one (limited by {}); lower it, leave "
        "it out for a share of the stable one, or insist with --allow-unstable-time-step",
        s.time_step, limit.dt, limit.limited_by);
  };
  if (s.packing_file.empty()) {
    const bool shaken = s.packing == "poured", made_denser = !shaken && s.relative_density > 0.0;
    const double pouring = 0.1;  // s, at the least
    check(Height{}.lid_mass,
          pouring + (shaken        ? s.shake_time
                     : made_denser ? s.densify_time
                                   : 0.0),
          "the packing",
          shaken        ? "less --shake-time"
          : made_denser ? "less --densify-time"
                        : "fewer --grains");
  }
  for (const double load : s.loads) check(load, s.travel / s.shear_speed, "the test", "less --travel");
}

}  // namespace dem::rig::direct_shear
