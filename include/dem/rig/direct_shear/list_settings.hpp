#pragma once

#include <dem/rig/direct_shear/grain_kind.hpp>

#include <utility>

namespace dem::rig::direct_shear {

/// Names and values for the report.
inline std::vector<std::pair<std::string, std::string>> list_settings(const Settings& s) {
  const double k = contact_scale(s);
  std::string loads;
  for (const double load : s.loads) loads += (loads.empty() ? "" : ", ") + text("{}", load);
  const auto mm = [](double metres) { return text("{:g} mm", 1e3 * metres); };
  return {
      {"size", s.size},
      {"grains",
       text("{} {}", s.packing_file.empty() ? std::to_string(s.grains) : "the packing file's", kind_of(s).plural)},
      {"half-edge", mm(s.half_edge)},
      {"grain density", text("{:g} kg/m³", s.density)},
      {"box", text("{:g} x {:g} x {:g} mm", 1e3 * s.box_length, 1e3 * s.box_width, 1e3 * s.box_height)},
      {"normal stiffness K", text("{:g} N/m (given {:g} for {})", k * s.stiffness, s.stiffness, mm(s.constants_for))},
      {"normal damping C", text("{:g} N s/m (given {:g})", k * k * s.damping, s.damping)},
      {"separation factor Sp", text("{:g}", s.separation_factor)},
      {"friction, grain on grain", text("{:g}", s.friction)},
      {"friction, grain on wall", text("{:g}", s.wall_friction)},
      {"friction stiffness kt", text("{:g} N/m (given {:g})", k * s.friction_stiffness, s.friction_stiffness)},
      {"velocity stiffness cv", text("{:g} N s/m (given {:g})", k * k * s.velocity_stiffness, s.velocity_stiffness)},
      {"asperity breaking factor", text("{:g}", s.breaking_factor)},
      {"packing", !s.packing_file.empty() ? "from " + s.packing_file.substr(s.packing_file.rfind('/') + 1)
                  : s.packing == "poured"
                      ? text("poured block, tilted by {:g}° about each axis", s.tilt_deg)
                      : text("random, seed {}, relative density {:g} asked for", s.seed, s.relative_density)},
      {"struck off", s.strike_off > 0.0 ? text("the highest {:g} % of the grains", 1e2 * s.strike_off) : "none"},
      {"loads", loads + " kg"},
      {"shearing", text("{:g} mm at {:g} mm/s", 1e3 * s.travel, 1e3 * s.shear_speed)},
      {"stresses are forces over",
       s.area_correction ? "the area of contact of the halves" : "the nominal area of the box"},
      {"maximum is of the mean over", mm(s.smoothing)},
      {"integrator", s.integrator},
  };
}

}  // namespace dem::rig::direct_shear
