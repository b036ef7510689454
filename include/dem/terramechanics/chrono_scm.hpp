#pragma once

#include <dem/terramechanics/soil_text.hpp>

#include <string>

namespace dem::terramechanics {

/// What Project Chrono's SCMTerrain::SetSoilParameters takes, in its order and its units.
struct ChronoScm {
  double bekker_k_phi = 0.0;       ///< Pa/m^n
  double bekker_k_c = 0.0;         ///< Pa/m^(n-1)
  double bekker_n = 0.0;           ///< no unit
  double mohr_cohesion = 0.0;      ///< Pa
  double mohr_friction = 0.0;      ///< degrees
  double janosi_shear = 0.0;       ///< m
  double elastic_stiffness = 0.0;  ///< elastic_K, Pa/m; its number must be above that of bekker_k_phi
  double damping = 0.0;            ///< damping_R, Pa s/m
};

/// The soil for SCM terrain, whose unloading stiffness is k0 alone: it does not grow with the sinkage (A is left out).
/// SCM knows Bekker's pressure only: Reece's is taken as under a plate or wheel of a `width`
/// (m), with k_c = 0; the others do not need it. `damping` in Pa s/m. Throws Error for a soil that check_soil refuses,
/// without an unloading stiffness, and if that is not above k_phi, which SCM asks for.
inline ChronoScm to_chrono(const Soil& soil, double width = 0.0, double damping = 0.0) {
  check_soil(soil);
  require_non_negative(damping, "damping for SCM terrain", "Pa s/m");
  ChronoScm scm;
  if (const auto* bekker = std::get_if<Bekker>(&soil.pressure)) {
    scm.bekker_k_phi = bekker->k_phi;
    scm.bekker_k_c = bekker->k_c;
    scm.bekker_n = bekker->n;
  } else {
    if (std::holds_alternative<Reece>(soil.pressure)) {
      require_positive(width, "width that Reece's pressure is taken for", "m");
    }
    const PressureCurve curve = under(soil.pressure, width);
    scm.bekker_k_phi = curve.modulus;
    scm.bekker_n = curve.exponent;
  }
  scm.mohr_cohesion = soil.shear.cohesion;
  scm.mohr_friction = degrees(soil.shear.friction_angle);
  scm.janosi_shear = soil.shear.displacement;
  scm.elastic_stiffness = soil.unloading_stiffness;
  scm.damping = damping;
  if (!(scm.elastic_stiffness > scm.bekker_k_phi)) {
    fail(
        "unloading stiffness of the soil is {:g} Pa/m, but SCM terrain asks for more than its k_phi, {:g}; give the "
        "soil "
        "an unloading_stiffness above that",
        scm.elastic_stiffness, scm.bekker_k_phi);
  }
  return scm;
}

/// The call as a line of C++ each argument.
inline std::string to_text(const ChronoScm& scm, const std::string& terrain = "terrain") {
  const struct {
    double value;
    const char* what;
  } rows[] = {{scm.bekker_k_phi, "Bekker_Kphi, Pa/m^n"},
              {scm.bekker_k_c, "Bekker_Kc, Pa/m^(n-1)"},
              {scm.bekker_n, "Bekker_n"},
              {scm.mohr_cohesion, "Mohr_cohesion, Pa"},
              {scm.mohr_friction, "Mohr_friction, degrees"},
              {scm.janosi_shear, "Janosi_shear, m"},
              {scm.elastic_stiffness, "elastic_K, Pa/m"},
              {scm.damping, "damping_R, Pa s/m"}};
  std::string text = terrain + ".SetSoilParameters(\n";
  for (const auto& row : rows) {
    const bool last = &row == &rows[7];
    text += "    " + detail::shortest(row.value) + (last ? ");  // " : ",  // ") + row.what + '\n';
  }
  return text;
}

}  // namespace dem::terramechanics
