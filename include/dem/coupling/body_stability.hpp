#pragma once

#include <dem/coupling/body_contacts.hpp>
#include <dem/grain/stable_time_step.hpp>
#include <dem/mbd/drive/carried_bodies.hpp>

namespace dem::coupling {

/// From the centre of mass of a surface's body to the farthest corner of the surface's box, m.
template <class Surface>
double reach_of(const Surface& s) {
  const surface::Aabb b = std::visit([](const auto& geometry) { return geometry.bounds(); }, s.geometry);
  double farthest = 0.0;
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 corner(k & 1 ? b.high.x() : b.low.x(), k & 2 ? b.high.y() : b.low.y(), k & 4 ? b.high.z() : b.low.z());
    farthest = std::max(farthest, (s.position + s.rotation * corner).norm());
  }
  return farthest;
}
/// The inverse effective mass of a body at the farthest point of its surface, 1/m + R^2/I (1/kg); 0 for one that gives
/// no way. An endless surface is touched at `lever` (m).
template <class Surface>
double inverse_effective_mass_of(const Surface& s, const Body& body, bool gives_way, double lever) {
  if (!gives_way) return 0.0;
  if (const double reach = reach_of(s); reach < 1e100) lever = reach;
  return 1.0 / body.mass + lever * lever / body.inertia.minCoeff();
}

/// Throws Error for a pair of surfaces whose cohesion law acts at a distance, if neither surface is a ball. Points that
/// are shares of one contact have no pull of their own.
template <class Model, class Surface>
void check_body_cohesion(const Surface& a, const Surface& b, const Body& body_a, const Body& body_b,
                         const Materials<Model>& materials) {
  if constexpr (cohesion::reaches<typename Model::Cohesion>) {
    const auto& parameters = materials.table()[materials.row(a.material, b.material)];
    const double reach = Model::Cohesion::range(parameters.cohesion, pair_radius(a, b));
    if (!(reach > 0.0) || is_ball(a) || is_ball(b)) return;
    fail(
        "body '{}' and body '{}' of the materials '{}' and '{}' attract each other up to a gap of {:g} m, but bodies "
        "feel cohesion at a distance only if one of them is a ball; give these materials contact constants without "
        "cohesion, make one of the surfaces a surface::Sphere, or take a cohesion law that needs touch",
        body_a.name, body_b.name, materials.name(a.material), materials.name(b.material), reach);
  }
}

/// Largest stable time step of the contacts between bodies. All points are taken to act in line, at the point of the
/// surface that is farthest from the centre of mass:
///   W = 1/m_a + 1/m_b + R_a^2/I_a + R_b^2/I_b in stable_step()
/// The points of one side are one contact, but up to twice as stiff, as the deeper ones take over weight. There may be
/// two sides, as in a groove. A ball touches with one point. Bodies that are fixed or carried give no way. Throws Error
/// as check_body_cohesion() does.
template <class Model, class Surface>
StableTimeStep stable_time_step_of_bodies(std::span<const BodyPair> pairs, std::span<const Surface> surfaces,
                                          std::span<const Body> bodies, const mbd::CarriedBodies& carried,
                                          const Materials<Model>& materials, double overlap_limit) {
  StableTimeStep result;
  for (const BodyPair& pair : pairs) {
    const Surface &a = surfaces[pair.a.index()], &b = surfaces[pair.b.index()];
    const Body &body_a = bodies[a.body.index()], &body_b = bodies[b.body.index()];
    check_body_cohesion(a, b, body_a, body_b, materials);
    // An endless surface is touched where its partner is.
    const double smaller = std::min(reach_of(a), reach_of(b));
    const bool moves_a = carried.gives_way(body_a, a.body), moves_b = carried.gives_way(body_b, b.body);
    const double w =
        inverse_effective_mass_of(a, body_a, moves_a, smaller) + inverse_effective_mass_of(b, body_b, moves_b, smaller);
    if (!(w > 0.0)) continue;
    const auto turning_of = [](const Body& body, bool moves) { return moves ? 1.0 / body.inertia.minCoeff() : 0.0; };
    const double turning = turning_of(body_a, moves_a) + turning_of(body_b, moves_b);
    const double inverse_mass = (moves_a ? 1.0 / body_a.mass : 0.0) + (moves_b ? 1.0 / body_b.mass : 0.0);
    const double n = is_ball(a) || is_ball(b) ? 2.0 : 4.0;
    const double radius = pair_radius(a, b);
    const auto& parameters = materials.table()[materials.row(a.material, b.material)];
    const contact::NormalState<double> deepest = {2.0 * overlap_limit * radius, 0.0, radius, 1.0 / inverse_mass, 0.0};
    grain::for_each_swing<Model>(
        parameters, deepest, 1.0, w, turning, [&](double k, double c, double inverse_effective_mass, const auto& text) {
          const double dt =
              grain::stable_step(Model::Integrator::stability_limit, n * k, n * c, inverse_effective_mass);
          if (!(dt < result.dt)) return;
          result = {dt, dem::text("body '{}' on body '{}': {}, {:g} times", body_a.name, body_b.name, text(), n)};
        });
  }
  return result;
}

}  // namespace dem::coupling
