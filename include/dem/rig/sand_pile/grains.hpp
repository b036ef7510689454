#pragma once

#include <dem/grain/materials.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/rolling/constant_torque.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/rig/processes.hpp>
#include <dem/rig/sand_pile/settings.hpp>
#include <dem/world/model.hpp>

#include <cmath>
#include <numbers>
#include <type_traits>

namespace dem::rig::sand_pile {

/// The thesis's laws, penalty springs and springs of asperities, with a shape and a law of rolling.
template <class S, class R = rolling::None>
struct Sand : Model {
  using Shape = S;
  using Surfaces = surface::Set<surface::Box, surface::Cylinder>;
  using Rolling = R;
  using Integrator = integrator::VelocityVerlet;
  using Domain = rig::Domain;
};

/// What is piled up: the shape that all grains have, and the constants of their contacts. The shape's frame has its
/// origin in its centre of mass.
template <class Model>
struct Grains {
  typename Model::Shape shape;
  ContactParameters<Model> on_grain;      ///< grain on grain
  ContactParameters<Model> on_plate;      ///< grain on plate, rings, and a box's floor
  ContactParameters<Model> on_container;  ///< grain on cylinder, funnel, and a box's walls
};

/// m, of the sphere with the volume of a grain.
template <class Shape>
double equal_radius(const Shape& shape) {
  return std::cbrt(0.75 * shape.volume() / std::numbers::pi);
}

/// Grains with the thesis's laws and the constants of the settings, for one kind. A viscous kind has asperities without
/// a spring, which is Coulomb-viscous friction: min(cv |vt|, mu Fn).
template <class Model>
Grains<Model> grains_of(const Settings& s, const Kind& kind, const typename Model::Shape& shape) {
  const double scale = s.scale_contacts ? s.half_edge / s.constants_for : 1.0, points = kind.shape == "cube8" ? 1 : 4;
  const double k = points * scale, c = points * scale * scale;
  const double spring = kind.viscous ? 0.0 : k * s.friction_stiffness;
  const auto constants = [&](double mu, double rolling_length, double effective_radius) {
    ContactParameters<Model> p{{k * s.stiffness, c * s.damping, s.separation_factor},
                               {mu, spring, c * s.velocity_stiffness, s.breaking_factor}};
    const double resistance = kind.rolling ? rolling_length / effective_radius : 0.0;
    if constexpr (std::is_same_v<typename Model::Rolling, rolling::ElasticPlastic>) {
      p.rolling = {resistance, k * s.stiffness, s.rolling_damping};
    } else if constexpr (std::is_same_v<typename Model::Rolling, rolling::ConstantTorque>) {
      p.rolling = {resistance};
    }
    return p;
  };
  const double r = equal_radius(shape);
  return {shape, constants(s.friction, s.rolling_length, 0.5 * r),
          constants(s.plate_friction, s.plate_rolling_length, r),
          constants(s.container_friction, s.method == "drain" ? s.plate_rolling_length : 0.0, r)};
}

}  // namespace dem::rig::sand_pile
