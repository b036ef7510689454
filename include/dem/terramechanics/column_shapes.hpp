#pragma once

#include <dem/core/error.hpp>
#include <dem/terramechanics/column_shape.hpp>

#include <array>
#include <limits>

namespace dem::terramechanics {

/// A ball, centred at its frame.
class ColumnBall final : public ColumnShape {
 public:
  /// Throws Error unless the radius (m) is positive.
  explicit ColumnBall(double radius) : radius_(require_positive(radius, "radius of a ball on soil columns", "m")) {}

  PlanBox shadow(const ShapePose& pose, double top) const override {
    const double height = pose.position.z - top;  // of the centre over the soil
    if (height >= radius_) return PlanBox::nothing();
    const double reach = height > 0.0 ? std::sqrt(radius_ * radius_ - height * height) : radius_;
    const Vector3<double>& p = pose.position;
    return {p.x - reach, p.x + reach, p.y - reach, p.y + reach};
  }
  bool column_contact(const ShapePose& pose, const ColumnPlace& place, double top,
                      ColumnContactPoint& contact) const override {
    const double dx = place.at_x - pose.position.x, dy = place.at_y - pose.position.y;
    const double rest = radius_ * radius_ - dx * dx - dy * dy;
    if (!(rest > 0.0)) return false;
    const double down = std::sqrt(rest), z = pose.position.z - down;
    if (z >= top) return false;
    contact = {{place.at_x, place.at_y, z}, {dx / radius_, dy / radius_, -down / radius_}, 1.0};
    return true;
  }
  double width() const override { return 0.0; }
  std::string set_up() const override { return fmt::format("ball of radius {} m", radius_); }

 private:
  double radius_;
};

/// A wheel or roller: a cylinder whose axis is y of its frame, centred there. A column at its edge counts with the
/// share that lies under it, so the grid does not change its width.
class ColumnCylinder final : public ColumnShape {
 public:
  /// Throws Error unless radius and width (m) are positive.
  ColumnCylinder(double radius, double width)
      : radius_(require_positive(radius, "radius of a wheel on soil columns", "m")),
        half_(0.5 * require_positive(width, "width of a wheel on soil columns", "m")) {}

  PlanBox shadow(const ShapePose& pose, double top) const override {
    const Vector3<double> a = axis(pose);
    const double height = pose.position.z - half_ * std::abs(a.z) - top;
    if (height >= radius_) return PlanBox::nothing();
    const double reach = height > 0.0 && std::abs(a.z) < 0.7 ? std::sqrt(radius_ * radius_ - height * height) : radius_;
    // Of a disc of radius `reach` across the axis, moved along it by the half width; a tilted wheel's disc leans.
    const auto extent = [&](double along) { return std::sqrt(std::max(0.0, 1.0 - along * along)); };
    const double lean = std::abs(a.z) < 0.7 ? std::abs(a.z) * radius_ : 0.0;
    const double ex = reach * extent(a.x) + half_ * std::abs(a.x) + lean,
                 ey = reach * extent(a.y) + half_ * std::abs(a.y) + lean;
    const Vector3<double>& p = pose.position;
    return {p.x - ex, p.x + ex, p.y - ey, p.y + ey};
  }
  bool column_contact(const ShapePose& pose, const ColumnPlace& place, double top,
                      ColumnContactPoint& contact) const override {
    const Vector3<double> a = axis(pose);
    const double level2 = 1.0 - a.z * a.z;
    Vector3<double> q = {place.at_x - pose.position.x, place.at_y - pose.position.y, 0.0};
    // Most columns that are asked lie before or behind what presses. Along the axis the height changes by its slope.
    const bool low =
        level2 > 1e-12 && lateral(a, level2, q, top - pose.position.z + 2.0 * place.spacing * std::abs(a.z) / level2);
    if (low) {
      // The share along the axis is the whole column's, the height that of its point.
      Vector3<double> centre = {place.x - pose.position.x, place.y - pose.position.y, 0.0};
      const double extent = place.spacing * (std::abs(a.x) + std::abs(a.y));
      if (lateral(a, level2, centre)) {
        double middle = 0.0;
        const double share = detail::covered(dot(a, centre), extent, half_, middle);
        bool found = share > 0.0;
        if (found && share < 1.0) {
          const double along = dot(a, q);
          q.x += (middle - along) * a.x / level2;
          q.y += (middle - along) * a.y / level2;
          found = lateral(a, level2, q);
        }
        if (found) {
          contact.point = pose.position + q;
          contact.normal = (1.0 / radius_) * (q - dot(a, q) * a);
          contact.share = share;
          return contact.point.z < top && contact.normal.z < 0.0;
        }
      }
    }
    return on_side(pose, a, q, top, contact);
  }
  double width() const override { return std::min(2.0 * half_, 2.0 * radius_); }
  std::string set_up() const override {
    return fmt::format("cylinder of radius {} m and width {} m", radius_, 2.0 * half_);
  }

 private:
  static Vector3<double> axis(const ShapePose& pose) {
    return {pose.rotation.row0.y, pose.rotation.row1.y, pose.rotation.row2.y};
  }
  /// The lower of the heights at which the vertical through q, from the centre, leaves the endless cylinder; false
  /// where it does not, or not below `top` (m, from the centre), which is found without the root.
  bool lateral(const Vector3<double>& a, double level2, Vector3<double>& q, double top = 1e300) const {
    const double along = a.x * q.x + a.y * q.y;
    const double rest =
        (radius_ * radius_ - q.x * q.x - q.y * q.y + along * along) * level2 + a.z * a.z * along * along;
    const double down = a.z * along - top * level2;  // the root has to be more
    if (!(rest > 0.0) || (down > 0.0 && rest < down * down)) return false;
    q.z = (a.z * along - std::sqrt(rest)) / level2;
    return true;
  }
  /// The flat side that looks down, where the wheel leans by more than 6 degrees.
  bool on_side(const ShapePose& pose, const Vector3<double>& a, Vector3<double> q, double top,
               ColumnContactPoint& contact) const {
    if (std::abs(a.z) < 0.1) return false;
    const Vector3<double> down = a.z < 0.0 ? a : -a;
    q.z = (half_ - down.x * q.x - down.y * q.y) / down.z;
    const Vector3<double> across = q - half_ * down;
    if (dot(across, across) > radius_ * radius_ || pose.position.z + q.z >= top) return false;
    contact = {pose.position + q, down, 1.0};
    return true;
  }

  double radius_, half_;
};

/// A plate, shoe or block: a box centred at its frame, with its edges along the axes there. A column at its edge counts
/// with the share that lies under it. Of pieces in a row along x, as of a tread or a track, a column at the edge
/// between two is whole under the one that its point is under.
class ColumnBox final : public ColumnShape {
 public:
  /// Throws Error unless all edges (m) are positive.
  explicit ColumnBox(const Vector3<double>& edges, bool is_in_a_row = false) : half_(0.5 * edges), row_(is_in_a_row) {
    for (const double e : {edges.x, edges.y, edges.z}) require_positive(e, "edge of a box on soil columns", "m");
  }

  PlanBox shadow(const ShapePose& pose, double top) const override {
    const Matrix3<double>& r = pose.rotation;
    const auto reach = [&](const Vector3<double>& row) {
      return std::abs(row.x) * half_.x + std::abs(row.y) * half_.y + std::abs(row.z) * half_.z;
    };
    const Vector3<double>& p = pose.position;
    if (p.z - reach(r.row2) >= top) return PlanBox::nothing();
    const double ex = reach(r.row0), ey = reach(r.row1);
    return {p.x - ex, p.x + ex, p.y - ey, p.y + ey};
  }
  bool column_contact(const ShapePose& pose, const ColumnPlace& place, double top,
                      ColumnContactPoint& contact) const override {
    const Vector3<double>& up = pose.rotation.row2;
    const double reach = std::abs(up.x) * half_.x + std::abs(up.y) * half_.y + std::abs(up.z) * half_.z;
    if (pose.position.z - reach >= top) return false;
    const Matrix3<double> axes = transposed(pose.rotation);  // rows: the box's axes in global ones
    const std::array<Vector3<double>, 3> axis = {axes.row0, axes.row1, axes.row2};
    const std::array<double, 3> half = {half_.x, half_.y, half_.z};
    const Vector3<double> q = {place.x - pose.position.x, place.y - pose.position.y, 0.0};
    const Vector3<double> at = {place.at_x - pose.position.x, place.at_y - pose.position.y, 0.0};
    std::size_t flattest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (std::abs(axis[k].z) > std::abs(axis[flattest].z)) flattest = k;
    }
    if (row_ && flattest != 0) return on_face(pose, axis, half, flattest, q, &at, place.spacing, top, contact);
    return on_face(pose, axis, half, flattest, q, nullptr, place.spacing, top, contact) ||
           on_any(pose, axis, half, q, top, contact);
  }
  /// The smaller of the edges along x and y of the box.
  double width() const override { return 2.0 * std::min(half_.x, half_.y); }
  std::string set_up() const override {
    return fmt::format("box{} of {} x {} x {} m", row_ ? " in a row" : "", 2.0 * half_.x, 2.0 * half_.y, 2.0 * half_.z);
  }

 private:
  using Axes = std::array<Vector3<double>, 3>;

  /// The face that looks down most, with the shares of the columns at its edges; of a piece in a row with those at its
  /// sides, `point` being the column's.
  static bool on_face(const ShapePose& pose, const Axes& axis, const std::array<double, 3>& half, std::size_t k,
                      const Vector3<double>& centre, const Vector3<double>* point, double spacing, double top,
                      ColumnContactPoint& contact) {
    const Vector3<double> normal = axis[k].z < 0.0 ? axis[k] : -axis[k];
    const auto drop = [&](Vector3<double> at) {
      at.z = (half[k] - normal.x * at.x - normal.y * at.y) / normal.z;
      return at;
    };
    Vector3<double> q = drop(centre), shift = {0, 0, 0};
    double share = 1.0;
    for (const std::size_t side : {(k + 1) % 3, (k + 2) % 3}) {
      const Vector3<double>& u = axis[side];
      // Along the face, a step of 1 over the ground in its direction is a step of 1 over its slope.
      const double level = std::sqrt(u.x * u.x + u.y * u.y);
      if (level < 1e-9) return false;
      if (point != nullptr && side == 0) {
        const double along = dot(u, drop(*point));
        if (std::abs(along) > half[0]) return false;
        shift += (along - dot(u, q)) * u;
        continue;
      }
      const double extent = spacing * (std::abs(u.x) + std::abs(u.y)) / (level * level), along = dot(u, q);
      double middle = along;
      share *= detail::covered(along, extent, half[side], middle);
      shift += (middle - along) * u;
    }
    if (!(share > 0.0)) return false;
    q = drop(q + shift);
    contact = {pose.position + q, normal, share};
    return contact.point.z < top;
  }
  /// Whichever face the vertical enters by, for blocks that lean.
  static bool on_any(const ShapePose& pose, const Axes& axis, const std::array<double, 3>& half,
                     const Vector3<double>& q, double top, ColumnContactPoint& contact) {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    std::size_t face = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = axis[k].x * q.x + axis[k].y * q.y, step = axis[k].z;
      if (std::abs(step) < 1e-9) {
        if (std::abs(at) > half[k]) return false;
        continue;
      }
      const double one = (-half[k] - at) / step, other = (half[k] - at) / step;
      if (std::min(one, other) > low) {
        low = std::min(one, other);
        face = k;
      }
      high = std::min(high, std::max(one, other));
    }
    if (face == 3 || !(low < high) || std::abs(axis[face].z) < 0.1 || pose.position.z + low >= top) return false;
    contact = {pose.position + Vector3<double>{q.x, q.y, low}, axis[face].z < 0.0 ? axis[face] : -axis[face], 1.0};
    return true;
  }

  Vector3<double> half_;
  bool row_;
};

}  // namespace dem::terramechanics
