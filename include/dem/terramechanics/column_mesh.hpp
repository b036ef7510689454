#pragma once

#include <dem/geometry/mesh/mesh_data.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/terramechanics/column_shape.hpp>

namespace dem::terramechanics {

/// A machine part of triangles, in the mesh's own frame: a wheel with grousers, a track shoe, a blade. Rays are cast
/// upwards through `rays` x `rays` points of each column. The share of them that meets the mesh, up to two columns'
/// edges above the soil, is the share of the column under it; height and normal are those of the ray next to the
/// column's point. Faces steeper than 84 degrees are passed through: soil before a blade or a grouser does not push it
/// (see SoilColumns).
class ColumnMesh final : public ColumnShape {
 public:
  /// `width` (m) is b of the pressure law: the smaller side of what presses on the soil. Throws Error unless it is
  /// positive and 1 <= rays <= 16.
  ColumnMesh(const surface::TriangleMesh& mesh, double width, int rays = 3)
      : mesh_(mesh), width_(require_positive(width, "width of a mesh on soil columns", "m")), rays_(rays) {
    if (rays < 1 || rays > 16)
      fail("a mesh on soil columns has {} rays a side of a column, but 1 to 16 make sense", rays);
    const surface::Aabb box = mesh.data().bounds;
    middle_ = from_eigen(Vec3(0.5 * (box.low + box.high)));
    half_ = from_eigen(Vec3(0.5 * (box.high - box.low)));
  }

  PlanBox shadow(const ShapePose& pose, double top) const override {
    const Matrix3<double>& r = pose.rotation;
    const Vector3<double> p = pose.position + r * middle_;
    if (p.z - reach(r.row2) >= top) return PlanBox::nothing();
    const double ex = reach(r.row0), ey = reach(r.row1);
    return {p.x - ex, p.x + ex, p.y - ey, p.y + ey};
  }
  bool column_contact(const ShapePose& pose, const ColumnPlace& place, double top,
                      ColumnContactPoint& contact) const override {
    const double bottom =
        pose.position.z + dot(pose.rotation.row2, middle_) - reach(pose.rotation.row2) - 1e-3 * place.spacing;
    if (!(bottom < top)) return false;
    const double high = top + 2.0 * place.spacing, pitch = place.spacing / rays_;
    const auto cast = [&](int kx, int ky, ColumnContactPoint& hit) {
      hit.point = {place.x + pitch * (kx + 0.5) - 0.5 * place.spacing,
                   place.y + pitch * (ky + 0.5) - 0.5 * place.spacing, 0.0};
      return lowest(pose, bottom, high, hit);
    };
    const auto next_to = [&](double from_middle) {
      return std::clamp(static_cast<int>(std::floor(from_middle / pitch + 0.5 * rays_)), 0, rays_ - 1);
    };
    const int own_x = next_to(place.at_x - place.x), own_y = next_to(place.at_y - place.y);
    // Most columns that are asked lie before or behind what presses: one ray settles that.
    int hits = cast(own_x, own_y, contact) ? 1 : 0;
    if (hits == 1 && !(contact.point.z < top)) return false;
    double nearest = hits == 1 ? 0.0 : 1e300;
    for (int k = 0; k < rays_ * rays_; ++k) {
      ColumnContactPoint hit;
      if ((k % rays_ == own_x && k / rays_ == own_y) || !cast(k % rays_, k / rays_, hit)) continue;
      ++hits;
      const double dx = hit.point.x - place.at_x, dy = hit.point.y - place.at_y, distance = dx * dx + dy * dy;
      if (distance >= nearest) continue;
      nearest = distance;
      contact = hit;
    }
    contact.share = static_cast<double>(hits) / (rays_ * rays_);
    return hits > 0 && contact.point.z < top;
  }
  double width() const override { return width_; }
  std::string set_up() const override {
    return fmt::format("mesh {:016x} of width {} m with {} rays", mesh_.fingerprint(), width_, rays_);
  }

 private:
  double reach(const Vector3<double>& row) const {
    return std::abs(row.x) * half_.x + std::abs(row.y) * half_.y + std::abs(row.z) * half_.z;
  }
  /// The first face above a point's x and y between two heights (m): sets its height and normal, turned downwards.
  bool lowest(const ShapePose& pose, double bottom, double top, ColumnContactPoint& contact) const {
    constexpr double slack = 1e-9;  // of a triangle's heights, so that a ray through an edge meets it
    const surface::MeshData& m = mesh_.data();
    const Vector3<double> tail =
        transpose_times(pose.rotation, Vector3<double>{contact.point.x, contact.point.y, bottom} - pose.position);
    const Vector3<double> up = transpose_times(pose.rotation, Vector3<double>{0, 0, 1}), way = (top - bottom) * up;
    double nearest = 1.0;
    const surface::Face* found = nullptr;
    m.tree.for_each_along(tail, tail + way, [&](std::uint32_t k) {
      const surface::Face& f = m.faces[k];
      const double fall = dot(way, f.normal);
      if (std::abs(dot(up, f.normal)) < 0.1) return;
      const double at = dot(f.a - tail, f.normal) / fall;
      if (!(at >= 0.0 && at < nearest)) return;
      const Vector3<double> p = tail + at * way - f.a, across = cross(f.ab, f.ac);
      const double whole = dot(across, across), along_ab = dot(cross(p, f.ac), across),
                   along_ac = dot(cross(f.ab, p), across), least = -slack * whole;
      if (!(along_ab >= least && along_ac >= least && along_ab + along_ac <= whole - least)) return;
      nearest = at;
      found = &f;
    });
    if (!found) return false;
    contact.point.z = bottom + nearest * (top - bottom);
    const Vector3<double> n = pose.rotation * found->normal;
    contact.normal = n.z < 0.0 ? n : -n;
    return true;
  }

  surface::TriangleMesh mesh_;
  double width_;
  int rays_;
  Vector3<double> middle_, half_;
};

}  // namespace dem::terramechanics
