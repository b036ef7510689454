#pragma once

#include <dem/core/macros.hpp>
#include <dem/core/stable_time_step.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/grain/materials.hpp>
#include <dem/grain/species.hpp>

#include <cmath>
#include <span>

namespace dem::grain {

/// How many contacts at once the stable time step allows for. A grain in a bed has about six, but they pull in
/// different directions: the highest mode of a packed bed of cubes is that of about four contacts in line.
inline constexpr double contacts_in_line = 4.0;
/// How many of these have their damper act on that mode: some are pushed, with the damper of the normal law, the others
/// are sheared, with that of friction.
inline constexpr double damped_share = 0.5;

/// Largest stable time step of one law in contacts of stiffness k and damping c. Both are already times the number of
/// contacts that act in line. The partners have mass m, inertia I and the lever arm R (bounding radius). With
///   omega^2 = k W,   B = c W/2,   W = 1/m_i + 1/m_j + R_i^2/I_i + R_j^2/I_j,
/// explicit integration is stable while dt (sqrt(omega^2 + B^2) + B) stays under the integrator's limit. A damper
/// shortens the step, as its force is taken from the velocity of a step before (Belytschko, Liu and Moran 2000).
/// Rolling resistance acts on W = 1/I_i + 1/I_j instead.
inline double stable_step(double limit, double k, double c, double w) {
  const double b = 0.5 * c * w, sum = std::sqrt(k * w + b * b) + b;
  return sum > 0.0 ? limit / sum : 1e300;
}

/// The springs of a pair's laws that swing separately: the one along the normal, and the sum of friction and rolling
/// resistance, which turn the same grains. Calls limit(k, c, w, text) for each, with the stiffness k (N/m), the damping
/// c (N s/m) and the inverse effective mass w (1/kg). `acting` is the share of the damping that acts; w_turning (1/(kg
/// m^2)) is the inverse inertia of rotations; text() names the spring. Throws Error if a law tells a stiffness or
/// damping that is negative or not finite, which would limit nothing.
template <class Model, class Parameters, class Limit>
DEM_SETUP void for_each_swing(const Parameters& p, const contact::NormalState<double>& deepest, double acting, double w,
                              double w_turning, Limit&& limit) {
  const auto stiffness = [](double k, const char* what) { return require_non_negative(k, what, "N/m or N m"); };
  const auto damping = [](double c, const char* what) { return require_non_negative(c, what, "N s/m or N m s"); };
  const double normal =
      stiffness(Model::Normal::stiffness(p.normal, deepest), "stiffness that a normal law tells") +
      stiffness(Model::Cohesion::stiffness(p.cohesion, deepest), "stiffness that a cohesion law tells");
  const double normal_damping =
      damping(contact::damping_of<typename Model::Normal>(p.normal, deepest), "damping that a normal law tells");
  limit(normal, acting * normal_damping, w, [&] { return dem::text("stiffness {:g} N/m", normal); });

  const double sliding = stiffness(friction::stiffness_of<typename Model::Friction>(p.friction, deepest),
                                   "stiffness that a friction law tells");
  const double slide_damping = acting * damping(contact::damping_of<typename Model::Friction>(p.friction, deepest),
                                                "damping that a friction law tells");
  const double rolling =
      stiffness(Model::Rolling::stiffness(p.rolling, deepest), "stiffness that a law of rolling resistance tells");
  const double roll_damping = damping(contact::damping_of<typename Model::Rolling>(p.rolling, deepest),
                                      "damping that a law of rolling resistance tells");
  const double to_slide = w > 0.0 ? w_turning / w : 0.0;
  limit(sliding + to_slide * rolling, slide_damping + to_slide * roll_damping, w, [&] {
    const std::string friction = dem::text("friction stiffness {:g} N/m", sliding);
    return rolling + roll_damping > 0.0 ? friction + dem::text(" with rolling stiffness {:g} N m", rolling) : friction;
  });
}

/// What the stable time step has to know of a surface.
struct SurfaceMatter {
  MaterialId material;
  /// 1/kg, of its body: 1/m + R^2/I at the surface's farthest point; 0 for a fixed one.
  double inverse_effective_mass = 0.0;
};

/// Largest stable time step of the grains: the smallest of all laws and pairs of species and surfaces. A shape whose
/// contacts are points counts with as many as may touch at once. A nonlinear law's stiffness is taken at the overlap
/// that the world reports as too deep, WorldOptions::overlap_limit.
template <class Model>
DEM_SETUP StableTimeStep stable_time_step(std::span<const Species<typename Model::Shape>> species,
                                          const Materials<Model>& materials, std::span<const SurfaceMatter> surfaces,
                                          double overlap_limit) {
  StableTimeStep result;
  const auto inverse_effective_mass_of = [](const Species<typename Model::Shape>& s) {  // 1/kg
    const double radius = s.shape.bounding_radius();
    return 1.0 / s.mass + radius * radius / s.inertia.minCoeff();
  };
  const auto turning = [](const Species<typename Model::Shape>& s) { return 1.0 / s.inertia.minCoeff(); };
  const auto consider = [&](MaterialId a, MaterialId b, double w, double w_turning, double mass, double radius,
                            const contact::Patch& patch) {
    const auto& p = materials.table()[materials.row(a, b)];
    const contact::NormalState<double> deepest = {2.0 * overlap_limit * radius, 0.0, radius, mass, 0.0};
    for_each_swing<Model>(p, deepest, damped_share, w, w_turning,
                          [&](double k, double c, double inverse_effective_mass, const auto& text) {
                            const double n = contacts_in_line * patch.weight;
                            const double dt =
                                stable_step(Model::Integrator::stability_limit, n * k, n * c, inverse_effective_mass);
                            if (!(dt < result.dt)) return;
                            const char* damper = c > 0.0 ? " with a damper" : "";
                            result = {dt, dem::text("{} on {}: {}{}, grain of {:.4g} kg", materials.name(a),
                                                    materials.name(b), text(), damper, mass)};
                          });
  };
  for (const auto& a : species) {
    const double ra = a.shape.bounding_radius();
    for (const auto& b : species) {
      const double rb = b.shape.bounding_radius();
      consider(a.material, b.material, inverse_effective_mass_of(a) + inverse_effective_mass_of(b),
               turning(a) + turning(b), std::min(a.mass, b.mass), ra * rb / (ra + rb), shape::patch_of(a.shape));
    }
    for (const SurfaceMatter& s : surfaces) {
      consider(a.material, s.material, inverse_effective_mass_of(a) + s.inverse_effective_mass, turning(a), a.mass, ra,
               shape::surface_patch_of(a.shape));
    }
  }
  return result;
}

}  // namespace dem::grain
