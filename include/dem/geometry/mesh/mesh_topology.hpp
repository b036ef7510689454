#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/indexed_mesh.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace dem {

/// The edges by which a mesh is open, or has no sides.
struct BadEdges {
  std::size_t boundary_edges = 0;      ///< that belong to one triangle only
  std::size_t non_manifold_edges = 0;  ///< that belong to three or more
  std::size_t inconsistent_edges = 0;  ///< whose two triangles run along them the same way
  Vec3 boundary_at = Vec3::Zero(), non_manifold_at = Vec3::Zero(), inconsistent_at = Vec3::Zero();  ///< m, the first
};

/// Who shares which edge. Edge k of a triangle leads from its corner k to its corner k + 1.
struct MeshTopology : BadEdges {
  static constexpr std::uint32_t none = 0xffffffffu;

  std::vector<std::array<std::uint32_t, 3>> neighbour;  ///< triangle across each edge; none: boundary or non-manifold

  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0; }
  bool oriented() const { return inconsistent_edges == 0; }
};

/// Pairs the triangles' edges by sorting them: O(n log n).
DEM_LAZY MeshTopology topology_of(const IndexedMesh& mesh);

}  // namespace dem

#if DEM_DEFINES

namespace dem {

DEM_LAZY_INLINE MeshTopology topology_of(const IndexedMesh& mesh) {
  struct Use {
    std::uint32_t low, high, triangle;
    std::uint8_t edge;
    bool forward;
  };
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1u) % 3u];
      uses.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
  });
  MeshTopology topology;
  topology.neighbour.assign(mesh.triangles.size(), {MeshTopology::none, MeshTopology::none, MeshTopology::none});
  for (std::size_t from = 0, to = 0; from < uses.size(); from = to) {
    while (to < uses.size() && uses[to].low == uses[from].low && uses[to].high == uses[from].high) ++to;
    const auto count = [&, middle = 0.5 * (mesh.vertices[uses[from].low] + mesh.vertices[uses[from].high])](
                           std::size_t& edges, Vec3& at) {
      if (edges++ == 0) at = middle;
    };
    if (to - from == 1) count(topology.boundary_edges, topology.boundary_at);
    if (to - from > 2) count(topology.non_manifold_edges, topology.non_manifold_at);
    if (to - from != 2) continue;
    const Use &a = uses[from], &b = uses[from + 1];
    topology.neighbour[a.triangle][a.edge] = b.triangle;
    topology.neighbour[b.triangle][b.edge] = a.triangle;
    if (a.forward == b.forward) count(topology.inconsistent_edges, topology.inconsistent_at);
  }
  return topology;
}

}  // namespace dem

#endif
