#pragma once

#include <dem/core/short_list.hpp>
#include <dem/geometry/direction_code.hpp>
#include <dem/geometry/mesh/mesh_data.hpp>

#include <cmath>

namespace dem::surface {

/// A local minimum of the distance from a point to a mesh: where a sphere about the point would touch it.
struct MeshMinimum {
  double distance;         ///< m, not negative
  Vector3<double> normal;  ///< into the surface as seen from the sample point
  std::uint32_t group;
  bool behind;

  std::uint32_t name() const { return group << direction_bits | direction_code(normal); }
};
using MeshMinima = ShortList<MeshMinimum, 16>;

/// The distance from points to the triangles of a mesh.
class DistanceToMesh {
 public:
  /// `has_inner_side`: whether what comes behind the triangles is told from what is before them.
  DistanceToMesh(const MeshData& data, bool has_inner_side) : data_(data), has_inner_side_(has_inner_side) {}

  /// All local minima within a radius (m).
  void find_minima(const Vector3<double>& p, double radius, MeshMinima::Items& found) const {
    const double reach2 = radius * radius;
    data_.tree.for_each_near(p, reach2, [&](std::uint32_t f) {
      const Face& face = data_.faces[f];
      if (std::abs(dot(p - face.a, face.normal)) >= radius) return;  // already its plane is too far
      const NearestOnFace q = face.nearest(p);
      const Vector3<double> v = p - q.point;
      const double distance2 = dot(v, v);
      if (distance2 >= reach2 || !is_minimum(f, q, v)) return;
      found.push_back(minimum_at(f, q, v, std::sqrt(distance2)));
    });
  }
  /// The nearest point of the mesh within a depth (m); false if there is none.
  bool find_nearest(const Vector3<double>& p, double depth, MeshMinimum& nearest) const {
    double reach2 = depth * depth;
    bool any = false;
    std::uint32_t face = 0;
    NearestOnFace at{};
    data_.tree.for_each_near(p, reach2, [&](std::uint32_t f) {
      const NearestOnFace q = data_.faces[f].nearest(p);
      const Vector3<double> v = p - q.point;
      const double distance2 = dot(v, v);
      if (distance2 > reach2 || (any && distance2 == reach2)) return;
      reach2 = distance2;
      any = true;
      face = f;
      at = q;
    });
    if (any) nearest = minimum_at(face, at, p - at.point, std::sqrt(reach2));
    return any;
  }

 private:
  using Part = NearestOnFace::Part;

  /// True if the nearest point of face f is a local minimum of the distance to the whole surface. A generous tolerance
  /// does no harm: what is found twice has one normal and becomes one contact.
  bool is_minimum(std::uint32_t f, const NearestOnFace& q, const Vector3<double>& v) const {
    constexpr double tolerance = 1e-7;
    const MeshData& m = data_;
    if (q.part == Part::face) return true;
    const double length2 = dot(v, v);
    if (q.part == Part::edge) {
      const std::uint32_t other = m.topology.neighbour[f][q.number];
      if (other == MeshTopology::none) return true;
      const Vector3<double> e = edge(f, q.number);
      const Vector3<double> into = cross(e, m.faces[other].normal);  // from the edge into the other triangle
      return dot(v, into) <= tolerance * std::sqrt(length2 * dot(e, e));
    }
    const std::uint32_t vertex = m.mesh.triangles[f][q.number];
    for (std::uint32_t k = m.ring_first[vertex]; k < m.ring_first[vertex + 1]; ++k) {
      const Vector3<double> e = m.vertices[m.ring[k]] - m.vertices[vertex];
      if (dot(v, e) > tolerance * std::sqrt(length2 * dot(e, e))) return false;
    }
    return true;
  }
  Vector3<double> edge(std::uint32_t f, int k) const {
    const Face& face = data_.faces[f];
    return k == 0 ? face.ab : k == 1 ? face.ac - face.ab : -face.ac;
  }

  /// The contact at a minimum; which side p is on is told by the normal there: of the face, of both faces of an edge,
  /// or the angle-weighted one of a vertex.
  MeshMinimum minimum_at(std::uint32_t f, const NearestOnFace& q, const Vector3<double>& v, double distance) const {
    const MeshData& m = data_;
    Vector3<double> outward = m.faces[f].normal;
    std::uint32_t group = m.groups.group[f];
    bool sided = true, flat = q.part == Part::face;
    if (q.part == Part::edge) {
      const std::uint32_t other = m.topology.neighbour[f][q.number];
      if (other != MeshTopology::none) {
        flat = detail::is_flat(outward, m.faces[other].normal);
        if (!flat) outward += m.faces[other].normal;
        group = std::min(group, m.groups.group[other]);
      } else {
        sided = false;  // beside the rim of a sheet there is no behind
      }
    } else if (q.part == Part::vertex) {
      const std::uint32_t vertex = m.mesh.triangles[f][q.number];
      sided = m.vertex_rim[vertex] == 0;
      flat = sided && m.vertex_flat[vertex] != 0;
      if (!flat) outward = m.vertex_normal[vertex];
      group = m.vertex_group[vertex];
    }
    const bool behind = sided && has_inner_side_ && dot(v, outward) < 0.0;
    Vector3<double> normal;
    if (flat) {  // free of the rounding of the nearest point
      normal = dot(v, outward) < 0.0 && !behind ? outward : -outward;
      distance = std::abs(dot(v, outward));
    } else if (distance > 1e-12 * m.mean_edge) {
      normal = (behind ? 1.0 : -1.0) / distance * v;
    } else {
      normal = -1.0 / max(norm(outward), 1e-300) * outward;
    }
    return {distance, normal, group, behind};
  }

  const MeshData& data_;
  bool has_inner_side_;
};

}  // namespace dem::surface
