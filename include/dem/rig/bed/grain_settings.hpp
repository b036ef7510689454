#pragma once
// Cubical grains and the thesis's constants of their contacts, as options of a rig.

#include <dem/grain/materials.hpp>
#include <dem/law/friction/asperity_spring.hpp>
#include <dem/law/normal/penalty.hpp>
#include <dem/rig/contact_options.hpp>
#include <dem/rig/sizes.hpp>
#include <dem/soil/relative_density.hpp>

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace dem::rig {

/// What the grains of a rig are, in SI units. The constants are those of a grain of half-edge `constants_for`; a grain
/// of another size gets them scaled, so that a bed of coarse grains deforms as one of fine grains does.
struct GrainSettings {
  double half_edge = 0.0;            ///< m, half the edge of the cube; 0: by size
  double density = 2650.0;           ///< kg/m^3, of a grain
  double stiffness = 2e4;            ///< K, N/m: the thesis's screenshots; its tables say 2000
  double damping = 0.015;            ///< C, N s/m
  double separation_factor = 0.05;   ///< Sp
  double friction = 0.4;             ///< mu, grain on grain
  double wall_friction = -1.0;       ///< mu, grain on wall; negative: as grain on grain
  double friction_stiffness = -1.0;  ///< kt, N/m; negative: as K
  double velocity_stiffness = -1.0;  ///< cv, N s/m; negative: as C
  double breaking_factor = 0.975;    ///< share of the friction that a broken asperity keeps
  double constants_for = 0.9e-3;     ///< m
  bool scale_contacts = true;        ///< K, kt ~ size and C, cv ~ size^2

  /// Of the grains' shape; relative densities count between them.
  soil::DensityLimits limits = soil::cube8_limits;

  /// What K is multiplied by. Overlap/size under a stress P is P d/K, and the damping ratio is C/sqrt(K m): K ~ d and
  /// C ~ d^2 keep both.
  [[nodiscard]] double scale() const { return scale_contacts ? half_edge / constants_for : 1.0; }
  [[nodiscard]] double edge() const { return 2.0 * half_edge; }  ///< m
  /// The relative density of a solid fraction; NaN where that is.
  [[nodiscard]] double relative_density(double solid_fraction) const {
    return std::isfinite(solid_fraction) ? soil::relative_density(solid_fraction, limits) : solid_fraction;
  }
};

/// The constants of a contact with a coefficient of friction, for a Model with the thesis's laws: penalty springs and
/// springs of asperities.
template <class Model>
ContactParameters<Model> grain_contact(const GrainSettings& s, double friction) {
  static_assert(std::is_same_v<typename Model::Normal, contact::Penalty> &&
                    std::is_same_v<typename Model::Friction, friction::AsperitySpring>,
                "a rig's settings are constants of contact::Penalty and friction::AsperitySpring: leave Normal and "
                "Friction of your Model as they are");
  const double k = s.scale();
  return {.normal = {k * s.stiffness, k * k * s.damping, s.separation_factor},
          .friction = {friction, k * s.friction_stiffness, k * k * s.velocity_stiffness, s.breaking_factor}};
}

/// Names the options of grains, in a group of their own.
inline void add_grain_options(Options& options, GrainSettings& s) {
  const auto add = [&](const char* name, auto& value, const char* text) { options.add(name, value, text); };
  options.group("Grains and contacts");
  add("--half-edge", s.half_edge, "half edge of a cube of eight spheres [m]; 0: by size");
  add("--density", s.density, "of a grain [kg/m^3]");
  add("--stiffness", s.stiffness, "K of a sphere [N/m]");
  add("--damping", s.damping, "C [N s/m]");
  add("--wall-friction", s.wall_friction, "mu, grain on wall and lid; negative: as grain on grain");
  add_contact_options(options, s);
}
inline void find_idle(IdleOptions& idle, const GrainSettings& s) {
  idle.unless(s.scale_contacts, "with --scale-contacts true", {"--constants-for"});
}

/// Fills in what was left open, and checks every option against its range. Throws Error.
inline void resolve(GrainSettings& s, double half_edge_by_size) {
  fill(s.half_edge, half_edge_by_size);
  if (s.wall_friction < 0.0) s.wall_friction = s.friction;
  if (s.friction_stiffness < 0.0) s.friction_stiffness = s.stiffness;
  if (s.velocity_stiffness < 0.0) s.velocity_stiffness = s.damping;
  require_positive(s.half_edge, "--half-edge", "m (0: by size)");
  require_positive(s.density, "--density", "kg/m^3");
  check_contact_options(s);
  check_constants_for(s);
  require_non_negative(s.wall_friction, "--wall-friction", "(no unit)");
}

using NamesAndValues = std::vector<std::pair<std::string, std::string>>;

/// Adds names and values for a report.
inline void list_settings(NamesAndValues& list, const GrainSettings& s) {
  const double k = s.scale();
  const auto given = [&](double scaled, double value, const char* unit) {
    return text("{:g} {} (given {:g} for half-edge {:g} mm)", scaled, unit, value, 1e3 * s.constants_for);
  };
  list.insert(list.end(),
              {{"half-edge", text("{:g} mm", 1e3 * s.half_edge)},
               {"grain density", text("{:g} kg/m³", s.density)},
               {"normal stiffness K", given(k * s.stiffness, s.stiffness, "N/m")},
               {"normal damping C", given(k * k * s.damping, s.damping, "N s/m")},
               {"separation factor Sp", text("{:g}", s.separation_factor)},
               {"friction, grain on grain", text("{:g}", s.friction)},
               {"friction, grain on wall", text("{:g}", s.wall_friction)},
               {"friction stiffness kt", given(k * s.friction_stiffness, s.friction_stiffness, "N/m")},
               {"velocity stiffness cv", given(k * k * s.velocity_stiffness, s.velocity_stiffness, "N s/m")},
               {"asperity breaking factor", text("{:g}", s.breaking_factor)}});
}

}  // namespace dem::rig
