#pragma once

#include <dem/integrator/motion.hpp>
#include <dem/terramechanics/column_field.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace dem::terramechanics {

/// A field of soil columns, as it is asked for.
struct ColumnsSpec {
  double low_x = 0.0, low_y = 0.0;        ///< m, a corner of the field
  double length_x = 1.0, length_y = 1.0;  ///< m; rounded up to whole columns
  /// m, edge of a column: an eighth of the contact's length or less. Where only two columns lie along a contact, as
  /// with 0.02 m under a wheel that touches over 0.04 m, forces change with each column that is met, and the speed of a
  /// driven wheel surges by more than half.
  double spacing = 0.01;
  double height = 0.0;     ///< m, of the level surface
  double thickness = 0.0;  ///< m, of the soil over hard ground; 0: without end
  Soil soil;
  /// Pa s/m, against sinking and rising: a speed v adds damping v to the pressure. Without it a body bounces for ever,
  /// and creeps down a slope that should hold it, as soil that it leaves forgets its shear. A hundredth of the critical
  /// damping 2 sqrt(k m)/A or more stands still, a tenth is a good choice: m (kg) is the mass on the part, A (m^2) and
  /// k (N/m) are area and stiffness of the soil under it, loads()[part].area and .stiffness.
  double damping = 0.0;
  double bulldozing = 0.0;       ///< share of the compacted volume that appears beside the rut
  double angle_of_repose = 0.6;  ///< rad, of that soil
};

/// Throws Error, in words, for a field that cannot be.
inline void check_columns(const ColumnsSpec& spec) {
  check_soil(spec.soil);
  require_positive(spec.spacing, "spacing of soil columns", "m");
  require_positive(spec.length_x, "length of the soil along x", "m");
  require_positive(spec.length_y, "length of the soil along y", "m");
  require_non_negative(spec.thickness, "thickness of the soil", "m (0: without end)");
  require_non_negative(spec.damping, "damping of soil columns", "Pa s/m");
  require_within(spec.bulldozing, 0.0, 2.0, "share of the soil that is pushed aside");
  require_within(spec.angle_of_repose, 0.0, 1.4, "angle of repose of soil that is pushed aside, in rad");
  require_within(spec.height, -1e6, 1e6, "height of the soil in m");
  require_within(spec.low_x, -1e6, 1e6, "corner of the soil in m");
  require_within(spec.low_y, -1e6, 1e6, "corner of the soil in m");
  // At least one across: a strip may be thinner than a column.
  const double columns = std::max(1.0, spec.length_x / spec.spacing) * std::max(1.0, spec.length_y / spec.spacing);
  if (!(columns < 2e8)) {
    fail(
        "{:g} m x {:g} m of soil in columns of {:g} m are {:.3g} columns, but at most 2e8 are taken; raise the spacing",
        spec.length_x, spec.length_y, spec.spacing, columns);
  }
}

/// A part of a machine on soil columns, as it moves now.
struct ColumnPart {
  std::shared_ptr<const ColumnShape> shape;
  integrator::Motion<double> body;       ///< of the body that carries it; forces count about its position
  Vector3<double> position = {0, 0, 0};  ///< m, of the shape in the body's frame
  Matrix3<double> rotation = Matrix3<double>::identity();  ///< shape -> body
  double width = 0.0;                                      ///< b of the pressure law, m; 0: the shape's
  double friction = rough;                                 ///< mu of the part on the soil
  std::int32_t continues = -1;  ///< number of a part before it that it goes on with, as the pieces of a tyre's tread do
  /// For `newest_share` of a step the part slides with its velocities of now; for the rest with those that it had at
  /// `before`. Integrators that look at a step more than once have it so.
  double newest_share = 1.0;
  integrator::Motion<double> before = {};

  static constexpr double rough = 1e9;  ///< the soil shears in itself

  ShapePose pose() const { return {body.position + body.rotation * position, body.rotation * rotation}; }
  /// Whether its position and velocities are finite and its rotation is one.
  bool is_somewhere() const {
    const ShapePose at = pose();
    const Vector3<double> spin = body.rotation * body.angular_velocity;
    const Matrix3<double>& r = at.rotation;
    const double axes = dot(r.row0, r.row0) + dot(r.row1, r.row1) + dot(r.row2, r.row2);  // 3 but for rounding
    const double sum = dot(at.position, at.position) + dot(body.velocity, body.velocity) + dot(spin, spin);
    return sum < 1e300 && std::abs(axes - 3.0) < 1e-3;
  }
};

/// What the soil puts on a part's body.
struct ColumnLoad {
  Vector3<double> force = {0, 0, 0};   ///< N, global axes
  Vector3<double> torque = {0, 0, 0};  ///< N m, about the body's position
  double stiffness = 0.0;              ///< N/m, of the soil under it against rising and sinking
  double area = 0.0;                   ///< m^2, of the soil that it presses on, seen from above
  std::size_t columns = 0;             ///< that press
  bool leaves = false;                 ///< its shadow reaches beyond the field, where there is no soil
};

/// That a part reaches beyond the field.
inline std::string leaving_in_words(const std::string& who, const ColumnPart& part, const ColumnGrid& g) {
  const Vector3<double> at = part.pose().position;
  return fmt::format(
      "{} leaves the soil at ({:g}, {:g}) m: there is none outside of x {:g} to {:g} and y {:g} to {:g} m; enlarge the "
      "field",
      who, at.x, at.y, g.low_x, g.high_x(), g.low_y, g.high_y());
}

/// What became of a step.
struct ColumnsReport {
  bool ok = true;
  std::size_t columns = 0;  ///< that press on anything
  std::size_t on_base = 0;  ///< of them squeezed against the hard ground
  std::int32_t part = -1;   ///< that went wrong
  std::string text;         ///< what went wrong and what to change; empty if all is well
  explicit operator bool() const { return ok; }
};

}  // namespace dem::terramechanics
