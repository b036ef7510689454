#pragma once

#include <dem/grain/materials.hpp>
#include <dem/rig/direct_shear/grain_kind.hpp>
#include <dem/rig/direct_shear/results.hpp>

#include <type_traits>

namespace dem::rig::direct_shear {

/// What is sheared: the shape that all grains have, and the constants of their contacts. The shape's frame has its
/// origin in its centre of mass.
template <class Model>
struct Grains {
  typename Model::Shape shape;
  ContactParameters<Model> on_grain;  ///< grain on grain
  ContactParameters<Model> on_wall;   ///< grain on walls, floor and lid
};

/// Coefficient of friction of a contact; NaN where the law's Parameters have none.
template <class Model>
double friction_of(const ContactParameters<Model>& p) {
  if constexpr (requires { p.friction.coefficient; }) return p.friction.coefficient;
  else if constexpr (requires { p.friction.law.coefficient; }) return p.friction.law.coefficient;
  else return std::is_empty_v<decltype(p.friction)> ? 0.0 : not_known;
}

/// The constants with a share of their friction. Throws Error for another share than 1 where there is none to lower.
template <class Model>
ContactParameters<Model> with_friction(ContactParameters<Model> p, double share) {
  if constexpr (requires { p.friction.coefficient *= share; }) p.friction.coefficient *= share;
  else if constexpr (requires { p.friction.law.coefficient *= share; }) p.friction.law.coefficient *= share;
  else if constexpr (!std::is_empty_v<decltype(p.friction)>) {
    if (share != 1.0) {
      fail(
          "grains are made denser by lowering their friction, but Model::Friction::Parameters have no `coefficient`; "
          "name it so, or let the packing be as it settles (relative_density 0)");
    }
  }
  return p;
}

/// Grains with the thesis's laws, penalty springs and springs of asperities, and the constants of the settings.
template <class Model>
Grains<Model> grains_of(const Settings& s, const typename Model::Shape& shape) {
  const double k = contact_scale(s);
  const auto constants = [&](double mu) {
    return ContactParameters<Model>{{k * s.stiffness, k * k * s.damping, s.separation_factor},
                                    {mu, k * s.friction_stiffness, k * k * s.velocity_stiffness, s.breaking_factor}};
  };
  return {shape, constants(s.friction), constants(s.wall_friction)};
}

}  // namespace dem::rig::direct_shear
