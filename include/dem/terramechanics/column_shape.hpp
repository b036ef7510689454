#pragma once

#include <dem/math/vector.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace dem::terramechanics {

/// Where a shape is: its own frame -> global.
struct ShapePose {
  Vector3<double> position;  ///< m
  Matrix3<double> rotation;
};

/// A rectangle of the ground, m.
struct PlanBox {
  double low_x, high_x, low_y, high_y;

  bool empty() const { return !(low_x <= high_x && low_y <= high_y); }
  static PlanBox nothing() { return {1.0, -1.0, 1.0, -1.0}; }
};

/// A column's square of ground, and the point in it where heights are taken. That point is another one in each row and
/// file of columns (ColumnGrid::place), by steps of an eighth: a wheel that rolls along the grid then meets columns one
/// by one, not whole rows of them at once, which would shake it.
struct ColumnPlace {
  double x, y;        ///< m, the middle
  double spacing;     ///< m, the edge
  double at_x, at_y;  ///< m, where heights are taken
};

/// Where a column meets the underside of a shape.
struct ColumnContactPoint {
  Vector3<double> point;   ///< m, on the shape
  Vector3<double> normal;  ///< unit, out of the shape, so downwards: z < 0
  double share = 1.0;      ///< of the column's area that lies under the shape
};

/// What a machine part shows to columns of soil: its underside. A class of the user's own may stand beside those of
/// column_shapes.hpp and column_mesh.hpp.
class ColumnShape {
 public:
  virtual ~ColumnShape() = default;
  /// The ground under what lies below a height `top` (m); may be too large, never too small. Columns with their middle
  /// up to one spacing beyond it are asked too, as they may lie partly under an edge.
  virtual PlanBox shadow(const ShapePose& pose, double top) const = 0;
  /// The underside over a column, or false if it has none below `top` (m).
  virtual bool column_contact(const ShapePose& pose, const ColumnPlace& place, double top,
                              ColumnContactPoint& contact) const = 0;
  /// b of the pressure law, m: the smaller side of what presses on the soil; 0 if the shape does not tell.
  virtual double width() const = 0;
  /// What it is, in words that differ where it differs: a saved state is only loaded where they are the same.
  virtual std::string set_up() const = 0;
};

namespace detail {

/// How much of a column, which reaches half `extent` to both sides of `at`, lies between -limit and limit; `middle`
/// becomes the middle of that part.
inline double covered(double at, double extent, double limit, double& middle) {
  const double low = std::max(at - 0.5 * extent, -limit), high = std::min(at + 0.5 * extent, limit);
  middle = 0.5 * (low + high);
  const double share = (high - low) / extent;
  // Less than a thousandth is none: an edge that lies on the grid and trembles would widen its rut by a column.
  return share > 1e-3 ? std::min(share, 1.0) : 0.0;
}

}  // namespace detail

}  // namespace dem::terramechanics
