#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/surface.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace dem::surface {

/// Recursive bounding boxes (thesis section 2.2.4): the boxes of the items are halved at the median of their longest
/// extent until a box holds a few, O(n log n). Nodes lie in one array in the order of a descent; each knows where to go
/// on when it is missed, so a query is one loop without a stack.
class BoundingVolumeTree {
 public:
  static constexpr std::uint32_t items_in_a_leaf = 2;

  BoundingVolumeTree() = default;
  DEM_LAZY explicit BoundingVolumeTree(std::span<const Aabb> boxes);

  /// Items in the order of the leaves: store them so, and place k is item order()[k].
  const std::vector<std::uint32_t>& order() const { return order_; }
  std::size_t nodes() const { return nodes_.size(); }

  /// Calls f(place) for every place whose leaf comes within sqrt(reach2) of the point, places ascending. f may lower
  /// reach2 meanwhile: a search for the nearest.
  template <class F>
  DEM_HOT void for_each_near(const Vector3<double>& p, const double& reach2, F&& f) const {
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      const bool hit = distance2(node, p) <= reach2;
      if (hit) visit(node, f);
      n = hit ? n + 1 : node.skip;
    }
  }
  /// True if some leaf comes within sqrt(reach2) of the point.
  bool reaches(const Vector3<double>& p, double reach2) const {
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const bool hit = distance2(nodes_[n], p) <= reach2;
      if (hit && nodes_[n].count > 0) return true;
      n = hit ? n + 1 : nodes_[n].skip;
    }
    return false;
  }
  /// Calls f(place) for every place whose leaf overlaps the box, places ascending.
  template <class F>
  DEM_HOT void for_each_in(const Vector3<double>& low, const Vector3<double>& high, F&& f) const {
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      const bool hit = node.low.x <= high.x && node.low.y <= high.y && node.low.z <= high.z && node.high.x >= low.x &&
                       node.high.y >= low.y && node.high.z >= low.z;
      if (hit) visit(node, f);
      n = hit ? n + 1 : node.skip;
    }
  }
  /// Calls f(place) for every place whose leaf the way from tail to head meets, places ascending.
  template <class F>
  void for_each_along(const Vector3<double>& tail, const Vector3<double>& head, F&& f) const {
    const Vector3<double> d = head - tail;
    for (std::uint32_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      const bool hit = meets(node, tail, d);
      if (hit) visit(node, f);
      n = hit ? n + 1 : node.skip;
    }
  }

 private:
  struct Node {
    Vector3<double> low, high;
    std::uint32_t skip;          ///< node to go on with when this one is missed
    std::uint32_t first, count;  ///< places of a leaf; count 0: an inner node
  };

  static DEM_HOT double distance2(const Node& node, const Vector3<double>& p) {
    const double x = max(max(node.low.x - p.x, p.x - node.high.x), 0.0);
    const double y = max(max(node.low.y - p.y, p.y - node.high.y), 0.0);
    const double z = max(max(node.low.z - p.z, p.z - node.high.z), 0.0);
    return x * x + y * y + z * z;
  }

  /// Whether the way from p by d meets a node's box, or passes it by no more than rounding.
  static bool meets(const Node& node, const Vector3<double>& p, const Vector3<double>& d) {
    const Vector3<double> middle = 0.5 * (node.low + node.high), half = 0.5 * (node.high - node.low);
    const double slack = 1e-9 * (half.x + half.y + half.z);
    double from = 0.0, to = 1.0;
    return clip_between(p.x - middle.x, d.x, half.x + slack, from, to) &&
           clip_between(p.y - middle.y, d.y, half.y + slack, from, to) &&
           clip_between(p.z - middle.z, d.z, half.z + slack, from, to);
  }

  template <class F>
  static DEM_HOT void visit(const Node& node, F&& f) {
    for (std::uint32_t k = 0; k < node.count; ++k) f(node.first + k);
  }

  void split(std::span<const Aabb> boxes, const std::vector<Vec3>& middle, std::uint32_t from, std::uint32_t to);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace dem::surface

#if DEM_DEFINES
#include <numeric>

namespace dem::surface {

DEM_LAZY_INLINE BoundingVolumeTree::BoundingVolumeTree(std::span<const Aabb> boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3> middle;
  for (const Aabb& b : boxes) middle.push_back(0.5 * (b.low + b.high));
  if (!boxes.empty()) split(boxes, middle, 0, static_cast<std::uint32_t>(boxes.size()));
}

DEM_INLINE void BoundingVolumeTree::split(std::span<const Aabb> boxes, const std::vector<Vec3>& middle,
                                          std::uint32_t from, std::uint32_t to) {
  const std::size_t self = nodes_.size();
  Vec3 low = filled(1e300), high = -low, first = low, last = high;
  for (std::uint32_t k = from; k < to; ++k) {
    low = lower(low, boxes[order_[k]].low);
    high = upper(high, boxes[order_[k]].high);
    first = lower(first, middle[order_[k]]);
    last = upper(last, middle[order_[k]]);
  }
  nodes_.push_back({from_eigen(low), from_eigen(high), 0, from, to - from});
  if (to - from > items_in_a_leaf) {
    nodes_[self].count = 0;
    Eigen::Index axis = 0;
    (last - first).maxCoeff(&axis);
    const std::uint32_t half = from + (to - from) / 2;
    std::nth_element(order_.begin() + from, order_.begin() + half, order_.begin() + to,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return std::pair(middle[a][axis], a) < std::pair(middle[b][axis], b);
                     });
    split(boxes, middle, from, half);
    split(boxes, middle, half, to);
  }
  nodes_[self].skip = static_cast<std::uint32_t>(nodes_.size());
}

}  // namespace dem::surface

#endif
