#pragma once

#include <dem/rig/direct_shear/grain_kind.hpp>

#include <fmt/ranges.h>

#include <utility>

namespace dem::rig::direct_shear {

/// Names and values for the report.
inline std::vector<std::pair<std::string, std::string>> list_settings(const Settings& s) {
  const double k = contact_scale(s);
  const auto mm = [](double metres) { return fmt::format("{:g} mm", 1e3 * metres); };
  return {
      {"size", s.size},
      {"grains", fmt::format("{} {}", s.packing_file.empty() ? std::to_string(s.grains) : "the packing file's",
                             kind_of(s).plural)},
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
      {"packing", !s.packing_file.empty() ? "from " + s.packing_file.substr(s.packing_file.rfind('/') + 1)
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

}  // namespace dem::rig::direct_shear
