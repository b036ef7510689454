#pragma once

#include "making.hpp"
#include "option_names.hpp"

#include <dem/io/file.hpp>
#include <dem/soil/lattice.hpp>
#include <dem/soil/packing_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <span>
#include <vector>

// What a run starts from, and all that can be refused of it before an earlier run's results are touched.

namespace direct_shear {

/// Throws Error if the grains stand out of the box; returns the height (m) that they reach.
template <class Shape>
double require_in_box(std::span<const dem::soil::Placement> grains, const Settings& s) {
  double highest = 0.0;
  for (const auto& g : grains) highest = std::max(highest, g.position.z());
  highest += Grain<Shape>::make(s.half_edge).bounding_radius();
  if (highest > s.box_height) {
    dem::fail(
        "the specimen is {:.1f} mm tall, but the box {:.1f} mm; take fewer grains, a denser packing, or a higher "
        "--box-height",
        1e3 * highest, 1e3 * s.box_height);
  }
  return highest;
}

/// Reads --packing-file. Throws Error if it is no packing, or not one of these grains in this box.
inline dem::soil::Packing read_packing(const Settings& s) {
  auto packing = dem::soil::load_packing(s.packing_file);
  if (packing.grains.empty()) {
    dem::fail("the packing '{}' has no grains, but must have at least one; give another --packing-file",
              s.packing_file);
  }
  if (packing.shape != s.shape) {
    dem::fail(
        "the packing '{}' is one of grains of shape {}, but --shape is {}: other grains in these places would overlap; "
        "give --shape {}, or leave --packing-file out",
        s.packing_file, packing.shape, s.shape, packing.shape);
  }
  const auto differs = [](double a, double b) { return std::abs(a - b) > 1e-9; };
  if (differs(packing.half_edge, s.half_edge) || differs(packing.length_x, s.box_length) ||
      differs(packing.length_y, s.box_width)) {
    dem::fail(
        "the packing '{}' has grains of half-edge {:g} m in a box of {:g} x {:g} m, but the settings say {:g} m in "
        "{:g} x {:g} m; give --half-edge {:g} --box-length {:g} --box-width {:g}",
        s.packing_file, packing.half_edge, packing.length_x, packing.length_y, s.half_edge, s.box_length, s.box_width,
        packing.half_edge, packing.length_x, packing.length_y);
  }
  return packing;
}

/// The grains as they are before they are poured: a random cloud or a tilted block. Throws Error if they do not fit.
template <class Shape>
std::vector<dem::soil::Placement> lattice(const Settings& s) {
  if (s.packing == "poured") {
    return dem::soil::tilted_block(s.grains, s.half_edge, s.box_length, s.box_width,
                                   s.tilt_deg * std::numbers::pi / 180.0);
  }
  return dem::soil::random_lattice(s.grains, s.half_edge, s.box_length, s.box_width, s.seed, 0.05,
                                   Grain<Shape>::make(s.half_edge).bounding_radius());
}

/// Throws Error if the grains cannot have place in the box, or, where they are made as dense as asked for, are too few
/// for a density to be measured.
template <class Shape>
void check_amount(const Settings& s) {
  const double solid = solid_height<Shape>(s);
  if (solid > s.box_height) {
    dem::fail(
        "{} grains fill the box {:.1f} mm high even without gaps, but --box-height is {:.1f} mm; take fewer --grains, "
        "or a higher box",
        s.grains, 1e3 * solid, 1e3 * s.box_height);
  }
  if (s.packing != "random" || s.relative_density == 0.0) return;
  // Nine tenths of the centres lie below the top of the region. Densifying starts from the loosest.
  const double h = s.half_edge, high = solid / dem::soil::solid_fraction_at(0.0, density_limits(s)),
               top = h + 0.9 * (high - 2.0 * h);
  const double least = std::min({s.box_length, s.box_width, top});
  if (least > 2.0 * measuring_margin(s)) return;
  dem::fail(
      "--relative-density is {:g}, but {} grains in a box of {:g} x {:g} mm, about {:.1f} mm high, are too few to "
      "measure a density {:g} mm away from the walls; take more --grains or a smaller --half-edge, or let the packing "
      "be as it settles (--relative-density 0)",
      s.relative_density, s.grains, 1e3 * s.box_length, 1e3 * s.box_width, 1e3 * high, 1e3 * measuring_margin(s));
}

/// Throws Error for a --time-step that is above the largest stable one of any of the run's rigs, unless insisted on.
/// No grain is needed for that, only what grains there will be.
template <class Integrator, class Shape>
void check_time_step(Settings s) {
  const bool insisted = s.allow_unstable_time_step;
  s.allow_unstable_time_step = true;  // the rig takes it, and is asked
  const auto check = [&](double lid_mass) {
    Rig<Integrator, Shape> rig(
        s, {.seam = 0.5 * s.box_height, .wall_top = s.box_height, .lid_mass = lid_mass, .lid_low = s.box_height}, {});
    rig.world.prepare();
    const auto limit = rig.world.stable_time_step();
    if (insisted || rig.world.time_step() <= limit.dt) return;
    dem::fail(
        "--time-step is {:g} s, but must be at most {:.4g} s, the largest stable one (limited by {}); lower it, leave "
        "it out for a share of the stable one, or insist with --allow-unstable-time-step",
        s.time_step, limit.dt, limit.limited_by);
  };
  if (s.packing_file.empty()) check(RigShape{}.lid_mass);
  for (const double load : s.loads) check(load);
}

/// Throws Error unless a file can be written there; an older one stays as it is.
inline void check_writable(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    dem::fail("'{}' is a folder, but a file is to be written there; give another path", file.string());
  }
  dem::io::AtomicFile{file};  // is gone again, for it is not committed
}

/// Checks all that can be checked before the run, and returns what it starts from: the packing of --packing-file, or
/// the grains to be poured. Throws Error.
template <class Integrator, class Shape>
dem::soil::Packing start(const Settings& s) {
  const bool made = s.packing_file.empty();
  dem::soil::Packing packing;
  if (made) {
    check_amount<Shape>(s);
    packing = {s.half_edge, s.box_length, s.box_width, {}, lattice<Shape>(s), s.shape};
  } else {
    packing = read_packing(s);
    if (!s.loads.empty()) require_in_box<Shape>(packing.grains, s);
  }
  check_time_step<Integrator, Shape>(s);
  if (made) check_writable(s.save_packing);
  check_writable(s.output / "settings.toml");
  return packing;
}

}  // namespace direct_shear
