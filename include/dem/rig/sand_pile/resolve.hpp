#pragma once

#include <dem/rig/contact_options.hpp>
#include <dem/rig/sand_pile/settings.hpp>
#include <dem/rig/sizes.hpp>

#include <cmath>
#include <numbers>

namespace dem::rig::sand_pile {

namespace detail {

struct Defaults {
  double half_edge, rest_limit, creep_time;
  std::uint64_t grains, seeds;
  const char* kinds;
};

inline Defaults defaults(Size size) {
  return BySize<Defaults>{
      .smoke = {3.0e-3, 0.3, 0.1, 250, 1, "cube8,sphere-rolling"},
      .quick = {1.6e-3, 0.6, 1.0, 1200, 1, "cube8,cube8-viscous,sphere,sphere-rolling"},
      .full = {0.9e-3, 1.0, 10.0, 12000, 3,
               "cube8,cube8-viscous,polyhedron,superquadric,sphere,sphere-viscous,sphere-rolling"}}[size];
}

inline void check(const Settings& s) {
  if (s.method != "lift" && s.method != "funnel" && s.method != "drain") {
    fail("--method is '{}', but must be lift, funnel or drain", s.method);
  }
  if (s.plate != "flat" && s.plate != "ridged") fail("--plate is '{}', but must be flat or ridged", s.plate);
  require_within(static_cast<double>(s.grains), 10.0, 1e7, "--grains (0: by size)");
  require_within(static_cast<double>(s.seeds), 1.0, 1000.0, "--seeds (0: by size)");
  if (!s.fill_file.empty() && s.seeds > 1) {
    fail("--seeds is {}, but must be 1 with --fill-file: all of them would be the same pile", s.seeds);
  }
  require_within(s.half_edge, 1e-6, 1.0, "--half-edge (m, 0: by size)");
  require_positive(s.density, "--density", "kg/m^3");
  const double d = 2.0 * s.half_edge;
  const bool drains = s.method == "drain";
  if (!drains)
    require_within(s.cylinder_radius, 2.0 * d, 1e3 * d, "--cylinder-radius (m, from two grains to a thousand)");
  // On a wider floor the rows of the lattice that grains fall from may end before enough of them lie in the cylinder.
  const double widest = 2.5 * d * std::sqrt(static_cast<double>(s.grains));
  if (!drains && s.cylinder_radius > widest) {
    fail(
        "--cylinder-radius is {:g} m, but must be at most {:.3g} m, for {} grains of half-edge {:g} m to cover a "
        "twentieth of its floor; lower it, or give more --grains",
        s.cylinder_radius, widest, s.grains, s.half_edge);
  }
  if (!drains) require_within(s.plate_radius, s.cylinder_radius, 4e3 * d, "--plate-radius (m, from the cylinder's up)");
  require_within(s.lift_speed, 1e-3, 10.0, "--lift-speed (m/s)");
  if (s.method == "funnel") {
    require_within(s.orifice_radius, 1.5 * d, 0.9 * s.cylinder_radius,
                   "--orifice-radius (m, from one and a half grains to nine tenths of the cylinder)");
  }
  require_positive(s.orifice_height, "--orifice-height", "m");
  require_within(s.funnel_angle_deg, 5.0, 80.0, "--funnel-angle (deg)");
  if (drains) {
    require_within(s.box_length, 4.0 * d, 4e3 * d, "--box-length (m, from four grains up)");
    require_within(s.box_width, 5.0 * d, 4e3 * d, "--box-width (m, from five grains up)");
    require_within(s.slot_width, 2.0 * d, 1e3 * d, "--slot-width (m, from two grains up)");
  }
  check_contact_options(s);
  check_constants_for(s);
  require_non_negative(s.plate_friction, "--plate-friction", "(no unit)");
  require_non_negative(s.container_friction, "--container-friction", "(no unit)");
  const double radius = sphere_radius(s.half_edge);
  require_within(s.rolling_length, 0.0, radius, "--rolling-length (m, at most the radius of a sphere)");
  require_within(s.plate_rolling_length, 0.0, radius, "--plate-rolling-length (m, at most the radius of a sphere)");
  require_non_negative(s.rolling_damping, "--rolling-damping", "(no unit)");
  require_positive(s.settle_limit, "--settle-limit", "s");
  require_positive(s.rest_limit, "--rest-limit", "s (0: by size)");
  require_positive(s.flow_limit, "--flow-limit", "s");
  require_positive(s.creep_time, "--creep-time", "s (0: by size)");
  require_within(s.sample_time, 1e-4, 0.05, "--sample-time (s, at most the 50 ms for which grains must rest)");
  require_within(s.flank_high, 0.1, 1.0, "--flank-high");
  require_within(s.flank_low, 0.0, s.flank_high - 0.05, "--flank-low (below --flank-high)");
  require_within(static_cast<double>(s.directions), 3.0, 360.0, "--directions");
  require_within(s.stable_share, 1e-3, 1.0, "--stable-share");
  require_within(s.threads, 0.0, 4096.0, "--threads (0: all)");
  require_positive(s.frame_time, "--frame-time", "s");
}

}  // namespace detail

/// m^3, that the grains fill about when they lie loosely.
inline double bulk_volume(const Settings& s) {
  return static_cast<double>(s.grains) * 8.0 * std::pow(s.half_edge, 3) / 0.6;
}

/// Fills in what depends on the size and on the number of grains, and checks every option. Throws Error.
inline void resolve(Settings& s) {
  const detail::Defaults size = detail::defaults(size_named(s.size));
  fill(s.half_edge, size.half_edge);
  fill(s.rest_limit, size.rest_limit);
  fill(s.creep_time, size.creep_time);
  if (s.grains == 0) s.grains = size.grains;
  if (s.seeds == 0) s.seeds = s.fill_file.empty() ? size.seeds : 1;
  if (s.kinds.empty()) s.kinds = size.kinds;
  kinds_in(s.kinds);
  const double volume = bulk_volume(s), pi = std::numbers::pi;
  // At least as wide as the lattice from which few grains fall needs it.
  fill(s.cylinder_radius, std::max(std::cbrt(volume / (2.0 * pi)), 6.0 * s.half_edge));
  fill(s.plate_radius, 3.0 * s.cylinder_radius);
  fill(s.orifice_radius, std::min(7.0 * s.half_edge, 0.9 * s.cylinder_radius));
  const double steep = std::tan(40.0 * pi / 180.0);
  fill(s.orifice_height, std::cbrt(3.0 * volume * steep * steep / pi) + 4.0 * s.half_edge);
  fill(s.box_width, 16.0 * s.half_edge);
  fill(s.slot_width, 12.0 * s.half_edge);
  fill(s.box_length, std::sqrt(volume / (0.7 * s.box_width)));
  if (s.plate_friction < 0.0) s.plate_friction = s.friction;
  if (s.container_friction < 0.0) s.container_friction = s.method == "drain" ? s.plate_friction : 0.0;
  fill(s.rolling_length, 0.2 * s.half_edge);
  if (s.plate_rolling_length < 0.0) s.plate_rolling_length = s.rolling_length;
  if (s.friction_stiffness < 0.0) s.friction_stiffness = s.stiffness;
  if (s.velocity_stiffness < 0.0) s.velocity_stiffness = s.damping;
  detail::check(s);
}

}  // namespace dem::rig::sand_pile
