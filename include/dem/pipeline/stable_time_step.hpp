#pragma once

#include <dem/state/materials.hpp>
#include <dem/state/species.hpp>

#include <cmath>
#include <span>

namespace dem::pipeline {

/// How many contacts at once the stable time step allows for. A grain in a bed has about six, but they pull in
/// different directions: the highest mode of a packed bed of cubes is that of about four contacts in line.
inline constexpr double contacts_in_line = 4.0;

struct StableTimeStep {
  double value = 1e300;  ///< s
  std::string contact;   ///< which contact limits it, in words
};

/// Largest stable time step of the grains. One contact of stiffness k between partners of mass m and inertia I, with
/// the lever arm R (bounding radius), has the frequency
///   omega^2 = k (1/m_i + 1/m_j + R_i^2/I_i + R_j^2/I_j)
/// and a grain with n contacts in line n times that. Explicit integration is stable while omega dt stays under the
/// integrator's limit. `typical` tells at which contact state a nonlinear law's stiffness is taken.
template <class Model>
StableTimeStep stable_time_step(std::span<const Species<typename Model::Shape>> species,
                                const Materials<Model>& materials, std::span<const MaterialId> surface_materials,
                                double overlap_limit) {
  StableTimeStep result;
  const auto softness = [](const Species<typename Model::Shape>& s) {  // 1/kg
    const double radius = s.shape.bounding_radius();
    return 1.0 / s.mass + radius * radius / s.inertia.minCoeff();
  };
  const auto consider = [&](MaterialId a, MaterialId b, double inverse_mass, double mass, double radius) {
    const auto& parameters = materials.table()[materials.row(a, b)];
    const contact::NormalState<double> deepest = {2.0 * overlap_limit * radius, 0.0, 1.0, radius, mass, 0.0};
    const double k =
        std::max(Model::Normal::stiffness(parameters.normal, deepest), Model::Friction::stiffness(parameters.friction));
    if (!(k > 0.0)) return;
    const double dt = Model::Integrator::stability_limit / std::sqrt(contacts_in_line * k * inverse_mass);
    if (dt < result.value) {
      result = {dt, fmt::format("{} on {}: stiffness {:g} N/m, grain of {:.4g} kg", materials.name(a),
                                materials.name(b), k, mass)};
    }
  };
  for (const auto& a : species) {
    const double ra = a.shape.bounding_radius();
    for (const auto& b : species) {
      const double rb = b.shape.bounding_radius();
      consider(a.material, b.material, softness(a) + softness(b), std::min(a.mass, b.mass), ra * rb / (ra + rb));
    }
    for (const MaterialId m : surface_materials) consider(a.material, m, softness(a), a.mass, ra);
  }
  return result;
}

}  // namespace dem::pipeline
