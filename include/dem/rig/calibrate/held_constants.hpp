#pragma once
// What a search leaves alone of the grains: constants that all its rigs have in common.

#include <dem/rig/bed/grain_settings.hpp>
#include <dem/rig/options.hpp>

namespace dem::rig::calibrate {

/// Constants of the grains that are not looked for, in SI units, as the options of the rigs: a negative one is as each
/// rig has it.
struct HeldConstants {
  double half_edge = -1.0;           ///< m
  double density = -1.0;             ///< kg/m^3
  double stiffness = -1.0;           ///< K, N/m
  double damping = -1.0;             ///< C, N s/m
  double separation_factor = -1.0;   ///< Sp
  double friction = -1.0;            ///< mu, grain on grain
  double wall_friction = -1.0;       ///< mu, grain on wall, and on the plate that a pile stands on
  double friction_stiffness = -1.0;  ///< kt, N/m
  double velocity_stiffness = -1.0;  ///< cv, N s/m
  double breaking_factor = -1.0;     ///< share of the friction that a broken asperity keeps
  double constants_for = -1.0;       ///< m, the half-edge that K, kt, C and cv are given for
  double relative_density = -1.0;    ///< of packing and bed
  double rolling = -1.0;             ///< half-edges, rolling length of the pile's grains
};

/// Calls f(option, value, unit, text) for each.
template <class Held, class F>
void for_each_held(Held& h, F&& f) {
  f("--half-edge", h.half_edge, "m", "half edge of a cube that a grain fills about");
  f("--density", h.density, "kg/m^3", "of a grain");
  f("--stiffness", h.stiffness, "N/m", "K");
  f("--damping", h.damping, "N s/m", "C");
  f("--separation-factor", h.separation_factor, "", "Sp, share of C while separating");
  f("--friction", h.friction, "", "mu, grain on grain");
  f("--wall-friction", h.wall_friction, "", "mu, grain on walls, and on the plate that a pile stands on");
  f("--friction-stiffness", h.friction_stiffness, "N/m", "kt");
  f("--velocity-stiffness", h.velocity_stiffness, "N s/m", "cv");
  f("--breaking-factor", h.breaking_factor, "", "friction kept by a broken asperity");
  f("--constants-for", h.constants_for, "m", "half-edge that K, kt, C and cv are given for");
  f("--relative-density", h.relative_density, "", "of packing and bed");
  f("--rolling", h.rolling, "half-edges", "rolling length of the pile's grains");
}

/// Whether one is held whose number goes with the size of the grains.
inline bool scales(const HeldConstants& h) {
  return h.stiffness >= 0.0 || h.damping >= 0.0 || h.friction_stiffness >= 0.0 || h.velocity_stiffness >= 0.0;
}

/// Names the options, in a group of their own.
inline void add_held_constants(Options& options, HeldConstants& h) {
  options.group("Constants that are not looked for (negative: as each rig has it)");
  for_each_held(h, [&](const char* name, double& value, const char* unit, const char* words) {
    options.add(name, value, *unit == '\0' ? std::string(words) : text("{} [{}]", words, unit));
  });
}

/// Gives a rig's grains what is held.
template <class Grains>
void hold(Grains& grains, const HeldConstants& h) {
  const auto set = [](double& to, double value) {
    if (value >= 0.0) to = value;
  };
  set(grains.half_edge, h.half_edge);
  set(grains.density, h.density);
  set(grains.stiffness, h.stiffness);
  set(grains.damping, h.damping);
  set(grains.separation_factor, h.separation_factor);
  set(grains.friction, h.friction);
  if constexpr (requires { grains.wall_friction; }) set(grains.wall_friction, h.wall_friction);
  else set(grains.plate_friction, h.wall_friction);
  set(grains.friction_stiffness, h.friction_stiffness);
  set(grains.velocity_stiffness, h.velocity_stiffness);
  set(grains.breaking_factor, h.breaking_factor);
  set(grains.constants_for, h.constants_for);
}

/// Adds names and values for a report: of those that were given.
inline void list_settings(NamesAndValues& list, const HeldConstants& h) {
  for_each_held(h, [&](const char* name, const double& value, const char* unit, const char* words) {
    if (value >= 0.0) list.emplace_back(text("{}, {}", name + 2, words), text("{:g} {}", value, unit));
  });
}

}  // namespace dem::rig::calibrate
