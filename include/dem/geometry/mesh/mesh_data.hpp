#pragma once

#include <dem/core/macros.hpp>
#include <dem/geometry/edge_set.hpp>
#include <dem/geometry/mesh/mesh_groups.hpp>
#include <dem/geometry/mesh/mesh_repair.hpp>
#include <dem/geometry/point_set.hpp>

namespace dem::surface {

/// A triangle and the place on it that is nearest to a point.
struct NearestOnFace {
  enum class Part : std::uint8_t { face, edge, vertex };
  Vector3<double> point;  ///< m
  Part part;
  std::uint8_t number;  ///< of the edge or corner
};

/// A triangle as a query wants it.
struct Face {
  Vector3<double> a, ab, ac;  ///< m, first corner and from there to the others
  Vector3<double> normal;

  /// The nearest point by the regions of the triangle's plane in which corners, edges and the face are nearest
  /// (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
  DEM_HOT NearestOnFace nearest(const Vector3<double>& p) const {
    using Part = NearestOnFace::Part;
    const Vector3<double> ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return {a, Part::vertex, 0};
    const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const double d3 = d1 - bb, d4 = d2 - bc;
    if (d3 >= 0.0 && d4 <= d3) return {a + ab, Part::vertex, 1};
    const double d5 = d1 - bc, d6 = d2 - cc;
    if (d6 >= 0.0 && d5 <= d6) return {a + ac, Part::vertex, 2};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + (d1 / bb) * ab, Part::edge, 0};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + (d2 / cc) * ac, Part::edge, 2};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
      const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
      return {(a + ab) + w * (ac - ab), Part::edge, 1};
    }
    const double share = 1.0 / (va + vb + vc);
    return {a + (vb * share) * ab + (vc * share) * ac, Part::face, 0};
  }
};

/// What a TriangleMesh is made of once it is checked: built once, then only read, and shared by all copies.
struct MeshData {
  IndexedMesh mesh;  ///< triangles in the order of the tree's leaves
  MeshReport report;
  MeshTopology topology;
  MeshGroups groups;
  BoundingVolumeTree tree;
  std::vector<Face> faces;
  std::vector<Vector3<double>> vertices, vertex_normal;  ///< the latter weighted by angle (Baerentzen & Aanaes 2005)
  std::vector<std::uint32_t> vertex_group;               ///< smallest of its triangles
  std::vector<char> vertex_flat, vertex_rim;             ///< 1: all its triangles lie in one plane; on an open edge
  std::vector<std::uint32_t> ring_first, ring;           ///< vertices at the other end of each vertex's edges
  PointSet points;                                       ///< vertices, and points on long sharp edges
  PointSet corners;  ///< those of them that stick out: on sharp edges, or on a convex surface
  EdgeSet edges;     ///< that stick out, see is_ridge
  EdgeSet bends;     ///< others that are long, see is_long_bend; for bodies, which may meet between far vertices
  Aabb bounds;
  double mean_edge = 0.0;  ///< m
};

namespace detail {

inline Vector3<double> unit_or_zero(const Vec3& v) {
  const double length = v.norm();
  return from_eigen(length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero()));
}

/// The same direction but for rounding.
inline bool is_flat(const Vector3<double>& a, const Vector3<double>& b) {
  const Vector3<double> d = a - b;
  return dot(d, d) < 1e-24;
}

DEM_LAZY void find_vertices(MeshData& m);

/// Whether the surface bends away on all in all around a vertex, by more than rounding.
DEM_LAZY bool is_convex(const MeshData& m, std::uint32_t v);

/// Sine of the angle by which the surface bends away at edge k of triangle t. It is 1 where the surface ends or turns
/// by more than a right angle, and 0 where it is flat or concave.
DEM_LAZY double bend(const MeshData& m, std::uint32_t t, std::size_t k);
/// Whether the surface ends at an edge or bends away by more than 0.02 rad. At a smaller bend an edge needs no points
/// of its own: the flat side of a grain on it reaches the faces beside it before it has sunk by a hundredth of its half
/// size.
inline bool is_ridge(double bend) { return bend > 0.02; }
/// Whether an edge of a smaller turn is longer than a quarter of the radius of the bend, as those of a finely cut
/// cylinder: its vertices are then too far apart to stand for it. `bend` as above, `width` of the narrower triangle.
inline bool is_long_bend(double bend, double length, double width) {
  return bend > 1e-5 && bend * length > 0.25 * width;  // below is the rounding of single precision
}
DEM_LAZY void find_edges(MeshData& m);

/// Vertices, and points on sharp edges that are longer than the spacing (m; 0: none). Throws Error for more than the
/// keys of contacts can tell apart.
DEM_LAZY void find_points(MeshData& m, double spacing);

}  // namespace detail

/// Repairs a mesh and builds what queries need. Throws Error as `repaired` does.
DEM_LAZY MeshData build_mesh(const IndexedMesh& given, MeshFacing facing, double smooth_angle, double point_spacing,
                             double tolerance);

}  // namespace dem::surface

#if DEM_DEFINES

namespace dem::surface::detail {

DEM_LAZY_INLINE void find_vertices(MeshData& m) {
  const std::size_t n = m.mesh.vertices.size();
  std::vector<Vec3> normal(n, Vec3::Zero());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  m.vertex_group.assign(n, MeshTopology::none);
  for (std::uint32_t t = 0; t < m.faces.size(); ++t) {
    const auto& tri = m.mesh.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = tri[k], next = tri[(k + 1) % 3], last = tri[(k + 2) % 3];
      const Vec3 a = m.mesh.vertices[next] - m.mesh.vertices[v], b = m.mesh.vertices[last] - m.mesh.vertices[v];
      normal[v] += std::atan2(cross(a, b).norm(), a.dot(b)) * to_eigen(m.faces[t].normal);
      edges.emplace_back(v, next);
      edges.emplace_back(next, v);
      m.vertex_group[v] = std::min(m.vertex_group[v], m.groups.group[t]);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  m.ring_first.assign(n + 1, 0);
  for (const auto& [from, to] : edges) {
    ++m.ring_first[from + 1];
    m.ring.push_back(to);
    if (from < to) m.mean_edge += (m.mesh.vertices[to] - m.mesh.vertices[from]).norm();
  }
  m.mean_edge /= static_cast<double>(edges.size() / 2);
  for (std::size_t v = 0; v < n; ++v) {
    m.ring_first[v + 1] += m.ring_first[v];
    m.vertices.push_back(from_eigen(m.mesh.vertices[v]));
    m.vertex_normal.push_back(unit_or_zero(normal[v]));
  }
  m.vertex_flat.assign(n, 1);
  m.vertex_rim.assign(n, 0);
  for (std::size_t t = 0; t < m.faces.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = m.mesh.triangles[t][k];
      m.vertex_flat[v] &= static_cast<char>(is_flat(m.faces[t].normal, m.vertex_normal[v]));
      if (m.topology.neighbour[t][k] == MeshTopology::none) {
        m.vertex_rim[v] = m.vertex_rim[m.mesh.triangles[t][(k + 1) % 3]] = 1;
      }
    }
  }
}

DEM_LAZY_INLINE bool is_convex(const MeshData& m, std::uint32_t v) {
  double height = 0.0, length = 0.0;
  for (std::uint32_t k = m.ring_first[v]; k < m.ring_first[v + 1]; ++k) {
    const Vector3<double> along = m.vertices[m.ring[k]] - m.vertices[v];
    height += dot(along, m.vertex_normal[v]);
    length += norm(along);
  }
  return height < -1e-6 * length;
}

DEM_LAZY_INLINE double bend(const MeshData& m, std::uint32_t t, std::size_t k) {
  const std::uint32_t other = m.topology.neighbour[t][k];
  if (other == MeshTopology::none) return 1.0;
  const Vector3<double>&n = m.faces[t].normal, &across = m.faces[other].normal;
  double height = 0.0;  // of the other triangle over this one's plane
  for (const std::uint32_t v : m.mesh.triangles[other]) height += dot(n, m.vertices[v] - m.faces[t].a);
  if (!(height < 0.0)) return 0.0;
  return dot(n, across) < 0.0 ? 1.0 : norm(cross(n, across));
}

DEM_LAZY_INLINE void find_edges(MeshData& m) {
  std::vector<std::array<Vec3, 2>> edges, bends;
  for (std::uint32_t t = 0; t < m.faces.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = m.topology.neighbour[t][k];
      if (other != MeshTopology::none && other < t) continue;
      const auto& corner = m.mesh.triangles[t];
      const std::array<Vec3, 2> ends = {m.mesh.vertices[corner[k]], m.mesh.vertices[corner[(k + 1) % 3]]};
      const double turn = bend(m, t, k), length = (ends[1] - ends[0]).norm();
      if (is_ridge(turn)) {
        edges.push_back(ends);
      } else if (is_long_bend(turn, length,
                              std::min(m.mesh.area_vector(t).norm(), m.mesh.area_vector(other).norm()) / length)) {
        bends.push_back(ends);
      }
    }
  }
  m.edges = EdgeSet(edges);
  m.bends = EdgeSet(bends);
}

DEM_LAZY_INLINE void find_points(MeshData& m, double spacing) {
  constexpr double most_points = 1 << 22;
  if (static_cast<double>(m.mesh.vertices.size()) > most_points) {
    fail("a mesh has {} vertices, but at most {:g} can be told apart; simplify it, or cut it into several surfaces",
         m.mesh.vertices.size(), most_points);
  }
  std::vector<Vec3> on_edges, corners;
  std::vector<bool> sharp(m.mesh.vertices.size(), false);
  for (std::uint32_t t = 0; t < m.faces.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = m.mesh.triangles[t][k], b = m.mesh.triangles[t][(k + 1) % 3];
      if (!m.groups.sharp[t][k]) continue;
      sharp[a] = sharp[b] = true;
      const std::uint32_t other = m.topology.neighbour[t][k];
      if (spacing <= 0.0 || (other != MeshTopology::none && other < t)) continue;
      const Vec3 from = m.mesh.vertices[a], along = m.mesh.vertices[b] - from;
      const double needed = std::ceil(along.norm() / spacing);
      if (static_cast<double>(on_edges.size() + m.mesh.vertices.size()) + needed > most_points) {
        fail("points on the edges of a mesh, {:g} m apart, would be more than {:g}; raise point_spacing", spacing,
             most_points);
      }
      const int pieces = static_cast<int>(needed);
      for (int p = 1; p < pieces; ++p) on_edges.push_back(from + (double(p) / pieces) * along);
    }
  }
  for (std::uint32_t v = 0; v < sharp.size(); ++v) {
    if (sharp[v] || is_convex(m, v)) corners.push_back(m.mesh.vertices[v]);
  }
  std::vector<Vec3> points = m.mesh.vertices;
  points.insert(points.end(), on_edges.begin(), on_edges.end());
  corners.insert(corners.end(), on_edges.begin(), on_edges.end());
  m.points = PointSet(points);
  m.corners = PointSet(corners);
}

}  // namespace dem::surface::detail

namespace dem::surface {

DEM_LAZY_INLINE MeshData build_mesh(const IndexedMesh& given, MeshFacing facing, double smooth_angle,
                                    double point_spacing, double tolerance) {
  RepairedMesh whole = repaired(given, facing, tolerance);
  MeshData m;
  m.report = whole.report;
  std::vector<Aabb> boxes;
  m.bounds = {filled(1e300), filled(-1e300)};
  for (std::size_t t = 0; t < whole.mesh.triangles.size(); ++t) {
    const Vec3 a = whole.mesh.corner(t, 0), b = whole.mesh.corner(t, 1), c = whole.mesh.corner(t, 2);
    boxes.push_back({lower(lower(a, b), c), upper(upper(a, b), c)});
    m.bounds = {lower(m.bounds.low, boxes.back().low), upper(m.bounds.high, boxes.back().high)};
  }
  m.tree = BoundingVolumeTree(boxes);
  m.mesh.vertices = std::move(whole.mesh.vertices);
  for (const std::uint32_t t : m.tree.order()) m.mesh.triangles.push_back(whole.mesh.triangles[t]);
  m.topology = topology_of(m.mesh);
  for (std::size_t t = 0; t < m.mesh.triangles.size(); ++t) {
    const Vec3 a = m.mesh.corner(t, 0);
    m.faces.push_back({from_eigen(a), from_eigen(Vec3(m.mesh.corner(t, 1) - a)),
                       from_eigen(Vec3(m.mesh.corner(t, 2) - a)), detail::unit_or_zero(m.mesh.area_vector(t))});
    // Neighbours that look the other way (on a Moebius strip) are treated as if the surface ended there.
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& other = m.topology.neighbour[t][k];
      const auto& tri = m.mesh.triangles[t];
      if (other != MeshTopology::none && dem::detail::runs(m.mesh.triangles[other], tri[k], tri[(k + 1) % 3])) {
        other = MeshTopology::none;
      }
    }
  }
  m.groups = group_triangles(m.mesh, m.topology, smooth_angle);
  detail::find_vertices(m);
  detail::find_points(m, point_spacing);
  detail::find_edges(m);
  return m;
}

}  // namespace dem::surface

#endif
