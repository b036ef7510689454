#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/mesh/mesh_facing.hpp>

#include <cmath>
#include <string>

namespace dem {

/// What was found in a mesh, and what was done about it. Its bad edges are those that are left after the repair.
struct MeshReport : BadEdges {
  std::size_t vertices = 0, triangles = 0;  ///< left after the repair
  std::size_t merged_vertices = 0;          ///< that lay on another one
  std::size_t unused_vertices = 0;          ///< removed
  std::size_t degenerate_triangles = 0;     ///< without an area: removed, or their long edge flipped
  std::size_t duplicate_triangles = 0;      ///< over the same three vertices as another one: removed
  std::size_t flipped_triangles = 0;        ///< turned round
  std::size_t components = 0;               ///< connected pieces
  double enclosed_volume = 0.0;             ///< m^3, of the closed mesh; negative where it faces inward
  double tolerance = 0.0;                   ///< m, within which vertices are one

  bool closed() const { return triangles > 0 && boundary_edges == 0 && non_manifold_edges == 0; }
  bool oriented() const { return inconsistent_edges == 0; }

  /// One finding a line.
  std::string text() const;
};

struct RepairedMesh {
  IndexedMesh mesh;
  MeshReport report;
};

namespace detail {

/// Merges vertices within the tolerance, through a grid of cells; a vertex goes to the first one near it.
DEM_LAZY std::size_t merge_vertices(IndexedMesh& mesh, double tolerance);

inline bool repeats_a_corner(const std::array<std::uint32_t, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Removes triangles with a repeated corner. One whose corners lie in a line is joined to the neighbour at its longest
/// edge: the two are cut the other way, which closes the surface again; it is removed if there is no neighbour.
DEM_LAZY std::size_t remove_degenerate(IndexedMesh& mesh, double tolerance);

DEM_LAZY std::size_t remove_duplicates(IndexedMesh& mesh);

DEM_LAZY std::size_t remove_unused(IndexedMesh& mesh);

/// Throws Error if more than half of the triangles have vertices that were merged although they are neighbours. A
/// single corrupt coordinate does this: it makes the mesh so large that all else is a point beside it.
DEM_LAZY void refuse_collapse(const IndexedMesh& given, const IndexedMesh& merged, double tolerance);

/// Throws Error for a triangle without an area, hence without a normal. Some are left if more vertices lie in a line
/// than can be joined.
DEM_LAZY void refuse_without_area(const IndexedMesh& mesh);

}  // namespace detail

/// Checks a mesh and repairs what is safe to repair: merges vertices within `tolerance` (m; 0: 1e-9 of the diagonal),
/// removes triangles without an area or there twice, drops unused vertices, and turns triangles that look the wrong
/// way. Holes and edges of more than two triangles are left, and reported. Throws Error for indices out of range,
/// coordinates that are not finite or so far out that all other vertices merge, triangles that have no area after the
/// repair, and a mesh without triangles.
DEM_LAZY RepairedMesh repaired(const IndexedMesh& given, MeshFacing facing = MeshFacing::outward,
                               double tolerance = 0.0);

}  // namespace dem

#if DEM_DEFINES
#include <unordered_map>

namespace dem {

DEM_INLINE std::string MeshReport::text() const {
  std::string s = dem::text("{} triangles over {} vertices in {} connected piece{}\n", triangles, vertices, components,
                            components == 1 ? "" : "s");
  const auto line = [&](std::size_t count, const char* what) {
    if (count > 0) s += dem::text("{} {}\n", count, what);
  };
  line(merged_vertices, "vertices lay on another one and were merged with it");
  line(unused_vertices, "vertices belonged to no triangle and were removed");
  line(degenerate_triangles, "triangles had no area and were removed or joined to a neighbour");
  line(duplicate_triangles, "triangles were there twice; one of each was kept");
  line(flipped_triangles, "triangles looked the wrong way and were turned round");
  const auto edges = [&](std::size_t count, const char* what, const Vec3& at) {
    if (count > 0)
      s += dem::text("{} edges {}; the first lies at ({:g}, {:g}, {:g}) m\n", count, what, at.x(), at.y(), at.z());
  };
  edges(boundary_edges, "belong to one triangle only: the surface has holes or is a sheet", boundary_at);
  edges(non_manifold_edges, "belong to more than two triangles: split the parts that meet there", non_manifold_at);
  edges(inconsistent_edges, "lie between triangles that look opposite ways (a Moebius strip): no side is outside",
        inconsistent_at);
  if (closed()) {
    s += dem::text("closed; encloses {:.6g} m^3{}\n", std::abs(enclosed_volume),
                   enclosed_volume < 0.0 ? ", facing inward (a cavity)" : "");
  } else {
    s += "not closed\n";
  }
  return s;
}

}  // namespace dem

namespace dem::detail {

DEM_LAZY_INLINE std::size_t merge_vertices(IndexedMesh& mesh, double tolerance) {
  struct Hash {
    std::size_t operator()(const std::array<std::int64_t, 3>& c) const {
      return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
    }
  };
  std::unordered_map<std::array<std::int64_t, 3>, std::vector<std::uint32_t>, Hash> cells;
  const double cell = 16.0 * tolerance;
  std::vector<std::uint32_t> target(mesh.vertices.size());
  std::vector<Vec3> kept;
  const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell)); };
  const Vec3 origin = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : mesh.vertices[0];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 x = mesh.vertices[v] - origin;
    std::uint32_t found = MeshTopology::none;
    for (std::int64_t i = index(x.x() - tolerance); i <= index(x.x() + tolerance); ++i) {
      for (std::int64_t j = index(x.y() - tolerance); j <= index(x.y() + tolerance); ++j) {
        for (std::int64_t k = index(x.z() - tolerance); k <= index(x.z() + tolerance); ++k) {
          const auto place = cells.find({i, j, k});
          if (place == cells.end()) continue;
          for (const std::uint32_t other : place->second) {
            if ((kept[other] - mesh.vertices[v]).norm() <= tolerance) found = std::min(found, other);
          }
        }
      }
    }
    if (found == MeshTopology::none) {
      found = static_cast<std::uint32_t>(kept.size());
      kept.push_back(mesh.vertices[v]);
      cells[{index(x.x()), index(x.y()), index(x.z())}].push_back(found);
    }
    target[v] = found;
  }
  for (auto& t : mesh.triangles) {
    for (auto& v : t) v = target[v];
  }
  const std::size_t merged = mesh.vertices.size() - kept.size();
  mesh.vertices = std::move(kept);
  return merged;
}

DEM_LAZY_INLINE std::size_t remove_degenerate(IndexedMesh& mesh, double tolerance) {
  const std::size_t repeated = std::erase_if(mesh.triangles, repeats_a_corner);
  std::size_t fixed = 0;
  for (int round = 0; round < 8; ++round) {
    std::size_t found = 0;
    const MeshTopology topology = topology_of(mesh);
    std::vector<bool> touched(mesh.triangles.size(), false), dead(mesh.triangles.size(), false);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      std::size_t longest = 0;
      double length = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double l = (mesh.corner(t, static_cast<int>((k + 1) % 3)) - mesh.corner(t, static_cast<int>(k))).norm();
        if (l > length) std::tie(longest, length) = std::pair(k, l);
      }
      if (mesh.area_vector(t).norm() > tolerance * length || touched[t]) continue;
      const std::uint32_t a = mesh.triangles[t][longest], c = mesh.triangles[t][(longest + 1) % 3],
                          b = mesh.triangles[t][(longest + 2) % 3], other = topology.neighbour[t][longest];
      if (other != MeshTopology::none && touched[other]) continue;  // next round
      ++found;
      touched[t] = true;
      if (other == MeshTopology::none) {
        dead[t] = true;
        continue;
      }
      touched[other] = true;
      // b lies between a and c; the neighbour (c, a, d) becomes (b, a, d) and (c, b, d), in its own direction.
      const auto& far = mesh.triangles[other];
      const std::uint32_t d = far[0] != a && far[0] != c ? far[0] : far[1] != a && far[1] != c ? far[1] : far[2];
      if (d == b) {  // folded onto itself
        dead[t] = dead[other] = true;
        continue;
      }
      auto first = far, second = far;
      std::replace(first.begin(), first.end(), c, b);
      std::replace(second.begin(), second.end(), a, b);
      mesh.triangles[t] = first;
      mesh.triangles[other] = second;
    }
    std::size_t at = 0;
    std::erase_if(mesh.triangles, [&](const auto&) { return dead[at++]; });
    fixed += found;
    if (found == 0) break;
  }
  return repeated + fixed;
}

DEM_LAZY_INLINE std::size_t remove_duplicates(IndexedMesh& mesh) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> sorted;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    auto key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> dead(mesh.triangles.size(), false);
  for (std::size_t k = 1; k < sorted.size(); ++k) dead[sorted[k].second] = sorted[k].first == sorted[k - 1].first;
  std::size_t at = 0;
  return std::erase_if(mesh.triangles, [&](const auto&) { return dead[at++]; });
}

DEM_LAZY_INLINE std::size_t remove_unused(IndexedMesh& mesh) {
  std::vector<std::uint32_t> target(mesh.vertices.size(), MeshTopology::none);
  std::vector<Vec3> kept;
  for (auto& t : mesh.triangles) {
    for (auto& v : t) {
      if (target[v] == MeshTopology::none) {
        target[v] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(mesh.vertices[v]);
      }
      v = target[v];
    }
  }
  const std::size_t unused = mesh.vertices.size() - kept.size();
  mesh.vertices = std::move(kept);
  return unused;
}

DEM_LAZY_INLINE void refuse_collapse(const IndexedMesh& given, const IndexedMesh& merged, double tolerance) {
  std::size_t collapsed = 0;
  for (std::size_t t = 0; t < merged.triangles.size(); ++t) {
    const bool had_corners = given.corner(t, 0) != given.corner(t, 1) && given.corner(t, 1) != given.corner(t, 2) &&
                             given.corner(t, 2) != given.corner(t, 0);
    collapsed += had_corners && repeats_a_corner(merged.triangles[t]) ? 1 : 0;
  }
  if (2 * collapsed <= merged.triangles.size()) return;
  const auto nearer = [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); };
  const Vec3 far = *std::max_element(merged.vertices.begin(), merged.vertices.end(), nearer);
  fail(
      "{} of the {} triangles of a mesh are smaller than {:.3g} m, 1e-9 of its size: the vertex at ({:g}, {:g}, {:g}) "
      "m "
      "seems to be corrupt; correct or export the mesh again, or give a tolerance",
      collapsed, merged.triangles.size(), tolerance, far.x(), far.y(), far.z());
}

DEM_LAZY_INLINE void refuse_without_area(const IndexedMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.area_vector(t).norm() > 0.0) continue;
    const Vec3 corner = mesh.corner(t, 0);
    fail(
        "a triangle of a mesh with a corner at ({:g}, {:g}, {:g}) m has no area and could not be joined to others; "
        "correct or export the mesh again",
        corner.x(), corner.y(), corner.z());
  }
}

}  // namespace dem::detail

namespace dem {

DEM_LAZY_INLINE RepairedMesh repaired(const IndexedMesh& given, MeshFacing facing, double tolerance) {
  check_indices(given);
  require_non_negative(tolerance, "tolerance of a mesh repair", "m (0 chooses one)");
  RepairedMesh result{given, {}};
  IndexedMesh& mesh = result.mesh;
  MeshReport& report = result.report;
  report.unused_vertices = detail::remove_unused(mesh);  // first: a stray vertex must not set the tolerance
  Vec3 low = filled(1e300), high = -low;
  for (const Vec3& v : mesh.vertices) {
    low = lower(low, v);
    high = upper(high, v);
  }
  const double size = mesh.vertices.empty() ? 0.0 : (high - low).norm();
  if (!(size > 0.0) || size > 1e100 || mesh.triangles.empty()) {
    fail("a mesh has {} triangles over {} vertices and is {:g} m large; it needs at least one triangle with an area",
         mesh.triangles.size(), mesh.vertices.size(), size);
  }
  report.tolerance = std::max(tolerance, 1e-9 * size);
  report.merged_vertices = detail::merge_vertices(mesh, report.tolerance);
  if (tolerance < report.tolerance) detail::refuse_collapse(given, mesh, report.tolerance);
  report.degenerate_triangles = detail::remove_degenerate(mesh, report.tolerance);
  report.duplicate_triangles = detail::remove_duplicates(mesh);
  report.unused_vertices += detail::remove_unused(mesh);
  if (mesh.triangles.empty()) fail("none of the {} triangles of a mesh has an area", given.triangles.size());
  detail::refuse_without_area(mesh);
  std::tie(report.flipped_triangles, report.components) = detail::orient(mesh, facing);
  const MeshTopology topology = topology_of(mesh);
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  static_cast<BadEdges&>(report) = topology;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    report.enclosed_volume += detail::spanned(mesh, t, mesh.vertices[0]) / 6.0;
  }
  return result;
}

}  // namespace dem

#endif
