#pragma once

#include <dem/core/macros.hpp>
#include <dem/core/short_list.hpp>
#include <dem/geometry/mesh/mesh_data.hpp>

#include <algorithm>
#include <vector>

namespace dem::surface {

/// Where a line crosses a surface of triangles.
struct MeshCrossing {
  double at;      ///< share of the way from tail to head
  bool entering;  ///< through the outer side
};
using MeshCrossings = ShortList<MeshCrossing, 16>;

/// Where the way from tail to head (m) crosses the triangles of a mesh, ascending. What only lies in a triangle's plane
/// does not cross it. A way through an edge crosses both its triangles.
DEM_LAZY void find_crossings(const MeshData& m, const Vector3<double>& tail, const Vector3<double>& head,
                             MeshCrossings::Items& crossings);

/// The parts of the way from tail to head (m) that lie in a closed mesh and cross its surface at one end at least:
/// callback(from, to), shares of the way, ascending.
template <class Callback>
void parts_inside(const MeshData& m, const Vector3<double>& tail, const Vector3<double>& head, Callback&& callback) {
  MeshCrossings list;
  auto& crossings = list.items;
  find_crossings(m, tail, head, crossings);
  if (crossings.empty()) return;
  bool inside = !crossings.front().entering;
  double from = 0.0;
  for (const MeshCrossing& c : crossings) {
    if (c.entering == inside) continue;  // once more through an edge
    if (inside && c.at > from) callback(from, c.at);
    inside = c.entering;
    from = c.at;
  }
  if (inside && from < 1.0) callback(from, 1.0);
}

/// Whether a point lies in a closed mesh that looks outward and is that long (m) at most.
DEM_LAZY bool lies_inside(const MeshData& m, const Vector3<double>& p, double size);

}  // namespace dem::surface

#if DEM_DEFINES
#include <numeric>

namespace dem::surface {

DEM_LAZY_INLINE void find_crossings(const MeshData& m, const Vector3<double>& tail, const Vector3<double>& head,
                                    MeshCrossings::Items& crossings) {
  // Of a triangle's heights, so that a way through an edge or a corner misses none of the triangles there.
  constexpr double slack = 1e-9;
  crossings.clear();
  const Vector3<double> d = head - tail;
  m.tree.for_each_along(tail, head, [&](std::uint32_t k) {
    const Face& f = m.faces[k];
    const double fall = dot(d, f.normal);
    if (fall * fall <= 1e-18 * dot(d, d)) return;
    const double at = dot(f.a - tail, f.normal) / fall;
    if (!(at >= 0.0 && at <= 1.0)) return;
    const Vector3<double> p = tail + at * d - f.a;
    const Vector3<double> normal = cross(f.ab, f.ac);  // twice the area long
    const double whole = dot(normal, normal), along_ab = dot(cross(p, f.ac), normal),
                 along_ac = dot(cross(f.ab, p), normal), least = -slack * whole;
    if (along_ab >= least && along_ac >= least && along_ab + along_ac <= whole - least) {
      crossings.push_back({at, fall < 0.0});
    }
  });
  std::sort(crossings.begin(), crossings.end(), [](const MeshCrossing& a, const MeshCrossing& b) {
    return a.at < b.at || (a.at == b.at && a.entering && !b.entering);
  });
}

DEM_LAZY_INLINE bool lies_inside(const MeshData& m, const Vector3<double>& p, double size) {
  bool inside = false;
  parts_inside(m, p, p + 1.2 * size * Vector3<double>{0.27, 0.2, 0.95},
               [&](double from, double) { inside |= from == 0.0; });
  if (!inside) return false;
  // That way may graze an edge, and is then wrong. The solid angle never is, but takes all triangles.
  std::vector<std::uint32_t> all(m.mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return dem::detail::winding_number(m.mesh, all, to_eigen(p)) > 0.5;
}

}  // namespace dem::surface

#endif
