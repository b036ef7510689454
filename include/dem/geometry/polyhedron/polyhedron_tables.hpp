#pragma once

#include <dem/core/aligned.hpp>
#include <dem/geometry/polyhedron/convex_mesh.hpp>

#include <cstdint>
#include <vector>

namespace dem::shape {

/// A convex body as the contact kernels read it, in its own frame: made once a species, shared by its grains. Columns
/// of doubles are padded to whole packs; the planes that pad lie out of everybody's reach.
struct PolyhedronTables {
  static constexpr int most_corners = 64, most_faces = 2 * most_corners - 4, most_edges = 3 * most_corners - 6;

  struct Edge {
    int tail, head, left, right;
    Vector3<double> direction;  ///< unit vector from tail to head, along cross(normal of left, normal of right)
  };
  /// A side of a face: from its corner to the corner of the face's next side.
  struct Side {
    int corner, edge;
    Vector3<double> outward;  ///< unit vector in the plane of the face
    double offset;            ///< outward . x = offset on the side
  };

  int corners = 0, faces = 0, edges = 0;
  int corner_lanes = 0, face_lanes = 0;  ///< padded
  AlignedVector<double> corner_x, corner_y, corner_z;
  AlignedVector<double> normal_x, normal_y, normal_z, offset;
  std::vector<Edge> edge;
  std::vector<Side> side;
  std::vector<int> first_side;  ///< of each face, and one entry more
  std::vector<int> fan;         ///< the faces around each corner
  std::vector<int> first_fan;
  std::vector<double> corner_share;  ///< what a corner shows to surfaces, see Polyhedron::sample_points
  double radius = 0.0;               ///< m, of the sphere of the same volume

  PolyhedronTables() = default;

  /// Throws Error if the body has more corners than the kernels have room for.
  explicit PolyhedronTables(const ConvexMesh& mesh)
      : corners(static_cast<int>(mesh.corners.size())),
        faces(static_cast<int>(mesh.faces.size())),
        edges(static_cast<int>(mesh.edges.size())),
        corner_lanes(round_up_to_pack(corners)),
        face_lanes(round_up_to_pack(faces)) {
    if (corners > most_corners) {
      fail("a polyhedron has {} corners, but may have {} at most; give fewer points or a coarser mesh", corners,
           most_corners);
    }
    const auto nc = static_cast<std::size_t>(corner_lanes), nf = static_cast<std::size_t>(face_lanes);
    for (auto* column : {&corner_x, &corner_y, &corner_z}) column->resize(nc);
    for (auto* column : {&normal_x, &normal_y, &normal_z}) column->resize(nf, 0.0);
    offset.resize(nf, 1e30);
    for (std::size_t k = 0; k < nc; ++k) {
      const Vec3& p = mesh.corners[std::min(k, mesh.corners.size() - 1)];
      corner_x[k] = p.x();
      corner_y[k] = p.y();
      corner_z[k] = p.z();
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      normal_x[f] = mesh.normals[f].x();
      normal_y[f] = mesh.normals[f].y();
      normal_z[f] = mesh.normals[f].z();
      offset[f] = mesh.offsets[f];
    }
    for (const ConvexMesh::Edge& e : mesh.edges) {
      const Vec3 along =
          mesh.corners[static_cast<std::size_t>(e.head)] - mesh.corners[static_cast<std::size_t>(e.tail)];
      edge.push_back({e.tail, e.head, e.left, e.right, from_eigen(along.normalized())});
    }
    list_sides(mesh);
    list_fans(mesh);
  }

  DEM_HOT Vector3<double> corner(int k) const {
    const auto i = static_cast<std::size_t>(k);
    return {corner_x[i], corner_y[i], corner_z[i]};
  }
  DEM_HOT Vector3<double> normal(int f) const {
    const auto i = static_cast<std::size_t>(f);
    return {normal_x[i], normal_y[i], normal_z[i]};
  }

  // Faces, edges and corners have numbers of their own, from which features are made.
  std::uint32_t face_element(int f) const { return static_cast<std::uint32_t>(f); }
  std::uint32_t edge_element(int e) const { return static_cast<std::uint32_t>(faces + e); }
  std::uint32_t corner_element(int k) const { return static_cast<std::uint32_t>(faces + edges + k); }

 private:
  void list_sides(const ConvexMesh& mesh) {
    std::map<std::pair<int, int>, int> number;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      number[{mesh.edges[e].tail, mesh.edges[e].head}] = number[{mesh.edges[e].head, mesh.edges[e].tail}] =
          static_cast<int>(e);
    }
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      first_side.push_back(static_cast<int>(side.size()));
      const auto& face = mesh.faces[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        const int from = face[k], to = face[(k + 1) % face.size()];
        const Vec3 tail = mesh.corners[static_cast<std::size_t>(from)];
        const Vec3 along = mesh.corners[static_cast<std::size_t>(to)] - tail;
        const Vec3 outward = cross(along, mesh.normals[f]).normalized();
        side.push_back({from, number.at({from, to}), from_eigen(outward), outward.dot(tail)});
      }
    }
    first_side.push_back(static_cast<int>(side.size()));
  }

  /// A corner's share in a face is one over the face's number of corners. What it shows to surfaces is the mean over
  /// its faces, each with the weight of its area.
  void list_fans(const ConvexMesh& mesh) {
    std::vector<double> share(mesh.corners.size(), 0.0), weight(mesh.corners.size(), 0.0);
    for (const auto& face : mesh.faces) {
      const double a = detail::area_vector(mesh.corners, face).norm();
      for (const int k : face) {
        share[static_cast<std::size_t>(k)] += a / static_cast<double>(face.size());
        weight[static_cast<std::size_t>(k)] += a;
      }
    }
    for (std::size_t k = 0; k < mesh.corners.size(); ++k) {
      corner_share.push_back(share[k] / weight[k]);
      first_fan.push_back(static_cast<int>(fan.size()));
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& face = mesh.faces[f];
        if (std::find(face.begin(), face.end(), static_cast<int>(k)) != face.end()) fan.push_back(static_cast<int>(f));
      }
    }
    first_fan.push_back(static_cast<int>(fan.size()));
  }
};

}  // namespace dem::shape
