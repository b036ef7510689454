#pragma once

#include <dem/terramechanics/column_field.hpp>

#include <algorithm>

namespace dem::terramechanics {

/// Force (N, global axes) that a column puts on a part, at the contact point.
struct ColumnForce {
  Vector3<double> force = {0, 0, 0};
  double stiffness = 0.0;  ///< N/m, against rising and sinking
  bool acts = false;
};

/// The soil of a column, and the part that presses on it.
struct PressedColumn {
  const ColumnLaw& law;
  const JanosiHanamoto& shear;
  double slope;     ///< tangent of the soil's angle of friction
  double friction;  ///< mu of the part on the soil; limits the shear stress to mu p: a smooth part slides on the soil
  double damping;   ///< Pa s/m, resists sinking and rising, but never pulls
  const ColumnContactPoint& contact;
  Vector3<double> velocity;  ///< m/s, of the part's material at the point
  Vector3<double> slid;      ///< m/s, the mean of it since the last step
  bool in_contact;           ///< the part was in contact with it in the last step
};

/// The force of one column, and what becomes of it. The pressure acts on the area of the part's surface over the
/// column, along its normal, as in thesis eqs. 2 and 3; the shear stress acts in the tangent plane against the way that
/// the surface slid. Steep surfaces count with the area of one of 84 degrees.
inline ColumnForce column_force(const ColumnField& field, const PressedColumn& c, double dt, ColumnChange& change) {
  const std::size_t row = change.row;
  const ColumnContactPoint& contact = c.contact;
  const double sinkage = field.reference(row) - contact.point.z;
  if (!(sinkage > field.sunk[row])) return {};
  const double before = deepest_for(field, row, c.law);
  const ColumnStress stress = c.law.at(sinkage, before);
  // The surface over a fixed place sinks with the speed of its normal over the normal's steepness.
  const double steep = std::max(-contact.normal.z, 0.1), normal_speed = dot(c.velocity, contact.normal);
  const double pulled = stress.pressure + c.damping * normal_speed / steep;
  const double pressure = pulled < 0.0 ? 0.0 : pulled;  // what is no number stays so, and is reported with the part
  const Vector3<double> sliding = c.slid - dot(c.slid, contact.normal) * contact.normal;
  change.deepest = stress.deepest;
  change.modulus = c.law.curve.modulus;
  change.sunk = stress.compacts ? stress.residual : field.sunk[row];
  change.pressure = pressure;
  change.on_base = stress.on_base;
  change.shear = slide(c.in_contact ? field.shear[row] : ShearMemory{}, dt * sliding, contact.normal,
                       std::min(c.shear.cohesion + pressure * c.slope, c.friction * pressure), stress.compacts,
                       c.shear.displacement);
  const double area = field.grid.area() * contact.share / steep;
  ColumnForce f;
  f.force = (-area * pressure) * contact.normal - (area * change.shear.strength) * change.shear.mobilised;
  f.stiffness = area * steep * stress.slope;
  f.acts = true;
  return f;
}

}  // namespace dem::terramechanics
