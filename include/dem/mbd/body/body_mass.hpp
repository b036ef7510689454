#pragma once

#include <dem/core/error.hpp>
#include <dem/core/macros.hpp>
#include <dem/geometry/mass_properties.hpp>
#include <dem/math/matrix3.hpp>

#include <algorithm>
#include <numbers>

namespace dem::mbd {

/// Mass, centre of mass and inertia of a rigid body in axes of the user's choice.
struct BodyMass {
  double mass = 0.0;                   ///< kg
  Vec3 centre_of_mass = Vec3::Zero();  ///< m, in the user's frame
  Mat3 inertia = Mat3::Zero();         ///< kg m^2, about the centre of mass, in the user's axes

  /// The same body shifted and turned in the user's frame: x -> shift + turn x.
  BodyMass moved(const Vec3& shift, const Mat3& turn = Mat3::Identity()) const;
};

/// Inertia of a point mass at r about the origin: m (r.r I - r r^T), the parallel axis theorem.
Mat3 steiner(double mass, const Vec3& r);

/// Two bodies welded together; subtract one with a negative mass.
BodyMass operator+(const BodyMass& a, const BodyMass& b);

/// From volume integrals and a density (kg/m^3).
BodyMass of_density(const MassProperties& volume, double density);

/// A box with full edges `size` (m), centred on the origin; density in kg/m^3.
BodyMass box_mass(const Vec3& size, double density);

/// A full cylinder about the z axis, centred on the origin (m, kg/m^3).
BodyMass cylinder_mass(double radius, double length, double density);

/// A full sphere about the origin (m, kg/m^3).
BodyMass sphere_mass(double radius, double density);

}  // namespace dem::mbd

#if DEM_DEFINES

namespace dem::mbd {

DEM_INLINE BodyMass BodyMass::moved(const Vec3& shift, const Mat3& turn) const {
  const Matrix3<double> r = from_eigen(turn);
  return {mass, to_eigen(from_eigen(shift) + r * from_eigen(centre_of_mass)),
          to_eigen(r * from_eigen(inertia) * transposed(r))};
}

DEM_INLINE Mat3 steiner(double mass, const Vec3& r) {
  const Vector3<double> x = from_eigen(r);
  const double square = dot(x, x);
  return to_eigen(mass * (diagonal_matrix(square, square, square) - outer(x, x)));
}

DEM_INLINE BodyMass operator+(const BodyMass& a, const BodyMass& b) {
  using V = Vector3<double>;
  const V ca = from_eigen(a.centre_of_mass), cb = from_eigen(b.centre_of_mass);
  const double mass = a.mass + b.mass;
  const V centre = (a.mass * ca + b.mass * cb) / mass;
  const auto moved = [&](const BodyMass& x, const V& c) {
    return from_eigen(x.inertia) + from_eigen(steiner(x.mass, to_eigen(c - centre)));
  };
  return {mass, to_eigen(centre), to_eigen(moved(a, ca) + moved(b, cb))};
}

DEM_INLINE BodyMass of_density(const MassProperties& volume, double density) {
  require_positive(density, "density", "kg/m^3");
  require_positive(volume.volume, "volume", "m^3");
  return {density * volume.volume, volume.centre, to_eigen(density * from_eigen(volume.inertia))};
}

DEM_INLINE BodyMass box_mass(const Vec3& size, double density) {
  require_positive(std::min({size[0], size[1], size[2]}), "smallest edge of a box", "m");
  return of_density(box_mass_properties(size), density);
}

DEM_INLINE BodyMass cylinder_mass(double radius, double length, double density) {
  require_positive(radius, "radius of a cylinder", "m");
  require_positive(length, "length of a cylinder", "m");
  const double m = require_positive(density, "density", "kg/m^3") * std::numbers::pi * radius * radius * length;
  const double across = m * (3.0 * radius * radius + length * length) / 12.0;
  return {m, Vec3::Zero(), to_eigen(diagonal_matrix(across, across, 0.5 * m * radius * radius))};
}

DEM_INLINE BodyMass sphere_mass(double radius, double density) {
  require_positive(radius, "radius of a sphere", "m");
  return of_density(sphere_mass_properties(radius), density);
}

}  // namespace dem::mbd

#endif
