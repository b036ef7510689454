#pragma once

#include <dem/core/error.hpp>
#include <dem/core/ids.hpp>
#include <dem/core/macros.hpp>
#include <dem/geometry/shape.hpp>
#include <dem/math/vector.hpp>

namespace dem {

/// The numbers of a species that the integration loop reads.
struct SpeciesInertia {
  double inverse_mass;
  double gravity_scale;  ///< 1, or 0 for grains that never move
  double inertia[3], inverse_inertia[3];
};

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
  SpeciesInertia for_motion() const {
    SpeciesInertia n = {inverse_mass, is_held() ? 0.0 : 1.0, {}, {}};
    for (int k = 0; k < 3; ++k) {
      n.inertia[k] = inertia[k];
      n.inverse_inertia[k] = is_held() ? 0.0 : 1.0 / inertia[k];
    }
    return n;
  }
  template <class V>
  void fields(V& v) {
    v.given("material", material), v.given("density", density, "kg/m^3"), v.given("mass", mass, "kg");
    v.given("inertia", inertia, "kg m^2"), v.given("bounding_radius", shape.bounding_radius(), "m");
    v.given("held", is_held()), v.fingerprint("shape", shape::fingerprint(shape));
  }
};

/// J, of a grain with a velocity (m/s) and an angular velocity (rad/s, body frame).
template <class Shape>
double kinetic_energy(const Species<Shape>& kind, const Vector3<double>& v, const Vector3<double>& spin) {
  const Vec3& j = kind.inertia;
  return 0.5 * kind.mass * dot(v, v) + 0.5 * (j[0] * spin.x * spin.x + j[1] * spin.y * spin.y + j[2] * spin.z * spin.z);
}

/// Throws Error for moments of inertia that no body has.
void check_moments(const Vec3& moments);

/// A species of grains, of a density in kg/m^3, without its material yet. Throws Error unless the density, the volume
/// and the radius are positive, and for moments of inertia that no body has.
template <class Shape>
Species<Shape> make_species(const Shape& shape, double density, bool held) {
  require_positive(density, "density of a species", "kg/m^3");
  require_positive(shape.volume(), "volume of a species' shape", "m^3");
  require_positive(shape.bounding_radius(), "bounding radius of a species' shape", "m");
  const double mass = density * shape.volume();
  const Species<Shape> s = {shape, {}, density, mass, held ? 0.0 : 1.0 / mass, density * shape.unit_inertia()};
  check_moments(s.inertia);
  return s;
}

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_INLINE void check_moments(const Vec3& moments) {
  const double largest = moments.maxCoeff();
  if (!(moments.minCoeff() > 0.0) || !(largest <= 1.01 * (moments.sum() - largest))) {
    fail(
        "the moments of inertia of a species are {:g}, {:g}, {:g} kg m^2, but must be positive and the largest no more "
        "than the sum of the others; check the mass properties that the shape was given",
        moments.x(), moments.y(), moments.z());
  }
}

}  // namespace dem

#endif
