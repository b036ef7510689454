#pragma once

#include <dem/terramechanics/column_field.hpp>

#include <algorithm>

namespace dem::terramechanics {

/// Force (N, global axes) that a column puts on a part, at the touch's point.
struct ColumnForce {
  Vector3<double> force = {0, 0, 0};
  double stiffness = 0.0;  ///< N/m, against rising and sinking
  bool acts = false;
};

/// The force of one column, and what becomes of it. `velocity` (m/s) is that of the part's material at the point. The
/// pressure acts on the area of the part's surface over the column, along its normal, as in thesis eqs. 2 and 3; the
/// shear stress acts in the tangent plane against the way that the surface slid. `damping` (Pa s/m) resists sinking and
/// rising, but never pulls. Steep surfaces count with the area of one of 84 degrees.
/// `slope` is the tangent of the soil's angle of friction. `friction` (mu of the part on the soil) limits the shear
/// stress to mu p: a smooth part slides on the soil.
inline ColumnForce column_force(const ColumnField& field, const ColumnLaw& law, const JanosiHanamoto& shear,
                                double slope, double friction, double damping, const ColumnContactPoint& touch,
                                const Vector3<double>& velocity, double dt, bool in_contact, ColumnChange& change) {
  const std::size_t row = change.row;
  const double sinkage = field.reference(row) - touch.point.z;
  if (!(sinkage > field.sunk[row])) return {};
  const double before = deepest_for(field, row, law);
  const ColumnStress stress = law.at(sinkage, before);
  // The surface over a fixed place sinks with the speed of its normal over the normal's steepness.
  const double steep = std::max(-touch.normal.z, 0.1), normal_speed = dot(velocity, touch.normal);
  const double pulled = stress.pressure + damping * normal_speed / steep;
  const double pressure = pulled < 0.0 ? 0.0 : pulled;  // what is no number stays so, and is reported with the part
  const Vector3<double> sliding = velocity - normal_speed * touch.normal;
  change.deepest = stress.deepest;
  change.modulus = law.curve.modulus;
  change.sunk = stress.compacts ? stress.residual : field.sunk[row];
  change.pressure = pressure;
  change.on_base = stress.on_base;
  change.shear =
      slide(in_contact ? field.shear[row] : ShearMemory{}, dt * sliding, touch.normal,
            std::min(shear.cohesion + pressure * slope, friction * pressure), stress.compacts, shear.displacement);
  const double area = field.grid.area() * touch.share / steep;
  ColumnForce f;
  f.force = (-area * pressure) * touch.normal - (area * change.shear.strength) * change.shear.mobilised;
  f.stiffness = area * steep * stress.slope;
  f.acts = true;
  return f;
}

}  // namespace dem::terramechanics
