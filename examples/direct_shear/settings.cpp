#include "settings.hpp"

#include "config_file.hpp"
#include "options.hpp"

#include <dem/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

namespace direct_shear {

namespace {

struct Size {
  const char* name;
  double half_edge, shear_speed, travel;
  std::vector<double> loads;
};

const Size& size_named(const std::string& name) {
  // Speeds keep the inertial number at the lightest load below 1e-3.
  static const std::vector<Size> sizes = {{"smoke", 3.0e-3, 0.020, 2e-3, {16.2}},
                                          {"quick", 1.6e-3, 0.020, 6e-3, {6.2, 16.2, 26.2}},
                                          {"full", 0.9e-3, 0.020, 6e-3, {6.2, 16.2, 26.2}}};
  for (const Size& size : sizes) {
    if (name == size.name) return size;
  }
  dem::fail("--size is '{}', but must be smoke, quick or full", name);
}

struct GrainShape {
  const char *name, *plural;
  double stiffness, damping;  ///< K (N/m), C and cv (N s/m)
  double relative_density;    ///< looser sharp or rounded cubes leave columns in corners that stand out of the box
  double strike_off;
  dem::soil::DensityLimits limits;
};

const GrainShape& shape_of(const Settings& s) {
  static const GrainShape shapes[] = {
      {"cube8", "cubes of 8 spheres", 2e4, 0.015, 0.18, 0.0, dem::soil::cube8_limits},
      {"polyhedron", "polyhedral cubes", 8e4, 0.06, 0.5, 0.18, dem::soil::sharp_cube_limits},
      {"superquadric", "superquadric cubes", 8e4, 0.06, 0.5, 0.0, dem::soil::rounded_cube_limits}};
  for (const GrainShape& shape : shapes) {
    if (s.shape == shape.name) return shape;
  }
  dem::fail("--shape is '{}', but must be cube8, polyhedron or superquadric", s.shape);
}

void check_specimen(const Settings& s) {
  dem::require_positive(s.box_length, "--box-length", "m");
  dem::require_positive(s.box_width, "--box-width", "m");
  dem::require_positive(s.box_height, "--box-height", "m");
  dem::require_positive(s.half_edge, "--half-edge", "m (0: by size)");
  dem::require_within(s.half_edge, 0.0, 0.5 * std::min(s.box_length, s.box_width), "--half-edge (m, within the box)");
  if (!(s.seam_height >= 0.0 && s.seam_height < s.box_height)) {
    dem::fail("--seam-height is {:g} m, but must be 0 (half the specimen) or between 0 and the box height, {:g} m",
              s.seam_height, s.box_height);
  }
  // Ten samples at the least: one is taken every hundredth of a millimetre.
  dem::require_within(s.travel, 1e-4, 0.5 * s.box_length, "--travel (m, at most half the box length; 0: by size)");
  // A thinner rim would let the halves slide open.
  dem::require_within(s.wall_thickness, s.travel, 10.0, "--wall-thickness (m, from the travel up)");
  dem::require_within(s.lid_clearance, 0.0, 0.99, "--lid-clearance");
  dem::require_within(s.relative_density, 0.0, 1.0, "--relative-density");
  dem::require_within(s.strike_off, 0.0, 0.9, "--strike-off");
  dem::require_within(s.tilt_deg, 0.0, 90.0, "--tilt (deg)");
  // Beyond the walls the grains would leave the world.
  dem::require_within(s.shake_amplitude, 0.0, s.wall_thickness, "--shake-amplitude (m, up to the wall thickness)");
  dem::require_within(s.shake_frequency, 0.1, 1000.0, "--shake-frequency (Hz)");
  dem::require_non_negative(s.shake_time, "--shake-time", "s");
  dem::require_positive(s.densify_time, "--densify-time", "s");
  dem::require_positive(s.settle_limit, "--settle-limit", "s");
}

void check_contacts(const Settings& s) {
  dem::require_positive(s.stiffness, "--stiffness", "N/m (0: by shape)");
  dem::require_non_negative(s.damping, "--damping", "N s/m");
  dem::require_within(s.separation_factor, 0.0, 1.0, "--separation-factor");
  dem::require_non_negative(s.friction, "--friction", "(no unit)");
  dem::require_non_negative(s.wall_friction, "--wall-friction", "(no unit)");
  dem::require_non_negative(s.friction_stiffness, "--friction-stiffness", "N/m");
  dem::require_non_negative(s.velocity_stiffness, "--velocity-stiffness", "N s/m");
  dem::require_within(s.breaking_factor, 0.0, 1.0, "--breaking-factor");
  dem::require_positive(s.density, "--density", "kg/m^3");
  dem::require_positive(s.constants_for, "--constants-for", "m");
}

void check_test(const Settings& s) {
  dem::require_positive(s.shear_speed, "--shear-speed", "m/s (0: by size)");
  dem::require_within(s.ramp_time, 0.0, s.travel / s.shear_speed, "--ramp-time (s, at most what the travel takes)");
  dem::require_within(s.smoothing, 0.0, 0.5 * s.travel, "--smoothing (m, at most half the travel)");
  dem::require_within(s.residual_share, 0.01, 1.0, "--residual-share");
  dem::require_positive(s.lid_speed, "--lid-speed", "m/s");
  dem::require_positive(s.rest_speed, "--rest-speed", "m/s");
  dem::require_positive(s.consolidation_limit, "--consolidation-limit", "s");
  std::map<std::string, double> names;
  for (const double load : s.loads) {
    dem::require_positive(load, "a mass of --loads", "kg");
    const auto [other, is_new] = names.emplace(load_name(s, load), load);
    if (!is_new) {
      dem::fail(
          "the masses {:g} and {:g} kg of --loads differ by less than 0.1 kPa, and both would be called {}; leave "
          "one out",
          other->second, load, other->first);
    }
  }
  if (s.shape != "cube8" && s.integrator != "verlet") {
    dem::fail("--integrator is '{}', but --shape {} runs with verlet only", s.integrator, s.shape);
  }
  dem::require_non_negative(s.time_step, "--time-step", "s (0: a share of the largest stable one)");
  dem::require_within(s.stable_share, 1e-3, 1.0, "--stable-share");
  dem::require_positive(s.overlap_limit, "--overlap-limit", "effective diameters");
  dem::require_within(s.threads, 0.0, 4096.0, "--threads (0: all)");
  dem::require_positive(s.vtk_interval, "--vtk-interval", "m (0: a twentieth of the travel)");
}

}  // namespace

bool read_settings(int argc, char** argv, Settings& s, std::string& config) {
  CLI::App app{"Direct shear test of cubical sand grains: shear strength at several normal stresses"};
  app.set_config("--config", "", "TOML file with any of these options");
  const auto toml = std::make_shared<StrictToml>(app);
  app.config_formatter(toml);
  app.footer(
      "Ends with 0 when all was done, 1 when the run ended early or a part of the report could not be made, 2 when the "
      "settings make no sense (results of an earlier run are then still there), 130 after Ctrl-C. What was found by "
      "then "
      "is saved and reported.");
  app.add_option("--size", s.size, "smoke (seconds), quick (minutes) or full (14256 grains)")->capture_default_str();
  add_specimen_options(app, s);
  add_contact_options(app, s);
  add_test_options(app, s);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return false;
  } catch (const CLI::ParseError& e) {
    dem::fail("{} (--help lists the options)", e.what());
  }
  const auto idle = idle_options(s);
  refuse_idle(idle, app, *toml);
  config = all_that_counts(app, idle);
  resolve(s);
  return true;
}

void resolve(Settings& s) {
  const Size& size = size_named(s.size);
  const auto fill = [](double& value, double by_size) {
    if (value == 0.0) value = by_size;
  };
  fill(s.half_edge, size.half_edge);
  fill(s.shear_speed, size.shear_speed);
  fill(s.travel, size.travel);
  fill(s.wall_thickness, std::max(0.015, 2.0 * s.travel));
  fill(s.vtk_interval, s.travel / 20.0);
  const GrainShape& shape = shape_of(s);
  fill(s.stiffness, shape.stiffness);
  if (s.damping < 0.0) s.damping = shape.damping;
  if (s.relative_density < 0.0) s.relative_density = shape.relative_density;
  if (s.strike_off < 0.0) s.strike_off = shape.strike_off;
  if (s.velocity_stiffness < 0.0) s.velocity_stiffness = shape.damping;
  if (s.wall_friction < 0.0) s.wall_friction = s.friction;
  if (s.friction_stiffness < 0.0) s.friction_stiffness = s.stiffness;
  if (s.packing_only) s.loads.clear();
  else if (s.loads.empty()) s.loads = size.loads;
  if (s.save_packing.empty()) s.save_packing = (s.output / "packing.txt").string();
  check_specimen(s);
  check_contacts(s);
  check_test(s);

  if (s.grains == 0) {
    const double fill_height = 14256.0 * std::pow(0.9e-3, 3) / (0.06 * 0.06);
    s.grains = static_cast<std::uint64_t>(std::llround(fill_height * s.area() / std::pow(s.half_edge, 3)));
  }
  dem::require_within(static_cast<double>(s.grains), 1.0, 1e8, "--grains (0: by size)");
  if (s.threads == 0) {
    const auto cores = static_cast<std::uint64_t>(omp_get_max_threads());  // OMP_NUM_THREADS counts
    s.threads = static_cast<int>(std::clamp<std::uint64_t>(s.grains / 1000, 1, std::max<std::uint64_t>(1, cores)));
  }
}

const dem::soil::DensityLimits& density_limits(const Settings& s) { return shape_of(s).limits; }

std::string load_name(const Settings& s, double load) {
  return fmt::format("load_{:.1f}kPa", 1e-3 * s.normal_stress(load));
}

double contact_scale(const Settings& s) { return s.scale_contacts ? s.half_edge / s.constants_for : 1.0; }

std::vector<std::pair<std::string, std::string>> list_settings(const Settings& s) {
  const double k = contact_scale(s);
  const auto mm = [](double metres) { return fmt::format("{:g} mm", 1e3 * metres); };
  return {
      {"size", s.size},
      {"grains", fmt::format("{} {}", s.packing_file.empty() ? std::to_string(s.grains) : "the packing file's",
                             shape_of(s).plural)},
      {"half-edge", mm(s.half_edge)},
      {"grain density", fmt::format("{:g} kg/m³", s.density)},
      {"box", fmt::format("{:g} x {:g} x {:g} mm", 1e3 * s.box_length, 1e3 * s.box_width, 1e3 * s.box_height)},
      {"normal stiffness K",
       fmt::format("{:g} N/m (given {:g} for {})", k * s.stiffness, s.stiffness, mm(s.constants_for))},
      {"normal damping C", fmt::format("{:g} N s/m (given {:g})", k * k * s.damping, s.damping)},
      {"separation factor Sp", fmt::format("{:g}", s.separation_factor)},
      {"friction, grain on grain", fmt::format("{:g}", s.friction)},
      {"friction, grain on wall", fmt::format("{:g}", s.wall_friction)},
      {"friction stiffness kt", fmt::format("{:g} N/m (given {:g})", k * s.friction_stiffness, s.friction_stiffness)},
      {"velocity stiffness cv",
       fmt::format("{:g} N s/m (given {:g})", k * k * s.velocity_stiffness, s.velocity_stiffness)},
      {"asperity breaking factor", fmt::format("{:g}", s.breaking_factor)},
      {"packing", !s.packing_file.empty() ? "from " + std::filesystem::path(s.packing_file).filename().string()
                  : s.packing == "poured"
                      ? fmt::format("poured block, tilted by {:g}° about each axis", s.tilt_deg)
                      : fmt::format("random, seed {}, relative density {:g} asked for", s.seed, s.relative_density)},
      {"struck off", s.strike_off > 0.0 ? fmt::format("the highest {:g} % of the grains", 1e2 * s.strike_off) : "none"},
      {"loads", fmt::format("{} kg", fmt::join(s.loads, ", "))},
      {"shearing", fmt::format("{:g} mm at {:g} mm/s", 1e3 * s.travel, 1e3 * s.shear_speed)},
      {"stresses are forces over",
       s.area_correction ? "the area of contact of the halves" : "the nominal area of the box"},
      {"maximum is of the mean over", mm(s.smoothing)},
      {"integrator", s.integrator},
  };
}

}  // namespace direct_shear
