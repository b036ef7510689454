#pragma once

#include <dem/core/ids.hpp>
#include <dem/math/vector.hpp>

#include <vector>

namespace dem {

/// Grains of one shape, size, density and material.
template <class Shape>
struct Species {
  Shape shape;
  MaterialId material;
  double density;       ///< kg/m^3
  double mass;          ///< kg
  double inverse_mass;  ///< 1/kg; 0 for grains that are held
  Vec3 inertia;         ///< kg m^2, principal

  /// Grains of it do not move by themselves (SpeciesOptions::held).
  bool is_held() const { return inverse_mass == 0.0; }
  template <class V>
  void fields(V& v) {
    v.given("material", material), v.given("density", density, "kg/m^3"), v.given("mass", mass, "kg");
    v.given("inertia", inertia, "kg m^2"), v.given("bounding_radius", shape.bounding_radius(), "m");
    v.given("held", is_held());
  }
};

/// The numbers of a species that the integration loop reads.
struct SpeciesInertia {
  double inverse_mass;
  double mobility;  ///< 1, or 0 for grains that never move
  double inertia[3], inverse_inertia[3];
};

}  // namespace dem
