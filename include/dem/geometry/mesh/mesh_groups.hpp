#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_topology.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace dem::surface {

/// How the triangles of a mesh belong together, as a contact sees it. The group of a triangle is the name under which a
/// contact is remembered, so a grain that moves over an edge within a group keeps its friction.
struct MeshGroups {
  std::vector<std::uint32_t> group;        ///< of each triangle
  std::vector<std::array<bool, 3>> sharp;  ///< edge k is boundary, or convex and sharper than the angle
  std::uint32_t count = 0;                 ///< groups
};

/// Groups triangles by their edges. A small turn (rad), convex or concave, is a curved surface: both triangles are in
/// one group. Sharper convex edges join groups too, as a contact moves over them steadily. A sharp concave edge
/// separates groups, as a grain touches both sides at once there. Two groups that meet at such an edge stay apart, and
/// so do two groups that both meet a third one there (the flanks of a slot).
DEM_LAZY MeshGroups group_triangles(const IndexedMesh& mesh, const MeshTopology& topology, double smooth_angle);

}  // namespace dem::surface

#if DEM_DEFINES
#include <numeric>
#include <set>

namespace dem::surface {

namespace detail {

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  /// The second joins the first.
  void join(std::uint32_t root, std::uint32_t other) { parent_[find(other)] = find(root); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace detail

DEM_LAZY_INLINE MeshGroups group_triangles(const IndexedMesh& mesh, const MeshTopology& topology, double smooth_angle) {
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  MeshGroups result;
  result.group.resize(n);
  result.sharp.assign(n, {false, false, false});
  detail::UnionFind smooth(n);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> convex, concave;
  for (std::uint32_t t = 0; t < n; ++t) {
    const Vec3 normal = mesh.area_vector(t).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = topology.neighbour[t][k];
      if (other == MeshTopology::none) {
        result.sharp[t][k] = true;
        continue;
      }
      const Vec3 across = mesh.area_vector(other).normalized();
      const double turn = std::atan2(cross(normal, across).norm(), normal.dot(across));
      double height = 0.0;  // of the other triangle above this one's plane
      for (int c = 0; c < 3; ++c) {
        const double h = normal.dot(mesh.corner(other, c) - mesh.corner(t, 0));
        if (std::abs(h) > std::abs(height)) height = h;
      }
      result.sharp[t][k] = turn > smooth_angle && height < 0.0;
      if (other < t) continue;
      if (turn <= smooth_angle) {
        smooth.join(t, other);
      } else {
        (height < 0.0 ? convex : concave).emplace_back(t, other);
      }
    }
  }

  std::vector<std::set<std::uint32_t>> opposite(n);  // groups across sharp concave edges, by their roots
  for (const auto& [a, b] : concave) {
    const std::uint32_t ra = smooth.find(a), rb = smooth.find(b);
    if (ra == rb) continue;
    opposite[ra].insert(rb);
    opposite[rb].insert(ra);
  }
  const auto apart = [&](std::uint32_t a, std::uint32_t b) {
    if (opposite[a].size() > opposite[b].size()) std::swap(a, b);
    if (opposite[b].contains(a)) return true;
    for (const std::uint32_t x : opposite[a]) {
      if (opposite[b].contains(x)) return true;
    }
    return false;
  };
  for (const auto& [a, b] : convex) {
    std::uint32_t keep = smooth.find(a), give = smooth.find(b);
    if (keep == give || apart(keep, give)) continue;
    if (opposite[keep].size() < opposite[give].size()) std::swap(keep, give);
    for (const std::uint32_t x : opposite[give]) {
      opposite[x].erase(give);
      opposite[x].insert(keep);
      opposite[keep].insert(x);
    }
    opposite[give].clear();
    smooth.join(keep, give);
  }

  std::vector<std::uint32_t> number(n, MeshTopology::none);
  for (std::uint32_t t = 0; t < n; ++t) {
    std::uint32_t& known = number[smooth.find(t)];
    if (known == MeshTopology::none) known = result.count++;
    result.group[t] = known;
  }
  return result;
}

}  // namespace dem::surface

#endif
