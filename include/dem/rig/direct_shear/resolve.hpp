#pragma once

#include <dem/rig/affordable.hpp>
#include <dem/rig/contact_options.hpp>
#include <dem/rig/direct_shear/grain_kind.hpp>
#include <dem/rig/sizes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace dem::rig::direct_shear {

namespace detail {

inline constexpr double most_grains = 1e8;

struct Defaults {
  double half_edge, shear_speed, travel;
  std::vector<double> loads;
};

/// Speeds keep the inertial number at the lightest load below 1e-3. The coarse grains of `quick` go as far as their
/// strength takes to build up and no farther: later they wedge, see examples/direct_shear/RESULTS.md.
inline Defaults defaults(Size size) {
  return BySize<Defaults>{.smoke = {3.0e-3, 0.020, 2e-3, {16.2}},
                          .quick = {1.6e-3, 0.020, 4e-3, {6.2, 16.2, 26.2}},
                          .full = {0.9e-3, 0.020, 6e-3, {6.2, 16.2, 26.2}}}[size];
}

inline void check_specimen(const Settings& s) {
  require_positive(s.box_length, "--box-length", "m");
  require_positive(s.box_width, "--box-width", "m");
  require_positive(s.box_height, "--box-height", "m");
  require_positive(s.half_edge, "--half-edge", "m (0: by size)");
  require_within(s.half_edge, 0.0, 0.5 * std::min(s.box_length, s.box_width), "--half-edge (m, within the box)");
  if (!(s.seam_height >= 0.0 && s.seam_height < s.box_height)) {
    fail("--seam-height is {:g} m, but must be 0 (half the specimen) or between 0 and the box height, {:g} m",
         s.seam_height, s.box_height);
  }
  // Ten samples at the least: one is taken every hundredth of a millimetre.
  require_within(s.travel, 1e-4, 0.5 * s.box_length, "--travel (m, at most half the box length; 0: by size)");
  // A thinner rim would let the halves slide open.
  require_within(s.wall_thickness, s.travel, 10.0, "--wall-thickness (m, from the travel up)");
  require_within(s.lid_clearance, 0.0, 0.99, "--lid-clearance");
  require_within(s.relative_density, 0.0, 1.0, "--relative-density");
  require_within(s.strike_off, 0.0, 0.9, "--strike-off");
  require_within(s.tilt_deg, 0.0, 90.0, "--tilt (deg)");
  // Beyond the walls the grains would leave the world.
  require_within(s.shake_amplitude, 0.0, s.wall_thickness, "--shake-amplitude (m, up to the wall thickness)");
  require_within(s.shake_frequency, 0.1, 1000.0, "--shake-frequency (Hz)");
  require_non_negative(s.shake_time, "--shake-time", "s");
  require_positive(s.densify_time, "--densify-time", "s");
  require_positive(s.settle_limit, "--settle-limit", "s");
}

inline void check_contacts(const Settings& s) {
  check_contact_options(s, "N/m (0: by shape)");
  require_non_negative(s.wall_friction, "--wall-friction", "(no unit)");
  require_positive(s.density, "--density", "kg/m^3");
}

inline void check_test(const Settings& s) {
  require_positive(s.shear_speed, "--shear-speed", "m/s (0: by size)");
  require_within(s.ramp_time, 0.0, s.travel / s.shear_speed, "--ramp-time (s, at most what the travel takes)");
  require_within(s.smoothing, 0.0, 0.5 * s.travel, "--smoothing (m, at most half the travel)");
  require_within(s.residual_share, 0.01, 1.0, "--residual-share");
  require_positive(s.lid_speed, "--lid-speed", "m/s");
  require_positive(s.rest_speed, "--rest-speed", "m/s");
  require_positive(s.consolidation_limit, "--consolidation-limit", "s");
  for (std::size_t k = 0; k < s.loads.size(); ++k) {
    require_positive(s.loads[k], "a mass of --loads", "kg");
    for (std::size_t other = 0; other < k; ++other) {
      if (load_name(s, s.loads[other]) != load_name(s, s.loads[k])) continue;
      fail(
          "the masses {:g} and {:g} kg of --loads differ by less than 0.1 kPa, and both would be called {}; leave "
          "one out",
          s.loads[other], s.loads[k], load_name(s, s.loads[k]));
    }
  }
  if (!s.own_kind && s.shape != "cube8" && s.integrator != "verlet") {
    fail("--integrator is '{}', but --shape {} runs with verlet only", s.integrator, s.shape);
  }
  require_non_negative(s.time_step, "--time-step", "s (0: a share of the largest stable one)");
  require_within(s.stable_share, 1e-3, 1.0, "--stable-share");
  require_positive(s.overlap_limit, "--overlap-limit", "effective diameters");
  require_within(s.threads, 0.0, 4096.0, "--threads (0: all)");
  require_positive(s.vtk_interval, "--vtk-interval", "m (0: a twentieth of the travel)");
}

}  // namespace detail

/// Fills in what depends on the size and on the kind of grain, and checks every option against its range. Throws Error.
inline void resolve(Settings& s) {
  const detail::Defaults size = detail::defaults(size_named(s.size));
  fill(s.half_edge, size.half_edge);
  fill(s.shear_speed, size.shear_speed);
  fill(s.travel, size.travel);
  fill(s.wall_thickness, std::max(0.015, 2.0 * s.travel));
  fill(s.vtk_interval, s.travel / 20.0);
  const GrainKind& kind = kind_of(s);
  fill(s.stiffness, kind.stiffness);
  if (s.damping < 0.0) s.damping = kind.damping;
  if (s.relative_density < 0.0) s.relative_density = kind.relative_density;
  if (s.strike_off < 0.0) s.strike_off = kind.strike_off;
  if (s.velocity_stiffness < 0.0) s.velocity_stiffness = s.damping;
  if (s.wall_friction < 0.0) s.wall_friction = s.friction;
  if (s.friction_stiffness < 0.0) s.friction_stiffness = s.stiffness;
  if (s.packing_only) s.loads.clear();
  else if (s.loads.empty()) s.loads = size.loads;
  if (s.save_packing.empty()) s.save_packing = (s.output.empty() ? "" : s.output + "/") + "packing.txt";
  detail::check_specimen(s);
  detail::check_contacts(s);
  detail::check_test(s);

  if (s.grains == 0) {
    const double fill_height = 14256.0 * std::pow(0.9e-3, 3) / (0.06 * 0.06);
    const double count = std::round(fill_height * s.area() / std::pow(s.half_edge, 3));
    if (!(count >= 1.0 && count <= detail::most_grains)) {
      fail(
          "{:g} grains of --half-edge {:g} m fill a box of {:g} x {:g} mm, but there must be 1 to {:g}; change "
          "--half-edge, or give --grains",
          count, s.half_edge, 1e3 * s.box_length, 1e3 * s.box_width, detail::most_grains);
    }
    s.grains = static_cast<std::uint64_t>(count);
  }
  require_within(static_cast<double>(s.grains), 1.0, detail::most_grains, "--grains (0: by size)");
  if (s.threads == 0) s.threads = threads_for(s.grains);
}

}  // namespace dem::rig::direct_shear
