#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/bounding_volume_tree.hpp>

#include <array>
#include <vector>

namespace dem::surface {

/// The weight of a point of an edge, `to_end` (m) from the nearer end, where a grain of that radius is near: it fades
/// where the edge ends, as its corners take over.
DEM_HOT double weight_on_edge(double to_end, double radius) { return min(1.0, 4.0 * to_end / radius); }

/// Points that stand for a straight edge where a sharp grain is near it: the one nearest to p and those half a radius
/// to either side, if they lie within the radius of p, callback(place, point, weight).
template <class Callback>
void points_of_edge(const Vector3<double>& tail, const Vector3<double>& head, const Vector3<double>& p, double radius,
                    Callback&& callback) {
  const double length = norm(head - tail);
  const Vector3<double> along = (1.0 / length) * (head - tail);
  const double foot = dot(p - tail, along);
  for (std::uint32_t place = 0; place < 3; ++place) {
    const double at = foot + (0.5 * place - 0.5) * radius, to_end = min(at, length - at);
    if (!(to_end > 0.0)) continue;
    const Vector3<double> point = tail + at * along, d = point - p;
    if (dot(d, d) <= radius * radius) callback(place, point, weight_on_edge(to_end, radius));
  }
}

/// Straight edges of a surface in a box tree; an edge's number is its place in the tree, so queries find numbers
/// ascending.
class EdgeSet {
 public:
  EdgeSet() = default;
  DEM_LAZY explicit EdgeSet(const std::vector<std::array<Vec3, 2>>& edges);

  std::size_t size() const { return ends_.size(); }

  /// f(number, one end, other end) for the edges that may lie in a box.
  template <class F>
  void for_each_in(const Aabb& box, F&& f) const {
    tree_.for_each_in(from_eigen(box.low), from_eigen(box.high),
                      [&](std::uint32_t k) { f(k, ends_[k][0], ends_[k][1]); });
  }
  /// f(number, point, weight) for points_of_edge() of the edges within a radius of p. Edges shorter than a quarter of
  /// it have none: their corners are near enough to each other.
  template <class F>
  void for_each_point_near(const Vector3<double>& p, double radius, F&& f) const {
    const double shortest = 0.25 * radius, reach2 = radius * radius;
    if (longest_ < shortest) return;
    tree_.for_each_near(p, reach2, [&](std::uint32_t k) {
      const auto& [tail, head] = ends_[k];
      if (dot(head - tail, head - tail) < shortest * shortest) return;
      points_of_edge(tail, head, p, radius, [&](std::uint32_t place, const Vector3<double>& point, double weight) {
        f(3 * k + place, point, weight);
      });
    });
  }

 private:
  BoundingVolumeTree tree_;
  std::vector<std::array<Vector3<double>, 2>> ends_;
  double longest_ = 0.0;
};

}  // namespace dem::surface

#if DEM_DEFINES

namespace dem::surface {

DEM_LAZY_INLINE EdgeSet::EdgeSet(const std::vector<std::array<Vec3, 2>>& edges) {
  std::vector<Aabb> boxes;
  for (const auto& [a, b] : edges) boxes.push_back({lower(a, b), upper(a, b)});
  tree_ = BoundingVolumeTree(boxes);
  for (const std::uint32_t k : tree_.order()) {
    ends_.push_back({from_eigen(edges[k][0]), from_eigen(edges[k][1])});
    longest_ = std::max(longest_, (edges[k][1] - edges[k][0]).norm());
  }
}

}  // namespace dem::surface

#endif
