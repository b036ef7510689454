#pragma once

#include <dem/math/vector.hpp>

#include <numbers>

namespace dem {

/// Volume integrals of a solid of density 1.
struct MassProperties {
  double volume = 0.0;          ///< m^3
  Vec3 centre = Vec3::Zero();   ///< m
  Mat3 inertia = Mat3::Zero();  ///< m^5, about the centre; times the density: kg m^2
};

inline MassProperties sphere_mass_properties(double radius) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return {volume, Vec3::Zero(), scaled_identity(0.4 * volume * radius * radius)};
}

/// A box with the given edge lengths.
inline MassProperties box_mass_properties(const Vec3& edges) {
  const double volume = edges.prod();
  const Vec3 squares = componentwise(edges, edges);
  const Vec3 moments = volume / 12.0 * (filled(squares.sum()) - squares);
  return {volume, Vec3::Zero(), diagonal_matrix(moments)};
}

}  // namespace dem
