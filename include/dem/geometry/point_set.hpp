#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/bounding_volume_tree.hpp>

#include <vector>

namespace dem::surface {

/// Points of a surface in a box tree; a point's number is its place in the tree, so queries find numbers ascending.
class PointSet {
 public:
  PointSet() = default;
  DEM_LAZY explicit PointSet(const std::vector<Vec3>& points);

  std::size_t size() const { return points_.size(); }
  const Vector3<double>& operator[](std::size_t number) const { return points_[number]; }

  /// f(number, point) for the points within a radius of p.
  template <class F>
  void for_each_near(const Vector3<double>& p, double radius, F&& f) const {
    const double reach2 = radius * radius;
    tree_.for_each_near(p, reach2, [&](std::uint32_t k) {
      const Vector3<double> d = points_[k] - p;
      if (dot(d, d) <= reach2) f(k, points_[k]);
    });
  }
  /// f(number, point) for the points in a box.
  template <class F>
  void for_each_in(const Aabb& box, F&& f) const {
    const Vector3<double> low = from_eigen(box.low), high = from_eigen(box.high);
    tree_.for_each_in(low, high, [&](std::uint32_t k) {
      const Vector3<double>& p = points_[k];
      if (p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z) f(k, p);
    });
  }

 private:
  BoundingVolumeTree tree_;
  std::vector<Vector3<double>> points_;
};

}  // namespace dem::surface

#if DEM_DEFINES

namespace dem::surface {

DEM_LAZY_INLINE PointSet::PointSet(const std::vector<Vec3>& points) {
  std::vector<Aabb> boxes;
  for (const Vec3& p : points) boxes.push_back({p, p});
  tree_ = BoundingVolumeTree(boxes);
  for (const std::uint32_t k : tree_.order()) points_.push_back(from_eigen(points[k]));
}

}  // namespace dem::surface

#endif
